"""Points of world space on an object's surface, in the coordinates of its pattern."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from renderer.meshfile import TriangleSoup
from renderer.tables import CYLINDER, RECTANGLE, SPHERE, Floats


class Surface:
    """An object's surface. `obj` is its row of OBJECT, `soup` its triangles where it is a mesh."""

    def __init__(self, obj: np.void, soup: TriangleSoup | None) -> None:
        self._obj, self._soup = obj, soup

    def project(self, points: Sequence[tuple[float, ...]]) -> list[tuple[float, float]]:
        """The nearest surface points (p, q) of world points (x, y, z).

        On spheres and cylinders u goes on past 1 rather than back to 0, so that a path that crosses the seam stays
        in one piece.
        """
        obj = self._obj
        local = (np.array(points, float) - obj["translation"]) @ obj["rotation"]
        if obj["shape"] == RECTANGLE:
            uv = local[:, :2] / obj["size"] + 0.5
        elif obj["shape"] in (SPHERE, CYLINDER):
            angle = np.unwrap(np.arctan2(local[:, 1], local[:, 0])) / (2.0 * math.pi)
            angle -= math.floor(angle[0])
            if obj["shape"] == SPHERE:
                height = 0.5 + np.arctan2(local[:, 2], np.hypot(local[:, 0], local[:, 1])) / math.pi
            else:
                height = local[:, 2] / obj["size"][1] + 0.5
            uv = np.stack([angle, height], axis=1)
        else:
            uv = self._on_mesh(local)
        m = obj["mapping"]
        return [(float(u * m[0] + m[2]), float(v * m[1] + m[3])) for u, v in uv]

    def _on_mesh(self, local: Floats) -> Floats:
        import trimesh

        soup = self._soup
        assert soup is not None
        assert soup.uv is not None
        mesh = trimesh.Trimesh(
            soup.corners.reshape(-1, 3), np.arange(3 * len(soup.corners)).reshape(-1, 3), process=False
        )
        nearest, _, row = trimesh.proximity.closest_point_naive(mesh, local)
        weights = trimesh.triangles.points_to_barycentric(soup.corners[row], nearest)
        return np.asarray(np.einsum("nk,nkc->nc", weights, soup.uv[row]), np.float64)
