"""What the ground truth itself is worth: its bias from single precision and from the start of its shadow rays.

Method `csg` draws the very same samples and meets the same solid in double precision, with no mesh. So the pictures
differ in no noise, only in the few samples that fall to the other side of an edge.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

import schema
from bench.report import Line
from bench.scenes import load
from renderer import pipeline, trace
from service.chart.run import inside

SIZE = (320, 240)
SAMPLES = 64
FACTORS = (0.25, 1.0, 10.0, 100.0)  # of the offset


def measure() -> tuple[list[Line], dict[str, Any]]:
    """Figures 14 and 15, and one side of a record: the mean of geometry's error over a picture, by offset."""
    lines: list[Line] = []
    detail: dict[str, Any] = {"resolution": SIZE, "samples": SAMPLES, "offset": trace.OFFSET}
    usual = trace.OFFSET
    for name in ("parallel", "tiles", "single"):
        scene = load(name)
        mask = inside(pipeline.render(scene, method="base", resolution=SIZE))
        solids: dict[str, Any] = {}

        def picture(method: str, scene: schema.Scene = scene, solids: dict[str, Any] = solids) -> NDArray[np.float64]:
            drawn = pipeline.render(scene, method=method, resolution=SIZE, samples=SAMPLES, solids=solids)
            return drawn.radiance.astype(np.float64)

        exact = picture("csg")[mask]
        found = {}
        try:
            for factor in FACTORS:
                trace.OFFSET = usual * factor
                off = picture("geometry")[mask] - exact
                found[factor] = float(off.mean())
                if factor == 1.0:
                    changed = float(np.mean(np.abs(off).max(axis=1) > 1e-4))
        finally:
            trace.OFFSET = usual
        lines += [Line(f"{name}: bias of geometry", found[1.0])]
        lines += [Line(f"{name}: at {factor:g} times the offset", found[factor]) for factor in FACTORS if factor != 1.0]
        lines += [Line(f"{name}: pixels with a sample on another side of an edge", changed)]
        detail[name] = {"bias": found, "pixels": changed}
    return lines, detail
