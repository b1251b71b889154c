"""The sweep: every factor, and every pair of factors, each method against the truth.

Errors are shares of the radiance of a white surface that faces the light. Against two truths A and B of different
seeds, the square of a method's error is estimated by the mean of (X - A)(X - B), in which their noise has no part but
by chance: what is less than that chance is called below the noise. `csg` and `geometry` are drawn once more with the
very samples of the truth in double precision, which leaves their own mistakes and no noise at all.

The pixels of a case are all alike and full of the plate. So one that sees no object is a hole, and one whose radiance
lies beyond the range of the truth's, by more than noise and tolerance tell, is a firefly, or too dark.
"""

from __future__ import annotations

import functools
import itertools
import json
import math
import multiprocessing
import time
from collections.abc import Iterator
from concurrent.futures import ProcessPoolExecutor
from contextlib import contextmanager
from typing import Any, NamedTuple

import numpy as np

import schema
from bench.scenes import Floats
from bench.stability import exact
from bench.stability.scenes import PIXELS, WIDTH, Case, Setting, setting
from renderer import mesh, pipeline
from renderer.compile import PatternCache
from renderer.tables import Pattern

METHODS = tuple(name for name in pipeline.METHODS if name != "geometry")
ITSELF = ("csg, same samples", "geometry, same samples")
SAMPLES = 256  # of a method
TRUTH = 4096  # of a truth
MESHED, MESHED_CURVES = 150, 40  # grooves and crossings; more are not meshed here, as that takes long
WAVES, MORE_WAVES = 20.0, 200.0  # likewise, of perturbed grooves, in pairs and alone: see `waves`
FEW_PIXELS = (3, 3)  # where there are very many grooves
TOLERANCE = 0.002  # of the render settings
NEAR = 0.5 * TOLERANCE  # by which a pixel may lie beyond the truth's range and noise: what is approximated
ARC = 1e-4  # groove widths by which a mesh's chords may leave their arcs


class Factor(NamedTuple):
    """What varies: a field of Case, its name on the axis, its values alone and in pairs."""

    field: str
    label: str
    alone: tuple[float, ...]
    paired: tuple[float, ...]


FACTORS = (
    Factor("view", "view elevation, °", (90, 60, 30, 10, 3, 1, 0.3, 0.1), (90, 30, 5, 1, 0.1)),
    Factor("light", "light elevation, °", (90, 60, 30, 10, 3, 1, 0.3, 0.1), (90, 30, 5, 1, 0.1)),
    Factor(
        "footprint", "footprint, groove widths", (1e-4, 1e-3, 0.01, 0.1, 1, 10, 100, 1000), (1e-4, 0.01, 1, 30, 1000)
    ),
    Factor("crossing", "crossing angle, °", (90, 30, 10, 3, 1, 0.3, 0.1, 0.03, 0.01), (90, 20, 3, 0.3, 0.01)),
    Factor("run", "run of a wall, widths", (0.5, 0.3, 0.1, 0.01, 1e-3, 1e-4, 1e-5, 1e-6, 0), (0.5, 0.1, 1e-3, 1e-6, 0)),
    Factor("aspect", "depth over width", (0.01, 0.03, 0.1, 0.3, 1, 3, 10, 30, 100), (0.01, 0.1, 1, 10, 100)),
    Factor("radius", "radius of paths, half-widths", (1000, 100, 30, 10, 3, 1, 0.5, 0.1), (1000, 100, 10, 1, 0.1)),
    Factor("slope", "perturbation slope", (1e-4, 1e-3, 0.01, 0.03, 0.1, 0.3, 1), (1e-4, 1e-3, 0.01, 0.1, 1)),
    Factor(
        "apart",
        "a second groove's distance, widths",
        (1, 0.5, 0.1, 0.01, 1e-4, 1e-6, 1e-8, 1e-10, 1e-12, 0),
        (0.5, 0.01, 1e-6, 1e-9, 0),
    ),
    Factor("number", "grooves in a footprint", (1, 3, 10, 30, 100, 300, 1000, 3000, 10000), (1, 10, 100, 1000, 10000)),
)


class Score(NamedTuple):
    """How a method did on one case; shares of a white surface's radiance."""

    rms: float  # over the pixels, the truth's noise taken out
    worst: float  # the largest pixel
    bias: float  # the mean, signed
    beyond: float = 0.0  # how far the farthest pixel lies beyond the truth's range and noise; negative: darker
    failed: str = ""  # an exception, or what is no radiance at all


class Result(NamedTuple):
    """One case."""

    case: Case
    truth: str  # exact, period, geometry, csg; or why there is none
    floor: float  # errors below this are the truth's own noise
    scores: dict[str, Score]
    seconds: float


def singles() -> Iterator[tuple[Factor, float, Case]]:
    """Each factor alone. Grooves counted in a footprint touch."""
    for factor in FACTORS:
        for value in factor.alone:
            yield factor, value, of({factor.field: value})


def pairs() -> Iterator[tuple[Factor, Factor, float, float, Case]]:
    """Each pair of factors."""
    for first, second in itertools.combinations(FACTORS, 2):
        for a, b in itertools.product(first.paired, second.paired):
            yield first, second, a, b, of({first.field: a, second.field: b})


def of(values: dict[str, float]) -> Case:
    """The case of some factors: grooves that are counted touch, unless the footprint is given."""
    if "number" in values and "footprint" not in values:
        values = values | {"footprint": values["number"]}
    return Case(**values)


@contextmanager
def fine_meshes() -> Iterator[None]:
    """Meshes as fine as matters and no larger, each built once."""
    build = mesh.build
    made: dict[object, mesh.SolidMesh] = {}

    def fine(pattern: Pattern, window: tuple[float, float, float, float], **_: Any) -> mesh.SolidMesh:
        key = (id(pattern), window)
        if key not in made:  # the plate itself is as large as matters
            made[key] = build(pattern, window, arc_tolerance=ARC * WIDTH, margin=2.0 * WIDTH)
        return made[key]

    mesh.build = fine
    try:
        yield
    finally:
        mesh.build = build


def picture(made: Setting, pixels: tuple[int, int], method: str, samples: int, seed: int) -> Floats:
    """The radiance (H, W) of a method."""
    return rendered(made, pixels, method, samples, seed).radiance[:, :, 0].astype(np.float64)


def rendered(made: Setting, pixels: tuple[int, int], method: str, samples: int, seed: int) -> pipeline.Picture:
    """What a method makes of it; ValueError where there are holes."""
    report = schema.check(made.scene | {"render": {"seed": seed}})
    assert report.scene is not None, [problem.line() for problem in report.problems]
    found = pipeline.render(
        report.scene, method=method, samples=samples, threads=1, resolution=pixels, patterns=_cache()
    )
    holes = np.count_nonzero(found.aovs["method"] == 0)
    if holes and method != "geometry":
        raise ValueError(f"{holes} holes")
    return found


@functools.cache
def _cache() -> PatternCache:
    return PatternCache()


def score(image: Floats, one: Floats, two: Floats, own: float = 0.0) -> Score:
    """A picture against two truths that differ by noise. own: by how much a pixel may lie off by its own noise."""
    if not np.isfinite(image).all():
        return Score(
            math.nan, math.nan, math.nan, failed=f"{np.count_nonzero(~np.isfinite(image))} pixels are not finite"
        )
    if (image < 0.0).any():
        return Score(math.nan, math.nan, math.nan, failed=f"a radiance of {image.min():.2g}")
    mean = 0.5 * (one + two)
    rms = math.sqrt(max(float(np.mean((image - one) * (image - two))), 0.0))
    return Score(rms, float(np.abs(image - mean).max()), float((image - mean).mean()), beyond(image, one, two, own))


def beyond(image: Floats, one: Floats, two: Floats, own: float = 0.0) -> float:
    """By how much the farthest pixel lies beyond the truths' range and four deviations of their noise, and its own."""
    noise = own + 4.0 * math.sqrt(float(np.mean((one - two) ** 2)) / 2.0)
    above = float(image.max() - max(one.max(), two.max())) - noise
    below = float(min(one.min(), two.min()) - image.min()) - noise
    return max(above, 0.0) if above >= below else -max(below, 0.0)


def outlies(one: Score) -> bool:
    """Whether there is a pixel that noise does not explain."""
    return abs(one.beyond) > NEAR


def own_noise(method: str, found: pipeline.Picture) -> float:
    """Four deviations of a pixel: as predicted, or of SAMPLES samples of values from 0 to 1 at the most."""
    if method in ("csg", "relief") or "error" not in found.aovs:
        return 2.0 / math.sqrt(SAMPLES)
    return 2.0 * float(found.aovs["error"].max())


def floor_of(one: Floats, two: Floats) -> float:
    """What the mean of (X - A)(X - B) may come to by chance, two standard deviations of it."""
    noise = math.sqrt(float(np.mean((one - two) ** 2)) / 2.0)
    return max(noise * math.sqrt(2.0 / math.sqrt(one.size)), 1e-7)


def waves(case: Case, made: Setting) -> float:
    """What the mesh of a perturbed groove costs: the grooves, times how far they run, times their slope."""
    side: float = made.scene["objects"][0]["shape"]["size"][0] / WIDTH
    side += 2.0 * min(max(3.0, 8.0 * case.aspect), side)
    return made.grooves * side * case.slope


def run(case: Case, most_waves: float = WAVES, samples: int = SAMPLES, truth_samples: int = TRUTH) -> Result:
    """All methods on one case."""
    begin = time.perf_counter()
    scores: dict[str, Score] = {}

    def done(truth: str, floor: float = math.nan) -> Result:
        return Result(case, truth, floor, scores, time.perf_counter() - begin)

    pixels = PIXELS if (case.number or case.footprint) <= 200 else FEW_PIXELS
    try:
        made = setting(case, pixels)
    except ValueError as error:
        return done(str(error))
    problems = schema.check(made.scene)
    if problems.scene is None:
        return done(problems.problems[0].line())
    meshed = made.grooves <= (MESHED if made.families else MESHED_CURVES) and waves(case, made) <= most_waves
    kind = "geometry" if meshed else "csg"
    same = None
    with fine_meshes():
        if made.families:
            period = exact.far(made, case)
            kind = "period" if period else "exact"
            one, two = (exact.truth(made, pixels, truth_samples, seed, period) for seed in (1, 2))
            same = exact.truth(made, pixels, samples, 0)
        else:
            try:
                one, two = (picture(made, pixels, kind, truth_samples, seed) for seed in (1, 2))
                same = picture(made, pixels, kind, samples, 0) if meshed else None
            except Exception as error:
                return done(f"{kind}: {type(error).__name__}: {error}")
        if not (np.isfinite(one).all() and np.isfinite(two).all()):
            return done(f"{kind} is not finite")
        for name in (*METHODS, *ITSELF):
            method = name.split(",")[0]
            try:
                if name in METHODS:
                    found = rendered(made, pixels, method, samples, 0)
                    scores[name] = score(found.radiance[:, :, 0].astype(float), one, two, own_noise(method, found))
                elif same is not None and (method == "csg" or (meshed and made.families)):
                    scores[name] = score(picture(made, pixels, method, samples, 0), same, same)
            except Exception as error:
                scores[name] = Score(math.nan, math.nan, math.nan, failed=f"{type(error).__name__}: {error}")
    return done(kind, floor_of(one, two))


def sweep(processes: int = 2) -> tuple[list[Result], list[Result]]:
    """All of it, singles and pairs in their order."""
    alone = [case for *_, case in singles()]
    paired = [case for *_, case in pairs()]
    with ProcessPoolExecutor(processes, multiprocessing.get_context("spawn")) as pool:
        results = []
        begin = time.perf_counter()
        most = [MORE_WAVES] * len(alone) + [WAVES] * len(paired)
        for index, result in enumerate(pool.map(run, alone + paired, most, chunksize=4)):
            results.append(result)
            if index % 200 == 199:
                print(f"  {index + 1} of {len(alone) + len(paired)}, {time.perf_counter() - begin:.0f} s", flush=True)
    return results[: len(alone)], results[len(alone) :]


def save(results: list[Result]) -> str:
    """As JSON."""
    return json.dumps(
        [
            result._asdict()
            | {
                "case": result.case._asdict(),
                "scores": {name: one._asdict() for name, one in result.scores.items()},
            }
            for result in results
        ]
    )
