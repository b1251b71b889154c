"""What a chart renders: methods, each at several settings."""

from __future__ import annotations

from collections.abc import Iterable
from typing import NamedTuple

import schema
from renderer import pipeline

REFERENCES = ("geometry", "csg")  # what may serve as the reference, the better one first
LADDERS = {
    "base": (), "segment": (), "line": (), "area": (), "auto": (), "lines": (2, 8, 32),
    "csg": (1, 4, 16, 64, 256), "geometry": (4, 16, 64, 256, 1024), "relief": (1, 4, 16),
}  # fmt: skip
TOLERANCES = (0.03, 0.01, 0.003, 0.001)  # of method `auto`
TEXELS = (256, 512, 1024, 2048)  # of method `relief`
MINE = 1  # the seed of a setting's first picture; the next ones follow
REFERENCE = 1001  # the seed of the reference's first pass: never one of the methods', whose samples it would repeat


class Setting(NamedTuple):
    """One method with its parameters; samples, texels, tolerance: None where it has none."""

    method: str
    samples: int | None = None
    texels: int | None = None
    tolerance: float | None = None

    @property
    def name(self) -> str:
        """Unique in a chart, and fit for a file's name."""
        parts = (self.method, self.texels and f"{self.texels}t", self.samples and f"{self.samples}",
                 self.tolerance and f"{self.tolerance:g}")  # fmt: skip
        return "-".join(part for part in parts if part)

    @property
    def label(self) -> str:
        """What stands beside its point."""
        return "/".join(str(part) for part in (self.texels, self.samples, self.tolerance) if part)

    def scene(self, scene: schema.Scene, seed: int) -> schema.Scene:
        """The scene with this method's own settings and another seed for its samples."""
        render: dict[str, float] = {"seed": seed}
        render |= {"texels": self.texels} if self.texels else {}
        render |= {"tolerance": self.tolerance} if self.tolerance else {}
        return scene.model_copy(update={"render": scene.render.model_copy(update=render)})


def methods() -> list[str]:
    """The names of the methods that a chart knows, the deterministic ones first."""
    return sorted(pipeline.METHODS, key=lambda name: (bool(LADDERS.get(name, ())), list(pipeline.METHODS).index(name)))


def ladder(names: Iterable[str], most: int = 1024) -> tuple[Setting, ...]:
    """The settings of the methods, cheap before expensive; none with more than `most` samples, or texels for them."""
    found: list[Setting] = []
    for name in names:
        if name == "auto":
            found += [Setting(name, tolerance=tolerance) for tolerance in TOLERANCES]
            continue
        texels = TEXELS if name == "relief" else (None,)
        found += [
            Setting(name, samples, size)
            for size in texels
            if size is None or size <= 8 * most
            for samples in LADDERS.get(name, ()) or (None,)
            if samples is None or samples <= most
        ]
    return tuple(found)
