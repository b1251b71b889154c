"""Ideal mirrors, followed as often as `bounces` says, inside and between grooves."""

from __future__ import annotations

import itertools
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from renderer.tables import AREA, CSG, LINE

from .scenes import SINGLE
from .test_strings import window

Json = dict[str, Any]
Floats = NDArray[np.float64]

HALF = {"base_color": [0.8, 0.7, 0.6], "metallic": 0.5, "roughness": 0, "specular": 0}
CHROME = {"base_color": [0.9, 0.9, 0.9], "metallic": 1, "roughness": 0}
PERFECT = {"base_color": [1, 1, 1], "metallic": 1, "roughness": 0}
COATED = {"base_color": [0.8, 0.7, 0.6], "roughness": 0}
SKY = {"type": "constant", "radiance": [0.3, 0.4, 0.5]}
SUN = {"type": "directional", "direction": [1, 0.45, -0.9], "irradiance": [2.0, 1.8, 1.6]}
LAMP = {"type": "point", "position": [-0.7, 0.4, 0.9], "intensity": [0.5, 0.6, 0.8]}
INSIDE = {"fov": 12}  # no pixel on the plate's edge
SQUARE = {"type": "v", "width": 0.2, "depth": 0.1}


def along(profile: Json, *points: list[float], step: float = 0.17, count: int = 14) -> Json:
    path = {"type": "polyline", "points": list(points) or [[0.01, -9], [0.06, 9]]}
    return {"path": path, "profile": profile, "repeat": {"type": "linear", "count": count, "step": [step, 0]}}


BOWLS = [along({"type": "round", "width": 0.16, "depth": 0.09, "facets": 7})]
DITCHES = [along({"type": "trapezoid", "width": 0.14, "floor": 0.06, "depth": 0.1}, step=0.14)]
CROSSED = [
    along({"type": "v", "width": 0.12, "depth": 0.06}),
    along({"type": "trapezoid", "width": 0.2, "floor": 0.1, "depth": 0.08}, [-1, 1], [3, 1.2], step=0.0, count=1),
]
LIPS = [
    along({"type": "v", "width": 0.12, "depth": -0.06}),
    along(
        {"type": "scratch", "width": 0.12, "depth": 0.08, "lip_width": 0.05, "lip_height": 0.03}, [-1, 1], [3, 1.2],
        step=0.0, count=1,
    ),
]  # fmt: skip


def scene(
    plate: Callable[..., Json], grooves: list[Json], material: Json, bounces: int, lights: list[Json], **parts: Any
) -> Json:
    rest = {"materials": {"stone": material}, "render": {"bounces": bounces}, "lights": lights}
    return plate(grooves, **rest, **parts)


def compare(radiance: Callable[..., Floats], data: Json, method: str, truth: int = 400, **options: Any) -> None:
    """A picture is as far from the mean of two pictures of the truth as its own noise and half of what they are from
    each other let it be. Noise of its own it has where it is sampled, and then another seed shows it."""
    one, two = (radiance(data, method="geometry", samples=truth, seed=seed) for seed in (1, 2))
    ours, again = (radiance(data, method=method, seed=seed, **options) for seed in (0, 3))
    off = ours - 0.5 * (one + two)
    noise = np.sqrt((0.5 * (ours - again) ** 2 + 0.25 * (one - two) ** 2).mean())
    assert np.sqrt((off**2).mean()) < 1.24 * noise
    assert abs(off.mean()) < 8.0 * noise / np.sqrt(off.size)


@pytest.mark.parametrize("bounces", [1, 2, 4])
@pytest.mark.parametrize("grooves", [BOWLS, DITCHES], ids=["bowls", "ditches"])
@pytest.mark.parametrize("material", [HALF, COATED], ids=["metal", "coat"])
def test_line_shows_what_rays_meet(
    plate: Callable[..., Json], radiance: Callable[..., Floats], grooves: list[Json], material: Json, bounces: int
) -> None:
    data = scene(plate, grooves, material, bounces, [SUN, LAMP, SKY], camera={"resolution": [32, 24]})
    compare(radiance, data, "line")


def test_mirrors_reflect_in_the_world(plate: Callable[..., Json], radiance: Callable[..., Floats]) -> None:
    """Where the pattern is stretched, angles of the pattern plane are not those of the world."""
    slanted = [along({"type": "v", "width": 0.2, "depth": 0.12}, [-1, -2], [5, 3], step=0.35)]
    data = scene(plate, slanted, HALF, 2, [SUN, SKY], mapping={"scale": [2.2, 0.9]}, camera=INSIDE)
    compare(radiance, data, "line")


@pytest.mark.parametrize("bounces", [1, 3])
@pytest.mark.parametrize("grooves", [CROSSED, LIPS, BOWLS], ids=["crossed", "lips", "bowls"])
def test_samples_show_what_rays_meet(
    plate: Callable[..., Json], radiance: Callable[..., Floats], grooves: list[Json], bounces: int
) -> None:
    compare(radiance, scene(plate, grooves, HALF, bounces, [SUN, LAMP, SKY]), "csg", samples=64)


@pytest.mark.parametrize("bounces", [1, 2, 4])
@pytest.mark.parametrize("material", [CHROME, HALF, COATED], ids=["mirror", "metal", "coat"])
@pytest.mark.parametrize("grooves", [CROSSED, LIPS], ids=["crossed", "lips"])
def test_area_shows_what_rays_meet(
    plate: Callable[..., Json], radiance: Callable[..., Floats], grooves: list[Json], material: Json, bounces: int
) -> None:
    """Crossings and ridges, seen in one another; what is matt in part is sampled besides."""
    data = scene(plate, grooves, material, bounces, [SUN, LAMP, SKY], camera=INSIDE | {"resolution": [32, 24]})
    data["render"]["tolerance"] = 0.003
    compare(radiance, data, "area", samples=256)


@pytest.mark.parametrize("bounces", [1, 3])
@pytest.mark.parametrize("grooves", [CROSSED, LIPS, DITCHES], ids=["crossed", "lips", "ditches"])
def test_area_shows_a_picture_of_the_sky(
    plate: Callable[..., Json], picture: Callable[..., Any], grooves: list[Json], bounces: int
) -> None:
    """In chrome: what is smooth of it in closed form, the edges of what is bright in it by samples."""
    sky = [{"type": "envmap", "file": "sky.exr", "rotate": 30}]
    data = scene(plate, grooves, CHROME, bounces, sky, camera=INSIDE | {"resolution": [32, 24]})
    one, two = (
        picture(data, method="geometry", samples=900, seed=s, meshes=window()).radiance.astype(float) for s in (1, 2)
    )
    ours = picture(data, method="auto", meshes=window())
    exact = ours.aovs["method"] == AREA
    assert exact.mean() > 0.9
    off = (ours.radiance - 0.5 * (one + two))[exact]
    noise = np.sqrt((0.25 * (one - two)[exact] ** 2).mean())
    assert np.sqrt((off**2).mean()) < 1.5 * noise + 0.0003
    assert abs(off.mean()) < 0.0001


@pytest.mark.parametrize("grooves", [CROSSED, LIPS], ids=["crossed", "lips"])
def test_crossing_mirrors_are_a_furnace(
    plate: Callable[..., Json], picture: Callable[..., Any], grooves: list[Json]
) -> None:
    """Perfect mirrors show nothing but the sky, however it comes to them, but for what is told to be left out."""
    white = [{"type": "constant", "radiance": [1, 1, 1]}]
    data = scene(plate, grooves, PERFECT, 16, white, camera=INSIDE)
    shown = picture(data, method="area", tolerance=0.003)
    exact = shown.aovs["method"] == AREA
    assert exact.mean() > 0.8
    off = np.abs(shown.radiance - 1.0).max(axis=2)[exact]
    assert (off <= shown.aovs["error"][exact] + SINGLE).all()
    assert np.median(off) < SINGLE


@pytest.mark.parametrize("method", ["line", "csg", "geometry"])
def test_a_square_groove_sends_light_back_after_two_bounces(
    plate: Callable[..., Json], radiance: Callable[..., Floats], method: str
) -> None:
    """A V of 90 degrees, from far straight above: each ray meets both walls before it leaves the way it came."""
    camera = {"origin": [0, 0, 60], "target": [0, 0, 0], "up": [0, 1, 0], "fov": 1.0, "resolution": [16, 12]}
    grooves = [along(SQUARE, [-4, -9], [-4, 9], step=0.2, count=60)]
    sky = [{"type": "constant", "radiance": [1, 1, 1]}]
    shown = [
        radiance(scene(plate, grooves, PERFECT, bounces, sky, camera=camera, size=[9, 9]), method=method, samples=16)
        for bounces in range(3)
    ]
    assert shown[0].max() == 0.0
    assert shown[1].mean() < 0.02  # the camera is not quite at infinity
    assert np.allclose(shown[2], 1.0, atol=1e-6)


@pytest.mark.parametrize("method", ["line", "csg", "geometry"])
def test_nothing_shines_brighter_than_the_sky(
    plate: Callable[..., Json], radiance: Callable[..., Floats], method: str
) -> None:
    """The furnace: perfect mirrors show the sky when all bounces are counted, and what is coated at most that."""
    sky = [{"type": "constant", "radiance": [1, 1, 1]}]
    perfect = radiance(scene(plate, BOWLS, PERFECT, 16, sky), method=method, samples=16)
    assert perfect.max() <= 1.0 + 1e-6
    if method == "line":
        assert np.allclose(perfect, 1.0, atol=1e-6)
    coated = radiance(scene(plate, BOWLS, COATED | {"base_color": [1, 1, 1]}, 4, sky), method=method, samples=16)
    assert coated.max() <= 1.0 + (2e-4 if method == "line" else 1e-6)  # it takes the coat in the middle of each part


def test_more_bounces_never_darken(plate: Callable[..., Json], radiance: Callable[..., Floats]) -> None:
    shown = [radiance(scene(plate, DITCHES, CHROME, n, [SUN, SKY]), method="line") for n in (0, 1, 2, 3, 16)]
    for fewer, more in itertools.pairwise(shown):
        assert (more >= fewer - 1e-6).all()


@pytest.mark.parametrize(("material", "bounces"), [(HALF, 2), (COATED, 1), (HALF | {"roughness": 0.3}, 1)])
def test_what_is_not_in_closed_form_is_sampled(
    plate: Callable[..., Json], picture: Callable[..., Any], material: Json, bounces: int
) -> None:
    """A mirror that is matt in part, seen once more; a coat; gloss."""
    data = scene(plate, BOWLS, material, bounces, [SUN, SKY], camera=INSIDE)
    assert LINE not in picture(data, method="auto", samples=4).aovs["method"]


def test_mirrored_scene_mirrored_picture(plate: Callable[..., Json], radiance: Callable[..., Floats]) -> None:
    camera = {"origin": [0, -1.9, 1.7], "target": [0, 0.02, 0]} | INSIDE
    points = [[-0.06, 0], [-0.04, -0.09], [0.03, -0.07], [0.08, 0]]
    one = [along({"type": "polyline", "points": points}, [0.1, -9], [0.1, 9], step=0.2, count=9)]
    points = [[-b, w] for b, w in reversed(points)]
    other = [along({"type": "polyline", "points": points}, [1.9, -9], [1.9, 9], step=-0.2, count=9)]
    sun = {"type": "directional", "direction": [-1, 0.45, -0.9], "irradiance": [2.0, 1.8, 1.6]}
    for material, bounces in ((HALF, 1), (CHROME, 3)):
        here = radiance(scene(plate, one, material, bounces, [SUN, SKY], camera=camera), method="line")
        there = radiance(scene(plate, other, material, bounces, [sun, SKY], camera=camera), method="line")
        assert np.allclose(here, there[:, ::-1], atol=1e-6)


def test_auto_takes_lines_where_it_can(plate: Callable[..., Json], picture: Callable[..., Any]) -> None:
    """Parallel grooves in closed form, crossings by samples; both within the tolerance."""
    data = scene(plate, CROSSED, HALF, 1, [SUN, SKY])
    data["render"]["tolerance"] = 0.01
    ours = picture(data, method="auto")
    assert set(np.unique(ours.aovs["method"])) >= {LINE, CSG}
    truth = picture(data, method="geometry", samples=1600).radiance.astype(np.float64)
    white = 2.0 * np.pi**-1 * 1.8 + 0.4
    off = np.abs((ours.radiance - truth).mean(-1)) / white
    assert (off < 0.01).mean() > 0.95
