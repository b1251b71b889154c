"""A small version of the sweep: every factor at its ends, and the pairs that something failed at once.

Against the truth in double precision `csg` draws the very same samples: it may differ by samples that fall within
rounding of an edge. Solid thinner than THIN of a groove's width counts as rounding, and so far may an edge be off for a
ray and for its shadow, at either side of a groove: of n samples in each of P footprints of F widths,
4 * THIN / F * n * P, and FLIPS more by chance.
"""

from __future__ import annotations

import math

import numpy as np
import pytest

from bench.stability import exact
from bench.stability.scenes import PIXELS, Case, axes, setting
from bench.stability.sweep import ITSELF, METHODS, Score, of, outlies, picture, rendered, run
from renderer.geometry.solid import THIN

SAMPLES = 256
FLIPS = 2
TOLERANCE = 0.002  # of the render settings

STRAIGHT: list[dict[str, float]] = [
    {},
    {"view": 90},
    {"view": 0.1},
    {"light": 90},
    {"light": 0.1},
    {"footprint": 1e-4},
    {"footprint": 100},
    {"crossing": 90},
    {"crossing": 0.01},
    {"run": 1e-6},
    {"run": 0},
    {"aspect": 0.01},
    {"aspect": 100},
    {"apart": 1e-9},
    {"apart": 0},
    {"number": 1},
    {"number": 10000},
    {"run": 0, "number": 1},
    {"run": 0, "number": 10},
    {"view": 0.1, "footprint": 1e-4},
    {"view": 0.1, "aspect": 10},
    {"view": 0.1, "light": 0.1},
    {"aspect": 100, "crossing": 3},
    {"light": 0.1, "aspect": 100},
    {"view": 0.1, "apart": 1e-9},
    {"view": 30, "apart": 0.5},
]
OTHERS: list[dict[str, float]] = [
    {"radius": 1000},
    {"radius": 3},
    {"radius": 1, "footprint": 1e-3},
    {"radius": 0.5},
    {"radius": 0.1},
    {"slope": 1e-3},
    {"slope": 0.1},
    {"slope": 1},
    {"view": 5, "radius": 10},
    {"run": 1e-6, "number": 10},
]


def name(values: dict[str, float]) -> str:
    return ", ".join(f"{key} {value:g}" for key, value in values.items()) or "base"


@pytest.mark.parametrize("values", STRAIGHT, ids=name)
def test_csg_is_exact_but_for_rounding(values: dict[str, float]) -> None:
    case = of(values)
    pixels = PIXELS if case.footprint <= 200 else (2, 2)
    made = setting(case, pixels)
    image, truth = picture(made, pixels, "csg", SAMPLES, 0), exact.truth(made, pixels, SAMPLES, 0)
    count = SAMPLES * truth.size
    assert np.abs(image - truth).sum() * SAMPLES <= FLIPS + 4 * THIN / case.footprint * count + 1e-7 * count


@pytest.mark.parametrize("values", STRAIGHT + OTHERS, ids=name)
def test_no_method_breaks(values: dict[str, float]) -> None:
    """Finite and not negative, no holes, no fireflies; `auto` as right as its tolerance, the truth's noise and its own
    samples allow."""
    result = run(of(values), most_waves=20.0, samples=SAMPLES, truth_samples=1024)
    assert not math.isnan(result.floor), result.truth
    assert {method: score.failed for method, score in result.scores.items() if score.failed} == {}
    assert set(METHODS) <= set(result.scores)
    for method in ("auto", "area", "csg", ITSELF[0]):
        if method in result.scores:
            assert not outlies(result.scores[method]), method

    def allowed(other: Score) -> float:
        return 1.5 * other.rms + result.floor + 0.5 * TOLERANCE

    assert result.scores["auto"].rms <= allowed(result.scores["csg"])


@pytest.mark.parametrize("footprint", [1e-4, 0.01])
def test_the_tip_in_a_circle_of_the_half_width(footprint: float) -> None:
    """What is left inside is a cone whose tip is the circle's centre, at the height of the plate, before the groove's
    floor. From straight above, vertical rays meet it in closed form; the light is steep enough to shade nothing."""
    case = of({"radius": 1.0, "footprint": footprint, "view": 90.0, "light": 70.0})
    made = setting(case, PIXELS)
    origin, forward, right, down = axes(made.scene["camera"], PIXELS)
    steep = case.aspect / case.run  # of the cone, 59 degrees: the light at 70 sees all of it
    light = np.array(made.light)
    truth = np.zeros(PIXELS[::-1])
    offsets = (np.arange(64) + 0.5) / 64
    for y, x in np.ndindex(truth.shape):
        across, along = np.meshgrid(x + offsets - 0.5 * PIXELS[0], y + offsets - 0.5 * PIXELS[1])
        rays = forward + across[..., None] * right + along[..., None] * down
        place = origin + rays * (-origin[2] / rays[..., 2:])
        slope = steep * place[..., :2] / np.hypot(place[..., 0], place[..., 1])[..., None]
        truth[y, x] = np.mean(slope @ light[:2] + light[2]) / math.hypot(steep, 1.0)
    for method in ("auto", "csg", "area"):
        assert picture(made, PIXELS, method, 1024, 0) == pytest.approx(truth, abs=0.002), method


def test_what_fails_by_nature_is_not_chosen() -> None:
    """Where `line` is far off, `auto` has not chosen it; where nothing crosses, bends or tapers, it has."""
    for values in ({"crossing": 90.0}, {"apart": 0.1}, {"radius": 3.0}, {"slope": 0.1}):
        result = run(of(values), samples=SAMPLES, truth_samples=1024)
        assert result.scores["line"].rms > 0.01
        assert result.scores["auto"].rms < 0.5 * result.scores["line"].rms
    for values in ({"view": 0.1}, {"light": 0.1}, {"run": 0.0}, {"aspect": 100.0}, {"footprint": 1e-4}):
        result = run(of(values), samples=SAMPLES, truth_samples=1024)
        assert result.scores["auto"] == result.scores["line"]
        assert result.scores["line"].rms <= result.floor + 0.5 * TOLERANCE


def test_more_grooves_than_line_holds_are_sampled() -> None:
    """Not left out: `line` and `segment` once drew a plate without grooves, 0.4 too bright."""
    result = run(Case(footprint=4000.0, number=4000.0), samples=SAMPLES, truth_samples=1024)
    for method in ("line", "segment"):
        assert result.scores[method].rms < 3.0 * result.scores["csg"].rms


def test_noise_is_told_where_strata_hold_many_grooves() -> None:
    """There strata gain nothing: 95 % of the pixels are within the error that is told, as of independent samples, but
    for four deviations of that share among so many."""
    pixels = 20, 18
    case = of({"light": 5, "footprint": 1000, "number": 2000})
    made = setting(case, pixels)
    found = rendered(made, pixels, "area", SAMPLES, 0)
    assert found.shares == {"csg": 1.0}
    off = np.abs(found.radiance[:, :, 0] - exact.truth(made, pixels, 4096, 1, whole_period=True))
    assert (off <= found.aovs["error"]).mean() >= 0.95 - 4.0 * math.sqrt(0.95 * 0.05 / off.size)


@pytest.mark.parametrize("aspect", [0.1, 0.5, 3.0])
def test_the_truth_of_v_grooves_that_touch(aspect: float) -> None:
    """In closed form, seen from above: walls of slope t have the normals (-t, 1) and (t, 1) over sqrt(1 + t^2), each
    half of what is seen. Under a light (x, z) of slope s = z / x across the grooves the wall towards it is dark where
    s < t, and the ridge's shadow leaves 2 s / (s + t) of the other wall lit: where the line w = -(b + h) s from the
    ridge at -h lies above the wall w = -(h - b) t."""
    t = 2.0 * aspect
    made = setting(Case(view=90.0, light=20.0, run=0.5, aspect=aspect, footprint=200.0, number=200.0))
    x, z = abs(made.light[0]), made.light[2]
    s = z / x
    if s < t:
        expected = s / (s + t) * (t * x + z)
    else:
        expected = 0.5 * ((t * x + z) + (z - t * x))
    image = exact.truth(made, PIXELS, 4096, 0, whole_period=True)
    # one sample of 4,096 at each of four edges
    assert np.abs(image - expected / math.sqrt(1.0 + t * t)).max() < 4.0 / 4096
