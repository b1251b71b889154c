"""Profiles that overhang, by closed forms.

The plate is 2 x 2 world units, p, q = x + 1, y + 1; the grooves run along y through the plate's middle, x = 0. Colours
tell the facets apart: each has a material of its own that shines by itself, in a scene without lights.
"""

from __future__ import annotations

import functools
import math
from collections.abc import Callable, Sequence
from itertools import pairwise
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

import schema
from renderer import mesh
from renderer.compile import PatternCache
from renderer.compile.parts import decompose
from renderer.heightmap import height_map
from renderer.tables import Pattern

Json = dict[str, Any]
Floats = NDArray[np.float64]
Points = list[list[float]]
Radiance = Callable[..., Floats]
Plate = Callable[..., Json]

A, B, D = 0.1, 0.2, 0.15
DOVETAIL: Points = [[-A, 0], [-B, -D], [B, -D], [A, 0]]
LIPS: Points = [[-0.3, 0], [-0.25, 0.06], [-A, 0.06], [-B, -D], [B, -D], [A, 0.06], [0.25, 0.06], [0.3, 0]]
MUSHROOM: Points = [[-A, 0], [-A, 0.1], [-B, 0.1], [-B, 0.16], [B, 0.16], [B, 0.1], [A, 0.1], [A, 0]]
ISLAND: Points = [
    [-0.3, 0], [-0.3, -D], [-0.05, -D], [-0.05, -0.05], [-0.12, 0.02], [0.12, 0.02], [0.05, -0.05], [0.05, -D],
    [0.3, -D], [0.3, 0],
]  # fmt: skip
KEYHOLE: Points = [
    [-0.05, 0], [-0.05, -0.06], *([0.13 * math.sin(a), -0.18 - 0.13 * math.cos(a)] for a in np.linspace(-2.7, 2.7, 13)),
    [0.05, -0.06], [0.05, 0],
]  # fmt: skip
ONE_SIDED: Points = [[-A, 0], [-A, -D], [B, -D], [A, 0]]
PROFILES = {
    "dovetail": DOVETAIL, "lips": LIPS, "mushroom": MUSHROOM, "island": ISLAND, "keyhole": KEYHOLE,
    "one-sided": ONE_SIDED,
}  # fmt: skip
METHODS = ("csg", "geometry", "area")


def profile(points: Points) -> Json:
    return {"type": "polyline", "points": points}


def through(points: Points, **more: Any) -> Json:
    """A groove through the middle, without ends: b = x."""
    return {"path": {"type": "polyline", "points": [[1, 11], [1, -9]]}, "profile": profile(points), **more}


def tinted(points: Points) -> tuple[Json, list[str | None]]:
    """Materials that shine by themselves, facet i as (i + 1) / 16; black for the plane."""
    dark = {"base_color": [0, 0, 0], "specular": 0}
    names: list[str | None] = [f"facet{i}" for i in range(len(points) - 1)]
    glow = {str(name): dark | {"emissive": [(i + 1) / 16] * 3} for i, name in enumerate(names)}
    return {"stone": dark} | glow, names


def test_parts_of_a_dovetail() -> None:
    """Under each overhang a triangle, and over the floor what is open upwards."""
    assert decompose(tuple((b, w) for b, w in DOVETAIL), 0, 3) == [
        (-B, -A, -D, -D, -D, 0, 1, 0, 1),
        (-A, A, -D, -D, math.inf, math.inf, 1, -1, 1),
        (A, B, -D, -D, 0, -D, 1, 2, 1),
    ]


def inside(polygon: Sequence[tuple[float, float]], b: Floats, w: Floats) -> NDArray[np.bool_]:
    """Which places a polygon holds: those from which a line to the right crosses it an odd number of times."""
    odd = np.zeros(len(b), np.bool_)
    for (b0, w0), (b1, w1) in zip(polygon, [*polygon[1:], polygon[0]], strict=True):
        if w0 != w1:
            odd ^= ((w0 <= w) != (w1 <= w)) & (b < b0 + (w - w0) / (w1 - w0) * (b1 - b0))
    return odd


@pytest.mark.parametrize("name", PROFILES)
def test_parts_are_what_is_removed_and_added(name: str) -> None:
    """Removed: the polygon of the internal facets, closed far above. Added: that of all facets, above w = 0."""
    points = tuple((b, w) for b, w in PROFILES[name])
    first, last = schema.internal(points)
    draw = np.random.default_rng(0)
    b, w = draw.uniform(-0.35, 0.35, 20000), draw.uniform(-0.35, 0.25, 20000)
    found = np.zeros((2, len(b)), int)
    for b0, b1, low0, low1, high0, high1, _, _, removes in decompose(points, first, last):
        u = (b - b0) / (b1 - b0)
        high = np.inf if math.isinf(high0) else high0 + u * (high1 - high0)
        found[removes] += (u >= 0) & (u <= 1) & (w > low0 + u * (low1 - low0)) & (w < high)
    assert found.max() == 1
    opened = [(points[last][0], 1.0), (points[first][0], 1.0)]
    assert np.array_equal(found[1] == 1, inside([*points[first : last + 1], *opened], b, w) & (first < last))
    assert np.array_equal(found[0] == 1, inside(points, b, w) & (w > 0))


def compiled(points: Points) -> Pattern:
    groove = {"path": {"type": "polyline", "points": [[0, 0], [1, 0]]}, "profile": profile(points)}
    return PatternCache().pattern(schema.Pattern.model_validate({"grooves": [groove]})).tables


def test_tables() -> None:
    made = compiled(DOVETAIL)
    assert (made.profiles[0]["left"], made.profiles[0]["right"]) == (-B, B)
    assert made.width == pytest.approx(B)
    assert made.part_first.tolist() == [0, 3]
    assert len(made.parts) == 3
    plain = compiled([[-A, 0], [-A, -D], [A, -D], [A, 0]])
    assert len(plain.part_first) == len(plain.parts) == 0


def seen(angle: float = 0.0) -> tuple[Json, Floats, float]:
    """A camera 60 units off at `angle` to the vertical, on the left; and where the columns' middles see the plane (x),
    and from how far above it."""
    lean, far, columns, rows = math.radians(angle), 60.0, 400, 160
    eye = [-far * math.sin(lean), 0, far * math.cos(lean)]
    half = 0.3 * math.cos(lean)
    fov = 2 * math.degrees(math.atan(half * rows / columns / far))
    if fov < 0.1:  # the least there is
        rows = math.ceil(columns * far * math.tan(math.radians(0.05)) / half)
        fov = 2 * math.degrees(math.atan(half * rows / columns / far))
    u = ((np.arange(columns) + 0.5) / columns * 2 - 1) * half / far
    x = eye[0] + eye[2] * np.tan(lean + np.arctan(u))
    camera = {"origin": eye, "target": [0, 0, 0], "up": [0, 1, 0], "fov": fov, "resolution": [columns, rows]}
    return camera, x, eye[2]


def facets(plate: Plate, radiance: Radiance, points: Points, camera: Json, method: str) -> NDArray[np.int_]:
    """Which facet each column sees, the middle of its samples: 0 the plane, else from 1 on."""
    materials, names = tinted(points)
    data = plate([through(points, material=names)], camera=camera, lights=[], materials=materials)
    return np.round(np.median(radiance(data, method=method, samples=1)[:, :, 0], axis=0) * 16).astype(int)


def only_at_edges(got: NDArray[np.int_], expected: NDArray[Any], edges: int) -> None:
    """Alike but for the columns in which one facet ends and another begins."""
    assert (got != expected).sum() <= edges


@pytest.mark.parametrize("method", METHODS)
def test_dovetail_from_above_is_its_aperture(plate: Plate, radiance: Radiance, method: str) -> None:
    camera, x, _ = seen()
    only_at_edges(facets(plate, radiance, DOVETAIL, camera, method), np.where(np.abs(x) < A, 2, 0), 2)


@pytest.mark.parametrize("method", METHODS)
def test_mushroom_from_above_is_its_cap(plate: Plate, radiance: Radiance, method: str) -> None:
    camera, x, height = seen()
    cap = np.abs(x) < B * height / (height - 0.16)
    only_at_edges(facets(plate, radiance, MUSHROOM, camera, method), np.where(cap, 4, 0), 2)


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize("angle", [30.0, 45.0, 60.0, 70.0])
def test_what_is_seen_under_an_overhang(plate: Plate, radiance: Radiance, angle: float, method: str) -> None:
    """Through the aperture at x the ray goes on by its slope: it meets the floor if it gets there short of B, else the
    far wall. The near wall is turned away and hides nothing."""
    camera, x, height = seen(angle)
    slope = (x + height * math.tan(math.radians(angle))) / height
    expected = np.where(np.abs(x) > A, 0, np.where(x + D * slope < B, 2, 3))
    assert angle > 60 or (expected == 2).sum() > 20
    assert angle < 45 or (expected == 3).sum() > 20
    only_at_edges(facets(plate, radiance, DOVETAIL, camera, method), expected, 3)


@pytest.mark.parametrize("method", METHODS)
def test_light_under_an_overhang_ends_by_similar_triangles(plate: Plate, radiance: Radiance, method: str) -> None:
    """Light from the left at 45 degrees: on the floor it begins at -A + D."""
    sun = {"type": "directional", "direction": [1, 0, -1], "irradiance": [math.pi * math.sqrt(2)] * 3}
    camera, x, height = seen()
    white = {"stone": {"base_color": [1, 1, 1], "specular": 0}}
    got = radiance(plate([through(DOVETAIL)], camera=camera, lights=[sun], materials=white), method=method, samples=1)
    floor = x * (height + D) / height
    lit = (np.abs(x) > A) | (floor > -A + D)
    assert (np.abs(np.median(got[:, :, 0], axis=0) - lit) > 1e-4).sum() <= 3


@pytest.mark.parametrize("method", METHODS)
def test_a_level_ceiling_throws_its_shadow(plate: Plate, radiance: Radiance, method: str) -> None:
    """A mushroom's cap, B wide at the heights 0.1 to 0.16: the light from the left at 45 degrees that passes its right
    upper edge meets the plane at B + 0.16, that which passes its left lower edge at -B + 0.1: under the cap."""
    sun = {"type": "directional", "direction": [1, 0, -1], "irradiance": [math.pi * math.sqrt(2)] * 3}
    camera, x, _ = seen()
    white = {"stone": {"base_color": [1, 1, 1], "specular": 0}}
    tall: Points = [[b, 0.1 + w if w else 0.0] for b, w in MUSHROOM]
    got = radiance(plate([through(tall)], camera=camera, lights=[sun], materials=white), method=method, samples=1)
    dark = (x > B) & (x < B + 0.26)
    assert (np.abs(np.median(got[:, :, 0], axis=0) - ~dark) > 1e-4).sum() <= 3


def test_a_height_field_is_the_same_cut_into_parts(plate: Plate, radiance: Radiance) -> None:
    """A hair's breadth of an overhang at a wall's foot makes a profile one that overhangs, and shows nowhere else."""
    box: Points = [[-A, 0], [-A, -D], [A, -D], [A, 0]]
    notched: Points = [*box[:2], [A + 1e-7, -D], [A, -D + 1e-6], [A, 0]]
    ring = {"type": "circle", "center": [1.2, 1], "radius": 0.4}
    one, other = (
        radiance(plate([through(p), through(p) | {"path": ring}]), method="csg", samples=16) for p in (box, notched)
    )
    assert (np.abs(one - other).max(axis=2) > 1e-5).sum() <= 3


@pytest.mark.parametrize("name", PROFILES)
def test_auto_takes_their_areas(plate: Plate, picture: Callable[..., Any], name: str) -> None:
    data = plate([through(PROFILES[name])])
    one, other = picture(data, method="auto", samples=64), picture(data, method="csg", samples=64)
    assert set(one.shares) == {"base", "area"}
    assert np.abs(one.radiance - other.radiance).mean() < 2e-3


# --- csg against the solid, as in test_truth: the same samples, of which hardly one may fall on another side of an edge

SAMPLES = 64
FLIPS = 4
ARC = 1e-5  # pattern units: arcs of the meshes of curves
V = {"type": "v", "width": 0.24, "depth": 0.14}
RIDGE = {"type": "v", "width": 0.22, "depth": -0.12}
RING = {"type": "circle", "center": [1.0, 1.0], "radius": 0.5}
BENT = [[0.3, 0.4], [1.1, 1.6], [1.5, 0.6], [1.7, 1.4]]
METALS = {
    "stone": {"base_color": [0.7, 0.65, 0.6], "specular": 0},
    "brass": {"base_color": [0.9, 0.7, 0.4], "metallic": 1, "roughness": 0.45},
    "lacquer": {"base_color": [0.2, 0.3, 0.6], "roughness": 0.4},
    "lamp": {"base_color": [0.1, 0.1, 0.1], "roughness": 0.6, "emissive": [0.3, 0.1, 0.05]},
}


def cut(path: Json | list[list[float]], cross: Json | Points, **more: Any) -> Json:
    return {
        "path": {"type": "polyline", "points": path} if isinstance(path, list) else path,
        "profile": profile(cross) if isinstance(cross, list) else cross,
    } | more


def row(cross: Json | Points, **more: Any) -> Json:
    return cut([[0.35, -1], [0.35, 9]], cross, repeat={"type": "linear", "count": 3, "step": [0.65, 0]}, **more)


def cases(p: Points) -> dict[str, tuple[list[Json], Json]]:
    """Scenes with a profile."""
    some = [("brass", "lacquer", "lamp", None)[i % 4] for i in range(len(p) - 1)]
    slanting = [[-1, 0.7], [3, 1.3]]
    return {
        "straight": ([row(p, material=some)], {"materials": METALS}),
        "crossing": ([row(p), cut(slanting, p), cut([[-1, 1.6], [3, 1.3]], RIDGE), cut([[0, 0.2], [2, 0.6]], V)], {}),
        "flat ends": ([cut([[0.5, 0.6], [1.4, 1.3]], p, ends="flat")], {}),
        "profile ends": ([cut([[0.5, 0.6], [1.4, 1.3]], p)], {}),
        "corner": ([cut(BENT, p)], {}),
        "linear": ([cut([[0.8, -1], [1.2, 3]], p, scale={"type": "linear", "start": 0.1, "end": 1.4})], {}),
        "circle": ([cut(RING, p), cut(RING | {"radius": 0.12}, p)], {}),
        "circle crossed": ([cut(RING, p), cut(slanting, p)], {}),
        "above others": ([row(V), cut(RING, RIDGE), cut(slanting, p, priority=1)], {}),
        "below others": ([row(p), cut(slanting, V, priority=1), cut([[-1, 1.6], [3, 1.3]], RIDGE, priority=2)], {}),
        "tiled": ([cut([[0.05, 0.1], [0.95, 0.85]], p)], {"tile": [1.0, 0.9]}),
        "low eye": ([row(p), cut(RING, p)], {"camera": {"origin": [0.1, -2.5, 0.35]}}),
    }


@pytest.mark.parametrize("case", list(cases(DOVETAIL)))
@pytest.mark.parametrize("name", PROFILES)
def test_against_the_solid(
    name: str, case: str, plate: Plate, picture: Callable[..., Any], monkeypatch: pytest.MonkeyPatch
) -> None:
    grooves, parts = cases(PROFILES[name])[case]
    monkeypatch.setattr(mesh, "build", functools.partial(mesh.build, arc_tolerance=ARC))
    drawn = picture(plate(grooves, **parts), method="csg", samples=SAMPLES)
    truth = picture(plate(grooves, **parts), method="geometry", samples=SAMPLES).radiance.astype(np.float64)
    seen = np.pad(drawn.aovs["method"] != 0, 1)
    rows, columns = truth.shape[:2]
    whole = np.all([seen[y : y + rows, x : x + columns] for y in range(3) for x in range(3)], axis=0)
    assert np.ptp(truth) > 0.01
    error = (drawn.radiance - truth)[whole]
    assert np.sqrt(np.mean(error**2)) < truth.max() / SAMPLES * (FLIPS / (rows * columns)) ** 0.5


def test_the_plane_over_an_undercut_is_the_plane(plate: Plate, radiance: Radiance) -> None:
    """As high as deep, a ray's chords on an arc end on the plane: no wall is seen there, nor another normal."""
    even: Points = [[-0.1, 0], [-0.14, -0.02], [0.08, 0.04], [-0.04, -0.04], [0.1, 0]]
    csg, truth = (
        radiance(plate([cut(RING, even)]), method=method, samples=SAMPLES)[6:] for method in ("csg", "geometry")
    )
    assert (np.abs(csg - truth).max(axis=2) > 0.02).sum() <= FLIPS


def test_on_curved_shapes(plate: Plate, radiance: Radiance) -> None:
    """csg renders in the tangent plane; on a sphere 200 grooves' depths thick the two differ by less than seeds do."""
    shape = {"type": "sphere", "radius": 1.0}
    grooves = [
        cut({"type": "circle", "center": [40, 20], "radius": 0.6}, DOVETAIL),
        cut([[20, 20.3], [60, 19.5]], LIPS),
    ]
    data = plate(grooves, camera={"origin": [-2, 0, 0.2], "fov": 6})
    data["objects"][0] |= {"shape": shape, "mapping": {"scale": [80, 40]}}
    csg, truth, other = (
        radiance(data, method=method, samples=64, seed=seed)
        for method, seed in (("csg", 0), ("geometry", 0), ("geometry", 1))
    )
    noise = np.sqrt(np.mean((truth - other) ** 2))
    assert np.ptp(truth) > 0.1
    assert np.sqrt(np.mean((csg - truth) ** 2)) < 1.5 * noise


@pytest.mark.parametrize("lips", [[[-0.12, 0], [-0.18, -0.1], [0.12, -0.1], [0.12, 0]], DOVETAIL])
def test_nothing_lights_what_nothing_stands_over(lips: Points, plate: Plate, radiance: Radiance) -> None:
    """The bare part of a sphere shines as it does alone, over an undercut too, where sight leaves the shell and comes
    in again."""
    data = plate([cut([[-3, 0.5], [3, 0.5]], lips)], camera={"origin": [0, -4, 0.9], "target": [0, 0, 0.75], "fov": 14})
    data["objects"][0] |= {"shape": {"type": "sphere", "radius": 1}, "mapping": {"scale": [2, 2], "offset": [-1, -1]}}
    data |= {"lights": [], "materials": {"stone": data["materials"]["stone"] | {"emissive": [0.25] * 3}}}
    alone, more = (radiance(data | {"render": {"bounces": n}}, method="csg", samples=16) for n in (0, 1))
    truth = radiance(data | {"render": {"bounces": 1}}, method="geometry", samples=16)
    bare = truth[:14].max(axis=2) == 0.25  # above the groove
    assert bare.sum() > 50
    assert np.abs(more[:14] - alone[:14])[bare].max() == 0.0


@pytest.mark.parametrize("name", PROFILES)
def test_solids_are_closed(name: str) -> None:
    """All of them, everywhere: straight between flat ends they hold what the polyline says, on a circle Pappus."""
    b, w = np.array(PROFILES[name]).T
    area = float(np.sum(0.5 * (w[1:] + w[:-1]) * np.diff(b)))
    moment = float(np.sum((w[:-1] * (2 * b[:-1] + b[1:]) + w[1:] * (b[:-1] + 2 * b[1:])) * np.diff(b))) / 6
    line, p = [[-0.5, 0.1], [0.5, 0.1]], PROFILES[name]
    ring = {"type": "circle", "center": [0, 0], "radius": 0.5}
    for groove, expected in (
        (cut(line, p, ends="flat"), area),
        (cut(ring, p), 2 * math.pi * (0.5 * area - moment)),  # b is to the left, towards the centre
    ):
        made = mesh.build(tables(groove), (-1, -1, 1, 1), margin=0.25)
        assert is_closed(made)
        assert volume(made) - 2.5**2 * -made.vertices[:, 2].min() == pytest.approx(expected, rel=1e-3)
    mixed = tables(
        cut(line, p), cut([[-0.2, -0.6], [0.3, 0.6]], p, priority=1), cut(ring, p), cut([[0, 0], [0.1, 0]], V)
    )
    assert is_closed(mesh.build(mixed, (-1, -1, 1, 1), margin=0.25))


def tables(*grooves: Json) -> Pattern:
    return PatternCache().pattern(schema.Pattern.model_validate({"grooves": list(grooves)})).tables


def volume(solid: mesh.SolidMesh) -> float:
    a, b, c = (solid.vertices[solid.triangles[:, i]] for i in range(3))
    return float(np.einsum("ij,ij->i", a, np.cross(b, c)).sum() / 6.0)


def is_closed(solid: mesh.SolidMesh) -> bool:
    edges = np.concatenate([solid.triangles[:, [i, (i + 1) % 3]] for i in range(3)]).astype(np.int64)
    n = len(solid.vertices)
    return bool(np.array_equal(np.sort(edges[:, 0] * n + edges[:, 1]), np.sort(edges[:, 1] * n + edges[:, 0])))


def test_profile_end_of_a_dovetail_is_half_a_frustum() -> None:
    made = mesh.build(tables(cut([[-0.5, 0], [0.5, 0]], DOVETAIL)), (-1, -1, 1, 1), margin=0.25)
    frustum = D / 3 * ((2 * A) ** 2 + (2 * B) ** 2 + 2 * A * 2 * B)
    taken = 2.5**2 * -made.vertices[:, 2].min() - volume(made)
    assert taken == pytest.approx((A + B) * D + frustum, rel=1e-5)


@pytest.mark.parametrize("name", PROFILES)
def test_height_maps_take_the_topmost_surface(name: str) -> None:
    """The greatest w at b of which all that is above is open: of the plane, or of facets that face upwards."""
    points = PROFILES[name]
    made = height_map(tables(cut([[0, -9], [0, 9]], points)), (-0.34, -0.01, 0.34, 0.01), (41, 1)).height[0]
    at = -(np.arange(41) + 0.5) / 41 * 0.68 + 0.34  # the path runs up, b to the left
    first, last = schema.internal(tuple((b, w) for b, w in points))
    for b, w in zip(at, made, strict=True):
        heights = [
            w0 + (b - b0) / (b1 - b0) * (w1 - w0) for (b0, w0), (b1, w1) in pairwise(points) if (b0 <= b) != (b1 <= b)
        ]
        opened = first < last and points[first][0] < b < points[last][0]
        assert w == pytest.approx(max(heights) if opened else max([0.0, *heights]), abs=1e-6)


def test_line_leaves_them_out(plate: Plate, radiance: Radiance) -> None:
    for method in ("line", "segment"):
        assert radiance(plate([through(DOVETAIL)]), method=method) == pytest.approx(
            radiance(plate([through(DOVETAIL)]), method="base"), abs=1e-6
        )
