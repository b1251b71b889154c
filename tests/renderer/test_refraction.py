"""Light through clear bodies: Snell's law, total reflection, the furnace; `csg`, `auto` and `geometry` side by side.

Without a coat (specular 0) refraction is all that happens below the critical angle, so that what a pixel shows follows
from its rays alone: these are traced here by the law of refraction in vector form.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from .scenes import DITCH, RIDGE, SKEW, Floats, Json, family, line
from .test_bounces import BALL, CUT, MATT, agree

Plate = Callable[..., Json]
Radiance = Callable[..., Floats]

IOR = 1.5
TINT = np.array([0.9, 0.8, 0.7])
CLEAR = {"base_color": TINT.tolist(), "specular": 0, "roughness": 0, "transmission": 1, "ior": IOR}
GLASS = CLEAR | {"base_color": [1, 1, 1], "specular": 1}
GLOW = np.array([0.5, 1.0, 2.0])
LAMP = {"base_color": [0, 0, 0], "specular": 0, "emissive": GLOW.tolist()}
METHODS = ["auto", "csg", "geometry"]
SIDE = 9  # rays across a pixel, from edge to edge: where all see the same, all of the pixel is taken to
RESOLUTION = (24, 18)


def sheet(z: float, x: float, size: list[float], material: str, up: bool = True) -> Json:
    return {
        "shape": {"type": "rectangle", "size": size}, "translate": [x, 0, z], "rotate": [0 if up else 180, 0, 0],
        "material": material,
    }  # fmt: skip


def view(camera: Json) -> tuple[Floats, Floats]:
    """The camera's place, and its rays (H, W, SIDE^2, 3)."""
    width, height = RESOLUTION
    origin = np.array(camera["origin"], float)
    forward = np.array(camera["target"], float) - origin
    forward /= np.linalg.norm(forward)
    right = np.cross(forward, [0.0, 0.0, 1.0])
    right /= np.linalg.norm(right)
    step = 2.0 * math.tan(math.radians(camera["fov"]) / 2.0) / height
    inside = np.linspace(0.0, 1.0, SIDE)
    x, y = np.meshgrid(inside, inside)
    j, i = np.mgrid[:height, :width]
    u = (i[..., None] + x.ravel() - 0.5 * width) * step
    v = (0.5 * height - j[..., None] - y.ravel()) * step
    rays = forward + u[..., None] * right + v[..., None] * np.cross(right, forward)
    return origin, rays / np.linalg.norm(rays, axis=-1, keepdims=True)


def refract(d: Floats, n: Floats, eta: float) -> Floats:
    """Unit directions d (..., 3) past surfaces of normal n on either side; eta: the index before over that behind."""
    n = np.where(np.sum(d * n, axis=-1, keepdims=True) > 0.0, -n, n)
    c = -np.sum(d * n, axis=-1, keepdims=True)
    square = 1.0 - eta**2 * (1.0 - c**2)
    through = eta * d + (eta * c - np.sqrt(np.maximum(square, 0.0))) * n
    return np.asarray(np.where(square > 0.0, through, d + 2.0 * c * n))


def plane(o: Floats, d: Floats, z: float) -> Floats:
    return np.asarray(o + ((z - o[..., 2]) / d[..., 2])[..., None] * d)


def shows(image: Floats, colours: Floats, least: float) -> None:
    """The picture has the rays' colours (H, W, SIDE^2, 3) in all pixels where these are one; so many, at least, of
    each of two kinds."""
    one = (colours == colours[:, :, :1]).all(axis=(2, 3))
    lit = colours[:, :, 0].max(axis=-1) > 0.0
    assert (one & lit).mean() > least
    assert (one & ~lit).mean() > least
    difference = np.abs(image - colours[:, :, 0]).max(axis=2)[one]
    assert np.quantile(difference, 0.98) < 1e-5  # rays may miss a corner of what is seen
    assert (difference > 1e-5).mean() < 0.02


@pytest.mark.parametrize("method", METHODS)
def test_a_ball_of_glass(method: str, plate: Plate, radiance: Radiance) -> None:
    """It turns what is behind it upside down."""
    camera = {"origin": [0, -4, 0.2], "target": [0, 0, 0], "fov": 26, "resolution": RESOLUTION}
    scene = plate([], lights=[], materials={"stone": CLEAR, "lamp": LAMP}, camera=camera, render={"bounces": 2})
    wall = {"shape": {"type": "rectangle", "size": [4, 4]}, "rotate": [90, 0, 0], "translate": [0.3, 3, 2.1]}
    scene["objects"] = [{"shape": {"type": "sphere", "radius": 1}, "material": "stone"}, wall | {"material": "lamp"}]
    origin, d = view(camera)

    def leave(o: Floats, d: Floats) -> Floats:
        b = np.sum(o * d, axis=-1)
        return np.asarray(-b + np.sqrt(np.maximum(b * b - np.sum(o * o, axis=-1) + 1.0, 0.0)))

    b = np.sum(origin * d, axis=-1)
    square = b * b - origin @ origin + 1.0
    near = origin + (-b - np.sqrt(np.maximum(square, 0.0)))[..., None] * d
    into = refract(d, near, 1.0 / IOR)
    far = near + leave(near, into)[..., None] * into
    out = refract(into, far, IOR)
    hit = square > 0.0
    o, way = np.where(hit[..., None], far, origin), np.where(hit[..., None], out, d)
    at = o + ((3.0 - o[..., 1]) / way[..., 1])[..., None] * way
    lit = (way[..., 1] > 0.0) & (np.abs(at[..., 0] - 0.3) < 2.0) & (np.abs(at[..., 2] - 2.1) < 2.0)
    colours = np.where(lit[..., None], np.where(hit[..., None], TINT**2, 1.0) * GLOW, 0.0)
    shows(radiance(scene, method=method, samples=16), colours, 0.15)


@pytest.mark.parametrize("method", METHODS)
def test_a_pane_shifts_what_is_behind_it(method: str, plate: Plate, radiance: Radiance) -> None:
    """Two rectangles back to back: d sin(t) (1 - cos t / (n cos t')) to the side."""
    camera = {"origin": [-3, 0, 2.5], "target": [0, 0, -0.4], "fov": 20, "resolution": RESOLUTION}
    scene = plate([], lights=[], materials={"stone": CLEAR, "lamp": LAMP}, camera=camera, render={"bounces": 2})
    pane = [sheet(0.0, 0.0, [9, 9], "stone"), sheet(-0.8, 0.0, [9, 9], "stone", up=False)]
    scene["objects"] = [*pane, sheet(-1.0, 5.1, [10, 10], "lamp")]
    origin, d = view(camera)
    t = np.arccos(-d[..., 2])
    inside = np.arcsin(np.sin(t) / IOR)
    shift = 0.8 * np.sin(t) * (1.0 - np.cos(t) / (IOR * np.cos(inside)))  # off the ray, in the plane of incidence
    at = plane(origin, d, -1.0)
    back = shift / np.cos(t)
    along = d[..., :2] / np.linalg.norm(d[..., :2], axis=-1, keepdims=True)
    x = at[..., 0] - back * along[..., 0]
    colours = np.where((x > 0.1)[..., None], TINT**2 * GLOW, 0.0)
    shows(radiance(scene, method=method, samples=16), colours, 0.15)


@pytest.mark.parametrize("method", METHODS)
def test_a_pane_lies_on_a_lamp(method: str, plate: Plate, radiance: Radiance) -> None:
    """In one plane with it: what lies there is seen, through the pane's face or before it, and nothing behind."""
    camera = {"origin": [-3, 0.2, 2.5], "target": [0, 0.1, -0.4], "fov": 20, "resolution": RESOLUTION}
    clear = CLEAR | {"base_color": [1, 1, 1]}
    scene = plate([], lights=[], materials={"stone": clear, "lamp": LAMP}, camera=camera, render={"bounces": 2})
    pane = [sheet(0.1, 0.0, [9, 9], "stone"), sheet(-0.7, 0.0, [9, 9], "stone", up=False)]
    scene["objects"] = [*pane, sheet(-0.7, 5.1, [10, 10], "lamp")]
    origin, d = view(camera)
    top = plane(origin, d, 0.1)
    x = plane(top, refract(d, np.array([0.0, 0.0, 1.0]), 1.0 / IOR), -0.7)[..., 0]
    colours = np.where((x > 0.1)[..., None], GLOW, 0.0)
    shows(radiance(scene, method=method, samples=16), colours, 0.15)


@pytest.mark.parametrize("method", METHODS)
def test_facets_refract(method: str, plate: Plate, radiance: Radiance) -> None:
    """V grooves side by side over a lamp with an edge: each flank shows it shifted to its own side."""
    camera = {"origin": [0, -0.9, 2.8], "target": [0, 0, 0], "fov": 22, "resolution": RESOLUTION}
    slope, width = 0.5, 0.5
    v = [[-0.5 * width, 0.0], [0.0, -0.5 * slope * width], [0.5 * width, 0.0]]
    grooves = [line([0.25, -9], [0.25, 9], profile=v, repeat={"type": "linear", "count": 9, "step": [width, 0]})]
    scene = plate(
        grooves, lights=[], materials={"stone": CLEAR, "lamp": LAMP}, camera=camera, render={"bounces": 1},
        mapping={"scale": [4, 4], "offset": [0, 0]},
    )  # fmt: skip
    scene["objects"][0]["shape"]["size"] = [4, 4]
    scene["objects"].append(sheet(-1.0, 2.05, [4, 4], "lamp"))
    origin, d = view(camera)
    # the flanks are planes; of those that a ray crosses where they stand it meets the highest
    best = np.full(d.shape[:-1], -np.inf)
    n = np.zeros(d.shape)
    for k in range(8):
        for side in (-1.0, 1.0):
            middle = -2.0 + (k + 0.5) * width
            normal = np.array([-side * slope, 0.0, 1.0]) / math.hypot(slope, 1.0)
            bottom = np.array([middle, 0.0, -0.5 * slope * width])
            t = np.sum((bottom - origin) * normal) / np.sum(d * normal, axis=-1)
            at = origin + t[..., None] * d
            inside = (side * (at[..., 0] - middle) >= 0.0) & (side * (at[..., 0] - middle) <= 0.5 * width)
            nearer = inside & (at[..., 2] > best) & (np.sum(d * normal, axis=-1) < 0.0)
            best = np.where(nearer, at[..., 2], best)
            n = np.where(nearer[..., None], normal, n)
    at = plane(origin, d, 0.0)
    at = at + ((best - at[..., 2]) / d[..., 2])[..., None] * d
    x = plane(at, refract(d, n, 1.0 / IOR), -1.0)[..., 0]
    colours = np.where((x > 0.05)[..., None], TINT * GLOW, 0.0)
    shows(radiance(scene, method=method, samples=16), colours, 0.15)


@pytest.mark.parametrize("method", METHODS)
def test_the_window_of_a_diver(method: str, plate: Plate, radiance: Radiance) -> None:
    """A camera in the glass sees what is above within the critical angle, beyond that the bottom, totally reflected."""
    camera = {"origin": [0, -1.5, -1.5], "target": [0, 0, 0], "fov": 30, "resolution": RESOLUTION}
    scene = plate([], lights=[], materials={"stone": CLEAR, "lamp": LAMP}, camera=camera, render={"bounces": 1})
    scene["objects"] = [sheet(0.0, 0.0, [40, 40], "stone"), sheet(-2.0, 0.0, [200, 200], "lamp")]
    _, d = view(camera)
    reflected = d[..., 2] < math.sqrt(1.0 - 1.0 / IOR**2)
    shows(radiance(scene, method=method, samples=16), np.where(reflected[..., None], GLOW, 0.0), 0.15)


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize("bounces", [1, 2, 5])
def test_the_furnace_of_a_ball(method: str, bounces: int, plate: Plate, radiance: Radiance) -> None:
    """In a white sky only what is still inside is missing: (1 - F) F^(k - 1) of it, as F is the same at both ends."""
    camera = {"origin": [0, -9, 0], "target": [0, 0, 0], "fov": 7, "resolution": [12, 12]}
    scene = plate(
        [], lights=[{"type": "constant", "radiance": [1, 1, 1]}], materials={"stone": GLASS}, camera=camera,
        render={"bounces": bounces},
    )  # fmt: skip
    scene["objects"] = [{"shape": {"type": "sphere", "radius": 1}, "material": "stone"}]
    step = 2.0 * math.tan(math.radians(3.5)) / 12
    side = (np.arange(12 * 40) + 0.5) / 40
    x, y = np.meshgrid((side - 6.0) * step, (side - 6.0) * step)
    sine = 9.0 * np.sin(np.arctan(np.hypot(x, y)))  # of the angle to the normal
    f = 0.04 + 0.96 * (1.0 - np.sqrt(np.maximum(1.0 - sine**2, 0.0))) ** 5
    expected = np.where(sine < 1.0, 1.0 - (1.0 - f) * f ** (bounces - 1), 1.0)
    image = radiance(scene, method=method, samples=400)
    assert image.max() < 1.0 + 1e-6
    assert image.mean() == pytest.approx(expected.mean(), abs=4.0 * 0.5 / math.sqrt(400 * 144))


def over_a_floor(plate: Plate, grooves: list[Json], glass: Json, bounces: int) -> Json:
    """Glass over a floor, a ball that glows in it."""
    scene = plate(
        grooves, materials={"stone": glass, "floor": MATT, "ball": MATT | {"emissive": [0.8, 0.4, 0.2]}},
        lights=[{"type": "constant", "radiance": [0.4, 0.5, 0.6]}],
        camera={"origin": [0.1, -1.2, 1.1], "target": [0, 0, 0], "fov": 24, "resolution": [24, 18]},
        render={"bounces": bounces},
    )  # fmt: skip
    scene["objects"] += [
        BALL | {"translate": [0.1, 0.3, -0.6]},
        sheet(-0.9, 0.0, [6, 6], "floor"),
    ]
    return scene


@pytest.mark.parametrize(
    ("name", "glass"),
    [
        ("smooth", GLASS),
        ("rough", GLASS | {"roughness": 0.5}),
        ("half", GLASS | {"transmission": 0.5, "metallic": 0.2}),
    ],
)
def test_a_grooved_plate(name: str, glass: Json, plate: Plate, radiance: Radiance) -> None:
    """Cut deep enough for light to leave a facet into the next groove, and ridges that it crosses."""
    grooves = CUT if name != "rough" else [family(DITCH, step=0.3, count=9)]
    agree(over_a_floor(plate, grooves, glass, 4), radiance, "csg" if name == "half" else "auto")


@pytest.mark.parametrize("shape", [{"type": "sphere", "radius": 1}, {"type": "cylinder", "radius": 0.8, "height": 2}])
def test_a_grooved_body(shape: Json, plate: Plate, radiance: Radiance) -> None:
    """Grooves where light enters, and where it leaves, seen from within."""
    grooves = [family([[b, 0.5 * w] for b, w in SKEW], step=0.5, count=192), line([0, 20], [96, 22], profile=RIDGE)]
    scene = plate(
        grooves, materials={"stone": GLASS | {"base_color": [0.8, 0.9, 1]}, "lamp": MATT | {"emissive": [1, 0.7, 0.3]}},
        lights=[{"type": "constant", "radiance": [0.4, 0.5, 0.6]}], mapping={"scale": [96, 48], "offset": [0, 0]},
        camera={"origin": [0.3, -4, 1.2], "target": [0, 0, 0], "fov": 30, "resolution": [24, 18]},
        render={"bounces": 3},
    )  # fmt: skip
    scene["objects"][0] |= {"shape": shape, "rotate": [20, 0, 10]}
    scene["objects"].append(
        {
            "shape": {"type": "rectangle", "size": [3, 3]},
            "rotate": [90, 0, 0],
            "translate": [1, 3, 0.5],
            "material": "lamp",
        }
    )
    agree(scene, radiance, "auto")


def test_a_camera_within(plate: Plate, radiance: Radiance) -> None:
    """Grooves seen from inside the body, from below."""
    scene = over_a_floor(plate, CUT, GLASS, 3)
    scene["camera"] = {"origin": [0.1, -0.5, -0.7], "target": [0, 0.1, 0], "fov": 40, "resolution": [24, 18]}
    agree(scene, radiance, "auto")


@pytest.mark.parametrize("method", METHODS)
def test_no_bounces_no_light_from_within(method: str, plate: Plate, radiance: Radiance) -> None:
    """But its own."""
    camera = {"origin": [0.1, -0.5, -0.7], "target": [0, 0.1, 0], "fov": 40, "resolution": RESOLUTION}
    for emissive in ([0.0, 0.0, 0.0], [0.1, 0.2, 0.3]):
        scene = plate(CUT, materials={"stone": GLASS | {"emissive": emissive}}, camera=camera)
        image: Any = radiance(scene, method=method, samples=4)
        seen = image.max(axis=2) > 0.0
        assert (image[seen] == np.array(emissive, np.float32)).all()
        assert seen.any() == any(emissive)
