"""How right `area` is: from close, and from far with more than ten grooves of each of two families in a pixel.

From close the truth is `geometry`. From far there are too many to mesh: grooves below the plane have a truth in double
precision that shares nothing with the renderer but random numbers (`bench.stability.exact`), lips that of `csg`.
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np

import schema
from bench.report import Line, at_most
from bench.special import scenes
from bench.special.reference import ENOUGH, converged, reference
from bench.stability import exact
from renderer import pipeline
from renderer.compile import PatternCache, compile_scene
from renderer.tables import AREA
from service.chart import measure as errors
from service.chart.record import Record

SAMPLES, LIPS_SAMPLES, FAR_COLUMNS = 4096, 4096, 256
PASSES = (3, 24)  # of the truth from far
CLOSE_GOAL, FAR_GOAL = 4e-4, 6e-4
FAR = {  # some 6 of each family in a pixel, or 13
    "steep": scenes.Far((0.4, -1.7), scenes.V, 0.008),
    "flat": scenes.Far((0.15, 0.7), scenes.V, 0.008),
    "lips": scenes.Far((0.4, -1.7), scenes.LIPS, 0.008),
    "dense": scenes.Far((0.15, 0.7), scenes.V, 0.004),
}


class Case(NamedTuple):
    """A scene with its reference."""

    name: str
    scene: schema.Scene
    resolution: tuple[int, int]
    goal: float
    far: scenes.Far | None = None

    def truth(self) -> Record:
        if self.far is None:
            return reference(self.scene, "geometry", self.resolution, SAMPLES)
        if self.far.profile is scenes.LIPS:
            return reference(self.scene, "csg", self.resolution, LIPS_SAMPLES)
        far = self.far
        return converged(self.scene, f"exact {FAR_COLUMNS}", lambda seed: straight(self.scene, far, seed), PASSES)


def cases() -> list[Case]:
    close = [Case(f"close, {name}", scenes.close(name), scenes.SMALL, CLOSE_GOAL) for name in scenes.CLOSE]
    return close + [Case(f"far, {name}", scenes.far(far), scenes.FAR, FAR_GOAL, far) for name, far in FAR.items()]


def straight(scene: schema.Scene, far: scenes.Far, seed: int) -> pipeline.Picture:
    """One pass of the truth in double precision, FAR_COLUMNS^2 samples a pixel."""
    camera = compile_scene(scene, scenes.FAR, PatternCache(), None).camera
    families, middle = [], 0.5 * scenes.PLATE
    for groove, slope in zip(scene.patterns["cut"].grooves, far.slopes, strict=True):
        path, repeat = groove.path, groove.repeat
        assert isinstance(path, schema.PolylinePath)
        assert isinstance(repeat, schema.LinearRepeat)
        (x, y), long = path.points[0][:2], math.hypot(1.0, slope)
        families.append([x - middle, y - middle, 1.0 / long, slope / long, repeat.step[1] / long, 0, repeat.count - 1])
    profile = scenes.fine(far.profile, far.pitch)
    half, deep = 0.5 * profile["width"], profile["depth"]
    light = -np.array(scenes.SUN["direction"], float)
    out = np.zeros(scenes.FAR[::-1])
    exact.shoot(
        camera.origin, camera.corner, camera.right, camera.down, FAR_COLUMNS, FAR_COLUMNS, seed,
        np.array(families, float), np.array([[-half, 0.0], [0.0, -deep], [half, 0.0]]), light / np.linalg.norm(light),
        np.zeros((2, 2)), out,
    )  # fmt: skip
    white = np.repeat(out[..., None], 3, axis=2).astype(np.float32)
    return pipeline.Picture(white, {}, {"total": 0.0}, 0, {})


def measure() -> tuple[list[Line], dict[str, Any]]:
    """The RMSE of each scene; every pixel sees the plate alone."""
    lines: list[Line] = []
    detail: dict[str, Any] = {}
    for case in cases():
        name = case.name
        print(f"  {name} ...", flush=True)
        picture = pipeline.render(case.scene, method="area", resolution=case.resolution)
        mask = picture.aovs["method"] != 0
        assert mask.all(), name
        truth = case.truth()
        drawn = Record()
        drawn.add(picture, 0.0)
        found = errors.errors(drawn, truth, mask, sampled=False).rmse
        noise = errors.noise(truth, mask)
        off = np.abs(drawn.mean - truth.mean).mean(axis=2)
        worst = np.unravel_index(int(np.argmax(off)), off.shape)
        bound = "" if found.value is not None else " at most"
        lines.append(at_most(f"area, {name}: RMSE{bound}", found.least, case.goal))
        what = f"area, {name}: the reference's noise"
        # lips from far would take csg an hour; what they are called is a bound
        known = case.far is None or case.far.profile is not scenes.LIPS
        lines.append(at_most(what, noise, ENOUGH) if known else Line(what, noise))
        detail[name] = {
            "rmse": found._asdict(), "noise": noise, "floor": errors.floor(truth, mask), "passes": truth.count,
            "shares": picture.shares, "its own": _own(drawn, truth, picture), "seconds": picture.seconds,
            "worst": {"row": int(worst[0]), "column": int(worst[1]), "off": float(off[worst])},
        }  # fmt: skip
    return lines, detail


def _own(drawn: Record, truth: Record, picture: pipeline.Picture) -> float | None:
    """The RMSE of the pixels that `area` took itself, the bound where it is no value; None: too few."""
    mask = picture.aovs["method"] == AREA
    return errors.errors(drawn, truth, mask, sampled=False).rmse.least if mask.sum() > 10 else None
