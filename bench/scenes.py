"""The scenes measured: the examples, and how they are rendered here."""

from __future__ import annotations

import time
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

import schema
from renderer import pipeline
from renderer.compile import PatternCache

EXAMPLES = Path(__file__).resolve().parent.parent / "examples"
PATIENCE = 10  # seconds after which a render is worth a line on the terminal
Floats = NDArray[np.float64]


def load(name: str) -> schema.Scene:
    """An example; AssertionError where it is not valid."""
    report = schema.check_text((EXAMPLES / f"{name}.json").read_bytes())
    assert report.scene is not None, [problem.line() for problem in report.problems]
    return report.scene


def timed(
    scene: schema.Scene, method: str, resolution: tuple[int, int], samples: int | None = None,
    patterns: PatternCache | None = None,
) -> tuple[Floats, float, pipeline.Picture]:  # fmt: skip
    """The radiance, the seconds of the whole frame by the clock, and all else of it."""
    begin = time.perf_counter()
    picture = pipeline.render(scene, method=method, resolution=resolution, samples=samples, patterns=patterns)
    seconds = time.perf_counter() - begin
    if seconds > PATIENCE:
        print(f"  {method}, {samples} samples: {seconds:.0f} s", flush=True)
    return picture.radiance.astype(np.float64), seconds, picture
