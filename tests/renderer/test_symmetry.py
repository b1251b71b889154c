"""A scene said in another way, or turned as a whole, has the same picture; mirrored, the mirrored one."""

from __future__ import annotations

import math
from collections.abc import Callable
from itertools import pairwise
from typing import Any

import numpy as np
import pytest

from .scenes import BOX, DITCH, MIXED, PALETTE, RIDGE, SINGLE, SKEW, Floats, Json, line, only_flips, only_noise

Plate = Callable[..., Json]
Radiance = Callable[..., Floats]

SAMPLES = 16
# so large that no edge of it is seen, which is antialiased by samples; again p, q = x + 1, y + 1
LARGE: Json = {"size": [20, 20], "mapping": {"scale": [20, 20], "offset": [-9, -9]}}
SINGLY = [line([-1, 0.7], [3, 1.1], profile=profile) for profile in (SKEW, RIDGE, BOX, DITCH)]
SINGLY = [g | {"path": {"type": "polyline", "points": [[p, q + 0.4 * i] for p, q in g["path"]["points"]]}}
          for i, g in enumerate(SINGLY)]  # fmt: skip
"""Parallel, of four profiles."""
FLAT = [groove | {"ends": "flat"} for groove in MIXED]
"""Ends that are closed take the profile's right half, which a mirror, or walking the other way, makes the left one."""


def every(scene: Json, groove: Callable[[Json], Json], **parts: Any) -> Json:
    """The scene with each groove changed, and parts replaced."""
    cut = scene["patterns"]["cut"]
    return scene | {"patterns": {"cut": cut | {"grooves": [groove(g) for g in cut["grooves"]]}}} | parts


def moved(path: Json, place: Callable[[list[float]], list[float]], size: float = 1.0) -> Json:
    if path["type"] == "circle":
        return path | {"center": place(path["center"]), "radius": size * path["radius"]}
    return path | {"points": [place(point) for point in path["points"]]}


def backwards(values: Any) -> Any:
    return values[::-1] if isinstance(values, list) else values


def mirrored(scene: Json) -> Json:
    """The scene seen in a mirror that is its plane x = 0: paths turn to the other side, profiles with them.

    A mirrored circle still runs anticlockwise: its profile stays as it is.
    """

    def flip(vector: list[float]) -> list[float]:
        return [-vector[0], *vector[1:]]

    def flipped(groove: Json) -> Json:
        more: Json = {"path": moved(groove["path"], lambda point: [2.0 - point[0], point[1]])}
        if groove["path"]["type"] != "circle":
            points = [[-b, w] for b, w in reversed(groove["profile"]["points"])]
            more |= {"profile": groove["profile"] | {"points": points}}
            more |= {"material": backwards(groove.get("material"))}
        if "repeat" in groove:
            more |= {"repeat": groove["repeat"] | {"step": flip(groove["repeat"]["step"])}}
        return groove | more

    camera = scene["camera"] | {"origin": flip(scene["camera"]["origin"]), "target": flip(scene["camera"]["target"])}
    lights = []
    for light in scene["lights"]:
        place = "direction" if "direction" in light else "position"
        lights.append(light | {place: flip(light[place])})
    return every(scene, flipped, camera=camera, lights=lights)


@pytest.mark.parametrize("method", ["segment", "line", "auto"])
@pytest.mark.parametrize("profile", [SKEW, RIDGE, BOX, DITCH], ids=["skew", "ridge", "box", "ditch"])
def test_mirror_of_parallel_grooves(method: str, profile: list[list[float]], plate: Plate, radiance: Radiance) -> None:
    material = ["moss", *[None] * (len(profile) - 2)]
    repeat = {"type": "linear", "count": 6, "step": [0.33, 0]}
    far = line([0.26, -90], [0.26, 90], profile=profile, material=material, repeat=repeat)  # no end is seen
    scene = plate([far], materials=PALETTE, **LARGE)
    assert np.abs(radiance(scene, method=method)[:, ::-1] - radiance(mirrored(scene), method=method)).max() < SINGLE


@pytest.mark.parametrize("method", ["area", "auto"])
def test_mirror_of_anything_exact(method: str, plate: Plate, radiance: Radiance) -> None:
    """But for what changes within a part of a footprint (gloss, lamps): that is taken in middles of parts, and which
    parts there are depends on the order of the grooves."""
    scene = plate(FLAT, materials=PALETTE, **LARGE)
    one, other = radiance(scene, method=method), radiance(mirrored(scene), method=method)[:, ::-1]
    off = np.abs(one - other)
    assert off.max() < 0.002
    assert off.mean() < 2e-5


@pytest.mark.parametrize("method", ["csg", "geometry"])
def test_mirror_of_anything(method: str, plate: Plate, radiance: Radiance) -> None:
    """Samples do not fall on mirrored places: noise is left."""
    scene = plate(FLAT, materials=PALETTE, **LARGE)
    one, again = (radiance(scene, method=method, samples=SAMPLES, seed=seed) for seed in (0, 1))
    only_noise(one, radiance(mirrored(scene), method=method, samples=SAMPLES)[:, ::-1], again)


def turn(degrees: list[float]) -> Floats:
    """Turns about the fixed x, then y, then z axis."""
    (cx, sx), (cy, sy), (cz, sz) = ((math.cos(math.radians(a)), math.sin(math.radians(a))) for a in degrees)
    about_x = np.array([[1, 0, 0], [0, cx, -sx], [0, sx, cx]])
    about_y = np.array([[cy, 0, sy], [0, 1, 0], [-sy, 0, cy]])
    about_z = np.array([[cz, -sz, 0], [sz, cz, 0], [0, 0, 1]])
    return np.asarray(about_z @ about_y @ about_x, np.float64)


def turned(scene: Json) -> Json:
    """The whole scene, turned and moved."""
    angles, shift = [25.0, -70.0, 130.0], np.array([3.0, -1.0, 0.5])
    matrix = turn(angles)
    camera = scene["camera"] | {
        "origin": (matrix @ scene["camera"]["origin"] + shift).tolist(),
        "target": (matrix @ scene["camera"]["target"] + shift).tolist(),
        "up": (matrix @ [0.0, 0.0, 1.0]).tolist(),
    }
    lights = [
        light | {"direction": (matrix @ light["direction"]).tolist()}
        if "direction" in light
        else light | {"position": (matrix @ light["position"] + shift).tolist()}
        for light in scene["lights"]
    ]
    objects = [item | {"rotate": angles, "translate": shift.tolist()} for item in scene["objects"]]
    return scene | {"camera": camera, "lights": lights, "objects": objects}


def grown(scene: Json, factor: float = 400.0) -> Json:
    """The world grown: light from a point thins out with the square of the distance."""
    camera = scene["camera"] | {
        name: [factor * x for x in scene["camera"][name]] for name in ("origin", "target")
    }  # fmt: skip
    lights = [
        light
        if "direction" in light
        else light
        | {
            "position": [factor * x for x in light["position"]],
            "intensity": [factor**2 * x for x in light["intensity"]],
        }
        for light in scene["lights"]
    ]
    size = [factor * x for x in scene["objects"][0]["shape"]["size"]]
    objects = [scene["objects"][0] | {"shape": {"type": "rectangle", "size": size}}]
    return scene | {"camera": camera, "lights": lights, "objects": objects}


def in_other_units(scene: Json, factor: float = 0.03, shift: float = 5.0) -> Json:
    """All of the pattern in another unit and from another origin, the mapping with it."""

    def place(point: list[float]) -> list[float]:
        return [factor * (x + shift) for x in point]

    def changed(groove: Json) -> Json:
        more: Json = {
            "path": moved(groove["path"], place, factor),
            "profile": groove["profile"] | {"points": [[factor * x for x in c] for c in groove["profile"]["points"]]},
        }
        if "repeat" in groove:
            more |= {"repeat": groove["repeat"] | {"step": [factor * x for x in groove["repeat"]["step"]]}}
        return groove | more

    mapping = scene["objects"][0]["mapping"]
    mapping = {"scale": [factor * x for x in mapping["scale"]], "offset": place(mapping.get("offset", [0, 0]))}
    return every(scene, changed, objects=[scene["objects"][0] | {"mapping": mapping}])


def run_backwards(scene: Json) -> Json:
    """Paths from their other end, left and right of them exchanged. (A circle has but one way to run.)"""

    def changed(groove: Json) -> Json:
        if groove["path"]["type"] == "circle":
            return groove
        return groove | {
            "path": groove["path"] | {"points": groove["path"]["points"][::-1]},
            "profile": groove["profile"] | {"points": [[-b, w] for b, w in reversed(groove["profile"]["points"])]},
            "material": backwards(groove.get("material")),
        }

    return every(scene, changed)


def in_more_points(scene: Json) -> Json:
    """A point amid each straight stretch."""

    def changed(groove: Json) -> Json:
        if groove["path"]["type"] == "circle":
            return groove
        points = groove["path"]["points"]
        amid = [[0.7 * p0 + 0.3 * p1, 0.7 * q0 + 0.3 * q1] for (p0, q0), (p1, q1) in pairwise(points)]
        return groove | {
            "path": groove["path"]
            | {"points": [p for pair in zip(points, amid, strict=False) for p in pair] + [points[-1]]}
        }

    return every(scene, changed)


def shuffled(scene: Json) -> Json:
    cut = scene["patterns"]["cut"]
    return scene | {"patterns": {"cut": cut | {"grooves": cut["grooves"][::-1]}}}


def doubled(scene: Json) -> Json:
    """Each groove once more in its own place: nothing is added or removed that has not been."""
    cut = scene["patterns"]["cut"]
    return scene | {"patterns": {"cut": cut | {"grooves": [*cut["grooves"], *cut["grooves"]]}}}


SAID_OTHERWISE = [turned, grown, in_other_units, run_backwards, in_more_points, shuffled]


@pytest.mark.parametrize("said", SAID_OTHERWISE, ids=lambda said: said.__name__)
def test_parallel_grooves_said_otherwise(said: Callable[[Json], Json], plate: Plate, radiance: Radiance) -> None:
    """The exact methods give the same picture to single precision, which the change of coordinates takes part of."""
    scene = plate(SINGLY, materials=PALETTE, **LARGE)
    for method in ("segment", "line", "auto"):
        one, other = radiance(scene, method=method), radiance(said(scene), method=method)
        assert np.abs(one - other).max() < 4 * SINGLE, method


@pytest.mark.parametrize("profile", [SKEW, RIDGE, BOX, DITCH], ids=["skew", "ridge", "box", "ditch"])
@pytest.mark.parametrize("method", ["segment", "line", "auto"])
def test_parallel_grooves_twice(method: str, profile: list[list[float]], plate: Plate, radiance: Radiance) -> None:
    repeat = {"type": "linear", "count": 6, "step": [0.33, 0]}
    scene = plate([line([0.26, -90], [0.26, 90], profile=profile, repeat=repeat)], **LARGE)
    assert np.abs(radiance(scene, method=method) - radiance(doubled(scene), method=method)).max() < SINGLE


@pytest.mark.parametrize("said", [*SAID_OTHERWISE, doubled], ids=lambda said: said.__name__)
@pytest.mark.parametrize("method", ["csg", "geometry"])
def test_anything_said_otherwise(method: str, said: Callable[[Json], Json], plate: Plate, radiance: Radiance) -> None:
    """The same samples meet the same surfaces."""
    scene = plate(FLAT if said is run_backwards else MIXED, materials=PALETTE, **LARGE)
    one, other = (radiance(data, method=method, samples=SAMPLES) for data in (scene, said(scene)))
    only_flips(one, other, SAMPLES)


@pytest.mark.parametrize("method", ["segment", "line", "csg", "auto", "geometry"])
def test_tile_is_repeats_written_out(method: str, plate: Plate, radiance: Radiance) -> None:
    """The plate is 2 wide; nothing reaches farther than 0.3 + 2 x 0.15 past a tile of its own."""
    if method in ("line", "segment"):
        groove, tile, steps, counts = line([0.1, -9], [0.1, 9]), [0.4, 20.0], [[0.4, 0], [0, 20]], [13, 1]
        first = [-4, 0]
    else:
        groove, tile, steps, counts = line([0.1, 0.1], [0.4, 0.3]), [0.4, 0.5], [[0.4, 0], [0, 0.5]], [13, 11]
        first = [-4, -3]
    path = moved(groove["path"], lambda point: [point[0] + first[0] * tile[0], point[1] + first[1] * tile[1]])
    written = groove | {"path": path, "repeat": {"type": "grid", "counts": counts, "steps": steps}}
    tiled = radiance(plate([groove], tile), method=method, samples=SAMPLES)
    only_flips(tiled, radiance(plate([written]), method=method, samples=SAMPLES), SAMPLES)
