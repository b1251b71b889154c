"""Files that a command writes: whole or not at all."""

from __future__ import annotations

import contextlib
import os
import tempfile
from collections.abc import Sequence
from pathlib import Path

SUFFIXES = (".png", ".exr", ".npy")


def fault(path: Path, suffixes: Sequence[str] = SUFFIXES) -> str | None:
    """Why no file can be written to `path`, found out before the work begins; None where one can."""
    if path.suffix.lower() not in suffixes:
        return f"{path}: expected a name that ends in {', '.join(suffixes)}, found {path.suffix or 'no suffix'}"
    if path.is_dir():
        return f"{path}: expected a file, found a folder"
    if not path.parent.is_dir():
        return f"{path}: expected an existing folder, found none named {path.parent}"
    if not os.access(path.parent, os.W_OK | os.X_OK):
        return f"{path}: expected a folder that can be written to, found {path.parent}"
    return None


def folder_fault(path: Path) -> str | None:
    """Why no files can be written into the folder `path`, or why it cannot be made; None where they can."""
    if path.is_dir():
        return None if os.access(path, os.W_OK | os.X_OK) else f"{path}: expected a folder that can be written to"
    if path.exists():
        return f"{path}: expected a folder, found a file"
    if not path.parent.is_dir() or not os.access(path.parent, os.W_OK | os.X_OK):
        return f"{path}: expected a folder, or a place for one, found no {path.parent} that can be written to"
    return None


def write(path: Path, data: bytes) -> None:
    """Write next to `path` and rename, so that nobody ever sees half of it."""
    handle, name = tempfile.mkstemp(prefix=".intaglio-", suffix=path.suffix, dir=path.parent)
    try:
        with os.fdopen(handle, "wb") as file:
            file.write(data)
        os.chmod(name, 0o666 & ~_umask())
        os.replace(name, path)
    except BaseException:
        with contextlib.suppress(OSError):
            os.unlink(name)
        raise


def _umask() -> int:
    mask = os.umask(0)
    os.umask(mask)
    return mask
