"""Solids of triangle meshes as they leave for a file: closed, of the volume that closed forms say, and what is
rendered as the ground truth."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
import trimesh

import schema
from renderer import body as truth
from renderer.compile import CompiledScene, PatternCache, compile_scene
from renderer.errors import RenderError
from renderer.export import body, volume
from renderer.tables import LIGHT

from .scenes import Floats, Json
from .solids import BOX, RIDGE, ROUNDING, TOWER, TURN, V, assert_closed, groove, tracer

Corner = tuple[Any, Any, Any]  # place, uv, normal
Soup = list[list[Corner]]
AREA = 0.5 * 0.3 * 0.1  # of a V's cross-section


def quad(places: Any, uv: Any, normal: Any) -> Soup:
    return [[(places[i], uv[i], normal) for i in three] for three in ((0, 1, 2), (0, 2, 3))]


SQUARE = quad([(-1, -1, 0), (1, -1, 0), (1, 1, 0), (-1, 1, 0)], [(0, 0), (1, 0), (1, 1), (0, 1)], (0, 0, 1))


def grid(count: int) -> Soup:
    """The same square of many triangles of odd shapes."""
    draw = np.random.default_rng(count)
    side = np.linspace(0.0, 1.0, count + 1)
    places = np.stack(np.meshgrid(side, side), axis=-1)
    places[1:-1, 1:-1] += draw.uniform(-0.3, 0.3, places[1:-1, 1:-1].shape) / count
    soup: Soup = []
    for i in range(count):
        for j in range(count):
            uv = [places[i, j], places[i, j + 1], places[i + 1, j + 1], places[i + 1, j]]
            soup += quad([(*(2.0 * p - 1.0), 0.0) for p in uv], uv, (0, 0, 1))
    return soup


def halves(shift: float) -> Soup:
    """The square of two islands, with a seam at x = 0, its right half `shift` farther right in uv."""
    left = [(-1, -1, 0), (0, -1, 0), (0, 1, 0), (-1, 1, 0)]
    right = [(0, -1, 0), (1, -1, 0), (1, 1, 0), (0, 1, 0)]
    return [
        *quad(left, [(0, 0), (0.5, 0), (0.5, 1), (0, 1)], (0, 0, 1)),
        *quad(right, [(0.5 + shift, 0), (1 + shift, 0), (1 + shift, 1), (0.5 + shift, 1)], (0, 0, 1)),
    ]


def cube(*, atlas: bool) -> Soup:
    """2 x 2 x 2, each face with a place of its own in uv or all with the same."""
    soup: Soup = []
    for number in range(6):
        normal = np.zeros(3)
        normal[number // 2] = 1 - 2 * (number % 2)
        one = np.roll([1.0, 0.0, 0.0], number // 2 + 1)
        two = np.cross(normal, one)
        uv = np.array([(0, 0), (1, 0), (1, 1), (0, 1)], np.float64)
        if atlas:
            uv = 0.32 * uv + [number % 3 / 3.0, number // 3 / 2.0]
        soup += quad([normal + x * one + y * two for x, y in ((-1, -1), (1, -1), (1, 1), (-1, 1))], uv, normal)
    return soup


def sphere(columns: int, rows: int, *, smooth: bool) -> Soup:
    """The unit sphere with a seam and poles, with its normals or the facets'."""
    soup: Soup = []

    def place(i: int, j: int) -> Floats:
        turn, tilt = TURN * (i % columns) / columns, math.pi * (j / rows - 0.5)
        flat = math.cos(tilt) if 0 < j < rows else 0.0
        return np.array([flat * math.cos(turn), flat * math.sin(turn), math.sin(tilt)])

    for i in range(columns):
        for j in range(rows):
            ends = [(i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)]
            for three in [(0, 1, 2)] * (j > 0) + [(0, 2, 3)] * (j + 1 < rows):
                places = [place(*ends[k]) for k in three]
                facet = np.cross(places[1] - places[0], places[2] - places[0])
                facet /= np.linalg.norm(facet)
                soup.append(
                    [
                        (places[n], (ends[k][0] / columns, ends[k][1] / rows), places[n] if smooth else facet)
                        for n, k in enumerate(three)
                    ]
                )
    return soup


def half(soup: Soup) -> Soup:
    return [triangle for triangle in soup if all(place[2] >= -1e-9 for place, _, _ in triangle)]


def prism(count: int) -> Soup:
    """A cylinder of radius 1 and height 2 with as many flat sides, smooth around, closed; its pattern in world units:
    p along the sides' chords from 0, q from 0, the ends far off."""
    soup: Soup = []
    around = [np.array([math.cos(TURN * k / count), math.sin(TURN * k / count), 0.0]) for k in range(count)]
    chord, up = 2.0 * math.sin(math.pi / count), np.array([0.0, 0.0, 1.0])
    for k in range(count):
        one, two = around[k], around[(k + 1) % count]
        places = [one - up, two - up, two + up, one + up]
        uv = [(k * chord, 0), ((k + 1) * chord, 0), ((k + 1) * chord, 2), (k * chord, 2)]
        corners = list(zip(places, uv, [one, two, two, one], strict=True))
        soup += [[corners[i] for i in three] for three in ((0, 1, 2), (0, 2, 3))]
        for side in (-1, 1):
            ring = [np.zeros(3), one, two][::side]
            soup.append([(p + side * up, (p[0] + 30.0, p[1] + 20.0 + 5.0 * side), side * up) for p in ring])
    return soup


def obj(soup: Soup) -> bytes:
    lines = []
    for number, triangle in enumerate(soup):
        for place, uv, normal in triangle:
            for kind, values in (("v", place), ("vt", uv), ("vn", normal)):
                lines.append(f"{kind} " + " ".join(f"{x:.17g}" for x in values))
        lines.append("f " + " ".join(f"{k}/{k}/{k}" for k in range(3 * number + 1, 3 * number + 4)))
    return "\n".join(lines).encode()


@pytest.fixture
def compiled(plate: Callable[..., Json]) -> Callable[..., CompiledScene]:
    def make(soup: Soup, grooves: list[Json], scale: tuple[float, float] = (2.0, 2.0), **more: Any) -> CompiledScene:
        scene = plate(grooves)
        scene["materials"]["brass"] = {}
        scene["objects"][0] |= {"shape": {"type": "mesh", "file": "it.obj"}, "mapping": {"scale": scale}, **more}
        report = schema.check(scene)
        assert report.scene is not None, report
        return compile_scene(report.scene, (1, 1), PatternCache(), lambda _: obj(soup))

    return make


ACROSS = [groove([[-1, 1], [9, 1.2]], V), groove([[3, -1], [3.2, 4]], BOX), groove([[1, 0.5], [2, 1.5]], RIDGE)]
SEAM = [
    groove([[-1, 0.5], [1, 1.7]], V), groove([[5, 1.6], [8, 0.2]], RIDGE), groove([[0, 1.2], [0, 1.9]], BOX),
    groove([[TURN, 0.2], [TURN, 1.3]], RIDGE, ends="flat"), groove([[-1, 2.0], [8, 2.0]], TOWER),
]  # fmt: skip
SHAPES: dict[str, tuple[Soup, tuple[float, float]]] = {
    "square": (SQUARE, (TURN, math.pi)),
    "cube with an atlas": (cube(atlas=True), (TURN, math.pi)),
    "cube of equal faces": (cube(atlas=False), (2.0, 2.0)),
    "sphere": (sphere(24, 12, smooth=True), (TURN, math.pi)),
    "facets": (sphere(12, 6, smooth=False), (TURN, math.pi)),
    "dome": (half(sphere(24, 12, smooth=True)), (TURN, math.pi)),
    "box without a lid": (cube(atlas=True)[:8] + cube(atlas=True)[10:], (TURN, math.pi)),
}


@pytest.mark.parametrize("grooves", [[], ACROSS, SEAM, ACROSS + SEAM], ids=["bare", "across", "seam", "both"])
@pytest.mark.parametrize("shape", SHAPES)
def test_closed(shape: str, grooves: list[Json], compiled: Callable[..., CompiledScene]) -> None:
    soup, scale = SHAPES[shape]
    solid = body(compiled(soup, grooves, scale, rotate=[20, 30, 40], translate=[0.3, 0.2, 0.7]), 0)
    assert_closed(solid)
    assert volume(solid) > 0.0


@pytest.mark.parametrize("soup", [SQUARE, grid(5), halves(0.0)], ids=["two", "grid", "halves"])
def test_a_flat_mesh_is_the_plate(
    soup: Soup, plate: Callable[..., Json], compiled: Callable[..., CompiledScene]
) -> None:
    """Grooves along the triangles' edges too."""
    grooves = [
        groove([[-1, -1], [3, 3]], BOX), groove([[-1, 1], [3, 1.2]], V), groove([[1, -1], [1, 3]], RIDGE),
        groove([[0.4, 0.4], [1.2, 0.4]], TOWER, ends="flat"),
    ]  # fmt: skip
    report = schema.check(plate(grooves))
    assert report.scene is not None
    flat = body(compile_scene(report.scene, (1, 1), PatternCache(), None), 0)
    ours = body(compiled(soup, grooves), 0)
    assert np.array_equal(flat.vertices.min(axis=0), ours.vertices.min(axis=0))
    assert np.array_equal(flat.vertices.max(axis=0), ours.vertices.max(axis=0))
    assert volume(ours) == pytest.approx(volume(flat), abs=20 * ROUNDING)


@pytest.mark.parametrize("profiles", [(V, None), (V, RIDGE), (RIDGE, RIDGE), (V, V)])
def test_volume_at_a_seam(profiles: tuple[Json, Json | None], compiled: Callable[..., CompiledScene]) -> None:
    """Grooves that meet others, out of line by a third of their width, or nothing at x = 0: there is the wall."""
    lines = [[[-1.0, 1.0], [1.5, 1.0]], [[4.5, 1.1], [7.0, 1.1]]]
    grooves = [groove(line, profile) for line, profile in zip(lines, profiles, strict=True) if profile]
    solid = body(compiled(halves(2.0), grooves), 0, thickness=1.0)
    taken = sum(AREA * math.copysign(1.0, profile["depth"]) for profile in profiles if profile)
    assert volume(solid) == pytest.approx(4.0 - taken, abs=20 * ROUNDING)
    corners = solid.vertices[solid.triangles].astype(np.float64)
    wall = np.abs(corners[:, :, 0]).max(axis=1) < 1e-6
    area = 0.5 * np.linalg.norm(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])[wall], axis=1)
    # Two triangles of 0.3 x 0.1, the second 0.1 to the side of the first: they share one of 0.2 / 0.3 of the size.
    same = profiles[0] == profiles[1]
    expected = AREA if profiles[1] is None else 2.0 * AREA * (1.0 - (2.0 / 3.0) ** 2 if same else 1.0)
    assert area.sum() == pytest.approx(expected, abs=10 * ROUNDING)


@pytest.mark.parametrize("share", [1.0, 0.5])
def test_volume_of_a_ring(share: float, compiled: Callable[..., CompiledScene]) -> None:
    """A V around the prism, wholly or from the seam half around, takes as `test_wrapped` has it, with the prism's own
    polygon: as sigma is 1, it is scaled by 1 + w at height w."""
    count = 24
    chord, polygon = 2.0 * math.sin(math.pi / count), 0.5 * count * math.sin(TURN / count)
    line = [[-1.0 if share == 1.0 else 0.0, 1.0], [share * count * chord + (1.0 if share == 1.0 else 0.0), 1.0]]
    solid = body(compiled(prism(count), [groove(line, V, ends="flat")], (1.0, 1.0)), 0)
    deep = 0.1
    taken = 0.3 * share * polygon * (deep - deep**2 / 3.0)
    assert volume(solid) == pytest.approx(2.0 * polygon - taken, abs=20 * ROUNDING)


def test_height_goes_by_sigma(compiled: Callable[..., CompiledScene]) -> None:
    """Of a square stretched to 3 by 1.5 of a pattern of 2 by 2, turned over and mirrored in uv."""
    normal = (0, 0, -1)
    soup = quad([(0, 0, 0), (3, 0, 0), (3, 1.5, 0), (0, 1.5, 0)], [(0, 0), (1, 0), (1, 1), (0, 1)], normal)
    solid = body(compiled(soup, [groove([[1, -1], [1, 3]], V)]), 0, thickness=0.5)
    sigma = math.sqrt(3.0 * 1.5 / (2.0 * 2.0))
    taken = AREA * (3.0 / 2.0) * sigma * 1.5
    assert volume(solid) == pytest.approx(3.0 * 1.5 * 0.5 - taken, abs=40 * ROUNDING)
    assert solid.vertices[:, 2].max() == pytest.approx(0.5)  # the floor
    assert solid.vertices[:, 2].min() == 0.0


def test_it_is_what_is_rendered(compiled: Callable[..., CompiledScene]) -> None:
    """Rays from outside meet the exported solid where they meet the body of the ground truth.

    Not so beside the seam, where the edges' chords are cut at the wall's points, which are on the carried curves.
    """
    soup, scale = SHAPES["sphere"]
    scene = compiled(soup, ACROSS + SEAM, scale)
    rendered = truth.build(0, scene.objects[0], scene.patterns[0], scene.triangles, np.zeros(3), np.zeros(0, LIGHT), 0)
    count = 3 * len(rendered.corners)
    theirs = trimesh.Trimesh(rendered.corners.reshape(-1, 3), np.arange(count).reshape(-1, 3), process=False)
    draw = np.random.default_rng(0)
    start = draw.normal(size=(20000, 3))
    start *= 3.0 / np.linalg.norm(start, axis=1, keepdims=True)
    way = 0.8 * draw.uniform(-1.0, 1.0, start.shape) - start
    far = []
    for one in (theirs, tracer(body(scene, 0))):
        hits, rays, _ = one.ray.intersects_location(start, way, multiple_hits=False)
        found = np.full(start.shape, np.nan)
        found[rays] = hits
        far.append(found)
    met = np.isfinite(far[0][:, 0])
    assert met.mean() > 0.9
    assert np.array_equal(met, np.isfinite(far[1][:, 0]))
    inside = met & (np.abs(np.arctan2(far[0][:, 1], far[0][:, 0])) > TURN / 24)
    apart = np.linalg.norm(far[0] - far[1], axis=1)[inside]
    assert (apart > 1e-5).sum() <= 0.0005 * inside.sum()  # Embree lets a few rays through between triangles


def test_materials(compiled: Callable[..., CompiledScene]) -> None:
    """The groove's is on its facets alone: the walls are the object's."""
    scene = compiled(halves(2.0), [groove([[-1.0, 1.0], [1.5, 1.0]], V, material="brass")])
    solid = body(scene, 0, thickness=1.0)
    corners = solid.vertices[solid.triangles].astype(np.float64)
    brass = solid.material == 1
    assert brass.any()
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    steep = (np.abs(normals[:, 1]) > 0.1 * np.abs(normals[:, 2])) & (normals[:, 2] > 1e-9)
    assert np.array_equal(brass, steep)


FIN = [*SQUARE, [((-1, -1, 0), (0, 0), (0, 0, 1)), ((1, 1, 0), (1, 1), (0, 0, 1)), ((0, 0, 1), (0, 1), (0, 0, 1))]]


@pytest.mark.parametrize(
    ("soup", "grooves", "options", "words"),
    [
        (FIN, [], {}, "two triangles on one side of an edge, at"),
        ([[(p, (0, 0), n) for p, _, n in t] for t in SQUARE], ACROSS, {}, "a triangle without an area in uv, at"),
        (SQUARE, ACROSS, {"thickness": 0.15}, "does not hold a groove of depth 0.15"),
        (cube(atlas=True), ACROSS, {"thickness": 1.0}, "a rectangle or an open mesh, as a thickness is given"),
        ([[(p, u, -n) for p, u, n in t] for t in cube(atlas=True)], [], {}, "normals point into it"),
        (quad([(-1, 0, 0), (1, 0, 0), (1, 0, 1), (-1, 0, 1)], [(0, 0), (1, 0), (1, 1), (0, 1)], (0, -1, 0))
         + quad([(1, 0, 0), (-1, 0, 0), (-1, 0.01, 1), (1, 0.01, 1)], [(0, 0), (1, 0), (1, 1), (0, 1)], (0, 1, 0)),
         [], {}, "a sheet folded too far"),
        (SQUARE, ACROSS, {"limit": 100}, "more than"),
    ],
)  # fmt: skip
def test_refused(
    soup: Soup, grooves: list[Json], options: Json, words: str, compiled: Callable[..., CompiledScene]
) -> None:
    with pytest.raises(RenderError, match=words):
        body(compiled(soup, grooves), 0, **options)
