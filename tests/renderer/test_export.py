"""The solid as it leaves for a file: closed, of the volume that closed forms say, and what the picture shows."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
import trimesh
from numpy.typing import NDArray

import schema
from renderer import maps, mesh, pipeline
from renderer.compile import CompiledScene, PatternCache, compile_scene
from renderer.errors import RenderError
from renderer.export import Body, body, closed, unpaired, volume

Json = dict[str, Any]
Floats = NDArray[np.float64]

V = {"type": "v", "width": 0.24, "depth": 0.14}
RIDGE = {"type": "v", "width": 0.22, "depth": -0.12}
SCRATCH = {"type": "scratch", "width": 0.18, "depth": 0.12, "lip_width": 0.08, "lip_height": 0.05}
BOX = {"type": "trapezoid", "width": 0.2, "floor": 0.2, "depth": 0.15}
TOWER = {"type": "trapezoid", "width": 0.5, "floor": 0.5, "depth": -0.1}
SVG = "M0.4,0.5 C0.6,1.9 1.0,1.6 1.0,1.0 S1.6,0.3 1.7,1.2 Q1.6,1.7 1.2,1.6 A0.3,0.2 20 0 1 0.7,1.3"


def groove(points: list[list[float]] | str, profile: Json, **more: Any) -> Json:
    path = {"type": "svg", "d": points} if isinstance(points, str) else {"type": "polyline", "points": points}
    return {"path": path, "profile": profile, **more}


def row(profile: Json, count: int = 3, step: float = 0.6, **more: Any) -> Json:
    return groove(
        [[0.26, -1], [0.26, 3]], profile, repeat={"type": "linear", "count": count, "step": [step, 0]}, **more
    )


def across(profile: Json, at: float = 1.0, tilt: float = 0.0, **more: Any) -> Json:
    return groove([[-1, at - 2 * tilt], [3, at + 2 * tilt]], profile, **more)


CASES: dict[str, tuple[list[Json], Json]] = {
    "bare": ([], {}),
    "crossing": ([row(V), across(SCRATCH, 1.0, 0.25)], {}),
    "ridges": ([row(RIDGE), across(RIDGE, 1.0, 0.1)], {}),
    "priorities": ([row(BOX), across(V, 1.0, 0.1, priority=3), across(RIDGE, 1.3, -0.1, priority=2)], {}),
    "tile": ([groove([[0.05, 0.1], [0.45, 0.35]], V), groove([[0.0, 0.0], [0.5, 0.0]], RIDGE)], {"tile": [0.5, 0.4]}),
    "arcs": ([groove(SVG, V)], {}),
    "ends": ([groove([[0.5, 0.6], [1.4, 1.3]], SCRATCH), groove([[0.4, 1.4], [0.8, 1.2]], RIDGE, ends="flat")], {}),
    "corner": ([groove([[0.3, 0.4], [1.1, 1.6], [1.5, 0.6], [1.7, 1.4]], RIDGE)], {}),
    "coincident": ([row(V), row(V), groove([[0.5, 0.9], [1.5, 1.0]], SCRATCH)], {}),
    "walls of no thickness": ([row(BOX, 10, 0.2), across(BOX, 0.5), across(BOX, 0.7)], {}),
    # Towers that touch in vertical edges alone: no closed surface without setting them apart.
    "chessboard": (
        [groove([[i / 2, j / 2 + 0.25], [i / 2 + 0.5, j / 2 + 0.25]], TOWER, ends="flat")
         for i in range(4) for j in range(4) if (i + j) % 2], {},
    ),
}  # fmt: skip


def compiled(scene: Json) -> CompiledScene:
    report = schema.check(scene)
    assert report.scene is not None, report
    return compile_scene(report.scene, (1, 1), PatternCache(), None)


def tracer(solid: Body) -> trimesh.Trimesh:
    return trimesh.Trimesh(solid.vertices.astype(np.float64), solid.triangles, process=False)


@pytest.mark.parametrize("turned", [False, True])
@pytest.mark.parametrize("name", CASES)
def test_closed(name: str, turned: bool, plate: Callable[..., Json]) -> None:
    grooves, parts = CASES[name]
    scene = plate(grooves, **parts)
    if turned:
        scene["objects"][0] |= {"rotate": [20, 30, 40], "translate": [0.3, 0.2, 0.7]}
    solid = body(compiled(scene), 0)
    assert not len(unpaired(solid.triangles))
    assert len(np.unique(solid.vertices, axis=0)) == len(solid.vertices)
    read = tracer(solid)
    assert read.is_watertight
    assert read.is_winding_consistent
    assert read.volume == pytest.approx(volume(solid))
    assert volume(solid) > 0.0


def test_an_edge_along_which_a_part_touches_itself() -> None:
    """Two full layers of 2 x 2 cubes, and between them two that meet in an edge alone: ten cubes."""
    filled = np.ones((2, 2, 3), np.bool_)
    filled[[0, 1], [1, 0], 1] = False
    around = np.pad(filled, 1)
    corners: list[Floats] = []
    for cube in np.argwhere(filled):
        for axis in range(3):
            for side in (-1, 1):
                step = side * np.eye(3, dtype=np.int64)[axis]
                if not around[tuple(cube + 1 + step)]:
                    one, two = np.eye(3)[(axis + 1) % 3], np.eye(3)[(axis + 2) % 3]
                    start = cube + np.maximum(step, 0)
                    face = np.array([start, start + one, start + one + two, start + two])[::side]
                    corners += [face[[0, 1, 2]], face[[0, 2, 3]]]
    triangles = np.arange(3 * len(corners), dtype=np.int32).reshape(-1, 3)
    solid = closed(np.concatenate(corners), triangles, np.zeros(len(corners), np.int32))
    assert not len(unpaired(solid.triangles))
    assert len(np.unique(solid.vertices, axis=0)) == len(solid.vertices)
    assert volume(solid) == pytest.approx(10.0, abs=1e-4)
    assert tracer(solid).is_watertight


@pytest.mark.parametrize("turn", [[0, 0, 0], [10, 20, 30]])
def test_volume_of_grooves(turn: list[float], plate: Callable[..., Json]) -> None:
    """Three V grooves across a stretched plate: each takes away half width times depth of the pattern, as wide as the
    plate is; a pattern unit is (a, b, sqrt(a b)) world units."""
    a, b, thickness = 2.0 / 2.0, 3.0 / 1.5, 0.7
    scene = plate([row(V)], size=[2, 3], mapping={"scale": [2, 1.5]})
    scene["objects"][0] |= {"rotate": turn, "translate": [5, -3, 2]}
    solid = body(compiled(scene), 0, thickness=thickness)
    groove = (0.5 * V["width"] * a) * (V["depth"] * math.sqrt(a * b)) * 3.0  # type: ignore[operator]
    # Single precision moves points by up to 8 * 2^-24: the volume by that over a plate's whole surface.
    assert volume(solid) == pytest.approx(2.0 * 3.0 * thickness - 3.0 * groove, abs=20 * 8 * 2**-24)


def test_what_comes_from_outside_cuts_too(plate: Callable[..., Json]) -> None:
    """A groove along the plate's edge, its axis outside: half of the wall that lies inside is cut away."""
    half, depth, out = 0.2, 0.1, 0.1
    scene = plate([groove([[-out, -1], [-out, 3]], {"type": "v", "width": 2 * half, "depth": depth})])
    left = 0.5 * (half - out) * depth * (half - out) / half
    assert volume(body(compiled(scene), 0, thickness=1.0)) == pytest.approx(4.0 - 2.0 * left, abs=1e-5)


def test_materials(plate: Callable[..., Json]) -> None:
    scene = plate([row(V, material=["brass", None])])
    scene["materials"]["brass"] = {}
    solid = body(compiled(scene), 0)
    a, b, c = (solid.vertices[solid.triangles[:, k]].astype(np.float64) for k in range(3))
    normals = np.cross(b - a, c - a)
    brass = solid.material == list(scene["materials"]).index("brass")
    # The path runs up, so that its left is -x: the first facet, of the least b, is the wall that rises to the right.
    steep = (normals[:, 0] < -1e-6) & (normals[:, 2] > 1e-6)
    assert (brass == steep).all()
    assert brass.any()


@pytest.mark.parametrize(
    ("change", "options", "words"),
    [
        ({}, {"thickness": 0.1}, "does not hold a groove of depth 0.14"),
        ({}, {"limit": 50}, "more than"),
        ({"translate": [1e6, 0, 0]}, {}, "too far off"),
    ],
)
def test_refused(change: Json, options: Json, words: str, plate: Callable[..., Json]) -> None:
    scene = plate([row(V), across(V)])
    scene["objects"][0] |= change
    with pytest.raises(RenderError, match=words):
        body(compiled(scene), 0, **options)


def test_too_many_pieces_are_refused_at_once(plate: Callable[..., Json]) -> None:
    scene = plate([groove([[0, 0], [1e-3, 0]], V)], tile=[0.001, 0.001])
    scene["patterns"]["cut"]["tile"] = [0.01, 0.01]
    with pytest.raises(RenderError, match="more than"):
        body(compiled(scene), 0, limit=1000)


@pytest.mark.parametrize("name", ["crossing", "arcs", "priorities", "ends"])
def test_renders_as_the_scene_does(
    name: str, plate: Callable[..., Json], picture: Callable[..., pipeline.Picture], monkeypatch: pytest.MonkeyPatch
) -> None:
    """What is exported, carried back to pattern space and traced in place of the solid, gives the same picture, and
    with the same samples: one that falls on the other side of an edge changes its pixel by the largest radiance over
    the samples, and all but four have to agree. The camera sees no edge of the plate, where the renderer shows a
    window on a plane that goes on."""
    grooves, _ = CASES[name]
    scene = plate(grooves, camera={"fov": 12})
    solid = body(compiled(scene), 0)
    carried = solid.vertices + np.array([1.0, 1.0, 0.0])  # p, q = x + 1, y + 1
    build = mesh.build  # gives arcs their own normals; files have those of the chords

    def flat(*arguments: Any, **options: Any) -> mesh.SolidMesh:
        made = build(*arguments, **options)
        return made._replace(bend=np.zeros_like(made.bend))

    monkeypatch.setattr(mesh, "build", flat)
    ours = picture(scene, method="geometry", samples=64).radiance.astype(np.float64)
    count = len(solid.triangles)
    exported = mesh.SolidMesh(carried, solid.triangles, np.full(count, -1, np.int32), np.zeros((count, 4)))
    monkeypatch.setattr(mesh, "build", lambda *_, **__: exported)
    theirs = picture(scene, method="geometry", samples=64).radiance.astype(np.float64)
    assert np.ptp(ours) > 0.05
    assert rms(ours - theirs) < float(ours.max()) / 64 * math.sqrt(4 / ours[..., 0].size)


def rms(values: Floats) -> float:
    return float(np.sqrt(np.mean(values**2)))


@pytest.mark.parametrize("name", ["crossing", "ridges", "priorities", "tile", "ends"])
def test_map_of_heights_is_the_solids(name: str, plate: Callable[..., Json]) -> None:
    """Rays straight down on the exported mesh, at the very points that a texel is the mean of."""
    grooves, parts = CASES[name]
    scene = compiled(plate(grooves, **parts))
    size = 24
    at = -1.0 + 2.0 * (np.arange(size * maps.K) + 0.5) / (size * maps.K)
    x, y = np.meshgrid(at, at[::-1])  # rows from the top of the picture
    origins = np.stack([x, y, np.full_like(x, 1.0)], axis=-1).reshape(-1, 3)
    solid = tracer(body(scene, 0))
    hits, rays, _ = solid.ray.intersects_location(origins, np.tile([0.0, 0.0, -1.0], (len(origins), 1)), False)
    top = np.full(len(origins), np.nan)
    top[rays] = hits[:, 2]
    expected = top.reshape(size, maps.K, size, maps.K).mean(axis=(1, 3))
    found = maps.texture(scene, 0, "height", (size, size))
    # A point on a vertical wall may fall to either side of it.
    walls = 1 if name == "priorities" else 0
    assert (np.abs(found - expected) > 2e-5).sum() <= walls * 4 * size
    assert np.median(np.abs(found - expected)) < 2e-6
