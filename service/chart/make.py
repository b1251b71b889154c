"""A chart from end to end: what the command line, the service and the measurements call."""

from __future__ import annotations

import json
import os
from collections.abc import Callable, Sequence
from pathlib import Path

import schema
from service import outputs
from service.chart import draw
from service.chart.report import Results, document, results
from service.chart.run import Plan, Run, State, opened
from service.chart.settings import ladder, methods

FILES = ("chart.json", "chart.png", "contact.png")
WIDTH = 320  # pixels of a chart's pictures, where not given


def plan(
    scene: schema.Scene,
    *,
    budget: float,
    resolution: tuple[int, int] | None = None,
    names: Sequence[str] | None = None,
    threads: int | None = None,
    meshes: Callable[[str], bytes] | None = None,
    most: int = 1024,
) -> Plan:
    """The plan of a chart; names: of the methods, all otherwise. most: samples of a setting."""
    width, height = scene.camera.resolution
    size = resolution or (min(WIDTH, width), max(1, round(height * min(WIDTH, width) / width)))
    return Plan(scene, size, ladder(names or methods(), most), budget, threads or os.cpu_count() or 1, meshes)


def measure(
    plan: Plan, folder: Path, stopped: Callable[[], bool], progress: Callable[[float], None] | None = None,
    say: Callable[[str], None] | None = None,
) -> State:  # fmt: skip
    """Measure into the folder `state` of `folder`, from where an earlier run has left it.

    Raises Cancelled where `stopped` says so, RenderError where no method can be the reference, OSError.
    """
    state, other = opened(plan, folder / "state")
    if other and say is not None:
        say(f"{folder}: another scene, other settings or another version was measured here: beginning anew")
    Run(plan, folder / "state", state, stopped, progress).go()
    return state


def left(plan: Plan, folder: Path) -> State | None:
    """What has been measured so far; None: nothing."""
    state, _ = opened(plan, folder / "state")
    return state if state.records else None


def files(found: Results, title: str, names: Sequence[str] = FILES) -> dict[str, bytes]:
    """The results by file name."""

    def text() -> bytes:
        told = {"scene": title} | document(found)
        return (json.dumps(told, indent=2, ensure_ascii=False, allow_nan=False) + "\n").encode()

    drawn: dict[str, Callable[[], bytes]] = {
        "chart.json": text,
        "chart.png": lambda: draw.chart(found, title),
        "contact.png": lambda: draw.contact(found),
    }
    return {name: drawn[name]() for name in names}


def write(plan: Plan, state: State, folder: Path, title: str) -> Results:
    """Evaluate, draw and write; OSError where that fails."""
    found = results(plan, state)
    for name, data in files(found, title).items():
        outputs.write(folder / name, data)
    return found
