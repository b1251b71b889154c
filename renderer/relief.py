"""Method `relief`: relief mapping (Policarpo, Oliveira and Comba 2005), the rival of papers 001 and 003.

The pattern is a texture of heights, normals and shares of materials with mip levels, all of them box-filtered from
exact points; rays are marched through it. As its authors would make it where speed costs no quality: the march stops
at every line between the centres of two texels, where bilinear heights are linear, so that no texel is skipped and two
of them are read at a time; the first cell at whose end the ray is below is solved for in closed form (a quadratic),
in place of the paper's steps of fixed length and its binary search. Normals are bilinear and made unit where they are
read; where materials meet in a texel, their colours are mixed.

The texels of a footprint's level are half to once as wide as its strata across their shorter axis: the samples stand
for the taps of anisotropic filtering. By the longer axis far detail is smoothed away (001, section 8): 1.2 to 2.6
times the error in figures 14 and 15 at 4 to 64 samples and 1024 and 2048 texels, at the same speed.

What bounds it:
- texels: a facet's edge is blurred over two texels of the level, and grooves narrower than that are lost: their mean
  height and mean normal are seen, without masking and shadows. The error of a pixel falls with the
  texels' size, at the memory of its square: (16 + 4 (materials - 1)) 4/3 bytes each;
- vertical walls jump from texel to texel: they are as steep as one texel, and lit by the normals beside them;
- between two lines of texel centres a ridge of a saddle can be missed, lower than the heights' twist over one texel;
- past the texture's window the border's texels go on;
- rays of more than STEPS texels are marched on a coarser level.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from renderer.geometry.random import jitter, seed_of
from renderer.geometry.view import View, on_plane, view_of
from renderer.heightmap import Window, height_map, slots_of
from renderer.kernel import borrow, kernel, leaf
from renderer.shading import ambient, dot, light_to_pattern, lit_by, normal_to_world, to_world, unit
from renderer.tables import MESH, RELIEF, Camera, Floats, Ints, Lighting, Pattern

POINTS = 2  # a texel's points along either side
MARGIN = 4.0  # height ranges that a window goes on past an object's edge: rays down to 14 degrees stay inside
LIMIT = 2 << 30  # bytes of all textures of a picture
STEPS = 4096  # lines of texel centres that one ray crosses
LIFT = 1e-2  # texels of the level that a shadow ray starts above the surface
FACING = 1e-3  # a filtered normal is turned to the eye until its cosine is this
LEVEL = 1e-6  # a light's slope to the plane is taken for at least this


class Texture(NamedTuple):
    """The levels of one texture, one after another; texels of a level row by row as in `HeightMap`."""

    height: NDArray[np.float32]  # (n,) pattern units
    normal: NDArray[np.float32]  # (n, 3) mean of unit normals of pattern space
    share: NDArray[np.float32]  # (n, S - 1) how much is of slots[1:]; the rest is of slots[0]
    slots: Ints  # (S,) material slots, as HeightMap.slots
    first: NDArray[np.int64]  # (levels,) where a level begins
    size: NDArray[np.int64]  # (levels, 2) its texels along p and q; 1, 1 in the last
    reach: Floats  # (levels, 2) its lowest and highest height
    window: Floats  # (4,) p0, q0, p1, q1: what each level covers, pattern units
    wraps: bool  # the window is a tile, repeated for ever

    @property
    def bytes(self) -> int:
        """Memory of the texels."""
        return self.height.nbytes + self.normal.nbytes + self.share.nbytes


class Textures(NamedTuple):
    """The textures of a scene's objects."""

    of: dict[int, Texture]  # by row of OBJECT

    @property
    def bytes(self) -> int:
        """Memory of all textures, each once."""
        return sum({id(texture): texture.bytes for texture in self.of.values()}.values())


def textures(
    objects: NDArray[np.void],
    patterns: Sequence[Pattern],
    uv: Floats,
    owner: Ints,
    texels: int,
    *,
    threads: int | None = None,
    cancelled: Callable[[], bool] | None = None,
) -> Textures:
    """The textures of all objects that have a pattern; those alike are one. uv (n, 3, 2), owner (n,): the triangles'.

    Raises ValueError where they would take more than LIMIT bytes.
    """
    wanted: dict[int, tuple[int, Window, bool]] = {}
    for row, obj in enumerate(objects):
        if obj["pattern"] < 0:
            continue
        low, high = np.zeros(2), np.ones(2)
        if obj["shape"] == MESH:
            own = uv[owner == row].reshape(-1, 2)
            low, high = own.min(axis=0), own.max(axis=0)
        (p0, q0), (p1, q1) = (corner * obj["mapping"][:2] + obj["mapping"][2:] for corner in (low, high))
        seen = float(p0), float(q0), float(p1), float(q1)
        wanted[row] = (int(obj["pattern"]), *window_of(patterns[obj["pattern"]], seen))
    sizes = {key: size_of(key[1], texels) for key in wanted.values()}
    total = sum(bytes_of(patterns[key[0]], size) for key, size in sizes.items())
    if total > LIMIT:
        raise ValueError(f"textures of {total >> 20} MiB, more than {LIMIT >> 20}")
    made = {
        key: texture(patterns[key[0]], key[1], size, key[2], threads=threads, cancelled=cancelled)
        for key, size in sizes.items()
    }
    return Textures({row: made[key] for row, key in wanted.items()})


def window_of(pattern: Pattern, seen: Window) -> tuple[Window, bool]:
    """What a texture has to cover for an object that shows `seen` of the pattern, and whether it repeats."""
    wide, tall = float(pattern.grid.tile[0]), float(pattern.grid.tile[1])
    p0, q0, p1, q1 = seen
    extent = max(p1 - p0, q1 - q0, 1e-9)
    p1, q1 = max(p1, p0 + 1e-6 * extent), max(q1, q0 + 1e-6 * extent)  # a mesh's uv may have no extent
    margin = min(MARGIN * (pattern.height + pattern.depth), 0.5 * extent)
    if 0.0 < wide * tall <= (p1 - p0 + 2.0 * margin) * (q1 - q0 + 2.0 * margin):
        return (0.0, 0.0, wide, tall), True
    return (p0 - margin, q0 - margin, p1 + margin, q1 + margin), False


def size_of(window: Window, texels: int) -> tuple[int, int]:
    """How many texels a window has along p and q, with `texels` along its longer side."""
    wide, tall = window[2] - window[0], window[3] - window[1]
    return max(round(texels * min(wide / tall, 1.0)), 1), max(round(texels * min(tall / wide, 1.0)), 1)


def bytes_of(pattern: Pattern, size: tuple[int, int]) -> int:
    """About how many bytes the texture of a pattern takes in so many texels."""
    return size[0] * size[1] * 4 * (4 + len(slots_of(pattern)) - 1) * 4 // 3


def texture(
    pattern: Pattern,
    window: Window,
    size: tuple[int, int],
    wraps: bool,
    *,
    threads: int | None = None,
    cancelled: Callable[[], bool] | None = None,
) -> Texture:
    """The texture of a window, as `window_of` and `size_of` say."""
    base = height_map(pattern, window, size, POINTS, threads=threads, cancelled=cancelled)
    heights = _levels(base.height[..., None])
    counts = [level.shape[0] * level.shape[1] for level in heights]
    return Texture(
        height=_joined(heights)[:, 0],
        normal=_joined(_levels(base.normal)),
        share=_joined(_levels(base.share[..., 1:])),
        slots=base.slots,
        first=np.concatenate([[0], np.cumsum(counts)[:-1]]).astype(np.int64),
        size=np.array([level.shape[1::-1] for level in heights], np.int64),
        reach=np.array([(level.min(), level.max()) for level in heights], np.float64),
        window=np.array(window, np.float64),
        wraps=wraps,
    )


def _levels(finest: NDArray[np.float32]) -> list[NDArray[np.float32]]:
    """A map (H, W, n), and its means down to one texel."""
    levels = [finest]
    while levels[-1].shape[:2] != (1, 1):
        levels.append(_halved(_halved(levels[-1], 0), 1))
    return levels


def _joined(levels: list[NDArray[np.float32]]) -> NDArray[np.float32]:
    """The texels (m, n) of all levels, one row after another."""
    return np.concatenate([level.reshape(level.shape[0] * level.shape[1], level.shape[2]) for level in levels])


def _halved(level: NDArray[np.float32], axis: int) -> NDArray[np.float32]:
    """Half as many texels along an axis, rounded up, over the same extent: the mean over each.

    Where the number is odd, a texel is a little less than two wide and reaches into up to three.
    """
    count = level.shape[axis]
    made = (count + 1) // 2
    wide = count / made
    begin = np.arange(made) * wide
    first = np.floor(begin).astype(int)
    shape = [made if i == axis else 1 for i in range(level.ndim)]
    total = np.float32(0.0)
    for k in range(2 if count % 2 == 0 else 3):
        part = np.minimum(begin + wide, first + k + 1) - np.maximum(begin, first + k)
        weight = (np.clip(part, 0.0, 1.0) / wide).astype(np.float32).reshape(shape)
        total = total + weight * np.take(level, np.minimum(first + k, count - 1), axis)
    return np.asarray(total)


@leaf
def index(i: float, n: int, wraps: bool) -> int:
    """The texel of n that a whole number stands for: clamped, or counted on in the next tile."""
    if not wraps:
        return int(min(max(i, 0.0), n - 1.0))
    k = int(i - n * np.floor(i / n))
    return k - n if k >= n else k


@leaf
def height_at(t: Texture, first: int, width: int, height: int, x: float, y: float) -> float:
    """The bilinear height at (x, y), texels of the level from the centre of its first."""
    fx, fy = np.floor(x), np.floor(y)
    i, j = index(fx, width, t.wraps), index(fx + 1.0, width, t.wraps)
    k, l = first + width * index(fy, height, t.wraps), first + width * index(fy + 1.0, height, t.wraps)
    x, y = x - fx, y - fy
    low = t.height[k + i] + x * (t.height[k + j] - t.height[k + i])
    high = t.height[l + i] + x * (t.height[l + j] - t.height[l + i])
    return low + y * (high - low)


@leaf
def march(
    t: Texture, level: int, x: float, y: float, w: float, dx: float, dy: float, dw: float, solve: bool
) -> float:  # fmt: skip
    """Where on its way (0 to 1) the ray from (x, y, w) along (dx, dy, dw) gets below the level's heights; inf: nowhere.

    x and y in texels of the level from the centre of its first. The heights along the ray are looked at wherever it
    crosses a line of texel centres, and at its end; with `solve`, the place is solved for in the last cell.
    """
    first, width, height, wraps = t.first[level], t.size[level, 0], t.size[level, 1], t.wraps
    i, j = np.floor(x), np.floor(y)  # the cell, from texel centre to texel centre
    step_x, step_y = (1.0 if dx > 0.0 else -1.0), (1.0 if dy > 0.0 else -1.0)
    next_x = (i + (1.0 if dx > 0.0 else 0.0) - x) / dx if dx != 0.0 else math.inf
    next_y = (j + (1.0 if dy > 0.0 else 0.0) - y) / dy if dy != 0.0 else math.inf
    each_x = abs(1.0 / dx) if dx != 0.0 else math.inf
    each_y = abs(1.0 / dy) if dy != 0.0 else math.inf
    before = 0.0
    f_before = w - height_at(t, first, width, height, x, y) if solve else 0.0
    if f_before < 0.0:
        return 0.0
    for _ in range(STEPS + 2):
        if next_x <= next_y and next_x < 1.0:
            at = next_x
            a = y + at * dy - j
            c = index(i + (1.0 if dx > 0.0 else 0.0), width, wraps)
            low = t.height[first + width * index(j, height, wraps) + c]
            high = t.height[first + width * index(j + 1.0, height, wraps) + c]
            f = w + at * dw - (low + a * (high - low))
            i += step_x
            next_x += each_x
        elif next_y < 1.0:
            at = next_y
            a = x + at * dx - i
            r = first + width * index(j + (1.0 if dy > 0.0 else 0.0), height, wraps)
            low, high = t.height[r + index(i, width, wraps)], t.height[r + index(i + 1.0, width, wraps)]
            f = w + at * dw - (low + a * (high - low))
            j += step_y
            next_y += each_y
        else:
            at = 1.0
            f = w + dw - height_at(t, first, width, height, x + dx, y + dy)
        if f < 0.0:
            if not solve:
                return at
            half = 0.5 * (before + at)
            f_half = w + half * dw - height_at(t, first, width, height, x + half * dx, y + half * dy)
            # the parabola f_before, f_half, f over 0..1; the heights of a bilinear cell along a ray are one
            square = 2.0 * (f_before + f) - 4.0 * f_half
            slope = 4.0 * f_half - 3.0 * f_before - f
            root = math.sqrt(max(slope * slope - 4.0 * square * f_before, 0.0)) - slope
            part = 2.0 * f_before / root if root > 0.0 else 1.0
            return before + min(part, 1.0) * (at - before)
        if at >= 1.0:
            break
        before, f_before = at, f
    return math.inf


@leaf
def shadowed(
    t: Texture, level: int, x: float, y: float, w: float, lp: float, lq: float, lw: float, ends: bool
) -> bool:  # fmt: skip
    """Whether the heights stand between the surface's point (x, y, w), of pattern space, and the light at (lp, lq, lw)
    from there; where not `ends`, the light is infinitely far that way."""
    if not ends:
        lw = max(lw, LEVEL * math.hypot(lp, lq))
    wide, tall = t.window[2] - t.window[0], t.window[3] - t.window[1]
    last = len(t.first) - 1
    for l in range(level, last + 1):
        columns, rows = t.size[l, 0], t.size[l, 1]
        sx, sy = columns / wide, rows / tall
        u, v = (x - t.window[0]) * sx - 0.5, (y - t.window[1]) * sy - 0.5
        above = w
        if l > level:
            above = max(w, height_at(t, t.first[l], columns, rows, u, v))
        above += LIFT / math.sqrt(sx * sy)
        end = 1.0
        if lw > 0.0:
            end = (t.reach[l, 1] - above) / lw
            if ends:
                end = min(end, 1.0)
        if not end > 0.0:
            return False
        du, dv = end * lp * sx, end * lq * sy
        if abs(du) + abs(dv) <= STEPS or l == last:
            return march(t, l, u, v, above, du, dv, end * lw, False) < math.inf
    return False


@leaf
def level_of(t: Texture, view: View, columns: int, rows: int) -> int:
    """The level for a footprint in columns x rows strata."""
    sx = t.size[0, 0] / (t.window[2] - t.window[0])
    sy = t.size[0, 1] / (t.window[3] - t.window[1])
    a, b = on_plane(view, 0.0, 0.0), on_plane(view, 1.0, 0.0)
    c, d = on_plane(view, 0.0, 1.0), on_plane(view, 1.0, 1.0)
    across = max(math.hypot((b[0] - a[0]) * sx, (b[1] - a[1]) * sy), math.hypot((d[0] - c[0]) * sx, (d[1] - c[1]) * sy))
    down = max(math.hypot((c[0] - a[0]) * sx, (c[1] - a[1]) * sy), math.hypot((d[0] - b[0]) * sx, (d[1] - b[1]) * sy))
    return min(int(math.log2(max(min(across / columns, down / rows), 1.0))), len(t.first) - 1)


@leaf
def normal_at(
    t: Texture, first: int, width: int, height: int, x: float, y: float
) -> tuple[tuple[float, float, float], int]:
    """The bilinear normal (any length) at (x, y), texels of the level from the centre of its first; and its texel."""
    fx, fy = np.floor(x), np.floor(y)
    i, j = index(fx, width, t.wraps), index(fx + 1.0, width, t.wraps)
    k, l = first + width * index(fy, height, t.wraps), first + width * index(fy + 1.0, height, t.wraps)
    x, y = x - fx, y - fy
    a, b, c, d = (1.0 - x) * (1.0 - y), x * (1.0 - y), (1.0 - x) * y, x * y
    m = t.normal
    n = (
        a * m[k + i, 0] + b * m[k + j, 0] + c * m[l + i, 0] + d * m[l + j, 0],
        a * m[k + i, 1] + b * m[k + j, 1] + c * m[l + i, 1] + d * m[l + j, 1],
        a * m[k + i, 2] + b * m[k + j, 2] + c * m[l + i, 2] + d * m[l + j, 2],
    )
    return n, (k if y < 0.5 else l) + (i if x < 0.5 else j)


@kernel
def relief(
    samples: int, seed: int, texture: Texture, footprints: NDArray[np.void], chosen: NDArray[np.int64],
    frames: NDArray[np.void], camera: Camera, lighting: Lighting, materials: NDArray[np.void],
    slots: NDArray[np.int32], albedo: NDArray[np.float64], radiance: NDArray[np.float64], method: NDArray[np.uint8],
) -> None:  # fmt: skip
    """Shade the footprints `chosen` of one object; write their radiance (n, 3) and method.

    samples: at least so many a footprint, in a grid of strata. slots: rows of `materials` for the pattern's facets,
    the object's own first.
    """
    t, frames, lighting, camera = borrow(texture), borrow(frames), borrow(lighting), borrow(camera)
    materials, slots, albedo = borrow(materials), borrow(slots), borrow(albedo)
    lights, eye = lighting.lights, camera.origin
    wide, tall = t.window[2] - t.window[0], t.window[3] - t.window[1]
    last = len(t.first) - 1
    columns = int(math.ceil(math.sqrt(samples)))
    rows = (samples + columns - 1) // columns
    for which in chosen:
        footprint = footprints[which]
        frame = frames[footprint.frame]
        view = view_of(footprint, frame, camera)
        method[which] = RELIEF
        dw = frame.eye[2]

        finest = level_of(t, view, columns, rows)
        state = seed_of(seed, footprint.x, footprint.y)
        red = green = blue = 0.0
        for sample in range(columns * rows):
            state, ju = jitter(state)
            state, jv = jitter(state)
            p, q = on_plane(view, (sample % columns + ju) / columns, (sample // columns + jv) / rows)
            gp, gq = (frame.eye[0] - p) / dw, (frame.eye[1] - q) / dw
            level = finest
            while True:
                width, height, first = t.size[level, 0], t.size[level, 1], t.first[level]
                sx, sy = width / wide, height / tall
                top = min(t.reach[level, 1], dw * (1.0 - 1e-9))
                fall = min(t.reach[level, 0] - top, 0.0)
                du, dv = fall * gp * sx, fall * gq * sy
                if abs(du) + abs(dv) <= STEPS or level == last:
                    break
                level += 1
            u, v = (p + top * gp - t.window[0]) * sx - 0.5, (q + top * gq - t.window[1]) * sy - 0.5
            way = min(march(t, level, u, v, top, du, dv, fall, True), 1.0)
            u, v = u + way * du, v + way * dv
            at = top + way * fall
            x, y = p + at * gp, q + at * gq

            n, texel = normal_at(t, first, width, height, u, v)
            at_world = to_world(frame, x, y, at)
            e = unit((eye[0] - at_world[0], eye[1] - at_world[1], eye[2] - at_world[2]))
            n_world = normal_to_world(frame, n)
            facing = dot(n_world, e)
            if facing < FACING:
                more = FACING - facing
                n_world = unit((n_world[0] + more * e[0], n_world[1] + more * e[1], n_world[2] + more * e[2]))
            for l in range(-1, len(lights)):  # -1: the sky and the material's own light
                dp = dq = dh = above = 0.0
                if l >= 0:
                    if (footprint.blocked >> np.uint64(l)) & np.uint64(1):
                        continue
                    dp, dq, above, dh = light_to_pattern(frame, lights[l])
                    if above <= 0.0:
                        continue
                rest = 1.0
                r = g = b = 0.0
                for column in range(len(t.slots) - 1, -1, -1):
                    share = rest
                    if column > 0:
                        share = t.share[texel, column - 1]
                        rest -= share
                    if share <= 0.0:
                        continue
                    material = materials[slots[t.slots[column]]]
                    if l < 0:
                        colour = ambient(material, lighting, albedo, n_world, e)
                    else:
                        colour = lit_by(lights[l], material, n_world, e, at_world)
                    r, g, b = r + share * colour[0], g + share * colour[1], b + share * colour[2]
                if r <= 0.0 and g <= 0.0 and b <= 0.0:
                    continue
                if l >= 0 and shadowed(t, level, x, y, at, dp - dh * x, dq - dh * y, above - dh * at, dh != 0.0):
                    continue
                red, green, blue = red + r, green + g, blue + b
        taken = columns * rows
        radiance[which, 0], radiance[which, 1], radiance[which, 2] = red / taken, green / taken, blue / taken
