"""Small charts for the service: bounded in pixels, samples and seconds, in a folder that is deleted."""

from __future__ import annotations

import tempfile
import time
from collections.abc import Callable
from dataclasses import dataclass
from http import HTTPStatus
from pathlib import Path

import schema
from renderer import pipeline
from renderer.errors import Cancelled, RenderError
from service import pictures
from service.problems import ProblemError, scene_error
from service.settings import Settings
from service.store import MeshStore

FILES = {"image/png": "chart.png", "application/json": "chart.json"}
WIDTH = 64  # pixels, where the request does not say
SAMPLES = 64  # of a setting, at most
LATE = 3.0  # what is measured within so many times the seconds asked for is what there is


@dataclass(frozen=True)
class ChartWish:
    """What a request asks for beside the scene. seconds: None: as many as the service gives."""

    media: str  # one of FILES
    methods: list[str] | None
    resolution: tuple[int, int] | None
    seconds: float | None


def size(scene: schema.Scene, wish: ChartWish, settings: Settings) -> tuple[int, int]:
    """The pixels of the chart's pictures: what was asked for, or the camera's made small."""
    width, height = wish.resolution or scene.camera.resolution
    if wish.resolution is None:
        factor = min(WIDTH / width, (settings.chart_pixels / (width * height)) ** 0.5, 1.0)
        width, height = max(1, int(width * factor)), max(1, int(height * factor))
    if width * height > settings.chart_pixels:
        limit = f"at most {settings.chart_pixels} pixels"
        raise ProblemError(
            HTTPStatus.UNPROCESSABLE_ENTITY,
            f"The chart is too large for this service: {limit}.",
            [schema.Problem("/camera/resolution", limit, str(width * height))],
        )
    return width, height


def draw(
    scene: schema.Scene, wish: ChartWish, settings: Settings, meshes: MeshStore, stopped: Callable[[], bool]
) -> bytes:
    """The chart as a file of the wished kind."""
    from service.chart import make  # matplotlib is slow to load, and few requests need it
    from service.chart.report import results

    pipeline.warm_up(geometry=True, textures=wish.methods is None or "relief" in wish.methods)
    seconds = min(wish.seconds or settings.chart_seconds, settings.chart_seconds)
    plan = make.plan(
        scene, budget=seconds, resolution=size(scene, wish, settings), names=wish.methods, threads=settings.threads,
        meshes=pictures.reader(meshes), most=SAMPLES,
    )  # fmt: skip
    end = time.monotonic() + LATE * seconds
    with tempfile.TemporaryDirectory(prefix="intaglio-") as name:
        folder = Path(name)
        try:
            state = make.measure(plan, folder, lambda: stopped() or time.monotonic() > end)
        except Cancelled:
            left = make.left(plan, folder)
            if left is None or stopped():
                raise
            state = left
        except RenderError as error:
            raise scene_error(error.faults) from None
    return make.files(results(plan, state), "scene", [FILES[wish.media]])[FILES[wish.media]]
