"""`intaglio validate` and `intaglio schema`."""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest

import schema

from .conftest import Command


def test_valid(intaglio: Command, scene_file: Path) -> None:
    done = intaglio("validate", scene_file)
    assert (done.returncode, done.stdout, done.stderr) == (0, b"", b"")


def test_standard_input(intaglio: Command, scene_file: Path) -> None:
    assert intaglio("validate", "-", stdin=scene_file.read_bytes()).returncode == 0
    assert intaglio("validate", "-", stdin=b"").returncode == 2


def test_problems_one_a_line(intaglio: Command, scene: dict[str, Any]) -> None:
    scene["camera"]["fov"] = "wide"
    scene["objects"][0]["material"] = "wo\nod"
    done = intaglio("validate", "-", stdin=json.dumps(scene).encode())
    assert done.returncode == 1
    lines = sorted(done.stdout.decode().splitlines())
    assert len(lines) == 2
    assert lines[0].startswith("/camera/fov: expected ")
    assert lines[0].endswith(', found "wide"')
    assert lines[1].startswith("/objects/0/material: expected ")
    assert ", found " in lines[1]
    assert done.stderr == b""


def test_warnings_go_to_the_standard_error(intaglio: Command, scene: dict[str, Any]) -> None:
    scene["patterns"]["tiles"]["grooves"][0]["path"] = {"type": "circle", "center": [0, 0], "radius": 0.01}
    done = intaglio("validate", "-", stdin=json.dumps(scene).encode())
    assert (done.returncode, done.stdout) == (0, b"")
    assert done.stderr.decode().startswith("warning: /patterns/tiles/grooves/0/path/radius: expected ")


def test_json(intaglio: Command, scene: dict[str, Any]) -> None:
    text = json.dumps(scene).encode()
    assert json.loads(intaglio("validate", "-", "--json", stdin=text).stdout) == {
        "valid": True,
        "problems": [],
        "warnings": [],
    }
    del scene["camera"]
    done = intaglio("validate", "-", "--json", stdin=json.dumps(scene).encode())
    assert done.returncode == 1
    report = json.loads(done.stdout)
    assert report["valid"] is False
    assert [set(problem) for problem in report["problems"]] == [{"pointer", "expected", "found"}]
    assert report["problems"][0]["pointer"] == "/camera"


@pytest.mark.parametrize("text", [b"", b"{", b"\xff\xfe", b"[" * 100_000, b"PK\x03\x04"])
def test_unreadable_text(intaglio: Command, tmp_path: Path, text: bytes) -> None:
    (tmp_path / "broken.json").write_bytes(text)
    for command in (("validate",), ("render", "-o", "a.png")):
        done = intaglio(*command, "broken.json")
        assert (done.returncode, done.stdout) == (2, b"")
        assert done.stderr.startswith(b"broken.json: expected ")
    assert not (tmp_path / "a.png").exists()


@pytest.mark.parametrize("name", ["missing.json", ".", "missing/scene.json"])
def test_unreadable_file(intaglio: Command, name: str) -> None:
    done = intaglio("validate", name)
    assert (done.returncode, done.stdout) == (2, b"")
    assert done.stderr.startswith(f"{name}: cannot be read: ".encode())


def test_json_that_is_no_scene_has_problems(intaglio: Command) -> None:
    for text in (b"null", b"[]", b"1", b'{"intaglio": 1, "intaglio": 1}'):
        assert intaglio("validate", "-", stdin=text).returncode == 1


def test_huge_file(intaglio: Command, tmp_path: Path) -> None:
    with open(tmp_path / "huge.json", "wb") as file:
        file.truncate(100 << 20)
    done = intaglio("validate", "huge.json")
    assert done.returncode == 2
    assert b"at most 64 MiB" in done.stderr


def test_schema(intaglio: Command) -> None:
    done = intaglio("schema")
    assert done.returncode == 0
    assert json.loads(done.stdout) == schema.json_schema()


def test_validation_loads_nothing_heavy(scene_file: Path) -> None:
    code = (
        "import sys, typer\n"
        "from service.cli import app\n"
        f"sys.argv = ['intaglio', 'validate', {str(scene_file)!r}]\n"
        "try: app()\n"
        "except SystemExit: pass\n"
        "print([m for m in ('numpy', 'numba', 'fastapi', 'renderer') if m in sys.modules])"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, check=True, timeout=60)
    assert done.stdout == b"[]\n"
