"""How a frame scales with the number of scratches: a hundred, and ten thousand ten times smaller each way."""

from __future__ import annotations

from typing import Any

import numpy as np

from bench.report import Line, at_most
from bench.special import scenes
from renderer import pipeline
from renderer.compile import PatternCache
from service.chart.record import APART

FEW, MANY = 100, 10_000
SIZES = ((640, 480), (320, 240))  # the first is that of the examples, of which the goal is taken to speak
RUNS = 3
GOAL = 3.0


def measure() -> tuple[list[Line], dict[str, Any]]:
    """Frames of the two in turns, by `auto` and by `area`, patterns compiled before."""
    patterns = PatternCache()
    of = {count: scenes.scattered(count) for count in (FEW, MANY)}
    seconds: dict[str, dict[int, list[float]]] = {}
    shares: dict[str, Any] = {}
    for turn in range(RUNS + 1):
        for method in ("auto", "area"):
            for size in SIZES:
                for count, scene in of.items():
                    picture = pipeline.render(scene, method=method, resolution=size, patterns=patterns)
                    spent = picture.seconds["total"] - sum(picture.seconds.get(stage, 0.0) for stage in APART)
                    how = f"{method}, {size[0]}x{size[1]}"
                    shares[f"{how}, {count}"] = picture.shares
                    if turn:
                        seconds.setdefault(how, {}).setdefault(count, []).append(spent)
    lines = []
    for how, each in seconds.items():
        few, many = float(np.median(each[FEW])), float(np.median(each[MANY]))
        lines.append(Line(f"{how}: {FEW} scratches", few, "s"))
        what = f"{how}: {MANY:,} scratches over {FEW} of the same area"
        judged = how == f"auto, {SIZES[0][0]}x{SIZES[0][1]}"
        lines.append(at_most(what, many / few, GOAL) if judged else Line(what, many / few, "times"))
    return lines, {"seconds": seconds, "shares": shares}
