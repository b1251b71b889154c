"""Flat mirrors show other objects as the eye's image sees them: grooves by their areas, edges split."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from renderer import mirror
from renderer.compile import PatternCache, compile_scene
from renderer.tables import BASE

from .conftest import checked
from .scenes import SINGLE
from .test_mirrors import PERFECT, compare

Json = dict[str, Any]
Floats = NDArray[np.float64]

CHROME = {"base_color": [0.9, 0.85, 0.8], "metallic": 1, "roughness": 0}
COATED = {"base_color": [0.3, 0.35, 0.4], "roughness": 0, "ior": 1.5}
CLAY = {"base_color": [0.7, 0.5, 0.3], "specular": 0}
SUN: Json = {"type": "directional", "direction": [0.5, 0.8, -1], "irradiance": [2.2, 2.1, 1.9]}
SKY: Json = {"type": "constant", "radiance": [0.4, 0.45, 0.5]}


def along(start: list[float], end: list[float], profile: Json, count: int, step: list[float]) -> Json:
    path = {"type": "polyline", "points": [start, end]}
    return {"path": path, "profile": profile, "repeat": {"type": "linear", "count": count, "step": step}}


FINE = along([-1, 0.1], [9, 0.1], {"type": "v", "width": 0.02, "depth": 0.01}, 200, [0, 0.02])  # several a pixel
WIDE = along([1.3, -1], [1.3, 9], {"type": "trapezoid", "width": 0.2, "floor": 0.1, "depth": 0.08}, 3, [0.8, 0])
FLUTES = along([-1, 0.05], [9, 0.05], {"type": "v", "width": 0.06, "depth": 0.02}, 50, [0, 0.08])  # finer afar
JOINTS = along([0.4, -1], [0.4, 9], {"type": "trapezoid", "width": 0.1, "floor": 0.05, "depth": 0.04}, 5, [0.9, 0])
LIP = along([-1, 1.3], [9, 1.3], {"type": "v", "width": 0.1, "depth": -0.05}, 1, [0, 1])
HOOPS = along([-1, 0.5], [13, 0.5], {"type": "v", "width": 0.6, "depth": -0.2}, 4, [0, 1])


def room(material: Json, bounces: int, floor: list[Json], **parts: Any) -> Json:
    """A floor that mirrors a wall with fine grooves and wide ones, and a ball with hoops."""
    return {
        "intaglio": 1,
        "camera": {"origin": [0.3, -3.2, 1.3], "target": [0, -0.4, 0.1], "fov": 36, "resolution": [48, 36]},
        "lights": [SUN, SKY],
        "materials": {"floor": material, "clay": CLAY},
        "patterns": {
            "floor": {"grooves": floor or [JOINTS]}, "wall": {"grooves": [FINE, WIDE]}, "ball": {"grooves": [HOOPS]},
        },
        "objects": [
            {"shape": {"type": "rectangle", "size": [4, 4]}, "mapping": {"scale": [4, 4]}, "material": "floor",
             "pattern": "floor" if floor else None},
            {"shape": {"type": "rectangle", "size": [4, 2]}, "rotate": [90, 0, 0], "translate": [0, 1.5, 1.02],
             "mapping": {"scale": [4, 2]}, "material": "clay", "pattern": "wall"},
            {"shape": {"type": "sphere", "radius": 0.3}, "translate": [-0.7, 0.2, 0.42], "mapping": {"scale": [12, 4]},
             "material": "clay", "pattern": "ball"},
        ],
        "render": {"bounces": bounces, "tolerance": 0.003},
    } | parts  # fmt: skip


@pytest.mark.parametrize("floor", [[], [JOINTS], [JOINTS, LIP]], ids=["bare", "joints", "lip"])
def test_a_mirror_shows_what_rays_meet(picture: Callable[..., Any], floor: list[Json]) -> None:
    """With no noise of its own: what is off is the noise of the truth, and edges within the tolerance."""
    data = room(CHROME, 1, floor)
    one, two = (picture(data, method="geometry", samples=1024, seed=s).radiance.astype(float) for s in (1, 2))
    ours = picture(data, method="auto")
    shown = ours.aovs["method"] == BASE
    assert shown.mean() > (0.4 if len(floor) < 2 else 0.1)
    off = (ours.radiance - 0.5 * (one + two))[shown]
    noise = np.sqrt((0.25 * (one - two)[shown] ** 2).mean())
    assert np.sqrt((off**2).mean()) < 1.3 * noise
    assert abs(off.mean()) < 0.0002


def test_grooves_in_a_grooved_mirror_are_antialiased(radiance: Callable[..., Floats]) -> None:
    """By as many samples a pixel as the tolerance asks for."""
    data = room(CHROME, 1, [FLUTES])
    data["objects"][2]["pattern"] = None
    one, two = (radiance(data, method="geometry", samples=900, seed=s) for s in (1, 2))
    ours = radiance(data, method="auto", samples=4096, tolerance=0.01)
    white = np.mean(SKY["radiance"]) + np.mean(SUN["irradiance"]) / np.pi
    off = np.abs((ours - 0.5 * (one + two)).mean(axis=2)) / white
    assert (off < 0.01).mean() > 0.97


@pytest.mark.parametrize("bounces", [1, 2])
def test_a_coat_shows_it_besides_what_the_body_gets(radiance: Callable[..., Floats], bounces: int) -> None:
    data = room(COATED, bounces, [JOINTS])
    data["objects"][2]["pattern"] = None  # hoops cast no shadow on others
    compare(radiance, data, "area", samples=256)


def test_mirrors_that_face_each_other(picture: Callable[..., Any]) -> None:
    """Up to so many bounces; what is left then is dark. Samples show the same but at edges."""
    mirror_of = {"shape": {"type": "rectangle", "size": [4, 4]}, "material": "floor"}
    data = room(CHROME, 5, [])
    data["objects"] = [
        mirror_of,
        mirror_of | {"rotate": [90, 0, 0], "translate": [0, 1.2, 1]},
        mirror_of | {"rotate": [-90, 0, 0], "translate": [0, -1.2, 1]},
        data["objects"][2],
    ]
    data["camera"] |= {"origin": [0.3, -1.0, 0.9], "target": [0, 1, 0.5]}
    ours = picture(data, method="auto")
    rays = picture(data, method="csg", samples=1024)
    off = (ours.radiance.astype(float) - rays.radiance).mean(axis=2)
    assert abs(off.mean()) < 0.0005
    assert np.sqrt((off**2).mean()) < 0.006
    assert np.median(abs(off)) < 0.001


def test_an_even_room_is_a_furnace(picture: Callable[..., Any]) -> None:
    """A perfect mirror in an even light of nothing else shows the light, whatever way it comes."""
    data = room(PERFECT, 9, [JOINTS], lights=[{"type": "constant", "radiance": [1, 1, 1]}])
    data["objects"] = [data["objects"][0], data["objects"][1] | {"material": "floor", "pattern": None}]
    ours = picture(data, method="auto", tolerance=0.003)
    shown = ours.aovs["method"] == BASE
    assert shown.any()
    assert np.abs(ours.radiance[shown] - 1.0).max() < SINGLE


@pytest.mark.parametrize("material", [CHROME, COATED], ids=["chrome", "coat"])
def test_the_same_for_any_tiling(picture: Callable[..., Any], material: Json) -> None:
    data = room(material, 3, [JOINTS])
    data["objects"][1] |= {"material": "floor"}
    one, two = (picture(data, method="auto", samples=64, tile=tile, threads=2) for tile in (64, 11))
    np.testing.assert_array_equal(one.radiance, two.radiance)


def test_a_black_mirror_seen_head_on_shows_nothing(picture: Callable[..., Any]) -> None:
    """Schlick's Fresnel is nought there in one pixel, and next to nought about it."""
    data = room({"base_color": [0, 0, 0], "metallic": 1, "roughness": 0}, 1, [])
    data["camera"] |= {"origin": [1, -1, 3], "target": [1, -1, 0], "up": [0, 1, 0], "fov": 1, "resolution": [7, 5]}
    assert np.abs(picture(data, method="auto").radiance).max() < 1e-6


def test_the_image_of_the_image_is_the_camera() -> None:
    compiled = compile_scene(checked(room(CHROME, 1, [])), (48, 36), PatternCache(), None)
    for obj in compiled.objects[:2]:
        twice = mirror.camera_behind(mirror.camera_behind(compiled.camera, obj), obj)
        for ours, theirs in zip(twice, compiled.camera, strict=True):
            np.testing.assert_allclose(ours, theirs, atol=1e-14)
