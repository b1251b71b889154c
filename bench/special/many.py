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
SIZE = (320, 240)
RUNS = 5
GOAL = 3.0


def measure() -> tuple[list[Line], dict[str, Any]]:
    """Frames of the two in turns, by `auto` and by `area`, patterns compiled before."""
    patterns = PatternCache()
    of = {count: scenes.scattered(count) for count in (FEW, MANY)}
    seconds: dict[str, dict[int, list[float]]] = {}
    shares: dict[str, Any] = {}
    for turn in range(RUNS + 1):
        for method in ("auto", "area"):
            for count, scene in of.items():
                picture = pipeline.render(scene, method=method, resolution=SIZE, patterns=patterns)
                spent = picture.seconds["total"] - sum(picture.seconds.get(stage, 0.0) for stage in APART)
                shares[f"{method} {count}"] = picture.shares
                if turn:
                    seconds.setdefault(method, {}).setdefault(count, []).append(spent)
    lines = []
    for method, each in seconds.items():
        few, many = float(np.median(each[FEW])), float(np.median(each[MANY]))
        lines.append(Line(f"{method}: {FEW} scratches, {SIZE[0]}x{SIZE[1]}", few, "s"))
        what = f"{method}: {MANY:,} scratches over {FEW} of the same area"
        lines.append(at_most(what, many / few, GOAL))
    return lines, {"seconds": seconds, "shares": shares}
