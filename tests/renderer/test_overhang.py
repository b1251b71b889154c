"""Profiles that overhang, by closed forms.

The plate is 2 x 2 world units, p, q = x + 1, y + 1; the grooves run along y through the plate's middle, x = 0. Colours
tell the facets apart: each has a material of its own that shines by itself, in a scene without lights.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

import schema
from renderer.compile import PatternCache
from renderer.compile.parts import decompose
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
METHODS = ("csg",)


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
    rows = decompose([(b, w) for b, w in DOVETAIL], *schema.internal([(b, w) for b, w in DOVETAIL]))
    assert rows == [
        (-B, -A, -D, -D, -D, 0, 1, 0, 1),
        (-A, A, -D, -D, math.inf, math.inf, 1, -1, 1),
        (A, B, -D, -D, 0, -D, 1, 2, 1),
    ]


def inside(polygon: list[tuple[float, float]], b: Floats, w: Floats) -> NDArray[np.bool_]:
    """Which places a polygon holds: those from which a line to the right crosses it an odd number of times."""
    odd = np.zeros(len(b), np.bool_)
    for (b0, w0), (b1, w1) in zip(polygon, [*polygon[1:], polygon[0]], strict=True):
        if w0 != w1:
            odd ^= ((w0 <= w) != (w1 <= w)) & (b < b0 + (w - w0) / (w1 - w0) * (b1 - b0))
    return odd


@pytest.mark.parametrize("name", PROFILES)
def test_parts_are_what_is_removed_and_added(name: str) -> None:
    """Removed: the polygon of the internal facets, closed far above. Added: that of all facets, above w = 0."""
    points = [(b, w) for b, w in PROFILES[name]]
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
def test_auto_leaves_them_to_sampling(plate: Plate, picture: Callable[..., Any], name: str) -> None:
    data = plate([through(PROFILES[name])])
    one, other = picture(data, method="auto", samples=64), picture(data, method="csg", samples=64)
    assert set(one.shares) == {"base", "csg"}
    assert np.abs(one.radiance - other.radiance).mean() < 2e-3


def test_line_leaves_them_out(plate: Plate, radiance: Radiance) -> None:
    for method in ("line", "segment"):
        assert radiance(plate([through(DOVETAIL)]), method=method) == pytest.approx(
            radiance(plate([through(DOVETAIL)]), method="base"), abs=1e-6
        )
