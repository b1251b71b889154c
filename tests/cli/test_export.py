"""`intaglio export`."""

from __future__ import annotations

import json
import os
from pathlib import Path
from typing import Any

import pytest
from PIL import Image

from .conftest import Command


def test_solid_and_map(intaglio: Command, scene_file: Path) -> None:
    done = intaglio("export", scene_file, "-o", "out.stl", "--thickness", "0.5", "--json")
    assert done.returncode == 0, done.stderr
    told = json.loads(done.stdout)
    assert told["triangles"] > 0
    assert told["volume"] > 0
    assert (scene_file.parent / "out.stl").stat().st_size == 84 + 50 * told["triangles"] == told["bytes"]
    done = intaglio("export", scene_file, "-o", "out.png", "--map", "height", "--size", "32x16", "--json")
    assert done.returncode == 0, done.stderr
    told = json.loads(done.stdout)
    assert told["low"] < told["high"]
    with Image.open(scene_file.parent / "out.png") as image:
        assert image.size == (32, 16)
        assert float(image.text["low"]) == told["low"]  # type: ignore[attr-defined]


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (("-o", "out.jpg"), b"expected a name that ends in .glb, .stl, .ply, .obj, .png, .exr"),
        (("-o", "out.png"), b"--map: expected one of height, normal, anisotropy"),
        (("-o", "out.glb", "--map", "height"), b"expected a name that ends in .png, .exr"),
        (("-o", "out.png", "--map", "depth"), b"--map: expected one of height"),
        (("-o", "out.png", "--map", "height", "--size", "0"), b"--size: expected N or WxH"),
        (("-o", "out.png", "--map", "height", "--thickness", "1"), b"--thickness"),
        (("-o", "out.stl", "--size", "8"), b"--size"),
        (("-o", "out.stl", "--object", "7"), b"--object: expected the number of an object, one of 0 ("),
        (("-o", "missing/out.stl"), b"expected an existing folder"),
    ],
)
def test_usage(intaglio: Command, scene_file: Path, arguments: tuple[str, ...], words: bytes) -> None:
    done = intaglio("export", scene_file, *arguments)
    assert (done.returncode, done.stdout) == (2, b"")
    assert words in done.stderr
    assert os.listdir(scene_file.parent) == ["scene.json"]


def test_no_solid(intaglio: Command, scene: dict[str, Any], tmp_path: Path) -> None:
    (tmp_path / "scene.json").write_text(json.dumps(scene))
    done = intaglio("export", "scene.json", "-o", "out.stl", "--thickness", "1e-9")
    assert done.returncode == 1
    assert done.stderr.startswith(b"/objects/0: expected an object with a closed solid, found a thickness")
    assert os.listdir(tmp_path) == ["scene.json"]
