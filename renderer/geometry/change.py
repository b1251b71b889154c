"""How fast colours change along a footprint."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from renderer.geometry.view import View, on_plane
from renderer.kernel import leaf
from renderer.shading import to_world
from renderer.tables import DIRECTIONAL, Floats

COAT = 2.0  # a coat reflects this much more than head on, but where light grazes it


@leaf
def turns(frame: np.void, view: View, lights: NDArray[np.void], turn: Floats) -> float:
    """Write by what angle, radians, the ways to each light and to the eye together turn along a footprint;
    the last is the way to the eye alone. Gives the footprint's length, pattern units."""
    a, b = on_plane(view, 0.0, 0.0), on_plane(view, 1.0, 1.0)
    c, d = on_plane(view, 1.0, 0.0), on_plane(view, 0.0, 1.0)
    one, two = to_world(frame, a[0], a[1], 0.0), to_world(frame, b[0], b[1], 0.0)
    other, last = to_world(frame, c[0], c[1], 0.0), to_world(frame, d[0], d[1], 0.0)
    long = max(apart(one, two), apart(other, last))
    middle = to_world(frame, view.p, view.q, 0.0)
    eye = long / apart(middle, to_world(frame, frame.eye[0], frame.eye[1], frame.eye[2]))
    turn[len(lights)] = eye
    for l in range(len(lights)):
        v = lights[l].vector
        turn[l] = eye
        if lights[l].kind != DIRECTIONAL:
            turn[l] += long / max(apart(middle, (v[0], v[1], v[2])), 1e-300)
    return max(math.hypot(b[0] - a[0], b[1] - a[1]), math.hypot(d[0] - c[0], d[1] - c[1]))


@leaf
def apart(a: tuple[float, float, float], b: tuple[float, float, float]) -> float:
    return math.sqrt((a[0] - b[0]) ** 2 + (a[1] - b[1]) ** 2 + (a[2] - b[2]) ** 2)


@leaf
def is_plain(material: np.void) -> bool:
    """Whether a material looks the same from everywhere."""
    return bool(material.metallic == 0.0 and material.f90 == 0.0)


@leaf
def peak(material: np.void) -> float:
    """How much brighter than a white matt surface a material may be: GGX is 1 / (4 alpha^2) of it where it reflects
    all."""
    if is_plain(material) or not material.alpha > 0.0:
        return 1.0
    part = 1.0 if material.metallic > 0.0 else min(COAT * material.f0, 1.0)
    return float(max(1.0, 0.25 * part / (material.alpha * material.alpha)))


@leaf
def sharpness(material: np.void) -> float:
    """How much faster than a matt surface's the light that this material sends turns with direction: of that of a white
    one, per radian squared. GGX's peak is alpha wide."""
    if is_plain(material) or not material.alpha > 0.0:
        return 1.0
    return float(peak(material) / (material.alpha * material.alpha))
