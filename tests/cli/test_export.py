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


def test_mesh(intaglio: Command, scene: dict[str, Any], tmp_path: Path) -> None:
    """A square as a mesh is a sheet, of the thickness that is asked for; of a tetrahedron there is none to ask for."""
    square = "v 0 0 0\nv 4 0 0\nv 4 4 0\nv 0 4 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nf 1/1 2/2 3/3\nf 1/1 3/3 4/4\n"
    (tmp_path / "square.obj").write_text(square)
    solid = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nvt 0 0\nvt 1 0\nvt 0 1\n" + "".join(
        f"f {a}/1 {b}/2 {c}/3\n" for a, b, c in ((1, 3, 2), (1, 2, 4), (1, 4, 3), (2, 3, 4))
    )
    (tmp_path / "solid.obj").write_text(solid)
    path = tmp_path / "scene.json"
    scene["objects"][0] |= {"shape": {"type": "mesh", "file": "square.obj"}, "mapping": {"scale": [4, 4]}}
    path.write_text(json.dumps(scene))
    done = intaglio("export", path, "-o", "out.ply", "--thickness", "0.5", "--json")
    assert done.returncode == 0, done.stderr
    assert json.loads(done.stdout)["volume"] == pytest.approx(16 * 0.5 - 0.5 * 0.16 * 0.08 * 4, abs=1e-4)
    scene["objects"][0] |= {"shape": {"type": "mesh", "file": "solid.obj"}, "pattern": None}
    path.write_text(json.dumps(scene))
    done = intaglio("export", path, "-o", "out.ply", "--json")
    assert done.returncode == 0, done.stderr
    assert json.loads(done.stdout)["volume"] == pytest.approx(1 / 6)
    done = intaglio("export", path, "-o", "out.ply", "--thickness", "0.5")
    assert done.returncode == 1
    assert b"/objects/0/shape/type: expected a rectangle or an open mesh, as a thickness is given" in done.stderr
