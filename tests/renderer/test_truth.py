"""`csg`, `line`, `lines`, `area` and `auto` against the meshed solid, traced.

*csg* draws the same samples as *geometry* for the same seed, so that the two pictures differ by no noise at all: only
where a sample falls so near to an edge that rounding puts it on the other side of it. One such sample changes a pixel
of n samples by at most M / n, with M the largest radiance; k of them in a picture of P pixels make an RMSE of
M / n * sqrt(k / P). All of the 100,000 samples but FLIPS have to agree. Where the scale varies along a curve the mesh's
normals are those of its chords: wrong by up to half the angle a between two rings, where a chord leaves its arc by
a R (a / 8) = ARC, and so is the light that they reflect by as large a part.

*line*, *lines*, *area* and *auto* are held against samples drawn from another seed. The samples' noise s is measured,
from two seeds; the RMSE of a faultless picture is s, that of its mean over P pixels s / sqrt(P). What they approximate
(one colour a facet and footprint) adds to that, by half of auto's tolerance at the most, and leaves the mean alone.
"""

from __future__ import annotations

import functools
import math
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from renderer import mesh, pipeline
from renderer.film import Aov

Json = dict[str, Any]
Floats = NDArray[np.float64]
Radiance = Callable[..., Floats]

V = {"type": "v", "width": 0.24, "depth": 0.14}
RIDGE = {"type": "v", "width": 0.22, "depth": -0.12}
SCRATCH = {"type": "scratch", "width": 0.18, "depth": 0.12, "lip_width": 0.08, "lip_height": 0.05}
TRAPEZOID = {"type": "trapezoid", "width": 0.26, "floor": 0.12, "depth": 0.12}
BOX = {"type": "trapezoid", "width": 0.2, "floor": 0.2, "depth": 0.15}
WALL = {"type": "trapezoid", "width": 0.12, "floor": 0.12, "depth": -0.1}
ROUND = {"type": "round", "width": 0.24, "depth": 0.1, "facets": 6}
SKEW = {"type": "polyline", "points": [[-0.06, 0], [-0.03, 0.04], [0.03, -0.12], [0.12, 0.05], [0.15, 0]]}


def groove(path: Json | list[list[float]], profile: Json, **more: Any) -> Json:
    if isinstance(path, list):
        path = {"type": "polyline", "points": path}
    return {"path": path, "profile": profile, **more}


def row(profile: Json, count: int = 5, step: float = 0.37, **more: Any) -> Json:
    """Parallel grooves along q."""
    return groove(
        [[0.26, -1], [0.26, 3]], profile, repeat={"type": "linear", "count": count, "step": [step, 0]}, **more
    )


def across(profile: Json, at: float = 1.0, tilt: float = 0.0, **more: Any) -> Json:
    """One groove along p."""
    return groove([[-1, at - 2 * tilt], [3, at + 2 * tilt]], profile, **more)


def circle(radius: float, profile: Json, **more: Any) -> Json:
    return groove({"type": "circle", "center": [1.0, 1.0], "radius": radius}, profile, **more)


BENT = [[0.3, 0.4], [1.1, 1.6], [1.5, 0.6], [1.7, 1.4]]
ACUTE = [[0.4, 0.5], [1.5, 1.2], [0.5, 1.0]]
SVG = "M0.4,0.5 C0.6,1.9 1.0,1.6 1.0,1.0 S1.6,0.3 1.7,1.2 Q1.6,1.7 1.2,1.6 A0.3,0.2 20 0 1 0.7,1.3"
SINE = {"type": "sine", "amplitude": 0.5, "periods": 6}
TABLE = {"type": "table", "t": [0, 0.4, 0.5, 0.7, 1], "values": [1, 0.4, 1, 0.7, 0.9]}
METALS = {
    "stone": {"base_color": [0.7, 0.65, 0.6], "specular": 0},
    "brass": {"base_color": [0.9, 0.7, 0.4], "metallic": 1, "roughness": 0.45},
    "lacquer": {"base_color": [0.2, 0.3, 0.6], "roughness": 0.4},
    "lamp": {"base_color": [0.1, 0.1, 0.1], "roughness": 0.6, "emissive": [0.3, 0.1, 0.05]},
}


def sun(*direction: float) -> Json:
    return {"type": "directional", "direction": list(direction), "irradiance": [3, 3, 3]}


def lamp(*position: float, power: float = 1.0) -> Json:
    return {"type": "point", "position": list(position), "intensity": [power, power, power]}


PARALLEL: dict[str, tuple[list[Json], Json]] = {
    "v": ([row(V)], {}),
    "ridges": ([row(RIDGE)], {}),
    "scratches": ([row(SCRATCH)], {}),
    "trapezoids": ([row(TRAPEZOID)], {}),
    "walls": ([row(BOX)], {}),
    "raised walls": ([row(WALL)], {}),
    "round": ([row(ROUND)], {}),
    "skew": ([row(SKEW)], {}),
    "touching": ([row(V, 9, 0.24)], {}),
    "oblique": ([across(V, 0.8, 0.3), across(V, 1.3, 0.3)], {}),
    "lights": (
        [row(SKEW)],
        {
            "lights": [
                sun(1, 0.2, -1),
                sun(-1, 0, -0.6),
                lamp(0.5, -0.5, 0.8),
                {"type": "constant", "radiance": [0.2, 0.2, 0.3]},
            ]
        },
    ),
    "grazing light": ([row(V)], {"lights": [sun(1, 0.3, -0.15)]}),
    "light from below": ([row(V)], {"lights": [sun(1, 0.3, 0.2), lamp(0.2, 0.2, -0.3), lamp(0.5, 0, 0.7)]}),
    "lamp close": ([row(V)], {"lights": [lamp(0.1, 0.1, 0.25, power=0.1)]}),
    "lamp between ridges": ([row(RIDGE)], {"lights": [lamp(-0.19, 0.1, 0.07, power=0.02)]}),
    "metal": ([row(TRAPEZOID, material=["brass", "lacquer", "lamp"])], {"materials": METALS}),
    "stretched": ([row(V, 10, 0.5)], {"mapping": {"scale": [4, 2]}}),
    "turned": ([row(SKEW)], {"turn": [20, -10, 30]}),
}

OTHERS: dict[str, tuple[list[Json], Json]] = {
    "crossing": ([row(V, 3, 0.6), across(TRAPEZOID)], {}),
    "oblique crossing": ([row(V, 3, 0.6), across(SCRATCH, 1.0, 0.25)], {}),
    "walls crossing": ([row(BOX, 3, 0.6), across(WALL, 0.9, 0.2)], {}),
    "tee": ([across(V), groove([[1.0, 1.0], [1.0, -1.0]], V)], {}),
    "profile ends": ([groove([[0.5, 0.6], [1.4, 1.3]], SKEW), groove([[0.4, 1.4], [0.7, 1.2]], RIDGE)], {}),
    "flat ends": (
        [groove([[0.5, 0.6], [1.4, 1.3]], V, ends="flat"), groove([[0.4, 1.4], [0.8, 1.2]], RIDGE, ends="flat")],
        {},
    ),
    "dot": ([groove([[1.0, 1.0], [1.0, 1.0001]], V)], {}),
    "corner": ([groove(BENT, V)], {}),
    "corner of a ridge": ([groove(BENT, RIDGE)], {}),
    "corner of a scratch": ([groove(BENT, SCRATCH)], {}),
    "acute corner": ([groove(ACUTE, V)], {}),
    "closed": (
        [groove({"type": "polyline", "points": [[0.5, 0.5], [1.5, 0.6], [1.1, 1.5]], "closed": True}, SKEW)],
        {},
    ),
    "crosses itself": ([groove([[0.4, 0.4], [1.6, 1.4], [1.5, 0.5], [0.5, 1.5]], SCRATCH)], {}),
    "linear corner": ([groove(BENT, V, scale={"type": "linear", "start": 1.3, "end": 0.3})], {}),
    "sine corner": (
        [groove([[0.3, 0.5], [1.0, 1.3], [1.7, 1.0]], V, scale={"type": "sine", "amplitude": 0.3, "periods": 3})],
        {},
    ),
    "linear": ([row(V, 3, 0.6, scale={"type": "linear", "start": 0, "end": 1.8})], {}),
    "sine": (
        [
            across(RIDGE, 0.7, 0.1, scale=SINE | {"periods": 20}),
            across(V, 1.3, 0.1, scale=SINE | {"phase": 90, "periods": 9}),
        ],
        {},
    ),
    "table": ([groove([[0.3, 0.5], [1.7, 1.5]], SCRATCH, scale=TABLE)], {}),
    "ridge above groove": ([row(V, 3, 0.6), across(RIDGE, 1.0, 0.1, priority=1)], {}),
    "groove above ridge": ([row(RIDGE, 3, 0.6), across(V, 1.0, 0.1, priority=1)], {}),
    "groove above groove": (
        [row(BOX, 3, 0.6), across(V, 1.0, 0.1, priority=3), across(RIDGE, 1.3, -0.1, priority=2)],
        {},
    ),
    "groove through ridge": ([row(RIDGE, 3, 0.6), across(V, 1.0, 0.1)], {}),
    "ridges crossing": ([row(RIDGE, 3, 0.6), across(WALL, 1.0, 0.15)], {}),
    "overlapping": ([row(V, 3, 0.6), row(TRAPEZOID, 3, 0.62), across(SCRATCH, 1.0), across(V, 1.07, 0.01)], {}),
    "coincident": (
        [
            row(V, 3, 0.6),
            row(V, 3, 0.6),
            groove([[0.5, 0.9], [1.5, 1.0]], SCRATCH),
            groove([[0.5, 0.9], [1.5, 1.0]], SCRATCH),
        ],
        {},
    ),
    "coincident walls": (
        [
            row(BOX, 3, 0.6),
            row(BOX, 3, 0.6, ends="flat"),
            across(BOX),
            across(BOX, scale={"type": "constant", "value": 1}),
        ],
        {},
    ),
    "tile": ([groove([[0.05, 0.1], [0.45, 0.35]], V), groove([[0.0, 0.0], [0.5, 0.0]], RIDGE)], {"tile": [0.5, 0.4]}),
    "many lights": (
        [row(V, 3, 0.6), across(RIDGE)],
        {"lights": [sun(1, 0.2, -1), sun(-1, 0, -0.6), lamp(0.5, -0.5, 0.8)]},
    ),
    "low lamp": ([row(RIDGE, 3, 0.6), across(V)], {"lights": [lamp(0.1, 0.1, 0.25, power=0.1), sun(0.3, 1, -0.12)]}),
    "low eye": ([row(RIDGE, 3, 0.6), across(V)], {"camera": {"origin": [0.1, -2.5, 0.35]}}),
    "metals crossing": (
        [row(TRAPEZOID, 3, 0.6, material=["brass", None, "lacquer"]), across(RIDGE, material="brass")],
        {"materials": METALS},
    ),
    "stretched crossing": ([row(V, 5, 0.8), across(SCRATCH, 1.0, 0.2)], {"mapping": {"scale": [4, 2]}}),
}

CURVES: dict[str, tuple[list[Json], Json]] = {
    "circle": ([circle(0.5, V)], {}),
    "ridge ring": ([circle(0.5, RIDGE)], {}),
    "scratched ring": ([circle(0.5, SCRATCH)], {}),
    "concentric": ([circle(0.2, ROUND, repeat={"type": "concentric", "count": 3, "step": 0.25})], {}),
    "tight circle": ([circle(0.08, V), groove({"type": "circle", "center": [1.5, 1.2], "radius": 0.12}, RIDGE)], {}),
    "spiral": (
        [groove({"type": "spiral", "center": [1, 1], "inner_radius": 0.1, "outer_radius": 0.8, "turns": 2.5}, V)],
        {},
    ),
    "svg": ([groove({"type": "svg", "d": SVG}, V)], {}),
    "svg ridge": ([groove({"type": "svg", "d": SVG}, WALL)], {}),
    "ring crossing": ([circle(0.5, V), across(TRAPEZOID, 1.1, 0.1)], {}),
    "linear spiral": (
        [
            groove(
                {"type": "spiral", "center": [1, 1], "inner_radius": 0.1, "outer_radius": 0.8, "turns": 2.5},
                V,
                scale={"type": "linear", "start": 0.3, "end": 1.2},
            )
        ],
        {},
    ),
    "sine ring": ([circle(0.5, SCRATCH, scale=SINE)], {}),
}

SAMPLES = 64
FLIPS = 4
TOLERANCE = 0.002  # of the render settings: what auto aims at for a pixel
ARC = 1e-5  # pattern units: arcs of the meshes of curves


def rms(values: Floats) -> float:
    return float(np.sqrt(np.mean(values**2)))


def placed(plate: Callable[..., Json], grooves: list[Json], parts: Json) -> Json:
    turn = parts.get("turn")
    scene = plate(grooves, **{name: part for name, part in parts.items() if name != "turn"})
    if turn:
        scene["objects"][0]["rotate"] = turn
    return scene


def inside(method: Aov) -> NDArray[np.bool_]:
    """The pixels that see nothing but the plate, with their neighbours: at its edge csg samples parts of pixels."""
    seen = np.pad(method != 0, 1)
    height, width = method.shape
    return np.asarray(np.all([seen[y : y + height, x : x + width] for y in range(3) for x in range(3)], axis=0))


def agree(test: Floats, truth: Floats, other: Floats, what: str) -> None:
    """`test` is as near to `truth` as another seed's truth is."""
    noise = rms(truth - other) / 2**0.5
    difference = (test - truth).mean(axis=2)
    assert rms(test - truth) < math.hypot(1.3 * noise, 0.5 * TOLERANCE), what
    assert abs(difference.mean()) < 4.0 * noise / difference.size**0.5 + 1e-5, what


@pytest.mark.parametrize("name", [*PARALLEL, *OTHERS, *CURVES])
def test_against_the_solid(
    name: str, plate: Callable[..., Json], picture: Callable[..., pipeline.Picture], monkeypatch: pytest.MonkeyPatch
) -> None:
    grooves, parts = (PARALLEL | OTHERS | CURVES)[name]
    scene = placed(plate, grooves, parts)
    if name in CURVES:
        monkeypatch.setattr(mesh, "build", functools.partial(mesh.build, arc_tolerance=ARC))

    def render(method: str, seed: int = 0) -> Floats:
        return picture(scene, method=method, samples=SAMPLES, seed=seed).radiance.astype(np.float64)

    drawn = picture(scene, method="csg", samples=SAMPLES)
    truth, other, csg = render("geometry"), render("geometry", 1), drawn.radiance.astype(np.float64)
    whole = inside(drawn.aovs["method"])
    assert np.ptp(truth) > 0.01
    pixels = truth.shape[0] * truth.shape[1]
    allowed = float(truth.max()) / SAMPLES * (FLIPS / pixels) ** 0.5
    if name in CURVES and "scale" in grooves[0]:  # radii of at least 0.1, half of all pixels at the most
        allowed += 0.5 * (8.0 * ARC / 0.1) ** 0.5 / SAMPLES**0.5 * float(truth.mean())
    if "corner" in name and "scale" in grooves[0]:  # the mesh rounds the bend of the scale at the mitre
        allowed *= 4.0
    assert rms((csg - truth)[whole]) < allowed

    auto = picture(scene, method="auto", samples=4 * SAMPLES)  # where it samples, its own noise must be the lesser
    agree(auto.radiance.astype(np.float64), other, truth, "auto")
    area = picture(scene, method="area")
    agree(area.radiance.astype(np.float64), other, truth, "area")
    assert area.shares.get("area", 0.0) > (0.9 if name in CURVES or "scale" in grooves[0] else 0.9999)
    agree(render("lines"), other, truth, "lines")
    if name in PARALLEL and name != "lamp between ridges":
        agree(render("line"), other, truth, "line")
        assert auto.shares.get("csg", 0.0) == 0.0


def test_segment_is_the_papers(plate: Callable[..., Json], radiance: Radiance) -> None:
    """The papers' segment stands for the footprint's width alone: nearer than no grooves, farther than `line`."""
    scene = plate([row(V)])
    truth = radiance(scene, method="geometry", samples=400)
    off = {method: rms(radiance(scene, method=method) - truth) for method in ("base", "segment", "line")}
    assert off["line"] < 0.5 * off["segment"] < 0.25 * off["base"]


@pytest.mark.parametrize("method", ["csg", "auto"])
def test_light_along_a_plate_that_tiles(method: str, plate: Callable[..., Json], radiance: Radiance) -> None:
    """Shadow rays that could run for ever come to an end: a billion tiles lie before this one leaves the ridges."""
    grooves = [groove([[0.1, 0.1], [0.3, 0.35]], RIDGE)]
    scene = plate(grooves, tile=[0.5, 0.5], lights=[sun(0, 1, -1e-9)], camera={"resolution": [4, 3]})
    assert np.isfinite(radiance(scene, method=method, samples=4)).all()
