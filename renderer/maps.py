"""An object's pattern as textures over its uv square [0, 1]^2: height, normal and anisotropy, after glTF 2.0.

Rows run from the top of the picture, v = 1, to the bottom, v = 0, so that a rectangle's map looks as the rectangle
does from above. glTF counts v from the top: there a vertex has (u, 1 - v).

Tangent space is that of the bare surface: x along dP/du, y along dP/dv, z along the normal, in world units; on spheres
these frames differ from row to row. A texel is K x K points, K_LOBE x K_LOBE for anisotropy.

Height: w sigma, world units. Normal: the mean of the points' unit normals, of length 1 again; +y is up in the picture
(OpenGL's and glTF's way).

Anisotropy (KHR_materials_anisotropy): "direction" is there the one in which roughness is greater, in which highlights
are drawn out: *across* grooves, not along them. With C the covariance of the slopes within a texel, l1 >= l2 its
eigenvalues, and alpha the material's own, slopes of variance alpha^2 / 2 as Beckmann's lobe has them add up:

    alpha_t = min(1, sqrt(alpha^2 + 2 l1))   along l1's eigenvector, the direction
    alpha_b = min(1, sqrt(alpha^2 + 2 l2))   along the grooves

and glTF's alpha_t = mix(alpha_b, 1, strength^2) gives strength = sqrt((alpha_t - alpha_b) / (1 - alpha_b)). glTF takes
the material's alpha for alpha_b; that is exact where the slopes vary in one direction only (l2 = 0, parallel grooves).
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from renderer.compile import CompiledScene
from renderer.errors import Fault, RenderError
from renderer.heightmap import HeightMap, height_map
from renderer.tables import BARE, CYLINDER, RECTANGLE, SPHERE, Floats

K, K_LOBE = 4, 8
_POINTS = 1 << 21  # sampled at a time

Map = NDArray[np.float32]


class Frames(NamedTuple):
    """Lengths of the pattern's axes in the world at the rows of a map, world units a pattern unit."""

    p: Floats  # (H, 1) |dP/dp|
    q: Floats  # (H, 1) |dP/dq|
    w: Floats  # (H, 1) sigma


def texture(
    scene: CompiledScene,
    row: int,
    kind: str,
    size: tuple[int, int],
    *,
    threads: int | None = None,
    cancelled: Callable[[], bool] | None = None,
) -> Map:
    """A map of the object `row` in `size` (W, H) texels: (H, W) heights, (H, W, 3) normals, -1 to 1, or (H, W, 3)
    anisotropy: direction as glTF stores it, 0 to 1, and strength.

    Raises RenderError where the object has none, Cancelled where `cancelled` says so.
    """
    obj = scene.objects[row]
    pattern = scene.patterns[obj["pattern"]] if obj["pattern"] >= 0 else BARE
    width, height = size
    su, sv, du, dv = (float(value) for value in obj["mapping"])
    alphas = scene.materials["alpha"][scene.slots[row]]
    k = K_LOBE if kind == "anisotropy" else K
    made = np.empty((height, width) if kind == "height" else (height, width, 3), np.float32)
    band = max(1, _POINTS // (width * k * k))
    for first in range(0, height, band):  # rows from v = 0 up
        end = min(first + band, height)
        v = (np.arange(first * k, end * k) + 0.5) / (height * k)
        frames = _frames(obj, v, row)
        window = (du, dv + sv * first / height, du + su, dv + sv * end / height)
        points = height_map(pattern, window, (width * k, (end - first) * k), threads=threads, cancelled=cancelled)
        if kind == "height":
            values = _mean(points.height * frames.w, k)
        elif kind == "normal":
            values = unit(_mean(_tangent(points, frames), k))
        else:
            values = _anisotropy(_tangent(points, frames), points.share @ alphas[points.slots] ** 2, k)
        made[height - end : height - first] = values[::-1]
    return made


def _frames(obj: np.void, v: Floats, row: int) -> Frames:
    """The frames of an object at heights `v` (n,) of its uv square."""
    su, sv = (float(value) for value in obj["mapping"][:2])
    one = np.ones((len(v), 1))
    size = obj["size"]
    if obj["shape"] == RECTANGLE:
        p, q = one * size[0], one * size[1]
    elif obj["shape"] == SPHERE:
        p, q = 2.0 * math.pi * size[0] * np.sin(math.pi * v)[:, None], one * math.pi * size[0]
    elif obj["shape"] == CYLINDER:
        p, q = one * 2.0 * math.pi * size[0], one * size[1]
    else:
        raise RenderError(
            Fault(f"/objects/{row}/shape/type", "a rectangle, a sphere or a cylinder, as a map is asked for", '"mesh"')
        )
    return Frames(p / su, q / sv, np.sqrt(p * q / (su * sv)))


def _tangent(points: HeightMap, frames: Frames) -> Floats:
    """The points' unit normals (H, W, 3) in tangent space."""
    scale = np.stack([frames.p, frames.q, frames.w], axis=2)
    return unit(points.normal / scale)


def _anisotropy(normals: Floats, alpha2: Floats, k: int) -> Floats:
    """Direction and strength (H, W, 3) from normals (kH, kW, 3) and squared alphas (kH, kW)."""
    x, y = (-normals[..., i] / normals[..., 2] for i in (0, 1))
    mx, my, own = _mean(x, k), _mean(y, k), _mean(alpha2, k)
    cxx, cyy, cxy = _mean(x * x, k) - mx * mx, _mean(y * y, k) - my * my, _mean(x * y, k) - mx * my
    half, spread = 0.5 * (cxx + cyy), np.hypot(0.5 * (cxx - cyy), cxy)
    least = np.maximum(half - spread, 0.0)
    alpha_t = np.minimum(np.sqrt(own + 2.0 * (half + spread)), 1.0)
    alpha_b = np.minimum(np.sqrt(own + 2.0 * least), 1.0)
    rest = 1.0 - alpha_b
    strength = np.sqrt(np.divide(alpha_t - alpha_b, rest, out=np.zeros_like(rest), where=rest > 0.0).clip(0.0, 1.0))
    strength[spread < _EVEN] = 0.0
    angle = np.where(strength > 0.0, 0.5 * np.arctan2(2.0 * cxy, cxx - cyy), 0.0)
    return np.stack([0.5 + 0.5 * np.cos(angle), 0.5 + 0.5 * np.sin(angle), strength], axis=2)


_EVEN = 1e-9  # slopes whose variances differ by no more than single precision's rounding do not differ


def _mean(values: Floats, k: int) -> Floats:
    """The means over squares of k x k."""
    h, w = values.shape[0] // k, values.shape[1] // k
    return np.asarray(values.reshape(h, k, w, k, *values.shape[2:]).mean(axis=(1, 3), dtype=np.float64))


def unit(vectors: Floats) -> Floats:
    """Vectors (..., 3) of length 1."""
    return np.asarray(vectors / np.linalg.norm(vectors, axis=-1, keepdims=True))
