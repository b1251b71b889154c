"""The loop: rounds in which every setting is rendered once, and passes of the reference in between.

All that is kept lies in the folder `state`, a file a setting, each written whole after each render. So a run may end at
any moment, and the next one goes on from there.
"""

from __future__ import annotations

import hashlib
import json
import os
import time
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

import schema
from renderer import CACHE, pipeline
from renderer.compile import PatternCache
from renderer.errors import Cancelled, RenderError
from renderer.relief import Textures
from renderer.trace import Truth
from service import outputs
from service.chart.record import Record, load
from service.chart.settings import LADDERS, MINE, REFERENCE, REFERENCES, Setting

# How often a setting is rendered at most, by the seconds that it takes.
REPEATS = ((0.5, 7), (2.0, 5), (5.0, 3), (np.inf, 2))
DEAR = 0.08  # a setting that takes more of the budget than this is left out
ROUNDS = 0.4  # of the budget goes into rounds at most; the reference has the rest
PASS = 1 / 10  # of the budget is what one pass of the reference may take
PASSES = 4  # of the reference at least, however small the budget
MANY = 1000  # passes at most, however small the picture
SIZES = (
    16,
    36,
    64,
    144,
    256,
    576,
    1024,
    2304,
    4096,
)  # samples of a pass: the more, the better for the same time, as they are stratified
FORMAT = 2  # of what lies in the folder
TRIAL = 16  # pixels: width of the pictures that load the kernels


@dataclass(frozen=True)
class Plan:
    """What to measure and how long."""

    scene: schema.Scene
    resolution: tuple[int, int]
    settings: tuple[Setting, ...]
    budget: float  # seconds
    threads: int
    meshes: Callable[[str], bytes] | None = None
    passes: int | None = None  # of the reference; None: what the budget gives
    samples: int | None = None  # of a pass; None: what the budget gives

    @property
    def key(self) -> str:
        """Equal for runs that may go on from each other: the budget alone may differ."""
        parts = {
            "scene": self.scene.model_dump(mode="json"), "resolution": self.resolution, "threads": self.threads,
            "settings": [setting.name for setting in self.settings], "kernels": CACHE.name,
            "format": FORMAT, "passes": self.passes, "samples": self.samples, "meshes": self._meshes(),
        }  # fmt: skip
        return hashlib.sha256(json.dumps(parts, sort_keys=True).encode()).hexdigest()

    def _meshes(self) -> list[str]:
        names = sorted({name for _, name in schema.files(self.scene)})
        return [hashlib.sha256(self.meshes(name)).hexdigest() for name in names] if self.meshes else names


@dataclass
class State:
    """What has been measured. cannot: why a method, or one setting, renders nothing here; dear: settings left out, with
    the seconds that they would have taken."""

    records: dict[str, Record] = field(default_factory=dict)
    reference: Record = field(default_factory=lambda: Record(np.float64))
    method: str = ""  # of the reference; empty: none yet
    cannot: dict[str, str] = field(default_factory=dict)
    dear: dict[str, float] = field(default_factory=dict)
    inside: NDArray[np.bool_] | None = None  # (H, W) pixels that see an object, and whose neighbours do
    finished: bool = False
    load: float = 0.0  # processes on the machine when a run began, at the worst: what its seconds suffered from

    @property
    def spent(self) -> float:
        """Seconds."""
        return self.reference.wall + sum(record.wall for record in self.records.values())


def opened(plan: Plan, folder: Path) -> tuple[State, bool]:
    """What an earlier run of the same plan has left in `folder`; all else there is deleted. True: there was such else.

    OSError where the folder cannot be written.
    """
    folder.mkdir(parents=True, exist_ok=True)
    key = folder / "key"
    state = State()
    known = key.read_text() if key.exists() else None
    if known != plan.key:
        for path in (*folder.glob("*.npz"), *folder.glob("*.json"), *folder.glob("*.npy")):
            path.unlink()
        outputs.write(key, plan.key.encode())
        return state, known is not None
    for setting in plan.settings:
        record = load(folder / f"{setting.name}.npz")
        if record is not None:
            state.records[setting.name] = record
    state.reference = load(folder / "reference.npz") or state.reference
    notes = folder / "notes.json"
    if notes.exists():
        found = json.loads(notes.read_text())
        state.method, state.cannot, state.dear = found["method"], found["cannot"], found["dear"]
        state.finished, state.load = found["finished"], found["load"]
    if (folder / "inside.npy").exists():
        state.inside = np.load(folder / "inside.npy")
    return state, False


class Run:
    """One run of a plan."""

    def __init__(
        self, plan: Plan, folder: Path, state: State, stopped: Callable[[], bool],
        progress: Callable[[float], None] | None = None,
    ) -> None:  # fmt: skip
        self.plan, self.folder, self.state = plan, folder, state
        self._stopped, self._progress = stopped, progress
        self._patterns = PatternCache()
        self._solids: dict[str, Truth | Textures] = {}
        self._prepared: dict[tuple[str, int | None], float] = {}  # seconds, by method and texels

    def go(self) -> None:
        """To the budget's end. Cancelled where `stopped` says so, RenderError where nothing can be the reference."""
        self.state.finished = False
        self.state.load = max(self.state.load, os.getloadavg()[0])
        self._prepare()
        for turn in range(max(times for _, times in REPEATS)):
            if self._round(turn) and not self._converged():
                self._pass()
        while not self._converged():
            self._pass()
        self.state.finished = True
        self._note()

    def _prepare(self) -> None:
        """Load all kernels, and find out which methods cannot render the scene and which one can be the reference."""
        width, height = self.plan.resolution
        small = (min(TRIAL, width), max(1, min(TRIAL, width) * height // width))
        state = self.state
        state.cannot = {}
        faults: dict[str, RenderError] = {}
        names = dict.fromkeys([setting.method for setting in self.plan.settings] + list(REFERENCES))
        for name in names:
            setting = next((s for s in self.plan.settings if s.method == name), Setting(name, 1))
            try:
                self._render(setting, MINE, small)
            except RenderError as error:
                faults[name] = error
                state.cannot[name] = str(error)
        if not state.method:
            state.method = next((name for name in REFERENCES if name not in faults), "")
            if not state.method:
                raise faults[REFERENCES[0]]
        if state.inside is None:
            state.inside = inside(self._render(Setting("base"), MINE, self.plan.resolution))
            np.save(self.folder / "inside.npy", state.inside)
        self._note()

    def _round(self, turn: int) -> bool:
        """Every setting that wants one more, once: whether there was any."""
        rendered = False
        for setting in self.plan.settings:
            if not self._wants(setting, turn):
                continue
            record = self.state.records.get(setting.name) or Record()
            begin = time.perf_counter()
            try:
                picture = self._render(setting, MINE + turn, self.plan.resolution)
            except RenderError as error:
                self.state.cannot[setting.name] = str(error)
                continue
            wall, prepared = time.perf_counter() - begin, self._prepared[setting.method, setting.texels]
            record.add(picture, wall, prepared, keep=turn == 0 or sampled(setting))
            record.save(self.folder / f"{setting.name}.npz")
            self.state.records[setting.name] = record
            rendered = True
            self._tell()
        return rendered

    def _wants(self, setting: Setting, turn: int) -> bool:
        state = self.state
        if setting.method in state.cannot or setting.name in state.cannot:
            return False
        record = state.records.get(setting.name)
        if record is not None:
            most = next(times for seconds, times in REPEATS if record.median <= seconds)
            return len(record.seconds) == turn < most and state.spent < ROUNDS * self.plan.budget
        if turn > 0:
            return False
        expected = self._expected(setting)
        if expected > DEAR * self.plan.budget:
            state.dear[setting.name] = expected
            self._note()
            return False
        state.dear.pop(setting.name, None)
        return True

    def _expected(self, setting: Setting) -> float:
        """Seconds, from the setting of the same method that is nearest below; 0 where there is none."""
        below = [
            (other.samples, self.state.records[other.name])
            for other in self.plan.settings
            if other.method == setting.method and other.texels == setting.texels and other.samples
            and other.name in self.state.records and setting.samples and other.samples < setting.samples
        ]  # fmt: skip
        if not below or not setting.samples:
            return self._texture(setting)
        below.sort(key=lambda one: one[0])
        samples, record = below[-1]
        rate = record.median / samples
        if len(below) > 1:  # what a frame takes without any samples is not multiplied
            fewer, other = below[-2]
            rate = max((record.median - other.median) / (samples - fewer), 0.0)
        return record.median + rate * (setting.samples - samples)

    def _texture(self, setting: Setting) -> float:
        """Seconds to make the texture that a setting is the first to use, from the last smaller one; 0: not known."""
        smaller = [
            (size, seconds) for (method, size), seconds in self._prepared.items()
            if method == setting.method and size and setting.texels and size < setting.texels
        ]  # fmt: skip
        if not smaller or not setting.texels:
            return 0.0
        size, seconds = max(smaller)
        return seconds * (setting.texels / size) ** 2

    def _pass(self) -> None:
        """One more pass of the reference."""
        reference = self.state.reference
        begin = time.perf_counter()
        if not reference.samples:
            reference.samples = self.plan.samples or self._size()
        setting = Setting(self.state.method, reference.samples)
        picture = self._render(setting, REFERENCE + reference.count, self.plan.resolution)
        reference.add(picture, time.perf_counter() - begin)
        reference.save(self.folder / "reference.npz")
        self._tell()

    def _size(self) -> int:
        """Samples of a pass."""
        method = self.state.method
        known = [
            (setting.samples, self.state.records[setting.name].median)
            for setting in self.plan.settings
            if setting.method == method and setting.samples and setting.name in self.state.records
        ]
        if not known:
            begin = time.perf_counter()
            self._render(Setting(method, SIZES[0]), MINE, self.plan.resolution)
            known = [(SIZES[0], time.perf_counter() - begin)]
        samples, seconds = max(known)
        return max((size for size in SIZES if seconds * size / samples <= PASS * self.plan.budget), default=SIZES[0])

    def _converged(self) -> bool:
        reference, plan = self.state.reference, self.plan
        if reference.count >= (plan.passes or MANY):
            return True
        if plan.passes:
            return False
        one = reference.wall / max(reference.count, 1)
        return reference.count >= PASSES and self.state.spent + one > plan.budget

    def _render(self, setting: Setting, seed: int, resolution: tuple[int, int]) -> pipeline.Picture:
        if self._stopped():
            raise Cancelled
        picture = pipeline.render(
            setting.scene(self.plan.scene, seed), method=setting.method, samples=setting.samples,
            threads=self.plan.threads, resolution=resolution, cancelled=self._stopped, meshes=self.plan.meshes,
            patterns=self._patterns, solids=self._solids,
        )  # fmt: skip
        of = setting.method, setting.texels
        spent = picture.seconds.get("compile", 0.0) + picture.seconds.get("solids", 0.0)
        self._prepared[of] = max(self._prepared.get(of, 0.0), spent)  # all but the first find what that has made
        return picture

    def _tell(self) -> None:
        if self._progress is not None:
            self._progress(min(self.state.spent / self.plan.budget, 1.0))

    def _note(self) -> None:
        state = self.state
        names = ("method", "cannot", "dear", "finished", "load")
        notes = {name: getattr(state, name) for name in names}
        outputs.write(self.folder / "notes.json", json.dumps(notes).encode())


def sampled(setting: Setting) -> bool:
    """Whether the setting's pictures differ from seed to seed."""
    return bool(LADDERS.get(setting.method, ()))


def inside(picture: pipeline.Picture) -> NDArray[np.bool_]:
    """The pixels (H, W) that see nothing but an object, and whose neighbours do so too."""
    seen = picture.aovs["method"] != 0
    padded = np.pad(seen, 1)  # what lies beyond the picture's edge is not known to be inside
    height, width = seen.shape
    shifted = [padded[y : y + height, x : x + width] for y in range(3) for x in range(3)]
    return np.asarray(np.all(shifted, axis=0))
