"""Shapes before the camera: silhouettes, shadows between objects, frames, uv and mesh files."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
import trimesh
from numpy.typing import NDArray

import schema
from renderer import pipeline
from renderer.compile import PatternCache, compile_scene
from renderer.errors import RenderError
from renderer.footprint import Tile, flat_frames, footprints
from renderer.raycast import Caster

Json = dict[str, Any]
Floats = NDArray[np.float64]
Radiance = Callable[..., Floats]

GLOW = {"base_color": [0, 0, 0], "specular": 0, "emissive": [1, 1, 1]}
GREY = {"base_color": [0.5, 0.5, 0.5], "specular": 0}
CUT: Json = {
    "path": {"type": "polyline", "points": [[-9, 0.45], [9, 0.55]]},
    "profile": {"type": "v", "width": 0.03, "depth": 0.02},
    "repeat": {"type": "linear", "count": 5, "step": [0, 0.06]},
}


def scene(*objects: Json, camera: Json | None = None, **more: Any) -> Json:
    """Glowing objects on black, seen from above: x right, y up, a unit of z = 0 is 10 pixels."""
    view: Json = {"origin": [0, 0, 4], "target": [0, 0, 0], "up": [0, 1, 0], "resolution": [48, 36]}
    view["fov"] = 2 * math.degrees(math.atan(1.8 / 4))  # 36 pixels are 3.6 units at a distance of 4
    return {
        "intaglio": 1,
        "camera": view | (camera or {}),
        "lights": [],
        "materials": {"glow": GLOW, "grey": GREY},
        "patterns": {"cut": {"grooves": [CUT]}},
        "objects": [{"material": "glow"} | one for one in objects],
    } | more


def ball(radius: float, *at: float) -> Json:
    return {"shape": {"type": "sphere", "radius": radius}, "translate": list(at)}


def compiled(data: Json, check: Callable[[Json], schema.Scene]) -> tuple[Any, Caster]:
    made = compile_scene(check(data), tuple(data["camera"]["resolution"]), PatternCache(), None)
    return made, Caster(made.objects, made.triangles)


# --- silhouettes ---


def test_silhouette_of_a_sphere(radiance: Radiance) -> None:
    """Seen along its axis a sphere of radius r at distance d covers the circle of radius tan(asin(r / d)).

    An edge pixel is cut in 256 squares, of which the edge crosses about 16 x 1.3; each is in or out by chance, which
    makes its area known to sqrt(21 / 4) / 256 = 0.009. The circle crosses about 8 R pixels. Where it bulges out
    between two corners of a pixel unseen, less than 1 / (8 R) of a pixel's edge is lost.
    """
    found = radiance(scene(ball(1.2, 0, 0, 0)))[..., 0]
    big = 10.0 * 4.0 * math.tan(math.asin(1.2 / 4.0))
    edge = 8.0 * big
    lost = edge / 2.0 / (8.0 * big)
    assert abs(found.sum() - math.pi * big**2) < 4.0 * 0.009 * math.sqrt(edge) + lost
    assert found.min() == 0.0
    assert found.max() == 1.0


@pytest.mark.parametrize("turn", [0.0, 10.0, 33.0])
def test_silhouette_of_a_rectangle(turn: float, radiance: Radiance) -> None:
    """2.03 x 1.51 units of 10 pixels each; the edges cross about 4 sides / 10 pixels. As above."""
    plate = {
        "shape": {"type": "rectangle", "size": [2.03, 1.51]},
        "rotate": [0, 0, turn],
        "translate": [0.013, 0.027, 0],
    }
    found = radiance(scene(plate))[..., 0]
    assert abs(found.sum() - 20.3 * 15.1) < 4.0 * 0.009 * math.sqrt(1.4 * 2 * (20.3 + 15.1)) + 1e-3 * 2 * (20.3 + 15.1)


@pytest.mark.parametrize("tolerance", [0.02, 0.002, 0.0005])
def test_edges_are_as_fine_as_the_tolerance(tolerance: float, radiance: Radiance) -> None:
    """Of a half plane, white on black: the root mean square of what its share of a pixel is off by is the tolerance,
    but for whole numbers of splits (2^0.75) and what is cut aslant (the root of 1.4).

    The edge goes through the picture's middle, turned: a pixel is covered on the left of y = tan(turn) x."""
    slope = math.tan(math.radians(23.0))
    plate = {"shape": {"type": "rectangle", "size": [9, 9]}, "rotate": [0, 0, 23.0]}
    half = [-4.5 * math.sin(math.radians(23.0)), 4.5 * math.cos(math.radians(23.0)), 0.0]
    data = scene(plate | {"translate": half}, render={"tolerance": tolerance})
    found = radiance(data)[..., 0]
    x = np.arange(48 * 64)[None, :] / 64.0 + 1.0 / 128.0 - 24.0  # the edge's height over each column, in pixels
    rows = 18.0 - np.arange(36)[:, None]  # the pixels' upper edges
    covered = np.clip(rows - slope * x, 0.0, 1.0).reshape(36, 48, 64).mean(axis=2)
    edge = (covered > 0.0) & (covered < 1.0)
    assert np.sqrt(np.mean((found - covered)[edge] ** 2)) <= 2.0**0.75 * math.sqrt(1.4) * tolerance
    assert np.abs(found - covered)[~edge].max() == 0.0


def test_the_inside_of_a_surface_is_one_footprint_a_pixel(check: Callable[[Json], schema.Scene]) -> None:
    data = scene({"shape": {"type": "rectangle", "size": [3, 2]}}, ball(0.4, 0, 0, 0.5))
    made, caster = compiled(data, check)
    flat = flat_frames(caster, made.camera.origin)
    seen = footprints(
        caster, made.camera, made.lighting.lights, Tile(0, 0, 48, 36), flat, np.zeros((9, 2)), 1.0, 0
    ).footprints
    count = np.bincount(seen["pixel"], minlength=48 * 36).reshape(36, 48)
    x, y = (np.arange(48) + 0.5 - 24) / 10, (18 - np.arange(36) - 0.5) / 10
    far = np.hypot(x[None, :], y[:, None])
    # the ball's circle has a radius of 4 tan(asin(0.4 / 3.5)) = 0.46, and 0.06 to a pixel's corner
    plate = (np.abs(x[None, :]) < 1.4) & (np.abs(y[:, None]) < 0.9) & (far > 0.6)
    assert (count[plate] == 1).all()
    assert (count[far < 0.25] == 1).all()
    assert (count[(np.abs(x[None, :]) > 1.6) & (y[:, None] < 9)] == 0).all()
    assert count.max() <= 256
    assert float(seen["weight"].sum()) == pytest.approx(600, abs=2)


# --- shadows ---


def test_umbra_of_a_sphere(radiance: Radiance) -> None:
    """A lamp at height H over a ball of radius r at height c: its rays touch the ball at asin(r / (H - c)) to the axis,
    so that the shadow on z = 0 has the radius H tan of that. In it nothing, outside I cos^3 / H^2 albedo / pi."""
    high, middle, r = 3.0, 1.5, 0.3
    plate = {"shape": {"type": "rectangle", "size": [8, 8]}, "material": "grey"}
    lamp = {"type": "point", "position": [0.2, 0, high], "intensity": [9, 9, 9]}
    camera = {"origin": [0, -3, 1], "target": [0.2, 0, 0], "up": [0, 0, 1], "fov": 40, "resolution": [60, 45]}
    data = scene(plate, ball(r, 0.2, 0, middle) | {"material": "grey"}, camera=camera, lights=[lamp])
    found = radiance(data)[..., 0]
    forward = np.array([0.2, 3.0, -1.0]) / math.sqrt(0.04 + 10.0)
    right = np.cross(forward, [0, 0, 1.0])
    right /= np.linalg.norm(right)
    up = np.cross(right, forward)
    step = 2 * math.tan(math.radians(20)) / 45
    umbra = high * math.tan(math.asin(r / (high - middle)))
    lit = dark = 0
    for j in range(45):
        for i in range(60):
            corners = []
            for dj, di in ((0, 0), (0, 1), (1, 0), (1, 1), (0.5, 0.5)):
                d = forward + right * step * (i + di - 30) - up * step * (j + dj - 22.5)
                point = np.array([0, -3, 1]) - d / d[2]
                corners.append(math.hypot(point[0] - 0.2, point[1]) if d[2] < -0.05 else 99.0)
            if max(corners) < umbra:
                dark += 1
                assert found[j, i] == 0.0
            elif min(corners) > umbra and max(corners) < 1.5:
                lit += 1
                cosine = high / math.hypot(high, corners[4])
                assert found[j, i] == pytest.approx(9 * cosine**3 / high**2 * 0.5 / math.pi, rel=2e-3)
    assert dark > 50
    assert lit > 200


def test_shadow_of_a_mesh(radiance: Radiance) -> None:
    """A square over the plate, as a mesh and as a rectangle: the same shadow, and the sun's 45 degrees move it by its
    height."""
    square = "v -0.5 -0.5 0\nv 0.5 -0.5 0\nv 0.5 0.5 0\nv -0.5 0.5 0\nf 1 2 3\nf 1 3 4\n"
    sun = {"type": "directional", "direction": [1, 0, -1], "irradiance": [1, 1, 1]}
    plate = {"shape": {"type": "rectangle", "size": [6, 6]}, "material": "grey"}
    pictures = []
    for shape in ({"type": "mesh", "file": "a.obj"}, {"type": "rectangle", "size": [1, 1]}):
        data = scene(plate, {"shape": shape, "translate": [-1, 0, 1.5], "material": "grey"}, lights=[sun])
        pictures.append(radiance(data, meshes=lambda name: square.encode())[..., 0])
    assert np.abs(pictures[0] - pictures[1]).mean() < 1e-3
    x = (np.arange(48) + 0.5 - 24) / 10
    assert (pictures[0][17, (x > 0.1) & (x < 0.9)] == 0.0).all()
    assert (pictures[0][17, (x > 1.1) & (x < 1.9)] > 0.1).all()


# --- where things are ---


def centre(picture: Floats) -> tuple[float, float]:
    """The middle of what glows, in pixels from the left and from the top."""
    weight = picture[..., 0] / picture[..., 0].sum()
    ys, xs = np.mgrid[0 : picture.shape[0], 0 : picture.shape[1]] + 0.5
    return float((weight * xs).sum()), float((weight * ys).sum())


def test_camera(radiance: Radiance) -> None:
    """x to the right, `up` to the top; 10 pixels a unit. Samples at its edge move a ball by 0.1 pixel."""
    assert centre(radiance(scene(ball(0.3, 1.0, 0.5, 0)))) == pytest.approx((34, 13), abs=0.2)
    camera = {"origin": [0, -4, 0], "up": [0, 0, 1]}
    assert centre(radiance(scene(ball(0.3, 1.0, 0, 0.5), camera=camera))) == pytest.approx((34, 13), abs=0.2)
    camera = {"origin": [0, -4, 0], "up": [1, 0, 0]}
    assert centre(radiance(scene(ball(0.3, 1.0, 0, 0.5), camera=camera))) == pytest.approx((19, 8), abs=0.2)


def test_field_of_view_is_vertical(radiance: Radiance) -> None:
    """A strip from the middle up to tan(fov / 2) covers the upper half, whatever the picture's width."""
    for width in (24, 60):
        camera = {"resolution": [width, 36], "fov": 50}
        top = 4 * math.tan(math.radians(25))
        strip = {"shape": {"type": "rectangle", "size": [99, top]}, "translate": [0, top / 2, 0]}
        found = radiance(scene(strip, camera=camera))[..., 0]
        assert (found[:18] > 0.99).all()
        assert (found[18:] < 0.01).all()


@pytest.mark.parametrize(
    ("rotate", "expected"), [((90, 0, 0), (0, 0, 1)), ((0, 90, 0), (0, 1, 0)), ((0, 0, 90), (-1, 0, 0)),
                             ((90, 0, 90), (0, 0, 1)), ((90, 90, 0), (1, 0, 0)), ((90, 90, 90), (0, 1, 0))],
)  # fmt: skip
def test_turns_come_in_the_order_x_y_z(
    rotate: tuple[float, ...], expected: tuple[float, ...], check: Callable[[Json], schema.Scene]
) -> None:
    """Where the object's y axis goes: by hand, about the world's fixed axes. Then it is moved."""
    made, _ = compiled(scene(ball(0.1, 1, 2, 3) | {"rotate": list(rotate)}), check)
    assert np.allclose(made.objects[0]["rotation"] @ [0, 1, 0], expected, atol=1e-12)
    assert made.objects[0]["translation"].tolist() == [1, 2, 3]


RAYS = [
    ({"type": "rectangle", "size": [2, 4]}, (0.5, 1, 9), (0, 0, -1), (0.75, 0.75), (0, 0, 1)),
    ({"type": "sphere", "radius": 2}, (9, 0, 0), (-1, 0, 0), (0.0, 0.5), (1, 0, 0)),
    ({"type": "sphere", "radius": 2}, (0, 9, 0), (0, -1, 0), (0.25, 0.5), (0, 1, 0)),
    (
        {"type": "sphere", "radius": 2},
        (9, 0, math.sqrt(2)),
        (-1, 0, 0),
        (0.0, 0.75),
        (math.sqrt(0.5), 0, math.sqrt(0.5)),
    ),
    ({"type": "sphere", "radius": 2}, (0, -9, 0), (0, 1, 0), (0.75, 0.5), (0, -1, 0)),
    ({"type": "cylinder", "radius": 1, "height": 4}, (0, 9, 1), (0, -1, 0), (0.25, 0.75), (0, 1, 0)),
    ({"type": "cylinder", "radius": 1, "height": 4}, (-9, 0, -2 + 1e-9), (1, 0, 0), (0.5, 0.0), (-1, 0, 0)),
]


@pytest.mark.parametrize(("shape", "origin", "direction", "uv", "normal"), RAYS)
def test_uv(
    shape: Json, origin: tuple[float, ...], direction: tuple[float, ...], uv: tuple[float, float],
    normal: tuple[float, ...], check: Callable[[Json], schema.Scene],
) -> None:  # fmt: skip
    """u from +x towards +y, v from the bottom to the top; and the frame's axes are what uv changes by in the world."""
    _, caster = compiled(scene({"shape": shape, "mapping": {"scale": [2, 3], "offset": [5, 7]}}), check)
    start, way = np.array(origin, float), np.array([direction], float)
    hit = caster.hits(start, way)
    assert (float(hit["u"][0]), float(hit["v"][0])) == pytest.approx(uv, abs=1e-6)
    assert hit["normal"][0] == pytest.approx(normal, abs=1e-6)
    frame = caster.frames(start, way, hit)[0][0]
    assert frame["pq"] == pytest.approx((uv[0] * 2 + 5, uv[1] * 3 + 7), abs=1e-6)
    h = 1e-4  # a small step along dP/dp must change p by as much
    for axis, change in ((0, (h, 0.0)), (1, (0.0, h))):
        aside = start + h * frame["axes"][:, axis]
        near = caster.hits(aside, way)
        if near["object"][0] >= 0:
            moved = caster.frames(aside, way, near)[0][0]["pq"] - frame["pq"]
            assert moved == pytest.approx(change, abs=1e-2 * h)


def test_back_faces_are_bare(radiance: Radiance, picture: Callable[..., pipeline.Picture]) -> None:
    sun = {"type": "directional", "direction": [1, 0, 1], "irradiance": [3, 3, 3]}
    plate = {"shape": {"type": "rectangle", "size": [3, 3]}, "material": "grey", "pattern": "cut"}
    data = scene(plate, camera={"origin": [0, 0, -4]}, lights=[sun])
    for method in ("csg", "line", "auto"):
        made = picture(data, method=method)
        assert set(made.shares) == {"base"}
        inside = made.radiance[6:30, 12:36]
        assert np.allclose(inside, 3 * math.sqrt(0.5) * 0.5 / math.pi, rtol=1e-6)


# --- mesh files ---

VERTICES = np.array([[-1, -0.75, 0], [1, -0.75, 0], [1, 0.75, 0], [-1, 0.75, 0]], float)
FACES = np.array([[0, 1, 2], [0, 2, 3]])
UV = np.array([[0, 0], [1, 0], [1, 1], [0, 1]], float)
OBJ = (
    "".join(f"v {x} {y} {z}\n" for x, y, z in VERTICES) + "".join(f"vt {u} {v}\n" for u, v in UV)
    + "f 1/1 2/2 3/3\nf 1/1 3/3 4/4\n"
)  # fmt: skip
PLY = (
    "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\nproperty float s\n"
    "property float t\nelement face 2\nproperty list uchar int vertex_indices\nend_header\n"
    + "".join(f"{x} {y} {z} {u} {v}\n" for (x, y, z), (u, v) in zip(VERTICES, UV, strict=True))
    + "3 0 1 2\n3 0 2 3\n"
)  # fmt: skip


def glb() -> bytes:
    mesh = trimesh.Trimesh(VERTICES, FACES, visual=trimesh.visual.TextureVisuals(uv=UV), process=False)
    return bytes(trimesh.Scene(mesh).export(file_type="glb"))


@pytest.mark.parametrize("kind", ["obj", "ply", "glb"])
def test_mesh_is_the_shape_it_describes(kind: str, radiance: Radiance) -> None:
    """A rectangle of two triangles with the rectangle's uv has its picture, but for samples at its edge."""
    sun = {"type": "directional", "direction": [1, 0.3, -1], "irradiance": [3, 3, 3]}
    data = {"obj": OBJ.encode(), "ply": PLY.encode(), "glb": glb()}[kind]
    pictures = []
    for shape in ({"type": "mesh", "file": f"a.{kind}"}, {"type": "rectangle", "size": [2, 1.5]}):
        one = {"shape": shape, "material": "grey", "pattern": "cut", "rotate": [20, 30, 0]}
        pictures.append(radiance(scene(one, lights=[sun]), method="auto", meshes=lambda name: data))
    inside = np.abs(pictures[0] - pictures[1]).max(axis=2)
    assert pictures[1].max() > 0.1
    assert np.median(inside) < 1e-6
    assert (inside > 1e-5).mean() < 0.12  # the edge: about 70 of 1,728 pixels, and pixels that are sampled
    assert np.abs(pictures[0] - pictures[1]).mean() < 1e-3


BROKEN = {
    "empty": ("a.obj", b""),
    "rubbish": ("a.ply", b"\x00\xffply rubbish" * 9),
    "rubbish glb": ("a.glb", b"glTF\x02\x00\x00\x00\xff\xff\xff\xff"),
    "no faces": ("a.obj", b"v 0 0 0\nv 1 0 0\n"),
    "a face beyond": ("a.obj", b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 9\n"),
    "no area": ("a.obj", b"v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n"),
    "not numbers": ("a.obj", b"v nan 0 0\nv 1 inf 0\nv 0 1 0\nf 1 2 3\n"),
}


@pytest.mark.filterwarnings("ignore:invalid value:RuntimeWarning")
@pytest.mark.parametrize("name", BROKEN)
def test_broken_mesh_files(name: str, radiance: Radiance) -> None:
    file, data = BROKEN[name]
    with pytest.raises(RenderError) as caught:
        radiance(scene({"shape": {"type": "mesh", "file": file}}), meshes=lambda _: data)
    fault = caught.value.faults[0]
    assert fault.pointer == "/objects/0/shape/file"
    assert fault.expected
    assert fault.found


def test_mesh_files_that_are_not_there(radiance: Radiance) -> None:
    def missing(name: str) -> bytes:
        raise FileNotFoundError(2, "No such file or directory", name)

    for meshes in (missing, None):
        with pytest.raises(RenderError) as caught:
            radiance(scene({"shape": {"type": "mesh", "file": "a.obj"}}), meshes=meshes)
        assert caught.value.faults[0].pointer == "/objects/0/shape/file"


def test_mesh_without_uv(radiance: Radiance) -> None:
    """Good enough for a bare surface, not for a pattern."""
    data = b"v -1 -1 0\nv 1 -1 0\nv 0 1 0\nf 1 2 3\n"
    bare = {"shape": {"type": "mesh", "file": "a.obj"}}
    found = radiance(scene(bare), meshes=lambda _: data)
    assert found.sum() / 3 == pytest.approx(200, abs=3)  # 2 x 2 / 2 units of 10 x 10 pixels
    with pytest.raises(RenderError) as caught:
        radiance(scene(bare | {"pattern": "cut"}), meshes=lambda _: data)
    assert caught.value.faults[0].pointer == "/objects/0/shape/file"
    assert "uv" in caught.value.faults[0].expected


def test_broken_triangles_are_left_out(radiance: Radiance) -> None:
    data = b"v -1 -1 0\nv 1 -1 0\nv 0 1 0\nv nan 0 0\nf 1 2 3\nf 1 2 4\nf 1 1 2\n"
    found = radiance(scene({"shape": {"type": "mesh", "file": "a.obj"}}), meshes=lambda _: data)
    assert np.isfinite(found).all()
    assert found.sum() / 3 == pytest.approx(200, abs=3)
