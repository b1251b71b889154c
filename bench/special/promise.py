"""What `auto` promises: at least 95 % of the pixels within the tolerance, no slower than the slowest that keeps it.

An error is the difference of radiance, the mean of its channels, over what a white matt surface turned to each light
sends there (`shading.white`). The reference is `csg` in passes, where meshes or round shapes are `geometry`; its noise
is in what is counted, so that the shares are of no more than its own noise too low. Single methods: `line`, `area`, and
`csg` with the first number of samples that keeps the tolerance. Where `auto` takes one method for nearly all, the two
are the same; so times are taken in turns, and are no slower where the mean of their ratios is not above one by more
than two standard errors.
"""

from __future__ import annotations

import math
from functools import cache
from typing import Any, NamedTuple

import numpy as np

import schema
from bench.report import Line, at_least, at_most
from bench.scenes import EXAMPLES, Floats, load
from bench.special.reference import reference
from renderer import pipeline
from renderer.compile import PatternCache, compile_scene
from renderer.footprint import rays
from renderer.raycast import Caster
from renderer.tables import DIRECTIONAL
from service.chart.record import APART
from service.chart.settings import MINE, Setting

NAMES = ("parallel", "tiles", "single", "vinyl", "dovetail", "hieroglyphs", "brushed", "scratches", "house")
TOLERANCES = (0.01, 0.003, 0.001)
SHARE = 0.95
SIZE = (32, 24)
SAMPLES, PASSES = {"scratches": 131_072}, {"scratches": (4, 4), "brushed": (2, 32)}  # of the reference: scratches glint
# Else `csg`, which on meshes errs where `auto` does.
TRUTH = dict.fromkeys(("hieroglyphs", "brushed", "house"), "geometry")
LADDER = (16, 64, 256, 1024)  # samples of csg
MOST = 65_536  # samples that `auto` may take where light is followed
RUNS = 5


class Drawn(NamedTuple):
    """A picture's errors at the pixels that see an object, and the seconds of its runs."""

    off: Floats
    runs: Floats

    @property
    def seconds(self) -> float:
        return float(np.median(self.runs))


def measure() -> tuple[list[Line], dict[str, Any]]:
    """Every example at every tolerance."""
    lines: list[Line] = []
    detail: dict[str, Any] = {}
    for name in NAMES:
        print(f"  auto: {name} ...", flush=True)
        found, detail[name] = _example(name)
        lines += [line._replace(what=f"auto, {name} {line.what}") for line in found]
    return lines, detail


def _example(name: str) -> tuple[list[Line], dict[str, Any]]:
    scene, samples, passes = load(name), SAMPLES.get(name, 16_384), PASSES.get(name, (2, 8))
    truth = reference(scene, TRUTH.get(name, "csg"), SIZE, samples, passes, meshes=_file)
    patterns = PatternCache()
    bright = white(scene, patterns)
    mask = np.isfinite(bright)
    noise = (np.sqrt(truth.variance / truth.count).mean(axis=2) / bright)[mask]

    def draw(method: str, samples: int | None = None, tolerance: float | None = None) -> Drawn:
        told = scene.render.model_copy(update={"tolerance": tolerance} if tolerance else {})
        seeded = Setting(method, samples).scene(scene.model_copy(update={"render": told}), MINE)
        picture = pipeline.render(
            seeded, method=method, samples=samples, resolution=SIZE, meshes=_file, patterns=patterns
        )
        seconds = picture.seconds["total"] - sum(picture.seconds.get(stage, 0.0) for stage in APART)
        off = np.abs((picture.radiance - truth.mean).mean(axis=2)) / bright
        return Drawn(off[mask], np.array([seconds]))

    sampled = cache(lambda samples: draw("csg", samples))
    lines: list[Line] = []
    detail: dict[str, Any] = {"noise": _quantiles(noise), "passes": truth.count, "pixels": int(mask.sum())}
    for tolerance in TOLERANCES:

        def within(drawn: Drawn, tolerance: float = tolerance) -> float:
            return float(np.mean(drawn.off <= tolerance))

        turns = [
            {"auto": draw("auto", MOST, tolerance), "line": draw("line"), "area": draw("area", tolerance=tolerance)}
            for _ in range(RUNS + 1)
        ][1:]  # in the first memory is new
        rivals = {
            method: drawn._replace(runs=np.concatenate([turn[method].runs for turn in turns]))
            for method, drawn in turns[0].items()
        }
        auto = rivals.pop("auto")
        for samples in LADDER:
            rivals[f"csg {samples}"] = sampled(samples)
            if within(rivals[f"csg {samples}"]) >= SHARE:
                break
        keep = {method: drawn.seconds for method, drawn in rivals.items() if within(drawn) >= SHARE}
        line = at_least(f"at {tolerance:g}: within it", 100.0 * within(auto), 100.0 * SHARE, "%")
        if not line.met and float(np.mean(auto.off - 2.0 * noise <= tolerance)) >= SHARE:  # the noise may be all of it
            line = line._replace(what=f"{line.what}, at least: the reference tells no more", met=None)
        lines.append(line)
        lines.append(Line(f"at {tolerance:g}", auto.seconds, "s"))
        if keep:
            slowest = max(keep, key=lambda method: keep[method])
            ratios = auto.runs / rivals[slowest].runs
            ratio, error = float(ratios.mean()), float(ratios.std(ddof=1)) / math.sqrt(RUNS)
            what = f"at {tolerance:g}: its time over that of {slowest}, the slowest that keeps it"
            line = at_most(f"{what}, +- {error:.3f}", ratio, 1.0)
            lines.append(line._replace(met=ratio - 2.0 * error <= 1.0))
        else:
            lines.append(Line(f"at {tolerance:g}: the methods that keep it, up to {LADDER[-1]} samples", 0))
        detail[f"{tolerance:g}"] = {
            "auto": _told(auto, tolerance), "rivals": {name: _told(drawn, tolerance) for name, drawn in rivals.items()},
            "unresolved": float(np.mean(2.0 * noise > tolerance)),
        }  # fmt: skip
    return lines, detail


def _told(drawn: Drawn, tolerance: float) -> dict[str, Any]:
    return {"seconds": drawn.seconds, "within": float(np.mean(drawn.off <= tolerance)), "off": _quantiles(drawn.off)}


def _quantiles(values: Floats) -> dict[str, float]:
    return {f"{share:g}": float(np.quantile(values, share)) for share in (0.5, 0.9, 0.95, 0.99, 1.0)}


def white(scene: schema.Scene, patterns: PatternCache) -> Floats:
    """What a white matt surface turned to each light sends (H, W), at what a pixel's middle sees; NaN: no object."""
    compiled = compile_scene(scene, SIZE, patterns, _file)
    caster = Caster(compiled.objects, compiled.triangles)
    y, x = (at.ravel() + 0.5 for at in np.mgrid[0 : SIZE[1], 0 : SIZE[0]])
    directions = rays(compiled.camera, x, y)
    hits = caster.hits(compiled.camera.origin, directions)
    seen = hits["object"] >= 0
    points = compiled.camera.origin + np.where(seen, hits["t"], 0.0)[:, None] * directions
    total = np.full(len(points), float(np.sum(compiled.lighting.sky)))
    for light in compiled.lighting.lights:
        part = float(np.sum(light["color"])) / math.pi
        far = np.sum((light["vector"] - points) ** 2, axis=1)
        total += part if light["kind"] == DIRECTIONAL else part / np.maximum(far, 1e-300)
    return np.where(seen, total / 3.0, np.nan).reshape(SIZE[1], SIZE[0])


def _file(name: str) -> bytes:
    return (EXAMPLES / name).read_bytes()
