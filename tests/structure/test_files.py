"""What must not get into the repository."""

from __future__ import annotations

import json
import re
import subprocess
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
LOCKS = sorted((ROOT / "requirements").glob("*.txt"))


@pytest.mark.parametrize("lock", LOCKS, ids=lambda path: path.name)
def test_lock_files_are_hashed_and_name_no_address(lock: Path) -> None:
    text = lock.read_text()
    assert "://" not in text
    assert not re.search(r"^\s*--(index|extra-index|find-links)", text, re.MULTILINE)
    for requirement in re.split(r"\n(?=[a-z])", text):
        if re.match(r"[a-z]", requirement):
            assert "--hash=sha256:" in requirement, requirement[:80]


def test_page_lock_names_no_address() -> None:
    lock = ROOT / "web" / "package-lock.json"
    if lock.exists():
        packages = json.loads(lock.read_text())["packages"]
        assert [name for name, entry in packages.items() if "resolved" in entry] == []


def test_our_requirements_do_not_include_our_own_names_from_elsewhere() -> None:
    for lock in LOCKS:
        assert not re.search(r"^(schema|renderer|service)==", lock.read_text(), re.MULTILINE)


def test_nothing_large_is_kept() -> None:
    """What is built, downloaded or measured in bulk stays out: once committed, it stays in the history for good."""
    listed = subprocess.run(["git", "ls-files", "-z"], cwd=ROOT, capture_output=True, text=True, check=False)
    if listed.returncode != 0:
        pytest.skip("no git repository")
    files = [ROOT / name for name in listed.stdout.split("\0") if name]
    assert [file.name for file in files if file.exists() and file.stat().st_size > 1 << 20] == []
