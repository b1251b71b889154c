"""Solids of spheres and cylinders as they leave for a file: closed, of the volume that closed forms say, as high as
the pattern is."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

import schema
from renderer import maps
from renderer.compile import CompiledScene, PatternCache, compile_scene
from renderer.errors import RenderError
from renderer.export import body, volume
from renderer.wrapped import CELL

from .scenes import Floats, Json
from .solids import BOX, RIDGE, ROUNDING, TOWER, TURN, V, assert_closed, groove, tracer

SPHERE: Json = {"type": "sphere", "radius": 1}
CYLINDER: Json = {"type": "cylinder", "radius": 1, "height": 2}
TALL = {"sphere": math.pi, "cylinder": 2.0}  # with these mappings a pattern unit is about a world unit
COLUMNS = math.ceil(TURN / CELL)
GON = 0.5 * COLUMNS * math.sin(TURN / COLUMNS)  # the area of the regular polygon in the unit circle
CASES: dict[str, list[Json]] = {
    "crossing": [groove([[-1, 1], [9, 1.2]], V), groove([[3, -1], [3.2, 4]], BOX), groove([[1, 0.5], [2, 1.5]], RIDGE)],
    # Grooves that begin, end, cross and run along the seam, over poles and ends.
    "seam": [groove([[-1, 0.5], [1, 1.7]], V), groove([[5, 1.6], [8, 0.2]], RIDGE), groove([[0, 1.2], [0, 1.9]], BOX),
             groove([[TURN, 0.2], [TURN, 1.3]], RIDGE, ends="flat")],
    "ends": [groove([[0.3, -1], [0.5, 4]], BOX), groove([[2, -1], [2.5, 4]], RIDGE), groove([[-1, 0], [8, 0.1]], V),
             groove([[-1, 2.0], [8, 2.0]], BOX)],
    "walls that lean": [groove([[0.0, 0.0], [0.0, 0.5]], {"type": "round", "width": 0.2, "depth": 0.1, "facets": 6},
                               ends="flat"), groove([[3.35, 2.28], [0.0, 1.17], [0.0, 0.9]], RIDGE),
                        groove([[1.16, 2.19], [-0.16, 0.43]], {**V, "width": 0.2}, ends="flat")],
    "steps": [groove([[0, 0.25], [0.5, 0.25]], TOWER, ends="flat"),
              groove([[TURN - 0.5, 0.75], [TURN, 0.75]], TOWER, ends="flat"),
              groove([[TURN - 0.5, 1.5], [TURN, 1.6]], {**TOWER, "depth": 0.2}, ends="flat")],
}  # fmt: skip


@pytest.fixture
def compiled(plate: Callable[..., Json]) -> Callable[..., CompiledScene]:
    def make(shape: Json, grooves: list[Json], **more: Any) -> CompiledScene:
        scene = plate(grooves)
        scene["objects"][0] |= {"shape": shape, "mapping": {"scale": [TURN, TALL[shape["type"]]]}, **more}
        report = schema.check(scene)
        assert report.scene is not None, report
        return compile_scene(report.scene, (1, 1), PatternCache(), None)

    return make


@pytest.mark.parametrize("turned", [False, True])
@pytest.mark.parametrize("shape", [SPHERE, CYLINDER], ids=lambda shape: shape["type"])
@pytest.mark.parametrize("name", CASES)
def test_closed(name: str, shape: Json, turned: bool, compiled: Callable[..., CompiledScene]) -> None:
    place = {"rotate": [20, 30, 40], "translate": [0.3, 0.2, 0.7]} if turned else {}
    solid = body(compiled(shape, CASES[name], **place), 0)
    read = assert_closed(solid)
    assert read.volume == pytest.approx(volume(solid))
    # Grooves and ridges are 0.1 or 0.15 deep and cover less than a third.
    bare = 4.0 / 3.0 * math.pi if shape is SPHERE else TURN
    assert 0.9 * bare < volume(solid) < 1.05 * bare


def test_volume_of_a_bare_sphere(compiled: Callable[..., CompiledScene]) -> None:
    """Its cells are flat, two corners on one and two on another circle of latitude: a pile of frustums.

    With cells of h: their polygons have sin(h) / h of the circle's area, 1 - h^2 / 6, and chords along the meridian
    lie h^2 / 12 deep on average, which takes three times that.
    """
    tilt = np.linspace(-0.5 * math.pi, 0.5 * math.pi, math.ceil(math.pi / CELL) + 1)
    r, z = np.cos(tilt), np.sin(tilt)
    pile = GON / 3.0 * float((np.diff(z) * (r[1:] ** 2 + r[:-1] ** 2 + r[1:] * r[:-1])).sum())
    found = volume(body(compiled(SPHERE, []), 0))
    assert found == pytest.approx(pile, abs=4.0 * math.pi * ROUNDING)
    assert found == pytest.approx(4.0 / 3.0 * math.pi, rel=CELL**2 * (1.0 / 6.0 + 1.0 / 4.0))


def test_volume_of_a_bare_cylinder(compiled: Callable[..., CompiledScene]) -> None:
    found = volume(body(compiled(CYLINDER, []), 0))
    assert found == pytest.approx(2.0 * GON, abs=6.0 * math.pi * ROUNDING)
    assert found == pytest.approx(TURN, rel=CELL**2 / 6.0)


@pytest.mark.parametrize("share", [1.0, 0.5])
def test_volume_of_a_ring(share: float, compiled: Callable[..., CompiledScene]) -> None:
    """A V around the cylinder, wholly or from the seam half around, takes GON (R^2 - r^2) along the axis: with r from
    1 - d to 1 over half a width, a (d - d^2 / 3) on either side. Where it fits itself the seam has no wall."""
    line = [[0.0, 1.0], [share * TURN, 1.0]]
    solid = body(compiled(CYLINDER, [groove(line, V, ends="flat")]), 0)
    half, deep = 0.15, 0.1
    left = 2.0 * half * share * GON * (deep - deep**2 / 3.0)
    assert volume(solid) == pytest.approx(2.0 * GON - left, abs=6.0 * math.pi * ROUNDING)
    corners = solid.vertices[solid.triangles]
    wall = ((corners[:, :, 0] > 0.5) & (abs(corners[:, :, 1]) < 1e-6) & (abs(corners[:, :, 2]) < 0.9)).all(axis=1)
    assert wall.any() == (share < 1.0)


@pytest.mark.parametrize("shape", [SPHERE, CYLINDER], ids=lambda shape: shape["type"])
def test_heights(shape: Json, compiled: Callable[..., CompiledScene]) -> None:
    """Rays along the normals of the bare shape, at the very points that a texel of the map of heights is the mean of.

    Over a cell, of a diagonal of sqrt(2) CELL, points of chords are off by at most (sqrt(2) CELL)^2 / 8 of the second
    derivatives, which are 1.1 with the heights' part; as much sideways, on slopes of up to 0.67 / sqrt(cos 69 deg).
    """
    grooves = [
        groove([[-1, 0.7], [9, 1.4]], V),
        groove([[3, -1], [3.4, 4]], V),
        groove([[0.2, 1.3], [1.1, 1.6]], RIDGE),
    ]
    scene = compiled(shape, grooves)
    size = 24
    at = (np.arange(size * maps.K) + 0.5) / (size * maps.K)
    u, v = (axis.ravel() for axis in np.meshgrid(at, at[::-1]))
    if shape is SPHERE:
        tilt = math.pi * (v - 0.5)
        out = np.stack([np.cos(tilt) * np.cos(TURN * u), np.cos(tilt) * np.sin(TURN * u), np.sin(tilt)], axis=1)
        start, known = 2.0 * out, abs(tilt) < 1.2
    else:
        out = np.stack([np.cos(TURN * u), np.sin(TURN * u), np.zeros_like(u)], axis=1)
        start, known = 2.0 * out + np.stack([0 * u, 0 * u, 2.0 * v - 1.0], axis=1), np.ones(len(u), np.bool_)
    hits, rays, _ = tracer(body(scene, 0)).ray.intersects_location(start, -out, False)
    top = np.full(len(u), np.nan)
    top[rays] = np.einsum("ij,ij->i", hits, out[rays]) - 1.0

    def texels(values: Floats) -> Floats:
        return np.asarray(values.reshape(size, maps.K, size, maps.K).mean(axis=(1, 3)))

    found = maps.texture(scene, 0, "height", (size, size))
    whole = texels(known.astype(np.float64)) == 1.0
    assert np.ptp(found) > 0.1
    limit = 1.1 * (2.0 * CELL**2 / 8.0) * (1.0 + 0.67 / math.sqrt(math.cos(1.2)))
    assert np.abs(found - texels(top))[whole].max() < limit


def test_materials(compiled: Callable[..., CompiledScene], plate: Callable[..., Json]) -> None:
    """The groove's is on its facets alone: the wall at the seam and the caps are the object's."""
    scene = plate([groove([[0.0, 1.0], [3.0, 1.0]], V, ends="flat", material="brass")])
    scene["materials"]["brass"] = {}
    scene["objects"][0] |= {"shape": CYLINDER, "mapping": {"scale": [TURN, 2.0]}}
    report = schema.check(scene)
    assert report.scene is not None
    solid = body(compile_scene(report.scene, (1, 1), PatternCache(), None), 0)
    brass = solid.material == list(scene["materials"]).index("brass")
    assert brass.any()
    centre = solid.vertices[solid.triangles[brass]].astype(np.float64).mean(axis=1)
    assert (np.hypot(centre[:, 0], centre[:, 1]) < 1.0).all()
    assert (abs(centre[:, 2]) < 0.15).all()
    assert (abs(centre[:, 1]) > 1e-6).all()


@pytest.mark.parametrize(
    ("shape", "grooves", "options", "words"),
    [
        (SPHERE, [groove([[1, 1], [2, 1]], {**V, "depth": 1.1})], {}, "a groove of depth 1.1 in a radius of 1"),
        (CYLINDER, CASES["crossing"], {"limit": 2000}, "more than 2000"),
        (CYLINDER, [], {"thickness": 0.5}, "expected a rectangle or an open mesh, as a thickness"),
    ],
)
def test_refused(
    shape: Json, grooves: list[Json], options: Json, words: str, compiled: Callable[..., CompiledScene]
) -> None:
    with pytest.raises(RenderError, match=words):
        body(compiled(shape, grooves), 0, **options)
