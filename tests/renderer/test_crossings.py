"""Crossings found at compile time, against closed forms and a look at every pair."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import schema
from renderer.compile import PatternCache
from renderer.tables import Floats

Json = dict[str, Any]


def crossings(*paths: Json, repeat: Json | None = None) -> Floats:
    grooves = [{"path": path, "profile": {"type": "v", "width": 0.05, "depth": 0.05}} for path in paths]
    if repeat is not None:
        grooves[0]["repeat"] = repeat
    pattern = schema.Pattern.model_validate({"grooves": grooves}, strict=False)
    return PatternCache().pattern(pattern).tables.grid.crossings


def line(*points: tuple[float, float], closed: bool = False) -> Json:
    return {"type": "polyline", "points": [list(point) for point in points], "closed": closed}


def circle(x: float, y: float, radius: float) -> Json:
    return {"type": "circle", "center": [x, y], "radius": radius}


def same(found: Floats, expected: list[tuple[float, float]]) -> None:
    assert len(found) == len(expected)
    assert np.array(sorted(map(tuple, found.round(9)))) == pytest.approx(np.array(sorted(expected)), abs=1e-8)


def test_a_line_over_a_row() -> None:
    found = crossings(
        line((0, 0), (0, 1)), line((-1, 0.5), (9, 0.5)), repeat={"type": "linear", "count": 8, "step": [1, 0]}
    )
    same(found, [(i, 0.5) for i in range(8)])


def test_circles() -> None:
    """Unit circles a unit apart meet at x = 1/2, y = ± sqrt(3)/2; the line through both centres meets each twice."""
    same(crossings(circle(0, 0, 1), circle(1, 0, 1)), [(0.5, math.sqrt(0.75)), (0.5, -math.sqrt(0.75))])
    same(crossings(circle(0, 0, 1), line((-3, 0), (3, 0))), [(-1, 0), (1, 0)])
    same(crossings(circle(0, 0, 1), circle(0, 0, 1.5), circle(5, 0, 1)), [])


def test_joints_and_ends() -> None:
    """A corner is no crossing; a path that crosses itself has one; an end on another path is one."""
    same(crossings(line((0, 0), (1, 0), (1, 1))), [])
    same(crossings(line((0, 0), (1, 0), (1, 1), (0, 1), closed=True)), [])
    same(crossings(line((0, 0), (2, 0), (2, 1), (1, 1), (1, -1))), [(1, 0)])
    same(crossings(line((0, 0), (2, 0)), line((1, 0), (1, 1))), [(1, 0)])


@settings(max_examples=40, deadline=None)
@given(st.lists(st.tuples(*[st.integers(0, 40)] * 4).filter(lambda p: p[:2] != p[2:]), min_size=2, max_size=12))
def test_lines_cross_where_every_pair_says(lines: list[tuple[int, int, int, int]]) -> None:
    """By the signs of areas, in whole numbers; pairs that touch at an end or overlap are left to the tests above."""

    def side(a: tuple[int, ...], x: int, y: int) -> int:
        return (a[2] - a[0]) * (y - a[1]) - (a[3] - a[1]) * (x - a[0])

    proper = touching = 0
    for i, a in enumerate(lines):
        for b in lines[i + 1 :]:
            signs = side(a, b[0], b[1]) * side(a, b[2], b[3]), side(b, a[0], a[1]) * side(b, a[2], a[3])
            proper += signs[0] < 0 and signs[1] < 0
            touching += 0 in signs
    found = crossings(*(line(a[:2], a[2:]) for a in lines))
    assert proper <= len(found) <= proper + touching
