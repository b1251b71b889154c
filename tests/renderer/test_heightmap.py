"""The maps of a pattern against closed forms (DESIGN 1.2). Texels are single precision: CLOSE of lengths about 1."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

import schema
from renderer.compile import PatternCache
from renderer.heightmap import HeightMap, Window, height_map

Json = dict[str, Any]
Floats = NDArray[np.float64]
CLOSE = 2e-7

V = {"type": "v", "width": 0.4, "depth": 0.1}  # slope 1 : 2
RIDGE = {"type": "v", "width": 0.3, "depth": -0.15}  # slope 1 : 1
ALONG_P: list[list[float]] = [[-5, 0], [5, 0]]
ALONG_Q: list[list[float]] = [[0, -5], [0, 5]]
WINDOW = (-0.5, -0.4, 0.5, 0.4)
SIZE = (51, 37)  # odd, and no multiple of each other: texels fall on both sides of all creases


def line(points: list[list[float]], profile: Json, **more: Any) -> Json:
    return {"path": {"type": "polyline", "points": points}, "profile": profile, **more}


def map_of(
    plate: Callable[..., Json],
    check: Callable[[Json], schema.Scene],
    grooves: list[Json],
    *,
    tile: list[float] | None = None,
    window: Window = WINDOW,
    size: tuple[int, int] = SIZE,
    k: int = 1,
) -> HeightMap:
    names: Json = {"m0": {}, "m1": {}, "m2": {}, "stone": {}}
    pattern = check(plate(grooves, tile, materials=names)).patterns["cut"]
    return height_map(PatternCache().pattern(pattern).tables, window, size, k, threads=2)


@pytest.fixture
def maps(plate: Callable[..., Json], check: Callable[[Json], schema.Scene]) -> Callable[..., HeightMap]:
    return lambda *grooves, **options: map_of(plate, check, list(grooves), **options)


def centres(window: Window = WINDOW, size: tuple[int, int] = SIZE) -> tuple[Floats, Floats]:
    p = window[0] + (np.arange(size[0]) + 0.5) * (window[2] - window[0]) / size[0]
    q = window[1] + (np.arange(size[1]) + 0.5) * (window[3] - window[1]) / size[1]
    return np.tile(p, (size[1], 1)), np.tile(q[:, None], (1, size[0]))


def v(b: Floats) -> Floats:
    """The height of V across its path."""
    return np.minimum(np.abs(b) / 2 - 0.1, 0.0)


def ridge(b: Floats) -> Floats:
    return np.maximum(0.15 - np.abs(b), 0.0)


def test_v_groove(maps: Callable[..., HeightMap]) -> None:
    """Height |b| / 2 - 0.1 within 0.2 of the path; its normal is (-+1, 0, 2) / sqrt 5, that of the plane (0, 0, 1).

    The groove runs along q; at its own crease, which a column of texels has for its centre, either wall will do.
    """
    made = maps(line(ALONG_Q, V))
    p, _ = centres()
    assert np.abs(made.height - v(p)).max() < CLOSE
    normal = np.zeros((*p.shape, 3))
    normal[..., 0] = np.where(np.abs(p) < 0.2, -np.sign(p) / math.sqrt(5), 0.0)
    normal[..., 2] = np.where(np.abs(p) < 0.2, 2 / math.sqrt(5), 1.0)
    off = np.abs(p) > 1e-9
    assert np.abs(made.normal - normal)[off].max() < CLOSE
    assert np.abs(made.normal[~off][:, 2] - 2 / math.sqrt(5)).max() < CLOSE
    assert (made.slots == [0]).all()
    assert (made.share == 1).all()


def test_round_groove_of_an_arc(maps: Callable[..., HeightMap]) -> None:
    """A V along a circle of radius 0.3 about the origin: b is 0.3 less the distance from there, whatever the sign."""
    made = maps({"path": {"type": "circle", "center": [0, 0], "radius": 0.3}, "profile": V})
    p, q = centres()
    r = np.hypot(p, q)
    assert np.abs(made.height - v(r - 0.3)).max() < CLOSE
    inside = (np.abs(r - 0.3) < 0.199) & (np.abs(r - 0.3) > 1e-3)
    normal = np.stack([-np.sign(r - 0.3) * p, -np.sign(r - 0.3) * q, 2 * r], axis=-1)[inside]
    normal /= np.linalg.norm(normal, axis=-1, keepdims=True)
    assert np.abs(made.normal[inside] - normal).max() < CLOSE


@pytest.mark.parametrize("flip", [False, True])
def test_crossing(maps: Callable[..., HeightMap], flip: bool) -> None:
    """Two grooves merge into the lower, two ridges into the higher, a groove cuts through a ridge; in either order."""
    p, q = centres()
    for one, other, expected in (
        (V, V, np.minimum(v(p), v(q))),
        (RIDGE, RIDGE, np.maximum(ridge(p), ridge(q))),
        (V, RIDGE, np.where(np.abs(p) < 0.2, v(p), ridge(q))),
    ):
        grooves = [line(ALONG_Q, one), line(ALONG_P, other)]
        made = maps(*(grooves[::-1] if flip else grooves))
        assert np.abs(made.height - expected).max() < CLOSE


def test_priority(maps: Callable[..., HeightMap]) -> None:
    """Inside the band of the higher priority the lower one has left nothing, be they grooves or ridges."""
    p, q = centres()
    for lower, section in ((V, v), (RIDGE, ridge)):
        made = maps(line(ALONG_P, lower), line(ALONG_Q, RIDGE, priority=1))
        assert np.abs(made.height - np.where(np.abs(p) < 0.15, ridge(p), section(q))).max() < CLOSE


def test_ends(maps: Callable[..., HeightMap]) -> None:
    """A path that ends at p = 0.001, cut square or closed by profile(max(|b|, x))."""
    p, q = centres()
    for ends, expected in (
        ("flat", np.where(p < 0.001, v(q), 0.0)),
        ("profile", v(np.maximum(np.abs(q), p - 0.001))),
    ):
        made = maps(line([[-5, 0], [0.001, 0]], V, ends=ends))
        assert np.abs(made.height - expected).max() < CLOSE


def test_tile(maps: Callable[..., HeightMap]) -> None:
    """A tile of 0.25 x 0.2 with one groove, over 4 x 4 tiles: the distance to the nearest path in the period."""
    made = maps(line([[0.1, -1], [0.1, 1]], V | {"width": 0.2}), tile=[0.25, 0.2])
    p, _ = centres()
    b = np.abs((p - 0.1 + 0.125) % 0.25 - 0.125)
    assert np.abs(made.height - np.minimum(b - 0.1, 0.0)).max() < CLOSE


def test_supersampling(maps: Callable[..., HeightMap]) -> None:
    """k x k points a texel are the means of the texels of a map k times as fine, of every quantity."""
    off = 0.0013  # no point falls on a crease, where either side will do
    grooves = [line([[off, -5], [off, 5]], V, material=["m0", "m1"]), line([[-5, off], [5, off]], RIDGE, material="m1")]
    k = 3
    coarse, fine = maps(*grooves, k=k), maps(*grooves, size=(k * SIZE[0], k * SIZE[1]))

    def mean(a: NDArray[np.float32]) -> Floats:
        return np.asarray(a.reshape(SIZE[1], k, SIZE[0], k, -1).mean(axis=(1, 3)).reshape(*a[::k, ::k].shape))

    for name in ("height", "normal", "share"):
        assert np.abs(getattr(coarse, name) - mean(getattr(fine, name))).max() < CLOSE
    assert (np.abs(coarse.share.sum(axis=2) - 1) < CLOSE).all()
    assert (coarse.slots == fine.slots).all()


def test_materials(maps: Callable[..., HeightMap]) -> None:
    """A path along +q has its left at p < 0, so that its first facet, of the material m2, lies at p > 0."""
    made = maps(
        line(ALONG_Q, V, material=["m2", None]), line([[-0.4, -5], [-0.4, 5]], V | {"width": 0.1}, material="m0")
    )
    p, _ = centres()
    assert len(made.slots) == 3
    wall, narrow = made.slot[0, 30], made.slot[0, 5]
    assert {0, wall, narrow} == set(made.slots)
    expected = np.where((p > 0) & (p < 0.2), wall, np.where(np.abs(p + 0.4) < 0.05, narrow, 0))
    off = np.abs(p) > 1e-9
    assert (made.slot == expected)[off].all()
    assert (made.share.max(axis=2) == 1).all()
    assert (made.share.sum(axis=2) == 1).all()


def test_texels_wider_than_grooves(maps: Callable[..., HeightMap]) -> None:
    """40 grooves a texel, many more than are looked for at once: every height is that of the texel's centre."""
    window, size = (0.0, 0.0, 100.0, 1.0), (3, 2)
    many = line([[0.0, -5], [0.0, 5]], V, repeat={"type": "linear", "count": 251, "step": [0.4, 0]})
    made = maps(many, window=window, size=size)
    p, _ = centres(window, size)
    b = np.abs((p + 0.2) % 0.4 - 0.2)
    assert np.abs(made.height - v(b)).max() < CLOSE
