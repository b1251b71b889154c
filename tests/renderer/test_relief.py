"""Method `relief`: its texture's levels, its march, and where its picture is that of the exact methods.

*relief* draws the same samples as *csg* for the same seed. Bilinear heights and normals are exact on planes, so that
samples differ only within some texels of an edge, or of a shadow's edge.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

import schema
from renderer import pipeline, relief
from renderer.compile import PatternCache
from renderer.errors import RenderError
from renderer.tables import Pattern

from .parts import alone

Json = dict[str, Any]
Floats = NDArray[np.float64]
Plate = Callable[..., Json]
Radiance = Callable[..., Floats]

SINGLE = 2e-6
V = {"type": "v", "width": 0.24, "depth": 0.14}
RIDGE = {"type": "v", "width": 0.2, "depth": -0.1}
SUN = {"type": "directional", "direction": [1, 0.45, -0.9], "irradiance": [3, 3, 3]}


def line(points: list[list[float]], profile: Json, **more: Any) -> Json:
    return {"path": {"type": "polyline", "points": points}, "profile": profile, **more}


OBLIQUE = line([[-1, 0.3], [3, 1.6]], {"type": "v", "width": 0.5, "depth": 0.2})
"""A coarse groove that meets the texels at every phase."""


def rms(values: Floats) -> float:
    return float(np.sqrt(np.mean(values**2)))


@pytest.fixture
def compiled(plate: Plate, check: Callable[[Json], schema.Scene]) -> Callable[..., Pattern]:
    def compile_pattern(*grooves: Json, **parts: Any) -> Pattern:
        return PatternCache().pattern(check(plate(list(grooves), **parts)).patterns["cut"]).tables

    return compile_pattern


def texture(pattern: Pattern, texels: int, threads: int = 2) -> relief.Texture:
    window, wraps = relief.window_of(pattern, (0.0, 0.0, 2.0, 1.3))
    return relief.texture(pattern, window, relief.size_of(window, texels), wraps, threads=threads)


def test_levels_keep_the_mean(compiled: Callable[..., Pattern]) -> None:
    """A level has half the texels of the one before, rounded up, down to one; each level is the mean over its texels,
    so that the mean of a level is that of the finest. Single precision: 1e-6 of what is about 1."""
    materials: Json = {"stone": {}, "a": {}, "b": {}}
    made = texture(
        compiled(OBLIQUE | {"material": ["a", "b"]}, line([[1, 0], [1, 1]], RIDGE), materials=materials), 203
    )
    assert tuple(made.size[-1]) == (1, 1)
    assert (made.size[1:] == (made.size[:-1] + 1) // 2).all()
    assert len(made.slots) == 3
    ends = [*made.first[1:], len(made.height)]
    for table in (made.height, made.normal, made.share):
        means = np.array([table[a:b].mean(axis=0, dtype=float) for a, b in zip(made.first, ends, strict=True)])
        assert np.abs(means - means[0]).max() < 1e-6
    for (low, high), a, b in zip(made.reach, made.first, ends, strict=True):
        assert (low, high) == (made.height[a:b].min(), made.height[a:b].max())


def test_bytes(compiled: Callable[..., Pattern]) -> None:
    """Four thirds of 16 bytes a texel: the height and the normal, no share where there is but one material."""
    pattern = compiled(OBLIQUE)
    made = texture(pattern, 256)
    size = (int(made.size[0, 0]), int(made.size[0, 1]))
    assert max(size) == 256
    assert made.bytes == 16 * len(made.height)
    assert made.bytes == pytest.approx(relief.bytes_of(pattern, size), rel=0.01)


def test_threads_make_the_same_texture(compiled: Callable[..., Pattern]) -> None:
    one, three = (texture(compiled(OBLIQUE), 100, threads) for threads in (1, 3))
    assert all((a == b).all() for a, b in zip(one[:3], three[:3], strict=True))


def test_too_many_texels(plate: Plate, radiance: Radiance) -> None:
    """8192 x 8192 texels of 4 materials: 4/3 times 28 bytes each are more than 2 GiB."""
    materials: Json = {name: {} for name in ("stone", "a", "b", "c")}
    scene = plate([OBLIQUE | {"material": name} for name in "abc"], materials=materials)
    with pytest.raises(RenderError) as caught:
        radiance(scene, method="relief", texels=8192)
    (fault,) = caught.value.faults
    assert fault.pointer == "/render/texels"
    assert f"{8192**2 * 28 * 4 // 3 >> 20} MiB" in fault.found


@pytest.mark.parametrize("wraps", [False, True])
def test_march(wraps: bool) -> None:
    """Through heights at random: at the place found the ray meets the bilinear heights, and nowhere before.

    Between two lines of texel centres the heights along a ray are a parabola that bends by at most a quarter of the
    cell's twist, here 0.5: that much it may have been below before. Heights are single precision.
    """
    random = np.random.default_rng(0)
    n = 9
    heights = random.random(n * n).astype(np.float32) * 0.25
    table = relief.Texture(
        heights, np.zeros((n * n, 3), np.float32), np.zeros((n * n, 0), np.float32), np.zeros(1, np.int32),
        np.zeros(1, np.int64), np.array([[n, n]]), np.array([[0.0, 0.25]]), np.array([0.0, 0, n, n]), wraps,
    )  # fmt: skip
    march, height_at = alone(relief.march), alone(relief.height_at)
    found = 0
    for _ in range(300):
        x, y = random.uniform(-2, n + 1, 2)
        dx, dy = random.normal(0, 4, 2) * (random.random(2) > 0.1)
        at = march(table, 0, x, y, 0.3, dx, dy, -0.3, True)
        t = np.linspace(0, min(at, 1.0), 200)[:-1]
        above = [0.3 * (1 - s) - height_at(table, 0, n, n, x + s * dx, y + s * dy) for s in t]
        assert min(above) > -0.5 / 4
        if at < math.inf:
            found += 1
            assert abs(0.3 * (1 - at) - height_at(table, 0, n, n, x + at * dx, y + at * dy)) < 1e-6
        # a shadow ray the same way: it is stopped where this one is, or a line of texel centres later
        assert (march(table, 0, x, y, 0.3, dx, dy, -0.3, False) < math.inf) == (at < math.inf)
    assert found > 200


def test_grooves_of_no_depth_are_the_bare_plate(plate: Plate, radiance: Radiance) -> None:
    flat = {"type": "v", "width": 0.3, "depth": 1e-9}
    scene = plate([OBLIQUE | {"profile": flat}], lights=[SUN])
    assert (
        np.abs(radiance(scene, method="relief", samples=9, texels=64) - radiance(scene, method="base")).max() < SINGLE
    )


def test_furnace(plate: Plate, radiance: Radiance) -> None:
    """White under a white sky: 1 to the last bit, also where three white materials share a texel."""
    white = {"base_color": [1, 1, 1], "specular": 0, "roughness": 1}
    scene = plate(
        [OBLIQUE | {"material": ["a", "b"]}, line([[0.5, -1], [0.7, 3]], RIDGE)],
        materials={"stone": white, "a": white, "b": white},
        lights=[{"type": "constant", "radiance": [1, 1, 1]}],
    )
    for texels in (16, 333):
        assert (radiance(scene, method="relief", samples=9, texels=texels) == 1.0).all()


def test_away_from_edges_it_is_exact(plate: Plate, radiance: Radiance) -> None:
    """A V seen from straight above, with a sun that shines along it and so casts no shadow.

    Only texels beside the three edges hold more than one plane: points within 1.5 texels of them, half a texel by the
    texel's own mean, one by the bilinear look-up, see a mixture. A pixel that no such point lies in is that of `csg`.
    """
    width, texels, distance = 0.5, 128, 50.0
    fov = math.degrees(2 * math.atan(0.75 / distance))  # 1.5 units high on the plate
    scene = plate(
        [line([[1, -1], [1, 3]], {"type": "v", "width": width, "depth": 0.2})],
        camera={"origin": [0, 0, distance], "target": [0, 0, 0], "up": [0, 1, 0], "fov": fov, "resolution": [48, 48]},
        lights=[{"type": "directional", "direction": [0, 1, -1], "irradiance": [3, 3, 3]}],
    )
    same = np.abs(
        radiance(scene, method="relief", samples=16, texels=texels) - radiance(scene, method="csg", samples=16)
    ).max(axis=(0, 2))
    texel = (2 + 2 * relief.MARGIN * 0.2) / texels
    pixel = 1.5 / 48
    shift = 0.75 * 0.2 / distance  # how far a point at the bottom is seen from where it is
    left = -0.75 + pixel * np.arange(48)
    near = np.zeros(48, bool)
    for edge in (-width / 2, 0.0, width / 2):
        near |= (left < edge + 1.5 * texel + shift) & (left + pixel > edge - 1.5 * texel - shift)
    assert near.sum() < 24
    assert same[~near].max() < SINGLE
    assert same[near].max() > 0.01


def test_converges_with_the_texels(plate: Plate, radiance: Radiance) -> None:
    """Samples differ from csg's within some texels of the edges of facets and shadows. Such a strip fills a part of
    its pixels that falls as 1 / texels while it is narrower than they are (a pixel is 0.05 wide or more, a texel of 256
    0.014), and with it their error. How often a sample falls into it is chance: n samples hit a strip that fills f of a
    pixel n f times, +- sqrt(n f) at the most, strata making it less. f is 0.05 or more here and n 256, that makes 0.28
    of the error of one pixel, or 0.28 / sqrt(m) of that of the m > 100 pixels on edges: 3%.
    """
    scene = plate([OBLIQUE])
    exact = radiance(scene, method="csg", samples=256)
    errors = [rms(radiance(scene, method="relief", samples=256, texels=n) - exact) for n in (256, 512, 1024)]
    assert errors[1] < 0.5 * 1.06 * errors[0]
    assert errors[2] < 0.5 * 1.06 * errors[1]


def test_tile_is_the_pattern_written_out(plate: Plate, radiance: Radiance) -> None:
    """A tile of 1/2, with a groove across its border, and the same 6 x 6 times over.

    The height range is 1/8, so that the margin of 4 ranges, 1/2, makes the written window 6 tiles wide: with 6 times
    as many texels they fall on the same points. Rounding may put single samples on the other side of an edge.
    """
    stroke = line([[0.3, 0.35], [0.45, 0.6]], {"type": "v", "width": 0.2, "depth": 0.125})
    grid = {"type": "grid", "counts": [8, 8], "steps": [[0.5, 0], [0, 0.5]]}
    written = line([[-1.2, -1.15], [-1.05, -0.9]], stroke["profile"], repeat=grid)
    tiled = radiance(plate([stroke], [0.5, 0.5]), method="relief", samples=16, texels=64)
    out = radiance(plate([written]), method="relief", samples=16, texels=384)
    differ = np.abs(tiled - out).max(axis=2) > 1e-4
    assert differ.mean() < 0.01
    assert rms(tiled - radiance(plate([]), method="base")) > 0.05


@pytest.mark.parametrize("texels", [16, 256])
def test_finite_at_grazing(texels: int, plate: Plate, radiance: Radiance) -> None:
    """Views and lights along the surface, lights below what is lit and inside grooves, an eye below a ridge's top."""
    ball: Json = {"shape": {"type": "sphere", "radius": 0.4}, "translate": [0.3, 0.2, 0.4]}
    scene = plate(
        [OBLIQUE, line([[0.2, -1], [0.3, 3]], RIDGE)],
        camera={"origin": [0.1, -1.3, 0.004], "target": [0, 0, 0]},
        materials={"stone": {"base_color": [0.7, 0.6, 0.5], "roughness": 0.05, "metallic": 1}},
        lights=[
            {"type": "directional", "direction": [1, 0.2, -1e-9], "irradiance": [1, 1, 1]},
            {"type": "directional", "direction": [0, 0, -1], "irradiance": [1, 1, 1]},
            {"type": "point", "position": [0.1, 0.1, 0.001], "intensity": [1, 1, 1]},
            {"type": "point", "position": [0.02, -0.1, -0.05], "intensity": [1, 1, 1]},
        ],
    )
    scene["objects"].append(ball | {"material": "stone", "pattern": "cut"})
    values = radiance(scene, method="relief", samples=4, texels=texels)
    assert np.isfinite(values).all()
    assert (values >= 0).all()


def test_like_objects_share_a_texture(plate: Plate, picture: Callable[..., pipeline.Picture]) -> None:
    """Two plates of one window have one texture; a third, mapped otherwise, another of as many texels."""
    scene = plate([OBLIQUE])
    (first,) = scene["objects"]
    alike, other = first | {"translate": [0, 0, -1]}, first | {"mapping": {"scale": [1, 1]}}
    one, two, three = (
        picture(scene | {"objects": objects}, method="relief", samples=1, texels=64).solid_bytes
        for objects in ([first], [first, alike], [first, alike, other])
    )
    assert two == one
    assert three == 2 * one


def test_what_is_built_is_timed_apart(plate: Plate, picture: Callable[..., pipeline.Picture]) -> None:
    made = picture(plate([OBLIQUE]), method="relief", samples=1, texels=64)
    assert made.seconds["solids"] > 0
    assert made.solid_bytes == pytest.approx(16 * 64 * 64 * 4 / 3, rel=0.01)  # the window is a square
    assert made.shares == {"relief": 1.0}
