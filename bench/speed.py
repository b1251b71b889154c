"""What grooves cost: a frame of figure 14 by `line` beside one with no grooves, very many grooves beside many, and the
light that facets exchange beside direct light alone."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

import schema
from bench.report import Line, at_most
from bench.scenes import load, timed
from renderer.compile import PatternCache

SIZE = (640, 480)
RUNS = 15
COUNTS = (250, 25_000)
FAR = (64, 48)  # of figure 14: 4 to 20 of the 250 grooves a pixel
ANGLES = (30, 60, 90, 120)  # of grooves that exchange light, degrees
BOUNCES = 16


def measure() -> tuple[list[Line], dict[str, Any]]:
    """Whole frames, the two methods in turn, patterns compiled before."""
    scene, cache = load("parallel"), PatternCache()
    seconds: dict[str, list[float]] = {"base": [], "line": []}
    for method in seconds:
        timed(scene, method, SIZE, patterns=cache)
    for _ in range(RUNS):
        for method, spent in seconds.items():
            spent.append(timed(scene, method, SIZE, patterns=cache)[1])
    crowds = {count: crowd(count) for count in COUNTS}
    spent_far: dict[int, list[float]] = {count: [] for count in COUNTS}
    for run in range(4 * RUNS + 1):
        for count, furrows in crowds.items():
            _, _, picture = timed(furrows, "auto", FAR, patterns=cache)
            if run > 0:
                spent_far[count].append(picture.seconds["line"])
    few, many = (float(np.median(spent_far[count])) for count in COUNTS)
    mutual, spent_mutual = exchange()
    line, base = (float(np.median(seconds[method])) for method in ("line", "base"))
    return [
        Line("figure 14, 640x480: base", base, "s"),
        Line("figure 14, 640x480: line", line, "s"),
        at_most("figure 14, 640x480: line / base", line / base, 2.5),
        Line("figure 14, 64x48: line, 250 grooves", few, "s"),
        Line("figure 14, 64x48: line, 25,000 grooves", many, "s"),
        at_most("figure 14, 64x48: line, 25,000 / 250 grooves", many / few, 1.5),
        *mutual,
    ], {"resolution": SIZE, "seconds": seconds, "far": spent_far, "exchange": spent_mutual}


def exchange() -> tuple[list[Line], dict[str, list[list[float]]]]:
    """Figure 14 with grooves of each angle, light followed from facet to facet over not followed, in turns: the time of
    frames, and of the kernel alone."""
    lines = []
    ratios: dict[str, list[list[float]]] = {}
    for angle in ANGLES:
        scene, cache = load("parallel"), PatternCache()
        told = scene.model_dump(mode="json")
        told["patterns"]["furrows"]["grooves"][0]["profile"]["depth"] = 0.5 / math.tan(math.radians(angle / 2))
        frames = [schema.Scene.model_validate(told | {"render": {"bounces": count}}) for count in (0, BOUNCES)]
        found = []
        for _ in range(RUNS + 1):
            alone, mutual = (timed(frame, "line", SIZE, patterns=cache) for frame in frames)
            found.append([mutual[1] / alone[1], mutual[2].seconds["line"] / alone[2].seconds["line"]])
        ratios[str(angle)] = found = found[1:]
        (frame, kernel), errors = np.mean(found, axis=0), np.std(found, axis=0, ddof=1) / math.sqrt(RUNS)
        what = f"V grooves of {angle} degrees, 640x480: line with {BOUNCES} bounces / with none"
        lines.append(at_most(f"{what}, +- {errors[0]:.3f}", float(frame), 1.1))
        lines.append(Line(f"{what}, its kernel alone, +- {errors[1]:.3f}", float(kernel)))
    return lines, ratios


def crowd(count: int) -> schema.Scene:
    """Figure 14 with so many grooves over the same plate, as much narrower and shallower as they are more."""
    scene = load("parallel").model_dump(mode="json")
    d = 250.0 / count
    furrow = scene["patterns"]["furrows"]["grooves"][0]
    furrow["path"]["points"] = [[0.5 * d - 125.0, -200], [0.5 * d - 125.0, 400]]
    furrow["profile"] |= {"width": d, "depth": 0.45 * d}
    furrow["repeat"] |= {"count": count, "step": [d, 0]}
    return schema.Scene.model_validate(scene)
