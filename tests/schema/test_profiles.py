"""Each profile's polyline against its definition."""

import math
from itertools import pairwise

import pytest
from hypothesis import given
from hypothesis import strategies as st

from schema import RoundProfile, ScratchProfile, TrapezoidProfile, VProfile


def test_v() -> None:
    assert VProfile(type="v", width=2, depth=3).polyline() == ((-1, 0), (0, -3), (1, 0))


def test_trapezoid() -> None:
    assert TrapezoidProfile(type="trapezoid", width=4, floor=2, depth=-1).polyline() == (
        (-2, 0),
        (-1, 1),
        (1, 1),
        (2, 0),
    )


def test_trapezoid_as_wide_as_its_floor_has_vertical_walls() -> None:
    points = TrapezoidProfile(type="trapezoid", width=2, floor=2, depth=1).polyline()
    assert points == ((-1, 0), (-1, -1), (1, -1), (1, 0))


def test_trapezoid_without_floor_is_a_v() -> None:
    assert TrapezoidProfile(type="trapezoid", width=2, floor=0, depth=1).polyline() == ((-1, 0), (0, -1), (1, 0))


def test_scratch() -> None:
    points = ScratchProfile(type="scratch", width=2, depth=1, lip_width=1, lip_height=0.5).polyline()
    assert list(points) == [(-2, 0), (-1.5, 0.5), (-1, 0), (0, -1), (1, 0), (1.5, 0.5), (2, 0)]
    assert len(ScratchProfile(type="scratch", width=2, depth=1).polyline()) == 3


@given(
    width=st.floats(1e-9, 1e6),
    depth=st.floats(1e-9, 1e6),
    ridge=st.booleans(),
    facets=st.integers(2, 256),
)
def test_round_holds_to_the_contract(width: float, depth: float, ridge: bool, facets: int) -> None:
    points = RoundProfile(type="round", width=width, depth=-depth if ridge else depth, facets=facets).polyline()
    assert len(points) == facets + 1
    assert [points[0], points[-1]] == [(-width / 2, 0), (width / 2, 0)]
    assert all(left[0] <= right[0] for left, right in pairwise(points))
    sign = 1 if ridge else -1
    assert all(-1e-9 * depth <= sign * w <= depth * (1 + 1e-9) for _, w in points)


@pytest.mark.parametrize("depth", [0.01, 0.3, 1.0])
def test_round_is_a_circle_while_shallow(depth: float) -> None:
    """The circle through (-1, 0), (0, -d), (1, 0) has radius (1 + d^2) / 2d and its centre that far above (0, -d)."""
    radius = (1 + depth**2) / (2 * depth)
    for b, w in RoundProfile(type="round", width=2, depth=depth, facets=8).polyline():
        assert math.hypot(b, w - (radius - depth)) == pytest.approx(radius)


def test_round_is_an_ellipse_when_deep() -> None:
    for b, w in RoundProfile(type="round", width=2, depth=3, facets=8).polyline():
        assert b**2 + (w / 3) ** 2 == pytest.approx(1)
