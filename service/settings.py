"""The service's settings: one environment variable each, `INTAGLIO_` and the field's name in capitals."""

from __future__ import annotations

import os
from collections.abc import Mapping
from dataclasses import dataclass, fields
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
MIB = 1 << 20


@dataclass(frozen=True)
class Settings:
    """Limits are inclusive; a size is in bytes, a time in seconds."""

    host: str = "127.0.0.1"  # where the service listens; on a loopback address, foreign Host headers are refused
    hosts: tuple[str, ...] = ()  # further names that a Host header may have, comma-separated
    origins: tuple[str, ...] = ()  # foreign origins whose pages may post, as in https://example.org, comma-separated
    page: Path = ROOT / "web" / "dist"  # the built page
    examples: Path = ROOT / "examples"
    body_limit: int = 8 * MIB  # of a scene or a pattern
    mesh_limit: int = 64 * MIB  # of one uploaded mesh or envmap
    mesh_store: int = 512 * MIB  # of all uploads; the oldest go first
    renders: int = 2  # renders at the same time
    queue: int = 8  # renders that wait; one more is refused with 503
    threads: int = max(1, (os.cpu_count() or 2) // 2)  # of one render
    pixel_limit: int = 1 << 24  # of one picture
    sample_limit: int = 1 << 30  # pixels times samples of one picture, where the method takes `samples`
    triangle_limit: int = 1 << 19  # of an exported solid
    texel_limit: int = 1 << 22  # of an exported map
    time_limit: float = 300.0  # of one render, from its start
    chart_pixels: int = 96 * 72  # of a chart's pictures
    chart_seconds: float = 20.0  # of a chart's renders
    warm_up: bool = True  # load or compile the kernels at the start

    @classmethod
    def from_environment(cls, environment: Mapping[str, str] = os.environ) -> Settings:
        """The settings; a value that cannot be read is a ValueError that names the variable."""
        values: dict[str, object] = {}
        for field in fields(cls):
            name = f"INTAGLIO_{field.name.upper()}"
            if name in environment:
                values[field.name] = _read(name, environment[name], getattr(cls, field.name))
        return cls(**values)  # type: ignore[arg-type]


def _read(name: str, text: str, default: object) -> object:
    """`text` as a value of the default's type."""
    if isinstance(default, bool):
        if text.lower() not in ("0", "1", "false", "true"):
            raise ValueError(f"{name}: expected 0 or 1, found {text!r}")
        return text.lower() in ("1", "true")
    if isinstance(default, int | float):
        least = 0 if name == "INTAGLIO_QUEUE" else 1
        try:
            number = int(text) if isinstance(default, int) else float(text)
        except ValueError:
            raise ValueError(f"{name}: expected a number, found {text!r}") from None
        if not least <= number < float("inf"):
            raise ValueError(f"{name}: expected at least {least}, found {text!r}")
        return number
    if isinstance(default, tuple):
        return tuple(part.strip() for part in text.split(",") if part.strip())
    if isinstance(default, Path):
        return Path(text)
    return text
