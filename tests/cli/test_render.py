"""`intaglio render`."""

from __future__ import annotations

import json
import os
import pty
import signal
import subprocess
import sys
import time
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from PIL import Image

from .conftest import Command

ROOT = Path(__file__).resolve().parents[2]

# A renderer that takes a minute, and looks up or not when it is told to stop.
SLOW = """
import time
from renderer import pipeline
from renderer.errors import Cancelled

def render(scene, *, cancelled, progress, **options):
    (Path() / "started").touch()
    for step in range(6000):
        if DEAF is False and cancelled():
            raise Cancelled
        if progress:
            progress(step / 6000)
        time.sleep(0.01)

pipeline.render = render
pipeline.kernels_compiled = lambda: KERNELS
from service.cli import main
main()
"""


def start_slow(folder: Path, *, deaf: bool = False, kernels: bool = True, stderr: int = subprocess.PIPE) -> Any:
    code = f"from pathlib import Path\nDEAF, KERNELS = {deaf}, {kernels}\n{SLOW}"
    process = subprocess.Popen(
        [sys.executable, "-c", code, "render", "scene.json", "-o", "out.png", "--aov", "method=method.png"],
        cwd=folder,
        stdout=subprocess.PIPE,
        stderr=stderr,
        env={**os.environ, "PYTHONPATH": str(ROOT), "TERM": "xterm"},
    )
    deadline = time.monotonic() + 60
    while not (folder / "started").exists():
        assert time.monotonic() < deadline
        assert process.poll() is None, process.communicate()
        time.sleep(0.02)
    return process


@pytest.mark.parametrize("suffix", [".png", ".exr", ".npy"])
def test_picture(intaglio: Command, scene_file: Path, suffix: str) -> None:
    out = scene_file.parent / f"out{suffix}"
    done = intaglio("render", scene_file, "-o", out)
    assert (done.returncode, done.stdout) == (0, b""), done.stderr
    if suffix == ".npy":
        picture = np.load(out)
        assert picture.shape == (12, 16, 3)
        assert picture.dtype == np.float32
        assert np.isfinite(picture).all()
        assert picture.max() > 0
    elif suffix == ".png":
        with Image.open(out) as image:
            assert (image.size, image.mode) == ((16, 12), "RGB")
    else:
        assert out.read_bytes().startswith(b"\x76\x2f\x31\x01")
    assert sorted(os.listdir(out.parent)) == sorted([out.name, "scene.json"])


def test_options(intaglio: Command, scene_file: Path) -> None:
    options = ("--method", "csg", "--samples", "4", "--threads", "1", "--resolution", "20x10", "--json")
    aovs = ("--aov", "method=method.npy", "--aov", "method=method.png")
    done = intaglio("render", "-", "-o", "out.npy", *options, *aovs, stdin=scene_file.read_bytes())
    assert done.returncode == 0, done.stderr
    folder = scene_file.parent
    assert np.load(folder / "out.npy").shape == (10, 20, 3)
    assert np.load(folder / "method.npy").shape[:2] == (10, 20)
    with Image.open(folder / "method.png") as image:
        assert image.size == (20, 10)
    told = json.loads(done.stdout)
    assert told["resolution"] == [20, 10]
    assert told["kernel_seconds"] >= 0
    assert told["seconds"]["total"] > 0
    assert "kernels" not in told["seconds"]
    assert told["pattern_bytes"] > 0
    assert sum(told["shares"].values()) == pytest.approx(1)
    assert told["warnings"] == []


def test_problems(intaglio: Command, scene: dict[str, Any], tmp_path: Path) -> None:
    scene["objects"][0]["material"] = "wood"
    done = intaglio("render", "-", "-o", "out.png", stdin=json.dumps(scene).encode())
    assert (done.returncode, done.stdout) == (1, b"")
    assert done.stderr.startswith(b"/objects/0/material: expected ")
    assert os.listdir(tmp_path) == []


def test_missing_mesh(intaglio: Command, scene: dict[str, Any]) -> None:
    scene["objects"][0]["shape"] = {"type": "mesh", "file": "missing.obj"}
    done = intaglio("render", "-", "-o", "out.png", stdin=json.dumps(scene).encode())
    assert done.returncode == 1
    assert done.stderr.startswith(b"/objects/0/shape/file: expected a file that can be read, found missing.obj: ")


def test_mesh_beside_the_scene(intaglio: Command, scene: dict[str, Any], tmp_path: Path) -> None:
    folder = tmp_path / "folder"
    folder.mkdir()
    (folder / "triangle.obj").write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\nf 1/1 2/2 3/3\n")
    scene["objects"][0]["shape"] = {"type": "mesh", "file": "triangle.obj"}
    (folder / "scene.json").write_text(json.dumps(scene))
    done = intaglio("render", "folder/scene.json", "-o", "out.png")
    assert done.returncode == 0, done.stderr


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (("-o", "out.jpg"), b"out.jpg: expected a name that ends in .png, .exr, .npy, found .jpg"),
        (("-o", "missing/out.png"), b"expected an existing folder"),
        (("-o", "out.png", "--aov", "depth=a.png"), b"--aov: expected NAME=OUT with NAME one of method"),
        (("-o", "out.png", "--aov", "method"), b"--aov: expected NAME=OUT"),
        (("-o", "out.png", "--aov", "method=a.gif"), b"a.gif: expected a name that ends in"),
        (("-o", "out.png", "--method", "best"), b"--method: expected one of auto, "),
        (("-o", "out.png", "--resolution", "640"), b"--resolution: expected WxH"),
        (("-o", "out.png", "--resolution", "0x10"), b"--resolution: expected WxH"),
        (("-o", "out.png", "--resolution", "99999x99999"), b"--resolution: expected WxH"),
        (("-o", "out.png", "--samples", "0"), b"--samples"),
        (("-o", "out.png", "--texels", "8193"), b"--texels"),
        (("-o", "out.png", "--threads", "no"), b"--threads"),
        ((), b"--out"),
        (("-o", "out.png", "--colour"), b"--colour"),
    ],
)
def test_usage(intaglio: Command, scene_file: Path, arguments: tuple[str, ...], words: bytes) -> None:
    done = intaglio("render", scene_file, *arguments)
    assert (done.returncode, done.stdout) == (2, b"")
    assert words in done.stderr
    assert os.listdir(scene_file.parent) == ["scene.json"]


@pytest.mark.parametrize("deaf", [False, True])
@pytest.mark.parametrize(("number", "code"), [(signal.SIGINT, 130), (signal.SIGTERM, 143)])
def test_stopping_leaves_no_file(scene_file: Path, deaf: bool, number: signal.Signals, code: int) -> None:
    process = start_slow(scene_file.parent, deaf=deaf)
    process.send_signal(number)
    start = time.monotonic()
    _, told = process.communicate(timeout=30)
    assert time.monotonic() - start < 5
    assert process.returncode == code
    assert told == b"stopped: no picture was written\n"
    assert sorted(os.listdir(scene_file.parent)) == ["scene.json", "started"]


def test_stopping_leaves_the_old_picture(scene_file: Path) -> None:
    (scene_file.parent / "out.png").write_bytes(b"old")
    process = start_slow(scene_file.parent)
    process.send_signal(signal.SIGINT)
    process.communicate(timeout=30)
    assert process.returncode == 130
    assert (scene_file.parent / "out.png").read_bytes() == b"old"


def test_first_start_says_what_it_waits_for(scene_file: Path) -> None:
    process = start_slow(scene_file.parent, kernels=False)
    process.send_signal(signal.SIGINT)
    _, told = process.communicate(timeout=30)
    assert told.startswith(b"compiling the kernels, once after an install: about a minute and a half\n")


def test_progress_bar_on_a_terminal(scene_file: Path) -> None:
    ours, theirs = pty.openpty()
    process = start_slow(scene_file.parent, stderr=theirs)
    os.close(theirs)
    seen = b""
    while b"rendering" not in seen:
        seen += os.read(ours, 1000)
    process.send_signal(signal.SIGINT)
    process.communicate(timeout=30)
    assert process.returncode == 130
    os.close(ours)
