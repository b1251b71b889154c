"""What renders of one setting leave: moments, the first picture, seconds. A file each, whole or not at all."""

from __future__ import annotations

import io
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from renderer.pipeline import Picture
from service import outputs

Floats = NDArray[np.float64]

APART = ("kernels", "compile", "solids")  # stages that are no part of a frame: they are done once


@dataclass
class Record:
    """Pictures of one setting or of the reference, each with another seed.

    mean, squares (H, W, 3): Welford's mean and sum of squared deviations. Kept in `kind`, on disk and here alike, so
    that a run that was stopped goes on with the very same numbers.
    """

    kind: type[np.float32] | type[np.float64] = np.float32
    count: int = 0
    mean: Floats = field(default_factory=lambda: np.zeros((0, 0, 3)))
    squares: Floats = field(default_factory=lambda: np.zeros((0, 0, 3)))
    first: NDArray[np.float32] = field(default_factory=lambda: np.zeros((0, 0, 3), np.float32))
    seconds: list[float] = field(default_factory=list)  # of each frame
    prepare: float = 0.0  # seconds of what is done once: patterns, meshes, textures
    wall: float = 0.0  # of all that was done for it
    bytes: int = 0  # of the representation
    samples: int = 0  # of a pass; for the reference

    def add(self, picture: Picture, wall: float, prepare: float = 0.0, keep: bool = True) -> None:
        """One more render; keep: False where its picture is the same as the last one's."""
        total = picture.seconds["total"]
        self.seconds.append(total - sum(picture.seconds.get(stage, 0.0) for stage in APART))
        self.prepare = max(self.prepare, prepare)
        self.wall += wall
        self.bytes = picture.solid_bytes or picture.pattern_bytes
        if not keep:
            return
        image = picture.radiance.astype(np.float64)
        if self.count == 0:
            self.first = picture.radiance
            self.mean, self.squares = np.zeros_like(image), np.zeros_like(image)
        self.count += 1
        before = image - self.mean
        mean = self.mean + before / self.count
        self.squares = (self.squares + before * (image - mean)).astype(self.kind).astype(np.float64)
        self.mean = mean.astype(self.kind).astype(np.float64)

    @property
    def variance(self) -> Floats:
        """The unbiased variance (H, W, 3) of one picture; 0 where there is but one."""
        return self.squares / max(self.count - 1, 1)

    @property
    def median(self) -> float:
        """Seconds of a frame."""
        return float(np.median(self.seconds))

    def save(self, path: Path) -> None:
        """OSError where it cannot be written."""
        text = io.BytesIO()
        np.savez(
            text, mean=self.mean.astype(self.kind), squares=self.squares.astype(self.kind), first=self.first,
            seconds=self.seconds, whole=np.array([self.count, self.bytes, self.samples]),
            spent=np.array([self.wall, self.prepare]),
        )  # fmt: skip
        outputs.write(path, text.getvalue())


def load(path: Path) -> Record | None:
    """What `save` wrote; None where there is nothing that can be read."""
    try:
        with np.load(path) as file:
            parts: Mapping[str, NDArray[np.float64]] = dict(file)
        count, size, samples = (int(number) for number in parts["whole"])
        wall, prepare = (float(number) for number in parts["spent"])
        return Record(
            np.float64 if parts["mean"].dtype == np.float64 else np.float32,
            count, parts["mean"].astype(np.float64), parts["squares"].astype(np.float64),
            parts["first"].astype(np.float32), list(map(float, parts["seconds"])), prepare, wall, size, samples,
        )  # fmt: skip
    except (OSError, ValueError, KeyError):
        return None
