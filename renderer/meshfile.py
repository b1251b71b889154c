"""Mesh files: OBJ, PLY and GLB as triangles with texture coordinates."""

from __future__ import annotations

import io
from pathlib import PurePath
from typing import NamedTuple

import numpy as np

from renderer.tables import Floats

SUFFIXES = (".obj", ".ply", ".glb")
MAX_TRIANGLES = 5_000_000


class MeshFileError(ValueError):
    """A mesh file that cannot be used; `expected` and `found` say why."""

    def __init__(self, expected: str, found: str) -> None:
        super().__init__(f"expected {expected}, found {found}")
        self.expected, self.found = expected, found


class TriangleSoup(NamedTuple):
    """Triangles in the file's axes."""

    corners: Floats  # (n, 3, 3)
    uv: Floats | None  # (n, 3, 2); None: the file has none
    normals: Floats  # (n, 3, 3) unit


def read(name: str, data: bytes) -> TriangleSoup:
    """The triangles of a mesh file; `name` tells its kind. Broken and empty triangles are left out.

    Raises MeshFileError where nothing usable is left.
    """
    import trimesh  # slow to load, and few scenes need it

    suffix = PurePath(name).suffix.lower()
    if suffix not in SUFFIXES:
        raise MeshFileError("an OBJ, PLY or GLB file", repr(name))
    try:
        loaded = trimesh.load(io.BytesIO(data), file_type=suffix[1:], process=False)
        parts = loaded.dump() if isinstance(loaded, trimesh.Scene) else [loaded]
        soups = [_soup(part) for part in parts if isinstance(part, trimesh.Trimesh) and len(part.faces)]
    except MeshFileError:
        raise
    except Exception as error:  # trimesh raises whatever the file makes it meet
        raise MeshFileError(f"a readable {suffix[1:].upper()} file", f"{type(error).__name__}: {error}") from None
    if not soups:
        raise MeshFileError("a mesh with triangles", "none")
    corners = np.concatenate([soup.corners for soup in soups])
    normals = np.concatenate([soup.normals for soup in soups])
    uvs = [soup.uv for soup in soups]
    uv = None if any(part is None for part in uvs) else np.concatenate([part for part in uvs if part is not None])
    if len(corners) > MAX_TRIANGLES:
        raise MeshFileError(f"at most {MAX_TRIANGLES} triangles", str(len(corners)))
    area = np.linalg.norm(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1)
    good = np.isfinite(corners).all(axis=(1, 2)) & (area > 0.0) & np.isfinite(normals).all(axis=(1, 2))
    if uv is not None:
        good &= np.isfinite(uv).all(axis=(1, 2))
    if not good.any():
        raise MeshFileError("triangles with an area", "none")
    return TriangleSoup(corners[good], None if uv is None else uv[good], normals[good])


def _soup(mesh: object) -> TriangleSoup:
    vertices = np.asarray(mesh.vertices, np.float64)  # type: ignore[attr-defined]
    faces = np.asarray(mesh.faces, np.int64)  # type: ignore[attr-defined]
    if faces.min() < 0 or faces.max() >= len(vertices):
        raise MeshFileError(f"faces of vertices 0 to {len(vertices) - 1}", f"a vertex {int(faces.max())}")
    corners = vertices[faces]
    coordinates = getattr(mesh.visual, "uv", None)  # type: ignore[attr-defined]
    uv = None
    if coordinates is not None and len(coordinates) == len(vertices):
        uv = np.asarray(coordinates, np.float64)[faces]
    flat = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    length = np.linalg.norm(flat, axis=1, keepdims=True)
    flat = np.repeat(np.divide(flat, length, out=np.zeros_like(flat), where=length > 0.0)[:, None], 3, axis=1)
    if "vertex_normals" not in mesh._cache.cache:  # type: ignore[attr-defined]
        return TriangleSoup(corners, uv, flat)  # the file has none: facets stay facets
    normals = np.asarray(mesh.vertex_normals, np.float64)[faces]  # type: ignore[attr-defined]
    length = np.linalg.norm(normals, axis=2, keepdims=True)
    return TriangleSoup(corners, uv, np.where(length > 0.0, normals / np.where(length > 0.0, length, 1.0), flat))
