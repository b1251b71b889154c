"""Parts of kernels, run alone."""

from __future__ import annotations

from typing import Any

from renderer.kernel import kernel


def alone(part: Any) -> Any:
    """A leaf or a callee as a kernel of its own, for Python to call."""
    return kernel(part.py_func)
