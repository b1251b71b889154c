"""Converged references: passes with other seeds until their mean is as good as wanted. Kept from run to run.

They are kept in bench/out under the hash of all that a right picture depends on: the scene without its render settings,
the resolution, and how it was sampled. `service.chart.measure` takes the noise that is left out of errors.
"""

from __future__ import annotations

import hashlib
import json
import time
from collections.abc import Callable
from pathlib import Path

import numpy as np

import schema
from renderer import pipeline
from renderer.compile import PatternCache
from renderer.relief import Textures
from renderer.trace import Truth
from service.chart import measure
from service.chart.record import Record, load
from service.chart.settings import REFERENCE, Setting

FOLDER = Path(__file__).resolve().parents[1] / "out" / "references"
ENOUGH = 1e-4  # RMSE of a reference
LEAST, MOST = 3, 12  # passes
TILE = 8  # small, so that a small picture has work for all threads

Mask = measure.Mask


def reference(
    scene: schema.Scene, method: str, resolution: tuple[int, int], samples: int,
    passes: tuple[int, int] = (LEAST, MOST), enough: float = ENOUGH, meshes: Callable[[str], bytes] | None = None,
) -> Record:  # fmt: skip
    """Passes of `samples` a pixel by a method: see `converged`."""
    patterns = PatternCache()
    solids: dict[str, Truth | Textures] = {}

    def draw(seed: int) -> pipeline.Picture:
        return pipeline.render(
            Setting(method, samples).scene(scene, seed), method=method, samples=samples, resolution=resolution,
            meshes=meshes, patterns=patterns, solids=solids, tile=TILE,
        )  # fmt: skip

    return converged(scene, f"{method} {samples} {resolution}", draw, passes, enough)


def converged(
    scene: schema.Scene, how: str, draw: Callable[[int], pipeline.Picture], passes: tuple[int, int] = (LEAST, MOST),
    enough: float = ENOUGH,
) -> Record:  # fmt: skip
    """At least the first number of `passes`, and until their mean's noise over all pixels is `enough`, at most the
    second. how: what else than the scene a pass depends on."""
    told = scene.model_dump(mode="json", exclude={"render"})
    told["camera"].pop("resolution")
    key = json.dumps([told, how, passes, enough], sort_keys=True)
    path = FOLDER / f"{hashlib.sha256(key.encode()).hexdigest()[:24]}.npz"
    known = load(path)
    if known is not None:
        return known
    record = Record(np.float64)
    while record.count < passes[1]:
        if record.count >= max(passes[0], 2):
            everywhere = np.ones(record.mean.shape[:2], np.bool_)
            if measure.noise(record, everywhere) <= enough:
                break
        begin = time.perf_counter()
        record.add(draw(REFERENCE + record.count), 0.0)
        record.wall += time.perf_counter() - begin
    print(f"    a reference of {record.count} passes: {how}, {record.wall:.0f} s", flush=True)
    FOLDER.mkdir(parents=True, exist_ok=True)
    record.save(path)
    return record
