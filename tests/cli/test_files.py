"""Output files are whole or not there."""

from __future__ import annotations

import os
from pathlib import Path

import pytest

from service import outputs


def test_write_replaces_whole(tmp_path: Path) -> None:
    path = tmp_path / "a.png"
    path.write_bytes(b"old")
    outputs.write(path, b"new")
    assert path.read_bytes() == b"new"
    assert os.listdir(tmp_path) == ["a.png"]


def test_failed_write_leaves_the_old_file_and_nothing_else(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path = tmp_path / "a.png"
    path.write_bytes(b"old")

    def fail(*_: object) -> None:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(os, "replace", fail)
    with pytest.raises(OSError, match="No space"):
        outputs.write(path, b"new")
    assert path.read_bytes() == b"old"
    assert os.listdir(tmp_path) == ["a.png"]


@pytest.mark.parametrize(
    ("name", "words"),
    [
        ("a", "found no suffix"),
        ("a.jpg", "found .jpg"),
        ("missing/a.png", "found none named"),
        ("folder.png", "found a folder"),
    ],
)
def test_fault(tmp_path: Path, name: str, words: str) -> None:
    (tmp_path / "folder.png").mkdir()
    assert words in (outputs.fault(tmp_path / name) or "")


@pytest.mark.parametrize("name", ["a.png", "a.exr", "a.npy", "A.PNG"])
def test_no_fault(tmp_path: Path, name: str) -> None:
    assert outputs.fault(tmp_path / name) is None
