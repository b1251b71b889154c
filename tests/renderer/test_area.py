"""`area`: shares that sum to one, and pictures that agree with sampling wherever the latter has come to its mean.

The mean of n stratified samples of radiances up to M is off by less than M n^-3/4 wherever a few edges cross a
footprint, and by far less in most: twice that allows for a dozen.
"""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np
import pytest
from numpy.typing import NDArray

from renderer import pipeline
from renderer.tables import AREA

from .scenes import BOX, DITCH, MIXED, PALETTE, RIDGE, Json, family, line, ring
from .test_overhang import PROFILES

Plate = Callable[..., Json]
Shot = Callable[..., pipeline.Picture]
SAMPLES = 1024
TRAPEZOID = [[-0.15, 0], [-0.08, -0.15], [0.08, -0.15], [0.15, 0]]
V = [[-0.1, 0.0], [0.0, -0.1], [0.1, 0.0]]


def sun(*direction: float) -> Json:
    return {"type": "directional", "direction": list(direction), "irradiance": [math.pi, math.pi, math.pi]}


def near(
    scene: Json, picture: Shot, least: float = 0.99, samples: int = SAMPLES, edges: int = 1
) -> NDArray[np.float64]:
    """The picture of `area`, which agrees with that of `csg` and took at least a part of the pixels itself.

    What strata miss at an edge goes with samples**-0.75, and with the root of so many edges in a pixel.
    """
    mine, other = picture(scene, method="area"), picture(scene, method="csg", samples=samples)
    taken, seen = mine.aovs["method"] == AREA, mine.aovs["method"] != 0
    assert taken.sum() >= least * seen.sum()
    assert np.isfinite(mine.radiance).all()
    values = mine.radiance.astype(np.float64)
    off = np.abs(values - other.radiance)[taken]
    most, few = max(float(other.radiance.max()), 1e-3), 2.0 * samples**-0.75
    assert off.max(initial=0.0) < 2.0 * few * most
    assert off.mean() < 0.1 * few * most * edges**0.5
    return values


def test_shares_sum_to_one(plate: Plate, picture: Shot) -> None:
    """Of straight grooves to rounding: the predicted error is what is left, where colours are the same all over."""
    straight = [groove for groove in MIXED if groove["path"]["type"] == "polyline"]
    matt = {name: material | {"specular": 0, "metallic": 0} for name, material in PALETTE.items()}
    made = picture(plate(straight, materials=matt, lights=[sun(1, 0.45, -0.9)]), method="area")
    assert (made.aovs["method"][made.aovs["method"] != 0] == AREA).all()
    assert made.aovs["error"].max() < 1e-6


def test_scattered_scratches(plate: Plate, picture: Shot) -> None:
    """Where they cross, faces get edges that rounding alone has made; those bound nothing: shares still sum to one."""
    scratch = {"type": "scratch", "width": 0.006, "depth": 0.003, "lip_width": 0.002, "lip_height": 0.001}
    repeat = {"type": "scatter", "count": 100, "seed": 5, "bounds": [0, 0, 2, 2], "angle": [0, 360]}
    groove = {"path": {"type": "polyline", "points": [[-0.1, 0], [0.1, 0]]}, "profile": scratch, "repeat": repeat}
    scene = plate([groove], lights=[sun(1, 0.45, -0.9)], camera={"fov": 20, "resolution": [320, 240]})
    made = picture(scene, method="area")
    assert (made.aovs["method"][made.aovs["method"] != 0] == AREA).all()
    assert made.aovs["error"].max() < 1e-6


def test_everything_at_once(plate: Plate, picture: Shot) -> None:
    near(plate(MIXED, materials=PALETTE), picture)


@pytest.mark.parametrize("angle", [0.0, 1e-12, 1e-9, 1e-6, 1e-3])
def test_nearly_parallel_crossings(angle: float, plate: Plate, picture: Shot) -> None:
    """Degrees; at none they coincide."""
    lean = math.tan(math.radians(angle))
    near(plate([line([1 - lean, 0], [1 + lean, 2], profile=V), line([1, 0], [1, 2], profile=V)]), picture)


def test_far_away_it_is_the_mean(plate: Plate, picture: Shot) -> None:
    """Some forty facets in a footprint, of two families; the plate's edges, where strata are few, are not seen."""
    grooves = [family(V, 0.2, 10), line([-1, 0.07], [3, 0.17], profile=V, repeat={"type": "linear", "count": 10,
                                                                                "step": [0, 0.2]})]  # fmt: skip
    camera = {"origin": [0.1, -6, 8], "target": [0, 0, 0], "fov": 8.5, "resolution": [3, 3]}
    near(plate(grooves, camera=camera), picture, samples=16 * SAMPLES, edges=40)


def test_a_lamp_next_to_wide_footprints(plate: Plate, picture: Shot) -> None:
    """Its light changes along a facet that runs through a footprint, and is integrated."""
    lamp = {"type": "point", "position": [0.1, 0.05, 0.8], "intensity": [1, 1, 1]}
    camera = {"origin": [0.1, -6, 8], "target": [0, 0, 0], "fov": 5, "resolution": [3, 2]}
    scene = plate([family(V, 0.2, 10)], camera=camera, lights=[lamp])
    exact, mine = picture(scene, method="csg", samples=65536).radiance, picture(scene, method="area")
    assert (mine.aovs["method"] == AREA).all()
    white = 1.0 / np.pi / 0.8**2
    assert np.abs(mine.radiance - exact).max() < 3e-4 * white
    assert np.abs(mine.radiance - exact).max() < 2.0 * mine.aovs["error"].max() * white


SHARP = {
    "line and arc": {"type": "svg", "d": "M 0.3 0.3 L 1 1 A 0.5 0.5 0 0 1 1.6 0.5"},
    "arcs": {"type": "svg", "d": "M 0.3 1 A 0.6 0.6 0 0 1 1 1 A 0.3 0.3 0 0 1 1.6 1"},
    "lines of changing scale": {"type": "polyline", "points": [[1.9, 1], [1, 1], [1.85, 1.31]]},
}


@pytest.mark.parametrize("name", SHARP)
def test_sharp_mitres(name: str, plate: Plate, picture: Shot) -> None:
    """Where the cross-sections of two pieces differ along their mitre a wall stands; arcs end at it."""
    groove = {"path": SHARP[name], "profile": {"type": "polyline", "points": TRAPEZOID}}
    if "scale" in name:
        groove["scale"] = {"type": "sine", "amplitude": 0.4, "periods": 2}
    near(plate([groove], camera={"resolution": [64, 48]}), picture, 0.97)


@pytest.mark.parametrize("low", [1.0, 0.999999, 1.000001])
def test_light_in_the_plane_of_a_facet(low: float, plate: Plate, picture: Shot) -> None:
    """A wall at 45 degrees under a light at 45 degrees: neither lit nor in shadow, and nothing else is lost."""
    near(plate([family(V, 0.41, 5)], lights=[sun(1, 0, -low)]), picture)


@pytest.mark.parametrize("low", [1.0, 0.999999, 1.000001])
def test_facet_seen_edge_on(low: float, plate: Plate, picture: Shot) -> None:
    camera = {"origin": [20, 0.0, 20.0 * low], "target": [0, 0, 0], "fov": 2, "resolution": [24, 18]}
    near(plate([family(V, 0.41, 5)], camera=camera), picture)


def test_chords_keep_within_the_tolerance(plate: Plate, picture: Shot) -> None:
    """On a tight arc with a scale that changes along it."""
    path = {"type": "circle", "center": [1.0, 1.0], "radius": 0.25}
    wave = {"type": "sine", "amplitude": 0.4, "periods": 3}
    groove = {"path": path, "profile": {"type": "polyline", "points": V}, "scale": wave}
    scene = plate([groove], camera={"origin": [0, -0.8, 1.2], "resolution": [24, 18]})
    fine = near(scene, picture, 0.95)
    coarse = picture(scene, method="area", tolerance=0.01)
    assert np.abs(coarse.radiance - fine).max() < 0.01 * fine.max()


def scaled(points: list[list[float]], by: float = 0.6) -> list[list[float]]:
    return [[by * b, by * w] for b, w in points]


def coloured(points: list[list[float]]) -> list[str | None]:
    """A material a facet."""
    return [("brick", None, "moss")[i % 3] for i in range(len(points) - 1)]


STACKED = [[-0.08, 0.0], [-0.08, -0.06], [-0.08, -0.1], [-0.2, -0.2], [0.2, -0.2], [0.08, 0.0]]
"""A wall of two facets above an undercut."""
SLOT = [
    [-0.08, 0.0],
    [-0.08, -0.08],
    [-0.2, -0.08],
    [-0.2, -0.2],
    [0.2, -0.2],
    [0.2, -0.08],
    [0.08, -0.08],
    [0.08, 0.0],
]
UNDERCUT = PROFILES | {"stacked": STACKED, "slot": SLOT}


def test_no_gaps_between_rings_that_touch(plate: Plate, picture: Shot) -> None:
    """Chords of neighbours run side by side. Each ring's own number of them opened gaps, where the plane would be seen
    that no ray meets: pictures were too bright everywhere by a part of the tolerance."""
    vee = [[-0.01, 0.0], [0.0, -0.012], [0.01, 0.0]]
    rings = ring(0.3, vee, repeat={"type": "concentric", "count": 30, "step": 0.02})
    scene = plate([rings], lights=[sun(1, 0.45, -0.4)], camera={"fov": 20})
    fine, rough = (picture(scene, method="area", tolerance=tolerance).radiance for tolerance in (1e-4, 0.01))
    off = (rough - fine).astype(np.float64)
    assert abs(off.mean()) < 0.0004
    assert np.quantile(np.abs(off), 0.95) < 0.01


@pytest.mark.parametrize("name", UNDERCUT)
def test_what_overhangs_alone(name: str, plate: Plate, picture: Shot) -> None:
    """Parallel grooves, corners and ends of both kinds. Nothing else is exact to rounding but a corner's mitre, which
    is single precision."""
    points = scaled(UNDERCUT[name])
    grooves = [
        line([0.25, -1], [0.25, 3], profile=points, material=coloured(points)),
        line([0.8, 0.4], [1.1, 1.1], [1.6, 0.5], profile=points, material=coloured(points)),
        line([0.8, 1.6], [1.7, 1.4], profile=points, ends="flat", material=coloured(points)),
    ]
    scene = plate(grooves, materials=PALETTE)
    near(scene, picture, 1.0)
    made = picture(scene, method="area")
    assert made.aovs["error"].max() < 1e-6


@pytest.mark.parametrize("name", UNDERCUT)
def test_what_overhangs_crossing(name: str, plate: Plate, picture: Shot) -> None:
    """One another, a ridge and a height field; and of different priorities. No two are as deep: where floors coincide
    either's material is right."""
    points = scaled(UNDERCUT[name], 0.55)
    grooves = [
        line([0.2, 0.2], [1.8, 1.6], profile=points, material=coloured(points)),
        line([0.3, 1.6], [1.2, -1], profile=scaled(SLOT, 0.5)),
        line([-1, 1.3], [3, 1.4], profile=RIDGE, material="moss"),
        line([1.5, -1], [1.3, 3], profile=BOX),
        line([0.2, 0.9], [0.8, 0.7], profile=scaled(UNDERCUT[name], 0.45), priority=1, ends="flat"),
        line([1.0, 0.9], [1.6, 0.4], profile=DITCH, priority=2),
    ]
    scene = plate(grooves, materials=PALETTE)
    near(scene, picture, 1.0)
    made = picture(scene, method="area")
    assert made.aovs["error"].max() < 1e-6


@pytest.mark.parametrize("lean", [0.0, 1e-12, 1e-6, 1.0])
def test_slots_of_one_depth_cross(lean: float, plate: Plate, picture: Shot) -> None:
    """Their floors are one plane and their ceilings another; a groove that lies on another changes nothing."""
    points = scaled(SLOT)
    across, along = line([-1, 0.9], [3, 0.9], profile=points), line([1.2, -1], [1.2 + 4 * lean, 3], profile=points)
    light = [sun(1, 0.45, -0.9)]
    one = near(plate([across, along], lights=light), picture, 1.0)
    again = picture(plate([across, along, along, across], lights=light), method="area")
    assert again.radiance == pytest.approx(one, abs=1e-6)


def test_what_overhangs_on_arcs(plate: Plate, picture: Shot) -> None:
    """And where the scale changes: by chords, as all grooves."""
    wave = {"type": "sine", "amplitude": 0.3, "periods": 2}
    grooves = [
        ring(0.7, scaled(SLOT), material="brick"),
        ring(0.3, scaled(PROFILES["dovetail"], 0.4), scale=wave),
        line([0.2, 0.2], [0.7, 1.8], profile=scaled(PROFILES["lips"]), scale={"type": "linear", "start": 0, "end": 1}),
    ]
    near(plate(grooves, materials=PALETTE), picture, 0.9)


@pytest.mark.parametrize("ends", ["flat", "profile"])
@pytest.mark.parametrize("way", [[-0.3, 0.6, -0.4], [1, 0.45, -0.4], [-1, 0.2, -0.5]])
def test_an_arc_before_a_sharp_corner(way: list[float], ends: str, plate: Plate, picture: Shot) -> None:
    """Walls stand where the line goes on past the arc along their mitre, and across the arc's flat end."""
    path = {"type": "svg", "d": "M1.31 .68 A.2 .2 0 0 0 1.343 .627 L1.23 .563"}
    ridge = {"path": path, "profile": {"type": "v", "width": 0.28, "depth": -0.08}, "ends": ends}
    camera = {"origin": [0, -0.5, 2.2], "target": [0.15, -0.3, 0], "fov": 20}
    scene = plate([ridge], camera=camera, lights=[sun(*way)])
    exact, mine = (picture(scene, method=method, samples=256).radiance for method in ("csg", "area"))
    assert np.abs(mine - exact).max() < 0.02
    assert np.abs(mine - exact).mean() < 2e-4
