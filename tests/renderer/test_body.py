"""Objects as real geometry: cuts without gaps, maps by their definition, and pictures that finer cuts leave alone."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from renderer import body, pipeline
from renderer.compile import PatternCache, compile_scene
from renderer.errors import RenderError
from renderer.geometry.overlay import bins, cut_by_grid, cut_by_triangles
from renderer.tables import CYLINDER, SPHERE, Floats, Ints

Json = dict[str, Any]

V = {"type": "v", "width": 0.12, "depth": 0.05}
RING = {"path": {"type": "circle", "center": [2.0, 1.0], "radius": 0.4}, "profile": V}
RIDGE = {
    "path": {"type": "polyline", "points": [[0.3, 0.7], [3.7, 1.2]]},
    "profile": {"type": "trapezoid", "width": 0.1, "floor": 0.04, "depth": -0.05},
}
SPHERE_ = {"type": "sphere", "radius": 1.0}
CYLINDER_ = {"type": "cylinder", "radius": 0.8, "height": 2.0}


def curved(shape: Json, grooves: list[Json], **more: Any) -> Json:
    """A round object that fills the picture's middle, its pattern 4 by 2 units, seen from above its equator."""
    return {
        "intaglio": 1,
        "camera": {"origin": [-3.4, 0.6, 1.1], "target": [0, 0, 0], "fov": 38, "resolution": [40, 30]},
        "lights": [
            {"type": "directional", "direction": [1, 0.6, -0.5], "irradiance": [2, 2, 2]},
            {"type": "point", "position": [-2, 2, 2], "intensity": [4, 4, 4]},
        ],
        "materials": {"stone": {"base_color": [0.7, 0.7, 0.7], "specular": 0}},
        "patterns": {"cut": {"grooves": grooves}} if grooves else {},
        "objects": [
            {"shape": shape, "material": "stone", "mapping": {"scale": [4, 2]}, "pattern": "cut" if grooves else None}
        ],
    } | more


def soup(count: int, seed: int) -> Floats:
    """A square of 2 by 2 as triangles (n, 3, 3) with heights, whose corners many share."""
    draw = np.random.default_rng(seed)
    side = np.linspace(0.0, 2.0, count + 1)
    x, y = np.meshgrid(side, side)
    inner = (slice(1, -1), slice(1, -1))
    x[inner] += draw.uniform(-0.3, 0.3, x[inner].shape) * side[1]
    y[inner] += draw.uniform(-0.3, 0.3, y[inner].shape) * side[1]
    points = np.stack([x, y, draw.uniform(-1, 1, x.shape)], axis=-1)
    a, b, c, d = points[:-1, :-1], points[:-1, 1:], points[1:, 1:], points[1:, :-1]
    one, two = np.stack([a, b, c], axis=2), np.stack([a, c, d], axis=2)
    return np.ascontiguousarray(np.concatenate([one.reshape(-1, 3, 3), two.reshape(-1, 3, 3)]))


def area(triangles: Floats) -> float:
    """In the plane."""
    one, two = triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0]
    return float(0.5 * np.abs(one[:, 0] * two[:, 1] - one[:, 1] * two[:, 0]).sum())


def open_edges(triangles: Floats) -> int:
    """Edges inside the square that are not shared by two triangles."""
    count: dict[tuple[Any, Any], int] = {}
    for triangle in triangles:
        corners = [tuple(corner) for corner in triangle]
        if len(set(corners)) < 3:
            continue
        for i in range(3):
            edge = tuple(sorted((corners[i], corners[(i + 1) % 3])))
            count[edge] = count.get(edge, 0) + 1  # type: ignore[index,arg-type]

    def outside(edge: tuple[Any, Any]) -> bool:
        return any(edge[0][k] == edge[1][k] and edge[0][k] in (0.0, 2.0) for k in (0, 1))

    return sum(1 for edge, times in count.items() if times % 2 and not outside(edge))


def cut(kernel: Callable[..., int], triangles: Floats, *how: Any) -> tuple[Floats, Ints, Ints]:
    room = kernel(triangles, *how, np.empty((0, 3, 3)), np.empty(0, np.int32), np.empty(0, np.int32))
    parts, sources, cells = np.empty((room, 3, 3)), np.empty(room, np.int32), np.empty(room, np.int32)
    assert kernel(triangles, *how, parts, sources, cells) == room
    return parts, sources, cells


def test_parts_of_a_grid_leave_no_gap() -> None:
    triangles = soup(7, 0)
    p, q = np.linspace(0.0, 2.0, 12), np.linspace(0.0, 2.0, 6)
    parts, _, cells = cut(cut_by_grid, triangles, p, q)
    assert area(parts) == pytest.approx(4.0, rel=1e-12)
    assert open_edges(parts) == 0
    low, high = parts[:, :, 0].min(axis=1), parts[:, :, 0].max(axis=1)
    column = cells % (len(p) - 1)
    assert np.all(low >= p[column] - 1e-12)
    assert np.all(high <= p[column + 1] + 1e-12)


def test_a_wall_along_the_seam_is_where_the_solid_ends(check: Callable[[Json], Any]) -> None:
    """A groove that comes to the seam square, from one side: its cross-section. From both: none."""
    window = np.array([0.0, 0.0, 3.0, 2.0])
    for start, area_of in ((0.9, 0.5 * 0.3 * 0.2), (-1.0, 0.0)):
        data = {
            "intaglio": 1, "camera": {"origin": [3, 0, 0], "target": [0, 0, 0]}, "lights": [],
            "materials": {"stone": {}}, "objects": [{
                "shape": {"type": "sphere", "radius": 1}, "mapping": {"scale": [3, 2]}, "material": "stone",
                "pattern": "cut",
            }],
            "patterns": {"cut": {"grooves": [{
                "path": {"type": "polyline", "points": [[start, 1], [4, 1]]},
                "profile": {"type": "v", "width": 0.3, "depth": 0.2},
            }]}},
        }  # fmt: skip
        pattern = compile_scene(check(data), (8, 6), PatternCache(), None).patterns[0]
        flat, _, _ = body.sheet(pattern, window)
        kept, walls = body._seamed(flat, window)
        assert area(walls[:, :, 1:]) == pytest.approx(area_of, abs=1e-7)
        assert np.all(walls[:, :, 0] == 0.0)  # the solid ends at its first p, where the groove has not begun
        assert not np.any((flat[kept][:, :, 0] == 3.0).all(axis=1))


def test_parts_of_a_mesh_leave_no_gap() -> None:
    triangles, by = soup(7, 0), np.ascontiguousarray(soup(5, 1)[:, :, :2])
    by[::2] = by[::2, ::-1]  # either way round
    low, size, shape = np.zeros(2), np.full(2, 0.25), np.full(2, 8, np.int32)
    first, items = bins(triangles, low, size, shape)
    parts, _, cells = cut(cut_by_triangles, triangles, by, low, size, shape, first, items)
    assert area(parts) == pytest.approx(4.0, rel=1e-12)
    assert open_edges(np.round(parts, 12) + 0.0) == 0
    weights = body.barycentric(by[cells], parts[..., :2])
    assert weights.min() > -1e-9


@pytest.mark.parametrize("shape", [SPHERE, CYLINDER])
def test_height_goes_by_sigma_along_the_normal(shape: int) -> None:
    """DESIGN 1.1, with the derivatives of the map taken by differences of h, each wrong by h^2."""
    mapping = np.array([5.0, 3.0, -1.0, 0.25])
    size = np.array([0.7, 0.0]) if shape == SPHERE else np.array([0.7, 1.9])
    base = body._NO_BASE._replace(shape=shape, size=size, mapping=mapping)
    h = 1e-4
    at = np.array([[0.3, 1.1, 0.0], [2.9, 2.4, 0.0], [-0.8, 1.75, 0.0]])

    def moved(p: float, q: float, w: float) -> Floats:
        return body.carry(base, (at + np.array([p, q, w]))[:, None], np.zeros(3, np.int32))[:, 0]

    along = (moved(h, 0, 0) - moved(-h, 0, 0)) / (2 * h)
    across = (moved(0, h, 0) - moved(0, -h, 0)) / (2 * h)
    rise = (moved(0, 0, h) - moved(0, 0, -h)) / (2 * h)
    normal = np.cross(along, across)
    sigma = np.sqrt(np.linalg.norm(normal, axis=1))
    assert np.allclose(rise, normal / sigma[:, None], rtol=0, atol=1e-6)


@pytest.mark.parametrize("shape", [SPHERE_, CYLINDER_])
def test_bare_shapes(shape: Json, picture: Callable[..., pipeline.Picture]) -> None:
    """`base` meets round shapes in closed form and takes one colour a pixel; the mesh's chords are off by 1e-5.

    Its centre's colour and a pixel's mean differ by h^2 / 24 of the sum of the second derivatives: where footprints
    of h = 0.06 are at most twice as long as wide, and the light of 0.45 falls with a cosine, by 3e-4 at the most.
    """
    scene = curved(shape, [])
    middle = (slice(8, 22), slice(12, 28))
    one, two = (
        picture(scene, method=method, samples=64).radiance.astype(float)[middle] for method in ("base", "geometry")
    )
    assert np.sqrt(np.mean((one - two) ** 2)) < 2e-3  # of 64 strata with colours of a range of 0.06, and the above
    assert abs(float((one - two).mean())) < 3e-4


@pytest.mark.parametrize("shape", [SPHERE_, CYLINDER_])
def test_finer_cells_change_nothing(
    shape: Json, picture: Callable[..., pipeline.Picture], monkeypatch: pytest.MonkeyPatch
) -> None:
    """The same samples of the same solid, but for those at its edges: far less than the samples' own noise."""
    scene = curved(shape, [RING, RIDGE])
    one, other = (picture(scene, method="geometry", samples=16, seed=seed).radiance for seed in (0, 1))
    monkeypatch.setattr(body, "CELL", 0.5 * body.CELL)
    two = picture(scene, method="geometry", samples=16).radiance
    noise = float(np.sqrt(np.mean((one - other) ** 2) / 2))
    assert np.sqrt(np.mean((one - two) ** 2)) < 0.2 * noise
    assert abs(float((one - two).mean())) < 0.02 * noise


@pytest.mark.parametrize("shape", [SPHERE_, CYLINDER_])
def test_fine_grooves_on_a_curve_are_those_of_its_tangent(
    shape: Json, picture: Callable[..., pipeline.Picture]
) -> None:
    """`csg` renders in the tangent plane: right where a groove is small beside the radius, wrong by about its part."""
    fine = [
        {"path": {"type": "polyline", "points": [[1.4, 0.2], [1.4, 1.8]]},
         "profile": {"type": "v", "width": 0.03, "depth": 0.01},
         "repeat": {"type": "linear", "count": 30, "step": [0.04, 0.003]}}
    ]  # fmt: skip
    scene = curved(shape, fine)
    one, other, csg = (
        picture(scene, method=method, samples=256, seed=seed).radiance
        for method, seed in (("geometry", 0), ("geometry", 1), ("csg", 2))
    )
    bare = picture(scene, method="base").radiance
    middle = (slice(8, 22), slice(12, 28))
    noise = float(np.sqrt(np.mean((one - other)[middle] ** 2) / 2))
    assert np.sqrt(np.mean((bare - one)[middle] ** 2)) > 5 * noise  # the grooves are seen
    assert np.sqrt(np.mean((csg - one)[middle] ** 2)) < 1.2 * math.sqrt(2.0) * noise
    assert abs(float((csg - one)[middle].mean())) < 0.01 * float(one[middle].mean())


def test_a_mesh_is_the_shape_it_stands_for(
    picture: Callable[..., pipeline.Picture], tmp_path: Any, check: Callable[[Json], Any]
) -> None:
    """A cylinder's side as a fine mesh with uv and smooth normals, and the cylinder: the same grooved picture.

    Chords of 1/180 turn leave the cylinder by 1.5e-4 of its radius.
    """
    count, radius, height = 180, 0.8, 2.0
    lines = []
    for k in range(count + 1):
        turn = 2 * math.pi * k / count
        for side in (0, 1):
            lines.append(
                f"v {radius * math.cos(turn):.17g} {radius * math.sin(turn):.17g} {height * (side - 0.5):.17g}"
            )
    for k in range(count + 1):
        for side in (0, 1):
            lines.append(f"vt {k / count:.17g} {side}")
    for k in range(count + 1):
        turn = 2 * math.pi * k / count
        for _ in (0, 1):
            lines.append(f"vn {math.cos(turn):.17g} {math.sin(turn):.17g} 0")
    for k in range(count):
        a, b, c, d = 2 * k + 1, 2 * k + 3, 2 * k + 4, 2 * k + 2
        lines += ["f " + " ".join(f"{i}/{i}/{i}" for i in three) for three in ((a, b, c), (a, c, d))]
    data = "\n".join(lines).encode()
    pictures = []
    for shape in ({"type": "mesh", "file": "side.obj"}, CYLINDER_):
        scene = check(curved(shape, [RING, RIDGE]))
        pictures.append(
            pipeline.render(scene, method="geometry", samples=64, meshes=lambda _: data, threads=2).radiance
        )
    other = picture(curved(CYLINDER_, [RING, RIDGE]), method="geometry", samples=64, seed=1).radiance
    middle = (slice(9, 22), slice(10, 30))  # clear of the caps, which the mesh has not
    noise = float(np.sqrt(np.mean((pictures[1] - other)[middle] ** 2) / 2))
    assert np.sqrt(np.mean((pictures[0] - pictures[1])[middle] ** 2)) < 1.2 * noise
    assert abs(float((pictures[0] - pictures[1])[middle].mean())) < 0.2 * noise


def test_too_large_a_solid_is_refused_with_its_size(
    picture: Callable[..., pipeline.Picture], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(body, "LIMIT", 1000)
    with pytest.raises(RenderError) as caught:
        picture(curved(SPHERE_, [RING]), method="geometry")
    assert caught.value.faults[0].pointer == "/objects/0/pattern"
    assert "triangles, more than 1000" in caught.value.faults[0].found
