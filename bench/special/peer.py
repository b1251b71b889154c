"""How fast: beside Mitsuba 3's vectorised variant on the same cores and on the triangles of method `geometry`.

Both in turns in one process, at the same resolution, their frames alone: no loading, meshing, or compiling. Mitsuba
takes multijittered samples, the best that it has for this. Its error is its noise alone, from seed to seed: what light
leaks along edges in single precision is told apart, and not held against it. Its curve of error over seconds is
followed to ours (`service.chart.compare`); where it has to be lengthened, the line says so.
"""

from __future__ import annotations

import time
from typing import Any, NamedTuple

import numpy as np

import schema
from bench.report import Line, at_least
from bench.scenes import Floats, load
from bench.special import accuracy, scenes
from bench.special.reference import reference
from renderer import pipeline
from renderer.compile import PatternCache
from service.chart import measure as errors
from service.chart.compare import Point, equal
from service.chart.record import APART, Record
from service.chart.run import inside
from tests.renderer import foreign

LADDER = (16, 64, 256, 1024, 4096)  # samples of Mitsuba
RUNS, FEW = 5, 2  # of the last one few
SAMPLES = 4096  # of a pass of the reference


class Case(NamedTuple):
    """A scene, our methods for it, how many times faster they should be."""

    name: str
    scene: schema.Scene
    methods: tuple[str, ...]
    goal: float
    resolution: tuple[int, int]
    far: accuracy.Case | None = None  # whose truth is better than a mesh's


def cases() -> list[Case]:
    """Under one sun: of two lights Mitsuba would choose one for each sample."""
    far = next(case for case in accuracy.cases() if case.name == "far, flat")
    parallel = load("parallel")
    parallel = parallel.model_copy(update={"lights": parallel.lights[:1]})
    return [
        Case("crossing", scenes.close("crossing", one_light=True), ("area", "auto"), 30.0, scenes.SMALL),
        Case("far", far.scene, ("area", "auto"), 30.0, scenes.FAR, far),
        Case("figure 14", parallel, ("line", "auto"), 200.0, scenes.SMALL),
    ]


def measure() -> tuple[list[Line], dict[str, Any]]:
    """How many times faster at equal error; a line that says so where Mitsuba, or LLVM, is missing."""
    try:
        mi = foreign.load()
    except ImportError as error:
        return [_missing(f"no Mitsuba: {error}")], {}
    if not mi.variant().startswith("llvm"):
        return [_missing(f"no LLVM for Mitsuba: {', '.join(foreign.LLVM)}")], {}
    lines: list[Line] = []
    detail: dict[str, Any] = {"variant": mi.variant(), "version": mi.__version__}
    for case in cases():
        print(f"  beside Mitsuba: {case.name} ...", flush=True)
        found, detail[case.name] = _compared(mi, case)
        lines += found
    return lines, detail


def _missing(why: str) -> Line:
    print(f"  {why}", flush=True)
    return Line(f"area beside Mitsuba: not measured, {why}", float("nan"))


def _compared(mi: Any, case: Case) -> tuple[list[Line], dict[str, Any]]:
    width, height = case.resolution
    scene = case.scene.model_copy(
        update={"camera": case.scene.camera.model_copy(update={"resolution": (width, height)})}
    )
    truth = case.far.truth() if case.far else reference(scene, "geometry", case.resolution, SAMPLES)
    mask = inside(pipeline.render(scene, method="base", resolution=case.resolution))
    theirs = foreign.foreign_scene(mi, scene, "multijitter")
    patterns = PatternCache()

    def ours(method: str) -> tuple[Record, float]:
        record = Record()
        picture = pipeline.render(scene, method=method, resolution=case.resolution, patterns=patterns)
        record.add(picture, 0.0)
        return record, picture.seconds["total"] - sum(picture.seconds.get(stage, 0.0) for stage in APART)

    seconds: dict[str, list[float]] = {}
    drawn: dict[int, list[Floats]] = {count: [] for count in LADDER}
    records = {method: ours(method)[0] for method in case.methods}
    for count in LADDER:
        foreign.picture(mi, theirs, count, 0)  # compiled for each number of samples
    for turn in range(RUNS):
        for method in case.methods:
            ours(method)  # after Mitsuba's threads the first frame is slower
            seconds.setdefault(method, []).append(ours(method)[1])
        for count in LADDER if turn < FEW else LADDER[:-1]:
            begin = time.perf_counter()
            image = foreign.picture(mi, theirs, count, turn + 1)
            seconds.setdefault(f"mitsuba {count}", []).append(time.perf_counter() - begin)
            drawn[count].append(image)
    curve = [
        Point(count, float(np.median(seconds[f"mitsuba {count}"])), _noise(drawn[count], mask)) for count in LADDER
    ]
    bias = float(np.mean(np.mean(drawn[LADDER[-1]], axis=0)[mask] - truth.mean[mask]))
    lines = [Line(f"{case.name}: Mitsuba's own bias", bias)]
    detail: dict[str, Any] = {
        "mitsuba": [point._asdict() for point in curve], "noise": errors.noise(truth, mask), "seconds": seconds,
    }  # fmt: skip
    for method in case.methods:
        error = errors.errors(records[method], truth, mask, sampled=False).rmse
        spent = float(np.median(seconds[method]))
        needed = equal(curve, error.least)
        detail[method] = {"rmse": error._asdict(), "seconds": spent, "needed": needed._asdict()}
        bound = "" if error.value is not None else " at most"
        lines.append(Line(f"{case.name}, {method}: RMSE{bound}", error.least))
        lines.append(Line(f"{case.name}, {method}", spent, "s"))
        if needed.seconds is None:  # it does not get there at all: what it has spent at its best
            at, how = curve[-1].seconds, f"never gets there, {curve[-1].rmse:.2g} is its best; more than"
        else:
            at, how = needed.seconds, f"{needed.how}, {needed.samples:,.0f} samples"
        lines.append(at_least(f"{case.name}, {method}: times faster than Mitsuba ({how})", at / spent, case.goal))
    return lines, detail


def _noise(pictures: list[Floats], mask: errors.Mask) -> float:
    """The RMSE of one picture by its noise alone."""
    return float(np.sqrt(np.mean(np.var(pictures, axis=0, ddof=1)[mask])))
