"""`intaglio chart`."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

from .conftest import Command

ROOT = Path(__file__).resolve().parents[2]
OPTIONS = ("--methods", "line,csg", "--resolution", "24x18", "--threads", "2")
FILES = ["chart.json", "chart.png", "contact.png", "state"]


def test_a_chart_that_is_stopped_leaves_what_it_has_and_goes_on(intaglio: Command, scene_file: Path) -> None:
    folder = scene_file.parent / "out"
    command = [sys.executable, "-m", "service.cli", "chart", str(scene_file), "-o", str(folder), *OPTIONS]
    process = subprocess.Popen(
        [*command, "--budget", "1000"], stderr=subprocess.PIPE, env={**os.environ, "PYTHONPATH": str(ROOT)}
    )
    deadline = time.monotonic() + 200
    while not (folder / "state" / "reference.npz").exists():
        assert time.monotonic() < deadline
        assert process.poll() is None, process.communicate()
        time.sleep(0.05)
    process.send_signal(signal.SIGINT)
    _, told = process.communicate(timeout=60)
    assert process.returncode == 130, told
    assert told.endswith(b"out has what was measured; the same command goes on\n")
    assert sorted(os.listdir(folder)) == FILES
    stopped = json.loads((folder / "chart.json").read_text())
    assert stopped["state"] == "stopped"

    done = intaglio("chart", scene_file, "-o", folder, *OPTIONS, "--budget", "1", "--json")
    assert done.returncode == 0, done.stderr
    assert b"anew" not in done.stderr
    complete = json.loads(done.stdout)
    assert complete == json.loads((folder / "chart.json").read_text())
    assert complete["state"] == "complete"
    assert complete["scene"] == "scene.json"
    assert complete["reference"]["passes"] >= max(stopped["reference"]["passes"], 4)
    for before, after in zip(stopped["rows"], complete["rows"], strict=True):
        runs = before.get("runs", [])
        assert after["runs"][: len(runs)] == runs


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (("-o", "scene.json"), b"scene.json: expected a folder, found a file"),
        (("-o", "missing/out"), b"expected a folder, or a place for one"),
        (("-o", "out", "--methods", "line,best"), b"--methods: expected one of auto, "),
        (("-o", "out", "--budget", "0"), b"--budget"),
    ],
)
def test_usage(intaglio: Command, scene_file: Path, arguments: tuple[str, ...], words: bytes) -> None:
    done = intaglio("chart", scene_file, *arguments)
    assert (done.returncode, done.stdout) == (2, b"")
    assert words in done.stderr
    assert os.listdir(scene_file.parent) == ["scene.json"]
