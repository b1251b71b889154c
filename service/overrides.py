"""What a command or a request may set in place of the scene's own."""

from __future__ import annotations

import re
from typing import get_args

from schema import Render
from schema.scene import MAX_PIXELS

METHODS: tuple[str, ...] = get_args(Render.model_fields["method"].annotation)
# The methods that take `samples`. What `auto` and the others leave to csg takes as many as the tolerance asks for,
# 64 x 64 a footprint at the most, whatever `samples` says.
SAMPLED = frozenset({"lines", "csg", "geometry", "relief"})
MAX_SIDE = 8192  # as the camera's


def method_fault(method: str) -> str | None:
    """What is wrong with a method's name; None where it is one."""
    return None if method in METHODS else f"expected one of {', '.join(METHODS)}, found {method!r}"


def resolution(text: str) -> tuple[int, int]:
    """Width and height from WxH; a ValueError says what is wrong."""
    match = re.fullmatch(r"([1-9][0-9]{0,5})x([1-9][0-9]{0,5})", text, re.ASCII)
    width, height = (int(match[1]), int(match[2])) if match else (0, 0)
    if not match or max(width, height) > MAX_SIDE or width * height > MAX_PIXELS:
        limits = f"each side 1 to {MAX_SIDE}, at most {MAX_PIXELS} pixels in all"
        raise ValueError(f"expected WxH as in 640x480, {limits}, found {text[:80]!r}")
    return width, height
