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
def scene() -> dict[str, Any]:
    return {
        "intaglio": 1,
        "camera": {"origin": [0, -3, 2], "target": [0, 0, 0], "fov": 40, "resolution": [16, 12]},
        "lights": [{"type": "directional", "direction": [-1, 0, -1], "irradiance": [3, 3, 3]}],
        "materials": {"stone": {"base_color": [0.7, 0.7, 0.7], "roughness": 1, "specular": 0}},
        "patterns": {
            "tiles": {
                "grooves": [
                    {
                        "path": {"type": "polyline", "points": [[0.25, -1], [0.25, 5]]},
                        "profile": {"type": "v", "width": 0.16, "depth": 0.08},
                    }
                ]
            }
        },
        "objects": [{"shape": {"type": "rectangle", "size": [4, 4]}, "material": "stone", "pattern": "tiles"}],
    }


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
