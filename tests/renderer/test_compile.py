"""Patterns are compiled once: what is kept, what is built anew, and how large the tables are."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

import schema
from renderer import grid, pipeline
from renderer.compile import PatternCache, internal, table_bytes
from renderer.tables import Pattern

Json = dict[str, Any]
V = {"type": "v", "width": 0.1, "depth": 0.05}


def groove(**more: Any) -> Json:
    return {"path": {"type": "polyline", "points": [[0, 0], [1, 0.5], [0.5, 1]]}, "profile": V} | more


def pattern(*grooves: Json, tile: list[float] | None = None) -> schema.Pattern:
    return schema.Pattern.model_validate({"tile": tile, "grooves": list(grooves)})


def tables(*grooves: Json, tile: list[float] | None = None) -> Pattern:
    return PatternCache().pattern(pattern(*grooves, tile=tile)).tables


# --- what is built anew ---


def test_a_new_camera_light_or_material_compiles_nothing(
    plate: Callable[..., Json], picture: Callable[..., pipeline.Picture]
) -> None:
    cache = PatternCache()
    first = plate([groove()])
    picture(first, resolution=(4, 3), patterns=cache)
    assert cache.builds == {"paths": 1, "patterns": 1}
    for change in (
        {"camera": first["camera"] | {"fov": 60}},
        {"lights": [{"type": "constant", "radiance": [1, 1, 1]}]},
        {"materials": {"stone": {"base_color": [0.1, 0.2, 0.3]}}},
        {"render": {"method": "csg", "samples": 4}},
        {"objects": [first["objects"][0] | {"rotate": [10, 0, 0], "mapping": {"scale": [3, 3]}}]},
    ):
        picture(first | change, resolution=(4, 3), patterns=cache)
    assert cache.builds == {"paths": 1, "patterns": 1}


@pytest.mark.parametrize(
    "change",
    [
        {"profile": {"type": "v", "width": 0.1, "depth": -0.2}},
        {"profile": {"type": "round", "width": 0.12, "depth": 0.05}},
        {"scale": {"type": "sine", "amplitude": 0.5, "periods": 3}},
        {"material": "brass"},
        {"priority": 3},
        {"ends": "flat"},
    ],
    ids=lambda change: next(iter(change)),
)
def test_what_is_no_path_does_not_rebuild_the_grid(change: Json) -> None:
    cache = PatternCache()
    first = cache.pattern(pattern(groove())).tables
    second = cache.pattern(pattern(groove(**change))).tables
    assert cache.builds == {"paths": 1, "patterns": 2}
    assert second.grid is first.grid


def test_curves_keep_their_grid_while_the_path_decides_how_fine_they_are() -> None:
    cache = PatternCache()
    path = {"path": {"type": "svg", "d": "M0,0 C1,2 2,0 3,1"}}
    cache.pattern(pattern(groove(**path)))
    cache.pattern(pattern(groove(**path, profile={"type": "v", "width": 0.11, "depth": 0.2})))
    assert cache.builds == {"paths": 1, "patterns": 2}


@pytest.mark.parametrize(
    "change",
    [
        {"path": {"type": "polyline", "points": [[0, 0], [1, 0.5]]}},
        {"repeat": {"type": "linear", "count": 2, "step": [0.1, 0]}},
    ],
)
def test_a_new_path_does(change: Json) -> None:
    cache = PatternCache()
    cache.pattern(pattern(groove()))
    cache.pattern(pattern(groove(**change)))
    assert cache.builds == {"paths": 2, "patterns": 2}


def test_the_oldest_are_dropped() -> None:
    """A limit that holds about three of the patterns; what has been asked for lately stays."""
    probe = PatternCache()
    probe.pattern(pattern(groove()))
    cache = PatternCache(limit=int(3.5 * probe._bytes))

    def take(index: int) -> None:
        cache.pattern(pattern(groove(path={"type": "polyline", "points": [[0, 0], [1, 0.5 + index], [0.5, 1]]})))
        assert cache._bytes <= cache.limit
        assert cache._bytes == sum(table_bytes(kept) for kept in cache._kept.values())

    for index in range(9):
        take(index)
        if index:
            take(0)
    built = cache.builds["patterns"]
    assert built == 9
    take(0)
    take(8)
    assert cache.builds["patterns"] == built
    take(1)
    assert cache.builds["patterns"] == built + 1


# --- the grid ---


SHAPES: dict[str, list[Json]] = {
    "lines": [groove(repeat={"type": "scatter", "count": 60, "seed": 4, "bounds": [0, 0, 9, 7]})],
    "circles": [
        groove(
            path={"type": "circle", "center": [1, 2], "radius": 0.1},
            repeat={"type": "concentric", "count": 30, "step": 0.2},
        )
    ],
    "curves": [
        groove(path={"type": "svg", "d": "M0,0 C3,5 5,-3 6,4 A2,1 30 1 0 1,3 Z"}),
        groove(path={"type": "spiral", "center": [2, 2], "inner_radius": 0.1, "outer_radius": 3, "turns": 9}),
    ],
    "one line": [groove(path={"type": "polyline", "points": [[0, 3], [5, 3]]})],
}


@pytest.mark.parametrize("name", SHAPES)
def test_every_cell_that_a_path_crosses_lists_it(name: str) -> None:
    """Points close together on the centre lines, by hand: each must fall into a cell that lists its piece."""
    made = tables(*SHAPES[name])
    g = made.grid
    assert g.shape.min() >= 1
    assert int(g.shape[0]) * int(g.shape[1]) <= grid.CELLS
    assert g.first[-1] == len(g.items)
    for row, piece in enumerate(made.pieces):
        count = 2 + int(piece["length"] / (0.05 * g.cell.min()))
        s = np.linspace(0.0, piece["length"], min(count, 2000))
        k = piece["curvature"]
        along, across = (s, 0.0 * s) if k == 0.0 else (np.sin(s * k) / k, (1.0 - np.cos(s * k)) / k)
        p = piece["x"] + along * piece["tx"] - across * piece["ty"]
        q = piece["y"] + along * piece["ty"] + across * piece["tx"]
        ix, iy = ((p - g.origin[0]) / g.cell[0]).astype(int), ((q - g.origin[1]) / g.cell[1]).astype(int)
        assert ix.min() >= 0
        assert iy.min() >= 0
        for cell in set((np.minimum(iy, g.shape[1] - 1) * g.shape[0] + np.minimum(ix, g.shape[0] - 1)).tolist()):
            assert row in g.items[g.first[cell] : g.first[cell + 1]]
    for cell in range(len(g.first) - 1):
        listed = g.items[g.first[cell] : g.first[cell + 1]]
        assert (np.diff(listed) > 0).all()


def test_the_grid_is_bounded() -> None:
    """However fine the grooves and however many."""
    many = tables(
        groove(
            profile={"type": "v", "width": 1e-5, "depth": 1e-5},
            repeat={"type": "scatter", "count": 3000, "seed": 1, "bounds": [0, 0, 50, 50]},
        )
    )
    assert int(many.grid.shape[0]) * int(many.grid.shape[1]) <= grid.CELLS
    assert len(many.grid.items) < 200 * len(many.pieces)


# --- sizes ---


def test_bytes_of_250_parallel_lines() -> None:
    lines = groove(
        path={"type": "polyline", "points": [[0.002, -1], [0.002, 2]]},
        profile={"type": "v", "width": 0.004, "depth": 0.003},
        repeat={"type": "linear", "count": 250, "step": [0.004, 0]},
    )
    made = PatternCache().pattern(pattern(lines))
    assert len(made.tables.pieces) == 250
    assert made.tables.parallel
    assert made.bytes <= 32 * 1024


def test_bytes_of_a_record_of_500_circles() -> None:
    circles = groove(
        path={"type": "circle", "center": [0.5, 0.5], "radius": 0.2},
        profile={"type": "v", "width": 0.0004, "depth": 0.0002},
        repeat={"type": "concentric", "count": 500, "step": 0.0005},
    )
    made = PatternCache().pattern(pattern(circles))
    assert len(made.tables.pieces) == 500
    assert made.bytes <= 200 * 1024


# --- cross-sections ---


@pytest.mark.parametrize(
    ("points", "expected"),
    [
        ([(-1, 0), (0, -1), (1, 0)], (0, 2)),  # a v: all internal
        ([(-1, 0), (0, 1), (1, 0)], (0, 0)),  # a ridge: none
        ([(-2, 0), (-1, 1), (0, -1), (1, 1), (2, 0)], (1, 3)),  # lips are external
        ([(-2, 0), (-1, 1), (0, 0.5), (1, 1), (2, 0)], (1, 3)),  # a dent in a ridge is internal
        ([(-1, 0), (-1, -1), (1, -1), (1, 0)], (0, 3)),  # vertical walls descend
        ([(-1, 0), (-1, 1), (1, 1), (1, 0)], (0, 0)),
        ([(-2, 0), (-1, 0), (0, -1), (1, 0)], (1, 3)),  # level facets do not descend
        ([(-1, 0), (0, -1), (1, 1), (2, 0)], (0, 2)),
    ],
)
def test_internal_facets(points: list[tuple[float, float]], expected: tuple[int, int]) -> None:
    """DESIGN 1.2: external from each end towards the centre while the polyline does not descend."""
    assert internal(points) == expected


def test_reach_covers_mitres_and_ends() -> None:
    """A right angle's mitre reaches sqrt(2) half-widths, so does the corner of a `profile` end; scale included."""
    corner = tables(
        groove(
            path={"type": "polyline", "points": [[0, 0], [1, 0], [1, 1]]},
            ends="flat",
            scale={"type": "linear", "start": 0.5, "end": 2},
        )
    )
    assert corner.width == pytest.approx(0.1)
    assert corner.reach == pytest.approx(0.1 * math.sqrt(2), rel=1e-6)
    assert corner.depth == pytest.approx(0.1)
    assert corner.height == 0.0
    ended = tables(groove(path={"type": "polyline", "points": [[0, 0], [1, 0]]}))
    assert ended.reach == pytest.approx(0.05 * math.sqrt(2), rel=1e-6)


def test_parallel_is_told() -> None:
    line = {"type": "polyline", "points": [[0, 0], [1, 0.5]]}
    back = {"type": "polyline", "points": [[3, 1], [1, 0]]}
    assert tables(groove(path=line), groove(path=back)).parallel
    assert not tables(groove(path=line), groove(path={"type": "polyline", "points": [[0, 0], [1, 0.6]]})).parallel
    assert not tables(groove(path={"type": "circle", "center": [0, 0], "radius": 1})).parallel
