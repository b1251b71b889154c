"""Errors against the solid traced, and the time that tracing needs for the same error."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from bench.report import Line, at_least, at_most
from bench.scenes import Floats, inside, load, seeded, timed

SIZE = (320, 240)
REFERENCE = 4096  # samples a pixel
REFERENCE_SEEDS = (1, 2)
CURVE = (16, 64, 256, 1024)
CURVE_SEED = 3
REPEATS = 7


def measure() -> tuple[list[Line], dict[str, Any]]:
    """Figures 14 and 15 of paper 000."""
    first, detail = _parallel()
    second, other = _tiles()
    return first + second, {"parallel": detail, "tiles": other}


def _parallel() -> tuple[list[Line], dict[str, Any]]:
    scene = load("parallel")
    mask = inside(scene, SIZE)
    one, seconds, _ = timed(seeded(scene, REFERENCE_SEEDS[0]), "geometry", SIZE, REFERENCE)
    two, _, _ = timed(seeded(scene, REFERENCE_SEEDS[1]), "geometry", SIZE, REFERENCE)
    # Two independent references differ by sqrt(2) of what one is off.
    noise = _rmse(one, two, mask) / math.sqrt(2)
    methods: dict[str, Any] = {}
    for _ in range(REPEATS):
        for method in ("line", "segment"):
            image, spent, _ = timed(scene, method, SIZE)
            entry = methods.setdefault(method, {"seconds": []})
            entry["seconds"].append(spent)
            entry["rmse"] = _rmse(image, one, mask)
            entry["own_rmse"] = _own_rmse(image, one, two, mask)
            entry["bias"] = _bias(image, one, mask)
    for entry in methods.values():
        entry["median"] = float(np.median(entry["seconds"]))
    curve = []
    for samples in CURVE:
        image, spent, _ = timed(seeded(scene, CURVE_SEED), "geometry", SIZE, samples)
        curve.append({"samples": samples, "seconds": spent, "rmse": _own_rmse(image, one, two, mask)})
    line = methods["line"]
    equal, slope, needed = _equal(curve, line["rmse"])
    detail = {
        "resolution": SIZE, "pixels": int(mask.sum()), "reference_samples": REFERENCE, "seeds": REFERENCE_SEEDS,
        "reference_seconds": seconds, "reference_noise": noise, "methods": methods, "curve": curve,
        "curve_seed": CURVE_SEED, "slope": slope, "equal_samples": equal, "equal_seconds": needed,
    }  # fmt: skip
    lines = [
        at_most("figure 14: line, RMSE", line["rmse"], 0.0008),
        Line("figure 14: line, RMSE without the reference's noise", line["own_rmse"]),
        Line("figure 14: line, bias", line["bias"]),
        Line("figure 14: segment, RMSE", methods["segment"]["rmse"]),
        Line("figure 14: segment, bias", methods["segment"]["bias"]),
        Line(f"figure 14: geometry at {REFERENCE} samples, its own noise", noise),
        Line("figure 14: line", line["median"], "s"),
        Line("figure 14: segment", methods["segment"]["median"], "s"),
        *(
            Line(f"figure 14: geometry at {point['samples']} samples, RMSE in {point['seconds']:.3g} s", point["rmse"])
            for point in curve
        ),
        Line("figure 14: slope of geometry's error over samples", slope),
        Line("figure 14: geometry's samples for line's error", equal),
        Line("figure 14: geometry's time for line's error", needed, "s"),
        at_least("figure 14: line is so many times faster at equal error", needed / line["median"], 200),
    ]
    return lines, detail


def _tiles() -> tuple[list[Line], dict[str, Any]]:
    scene = load("tiles")
    mask = inside(scene, SIZE)
    reference, reference_seconds, _ = timed(seeded(scene, REFERENCE_SEEDS[0]), "geometry", SIZE, REFERENCE)
    other, _, _ = timed(seeded(scene, REFERENCE_SEEDS[1]), "geometry", SIZE, REFERENCE // 4)
    runs = [timed(scene, "auto", SIZE) for _ in range(3)]
    image, _, picture = runs[0]
    seconds = float(np.median([spent for _, spent, _ in runs]))
    rmse, bias = _rmse(image, reference, mask), _bias(image, reference, mask)
    detail = {
        "resolution": SIZE, "pixels": int(mask.sum()), "reference_samples": REFERENCE, "seeds": REFERENCE_SEEDS,
        "reference_seconds": reference_seconds, "quarter_of_reference_rmse": _rmse(other, reference, mask),
        "samples": scene.render.samples, "rmse": rmse, "bias": bias,
        "seconds": [spent for _, spent, _ in runs], "shares": picture.shares,
    }  # fmt: skip
    return [
        at_most("figure 15: auto, RMSE", rmse, 0.004),
        Line("figure 15: auto, bias", bias),
        Line("figure 15: auto", seconds, "s"),
        *(Line(f"figure 15: share of {name}", share) for name, share in picture.shares.items()),
    ], detail


def _equal(curve: list[dict[str, Any]], rmse: float) -> tuple[float, float, float]:
    """The samples that tracing needs for an error, the slope of its error, and the seconds.

    The error that is asked for has the reference's noise in it, the curve has not: that is to tracing's favour. A line
    through the curve in logarithms; time grows with the samples as measured between the last two points.
    """
    samples = np.log([point["samples"] for point in curve])
    slope, offset = np.polyfit(samples, np.log([point["rmse"] for point in curve]), 1)
    needed = math.exp((math.log(rmse) - offset) / slope)
    before, last = curve[-2:]
    rate = (last["seconds"] - before["seconds"]) / (last["samples"] - before["samples"])
    return needed, float(slope), last["seconds"] + rate * (needed - last["samples"])


def _rmse(image: Floats, reference: Floats, mask: NDArray[np.bool_]) -> float:
    return float(np.sqrt(np.mean((image[mask] - reference[mask]) ** 2)))


def _own_rmse(image: Floats, one: Floats, two: Floats, mask: NDArray[np.bool_]) -> float:
    """The RMSE less what the references add: their noises are independent, so that they drop out of the product."""
    square = float(np.mean((image[mask] - one[mask]) * (image[mask] - two[mask])))
    return math.sqrt(max(square, 0.0))


def _bias(image: Floats, reference: Floats, mask: NDArray[np.bool_]) -> float:
    return float(np.mean(image[mask] - reference[mask]))
