"""From the command line to the picture: with kernels compiled before, and with none."""

from __future__ import annotations

import os
import subprocess
import sys
import tempfile
import time
from pathlib import Path
from typing import Any

import numpy as np

from bench.report import Line, at_most
from bench.scenes import EXAMPLES

RUNS = 5
COMMAND = [sys.executable, "-m", "service.cli", "render", str(EXAMPLES / "parallel.json"), "--resolution", "160x120"]


def measure() -> tuple[list[Line], dict[str, Any]]:
    """Whole processes."""
    with tempfile.TemporaryDirectory() as folder:
        cold = _run(Path(folder), {"XDG_CACHE_HOME": folder})
        warm = [_run(Path(folder), {"XDG_CACHE_HOME": folder}) for _ in range(RUNS)]
    return [
        at_most("start: intaglio render, kernels compiled", float(np.median(warm)), 3, "s"),
        at_most("start: intaglio render, an empty cache", cold, 60, "s"),
    ], {"warm": warm, "cold": cold}


def _run(folder: Path, environment: dict[str, str]) -> float:
    begin = time.perf_counter()
    subprocess.run(
        [*COMMAND, "-o", str(folder / "out.png")], env=os.environ | environment, check=True, capture_output=True,
        cwd=EXAMPLES.parent,
    )  # fmt: skip
    return time.perf_counter() - begin
