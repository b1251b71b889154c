"""The part of a pixel's square on one side of a line, against clipping the square."""

from __future__ import annotations

import math

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from renderer.geometry import share as shares

from .parts import alone

share = alone(shares.share)
NUMBER = st.floats(-10, 10, allow_nan=False)


def clipped(a: float, b: float, c: float) -> float:
    """Area of the unit square where a u + b v + c >= 0: Sutherland and Hodgman, then the shoelace formula."""
    square = [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)]
    kept = []
    for (x0, y0), (x1, y1) in zip(square, [*square[1:], square[0]], strict=True):
        d0, d1 = a * x0 + b * y0 + c, a * x1 + b * y1 + c
        if d0 >= 0.0:
            kept.append((x0, y0))
        if (d0 >= 0.0) != (d1 >= 0.0):
            t = d0 / (d0 - d1)
            kept.append((x0 + t * (x1 - x0), y0 + t * (y1 - y0)))
    return 0.5 * sum(
        x0 * y1 - x1 * y0 for (x0, y0), (x1, y1) in zip(kept, [*kept[1:], kept[0]] if kept else [], strict=True)
    )


@settings(deadline=None)  # the kernel is compiled or loaded in the first example
@given(a=NUMBER, b=NUMBER, c=NUMBER)
def test_against_clipping(a: float, b: float, c: float) -> None:
    """Where the line is well defined: its value must be known at the corners to more than rounding."""
    if max(abs(a), abs(b)) > 1e-6:
        assert share(a, b, c) == pytest.approx(clipped(a, b, c), abs=1e-9)


@settings(deadline=None)
@given(angle=st.floats(0, 7), offset=st.floats(-1, 1), factor=st.floats(1e-12, 1e12))
def test_both_sides_make_the_square_and_length_does_not_matter(angle: float, offset: float, factor: float) -> None:
    a, b = math.cos(angle), math.sin(angle)
    here = share(a, b, offset)
    assert 0.0 <= here <= 1.0
    assert share(-a, -b, -offset) == pytest.approx(1.0 - here, abs=1e-12)
    assert share(a * factor, b * factor, offset * factor) == pytest.approx(here, abs=1e-9)


def test_limits() -> None:
    """A line along an edge, through a corner, through the middle, beside the square; and no line at all."""
    assert share(1.0, 0.0, 0.0) == 1.0
    assert share(1.0, 0.0, -1.0) == 0.0
    assert share(1.0, 0.0, -0.25) == 0.75
    assert share(0.0, -1.0, 0.25) == 0.25
    assert share(1.0, 1.0, -1.0) == 0.5
    assert share(1.0, 1.0, -0.5) == pytest.approx(1.0 - 0.125)
    assert share(1.0, -1.0, 0.0) == 0.5
    assert share(1.0, 1.0, 5.0) == 1.0
    assert share(1.0, 1.0, -5.0) == 0.0
    assert share(0.0, 0.0, 1.0) == 1.0
    assert share(0.0, 0.0, -1.0) == 0.0
