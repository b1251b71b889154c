"""Uploaded meshes and envmaps, kept in memory under the hash of their content."""

from __future__ import annotations

import hashlib
import threading
from collections import OrderedDict

SUFFIXES = (".obj", ".ply", ".glb")
SKY_SUFFIXES = (".exr", ".hdr", ".png")
PREFIX = "upload:"


class MeshStore:
    """Thread-safe. When `limit` bytes are passed, the ones that were not used for longest go."""

    def __init__(self, limit: int) -> None:
        self._limit = limit
        self._files: OrderedDict[str, bytes] = OrderedDict()
        self._size = 0
        self._lock = threading.Lock()

    def put(self, data: bytes, suffix: str) -> str:
        """The name that `get` knows the file by: its hash and suffix."""
        name = hashlib.sha256(data).hexdigest()[:32] + suffix
        with self._lock:
            if name in self._files:
                self._files.move_to_end(name)
                return name
            self._files[name] = data
            self._size += len(data)
            while self._size > self._limit and len(self._files) > 1:
                self._size -= len(self._files.popitem(last=False)[1])
        return name

    def get(self, name: str) -> bytes | None:
        """The file, or None where there is none of this name (any more)."""
        with self._lock:
            data = self._files.get(name)
            if data is not None:
                self._files.move_to_end(name)
            return data
