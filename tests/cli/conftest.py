"""A tiny scene in a file, and the command in a process of its own."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from pathlib import Path
from typing import Any, Protocol

import pytest


class Command(Protocol):
    def __call__(self, *arguments: str | Path, stdin: bytes | None = None) -> subprocess.CompletedProcess[bytes]: ...


@pytest.fixture
def scene_file(tmp_path: Path, scene: dict[str, Any]) -> Path:
    path = tmp_path / "scene.json"
    path.write_text(json.dumps(scene))
    return path


@pytest.fixture
def intaglio(tmp_path: Path) -> Command:
    """Runs the command in the scene's folder; none of its output may ever be a traceback."""

    def run(*arguments: str | Path, stdin: bytes | None = None) -> subprocess.CompletedProcess[bytes]:
        command = [sys.executable, "-m", "service.cli", *map(str, arguments)]
        root = Path(__file__).resolve().parents[2]
        environment = {**os.environ, "PYTHONPATH": str(root)}
        done = subprocess.run(
            command, cwd=tmp_path, input=stdin, capture_output=True, timeout=300, env=environment, check=False
        )
        assert b"Traceback" not in done.stderr, done.stderr.decode()
        return done

    return run
