"""What grooves cost: a frame of figure 14 by `line` beside the same frame with no grooves."""

from __future__ import annotations

from typing import Any

import numpy as np

from bench.report import Line, at_most
from bench.scenes import load, timed
from renderer.compile import PatternCache

SIZE = (640, 480)
RUNS = 15


def measure() -> tuple[list[Line], dict[str, Any]]:
    """Whole frames, the two methods in turn, patterns compiled before."""
    scene, cache = load("parallel"), PatternCache()
    seconds: dict[str, list[float]] = {"base": [], "line": []}
    for method in seconds:
        timed(scene, method, SIZE, patterns=cache)
    for _ in range(RUNS):
        for method, spent in seconds.items():
            spent.append(timed(scene, method, SIZE, patterns=cache)[1])
    line, base = (float(np.median(seconds[method])) for method in ("line", "base"))
    return [
        Line("figure 14, 640x480: base", base, "s"),
        Line("figure 14, 640x480: line", line, "s"),
        at_most("figure 14, 640x480: line / base", line / base, 2.5),
    ], {"resolution": SIZE, "seconds": seconds}
