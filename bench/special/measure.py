"""`python -m bench special`: all of it."""

from __future__ import annotations

from typing import Any

from bench.report import Line
from bench.special import accuracy, many, peer, promise


def measure() -> tuple[list[Line], dict[str, Any]]:
    """Accuracy, the foreign peer, the promise of `auto`, and very many scratches."""
    lines: list[Line] = []
    details: dict[str, Any] = {}
    for part in (accuracy, peer, promise, many):
        found, detail = part.measure()
        lines += found
        details[part.__name__.split(".")[-1]] = detail
    return lines, details
