"""The decorators of kernels."""

from __future__ import annotations

import pytest

from renderer.geometry.share import share

from .parts import alone


def test_a_part_is_no_function_of_python() -> None:
    """It has no machine code of its own, says so the first time and the second, and runs in a kernel."""
    for _ in range(2):
        with pytest.raises(TypeError):
            share(1.0, 0.0, -0.25)
    assert alone(share)(1.0, 0.0, -0.25) == 0.75
    with pytest.raises(TypeError):
        share(1.0, 0.0, -0.25)
