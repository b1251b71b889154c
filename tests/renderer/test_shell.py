"""Rays through the grooves of spheres and cylinders: the map turned round, against that of the ground truth, and
pictures of grazing views, outlines and glass against the ground truth itself, seed by seed."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from renderer import body
from renderer.geometry import shell
from renderer.tables import CYLINDER, OBJECT, SPHERE

from .parts import alone
from .scenes import Floats, Json
from .test_curved import MOVED, row, some_turn
from .test_curved import scene as over

Radiance = Callable[..., Floats]

RUNS, SAMPLES = 4, 256
OFF = 0.002  # RMS of radiance that may be left but for noise
PLACES = [(0.3, 0.62, 0.05), (0.01, 0.2, -0.1), (0.99, 0.9, 0.0)]


def round_object(shape: int) -> np.void:
    obj = np.zeros(1, OBJECT)
    obj["shape"], obj["mapping"] = shape, [5.0, 3.0, -1.0, 0.25]
    obj["rotation"], obj["translation"] = some_turn(), MOVED
    obj["size"] = [0.7, 0.0] if shape == SPHERE else [0.7, 1.9]
    return np.asarray(obj)[0]  # type: ignore[no-any-return]


def place_of(obj: np.void, x: Floats) -> Floats:
    """The ground truth's map, object's axes."""
    return np.asarray(body.carry(body.round_base(obj), x[None, None], np.zeros(1, np.int32))[0, 0])


@pytest.mark.parametrize("shape", [SPHERE, CYLINDER])
def test_the_map_is_that_of_the_truth_and_turned_round(shape: int) -> None:
    obj = round_object(shape)
    su, sv, du, dv = obj["mapping"]
    for u, v, w in PLACES:
        x = np.array([du + u * su, dv + v * sv, w])
        at = place_of(obj, x)
        assert np.allclose(alone(shell.carried)(obj, *x), at, rtol=0, atol=1e-14)
        assert np.allclose(alone(shell.placed)(obj, *x), some_turn() @ at + MOVED, rtol=0, atol=1e-14)
        assert np.allclose(alone(shell.chart)(obj, tuple(at)), x, rtol=0, atol=1e-13)


@pytest.mark.parametrize("shape", [SPHERE, CYLINDER])
def test_normals_stand_on_what_they_are_normals_of(shape: int) -> None:
    """Of any plane of pattern space: its directions, carried into the world by differences of h, are across it. What
    these leave out is h^2 of the map's third derivatives."""
    obj, h = round_object(shape), 1e-4
    su, sv, du, dv = obj["mapping"]
    for u, v, w in PLACES:
        x = np.array([du + u * su, dv + v * sv, w])
        for n in ([0.0, 0.0, 1.0], [0.6, -0.3, 0.5], [1.0, 0.2, 0.0], [0.1, 0.9, -0.4]):
            found = np.array(alone(shell.raised)(obj, *x, tuple(n)))
            assert np.linalg.norm(found) == pytest.approx(1.0, abs=1e-12)
            steps = np.linalg.svd(np.array([n]))[2]
            for step in steps[1:]:
                way = some_turn() @ (place_of(obj, x + h * step) - place_of(obj, x - h * step)) / (2.0 * h)
                assert abs(found @ way) < 1e3 * h * h
            out = some_turn() @ (place_of(obj, x + h * np.array(n)) - place_of(obj, x))
            assert found @ out > 0.0


def alike(data: Json, radiance: Radiance, method: str) -> None:
    """Pictures of `method` and `geometry` differ by noise, and by no more than OFF."""
    solids: dict[str, Any] = {}
    theirs = np.array(
        [radiance(data, method="geometry", samples=SAMPLES, seed=100 + k, solids=solids) for k in range(RUNS)]
    )
    ours = np.array([radiance(data, method=method, samples=SAMPLES, seed=k) for k in range(RUNS)])
    noise = float((ours.var(axis=0, ddof=1) + theirs.var(axis=0, ddof=1)).mean()) / RUNS
    square = float(np.mean((ours.mean(axis=0) - theirs.mean(axis=0)) ** 2)) - noise
    assert square < OFF**2, f"RMS {math.sqrt(square):.5f}, noise {math.sqrt(noise):.5f}"


@pytest.mark.parametrize("shape", ["sphere", "cylinder"])
@pytest.mark.parametrize(("high", "low"), [(-0.05, 12.0), (0.025, 20.0)])
def test_grazing_views(high: float, low: float, shape: str, radiance: Radiance) -> None:
    """Crossing grooves of 1/20 of the radius, or ridges; the latter but for what of them stands out at the outline."""
    data = over(shape, [row(0.2, high, 15), row(0.2, high, 10, across=True)], low)
    if high > 0.0:
        data["camera"] |= {"fov": 16}
    alike(data, radiance, "csg")


@pytest.mark.parametrize("shape", ["sphere", "cylinder"])
@pytest.mark.parametrize("method", ["csg", "auto", "area", "lines"])
def test_grooves_cut_the_outline(method: str, shape: str, radiance: Radiance) -> None:
    """All that is seen glows, so that the picture's mean is what the body covers: less than the bare one, as much as
    the truth; and behind the outline is the wall."""
    data = over(shape, [row(1.2, -0.4, 3)], 20.0)
    data["lights"] = []
    for material in data["materials"].values():
        material |= {"base_color": [0, 0, 0], "specular": 0, "emissive": [1, 1, 1]}
    data["materials"]["wall"] = {"base_color": [0, 0, 0], "specular": 0, "emissive": [0, 0.5, 0]}
    covered = {}
    for wall in (False, True):
        if wall:
            data["objects"].append(
                {"shape": {"type": "rectangle", "size": [40, 40]}, "rotate": [90, 0, 0], "translate": [0, 3, 0],
                 "material": "wall"}
            )  # fmt: skip
        bare, truth, found = (
            radiance(data, method=name, samples=256).mean(axis=(0, 1)) for name in ("base", "geometry", method)
        )
        assert bare[0] > truth[0] + 2e-3
        assert np.abs(found - truth).max() < 3e-4
        covered[wall] = found
    assert covered[True][1] == pytest.approx(covered[False][1] + 0.5 * (1.0 - covered[False][0]), abs=3e-4)


@pytest.mark.parametrize("kind", ["sphere", "cylinder"])
def test_deeply_cut_glass(kind: str, radiance: Radiance) -> None:
    """Where light is reflected totally in grooves, runs along them and comes out at their ends."""
    around, shape = 2.0 * math.pi * 0.6, {"type": kind, "radius": 0.6} | ({"height": 1.6} if kind == "cylinder" else {})
    v = {"type": "v", "width": 0.16, "depth": 0.03}
    grooves = [
        {"path": {"type": "polyline", "points": [[0.1, 0.15], [0.1, 1.0]]}, "profile": v,
         "repeat": {"type": "linear", "count": 18, "step": [around / 18, 0]}},
        {"path": {"type": "polyline", "points": [[-0.2, 1.15], [around + 0.2, 1.15]]}, "profile": v},
    ]  # fmt: skip
    colours = {"red": [0.8, 0.2, 0.1], "blue": [0.1, 0.3, 0.7], "glass": [0, 0, 0]}
    data: Json = {
        "intaglio": 1,
        "camera": {"origin": [0.4, -3.6, 1.9], "target": [0, 0, 0.75], "fov": 30, "resolution": [48, 36]},
        "lights": [{"type": "constant", "radiance": [0.5, 0.52, 0.55]}],
        "materials": {n: {"base_color": [0, 0, 0], "specular": 0, "emissive": c} for n, c in colours.items()},
        "patterns": {"cuts": {"grooves": grooves}},
        "objects": [
            {"shape": shape, "translate": [0, 0, 0.82], "mapping": {"scale": [around, 1.6]}, "pattern": "cuts",
             "material": "glass"},
            {"shape": {"type": "rectangle", "size": [8, 8]}, "material": "red"},
            {"shape": {"type": "rectangle", "size": [8, 4]}, "rotate": [90, 0, 0], "translate": [0, 2.5, 2],
             "material": "blue"},
        ],
        "render": {"bounces": 6},
    }  # fmt: skip
    data["materials"]["glass"] = {"base_color": [1, 1, 1], "specular": 0, "roughness": 0, "transmission": 1, "ior": 1.5}
    alike(data, radiance, "auto")
