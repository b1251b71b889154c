"""What the renderer raises."""

from __future__ import annotations

from typing import NamedTuple


class Fault(NamedTuple):
    """One reason why a scene cannot be rendered, with the place of it: the same three words as a schema problem's."""

    pointer: str  # JSON pointer into the scene
    expected: str
    found: str


class RenderError(Exception):
    """The scene is valid, but it cannot be rendered as asked."""

    def __init__(self, *faults: Fault) -> None:
        super().__init__("; ".join(f"{f.pointer or '(root)'}: expected {f.expected}, found {f.found}" for f in faults))
        self.faults = faults


class Cancelled(Exception):
    """The caller asked to stop."""
