"""Maps against closed forms."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

import schema
from renderer import maps
from renderer.compile import CompiledScene, PatternCache, compile_scene
from renderer.errors import RenderError

Json = dict[str, Any]


def compiled(scene: Json) -> CompiledScene:
    report = schema.check(scene)
    assert report.scene is not None, report
    return compile_scene(report.scene, (1, 1), PatternCache(), None)


def line(a: list[float], b: list[float], profile: Json, **more: Any) -> Json:
    return {"path": {"type": "polyline", "points": [a, b]}, "profile": profile, **more}


def test_rows_run_from_the_top(plate: Callable[..., Json]) -> None:
    """A groove at the plate's lower left shows at the picture's lower left: in its last row and first column."""
    scene = compiled(plate([line([0.1, 0.3], [0.5, 0.3], {"type": "v", "width": 0.2, "depth": 0.1})]))
    height = maps.texture(scene, 0, "height", (20, 10))
    assert height.shape == (10, 20)
    rows, columns = np.nonzero(height < -0.01)
    assert rows.min() >= 7
    assert columns.max() <= 6


@pytest.mark.parametrize(("su", "sv"), [(2.0, 2.0), (4.0, 1.0)])
def test_walls_of_a_v_groove(su: float, sv: float, plate: Callable[..., Json]) -> None:
    """One V groove along v as wide as the plate: the left half falls, the right half rises, at a slope of
    depth sigma / (half the width a), with a = 2 / su world units a unit of p and sigma^2 = 2 / su * 2 / sv."""
    depth = 0.3
    groove = line([su / 2, -1], [su / 2, sv + 1], {"type": "v", "width": su, "depth": depth})
    scene = compiled(plate([groove], mapping={"scale": [su, sv]}))
    sigma = math.sqrt(4.0 / (su * sv))
    slope = depth * sigma / 1.0
    normal = maps.texture(scene, 0, "normal", (8, 8))
    # The left wall faces right: +x.
    expected = np.array([slope, 0.0, 1.0]) / math.hypot(slope, 1.0)
    np.testing.assert_allclose(normal[:, :4], np.broadcast_to(expected, (8, 4, 3)), atol=1e-6)
    np.testing.assert_allclose(normal[:, 4:], np.broadcast_to(expected * [-1, 1, 1], (8, 4, 3)), atol=1e-6)
    height = maps.texture(scene, 0, "height", (8, 8))
    centres = (np.arange(8) + 0.5) / 8.0
    np.testing.assert_allclose(height[3], -depth * sigma * (1.0 - np.abs(2.0 * centres - 1.0)), atol=1e-6)


def test_green_is_up(plate: Callable[..., Json]) -> None:
    """The wall of a groove along u that lies lower in the picture rises downwards: it faces up, +y."""
    scene = compiled(plate([line([-1, 1], [3, 1], {"type": "v", "width": 2, "depth": 0.3})]))
    normal = maps.texture(scene, 0, "normal", (4, 4))
    assert (normal[2:, :, 1] > 0.2).all()
    assert (normal[:2, :, 1] < -0.2).all()


@pytest.mark.parametrize("degrees", [0.0, 30.0, 90.0, 135.0])
@pytest.mark.parametrize("roughness", [0.0, 0.5, 1.0])
def test_anisotropy_of_parallel_grooves(degrees: float, roughness: float, plate: Callable[..., Json]) -> None:
    """A family without gaps, many to a texel, its walls at slopes +s and -s in equal parts: the slopes' variance is s^2
    across and 0 along. Highlights are drawn out across the grooves, so that is glTF's direction."""
    s, width = 0.5, 0.01
    turn = math.radians(degrees)
    along, over = np.array([math.cos(turn), math.sin(turn)]), np.array([-math.sin(turn), math.cos(turn)])
    middle, count = np.array([1.0, 1.0]), 400
    start = middle - 0.5 * (count - 1) * width * over
    family = line(
        (start - 3 * along).tolist(), (start + 3 * along).tolist(),
        {"type": "v", "width": width, "depth": 0.5 * width * s},
        repeat={"type": "linear", "count": count, "step": (width * over).tolist()},
    )  # fmt: skip
    data = plate([family])
    data["materials"]["stone"]["roughness"] = roughness
    found = maps.texture(compiled(data), 0, "anisotropy", (4, 4)).reshape(-1, 3).mean(axis=0)
    alpha = roughness**2
    alpha_t = min(1.0, math.sqrt(alpha**2 + 2.0 * s * s))
    strength = math.sqrt((alpha_t - alpha) / (1.0 - alpha)) if alpha < 1.0 else 0.0
    # The means of a texel's 64 points are those of its grooves but for the chance of which walls they fall on: the
    # variance is s^2 (1 - m^2), m of the order of 1 / 8.
    assert found[2] == pytest.approx(strength, abs=0.05)
    if strength > 0.0:
        direction = 2.0 * found[:2] - 1.0
        assert abs(direction @ over) == pytest.approx(np.linalg.norm(direction), abs=0.02)


def test_no_anisotropy_without_grooves_or_with_as_many_each_way(plate: Callable[..., Json]) -> None:
    bare = maps.texture(compiled(plate([])), 0, "anisotropy", (4, 4))
    np.testing.assert_array_equal(bare, np.broadcast_to(np.array([1.0, 0.5, 0.0]), (4, 4, 3)))
    assert (maps.texture(compiled(plate([])), 0, "height", (4, 4)) == 0.0).all()
    np.testing.assert_array_equal(
        maps.texture(compiled(plate([])), 0, "normal", (4, 4)), np.broadcast_to(np.array([0, 0, 1]), (4, 4, 3))
    )
    # A pyramid in the middle of each texel looks the same from four sides: its slopes' covariance is even.
    pit = line([0.2499, 0.25], [0.2501, 0.25], {"type": "v", "width": 0.4, "depth": 0.1})
    pits = maps.texture(compiled(plate([pit], tile=[0.5, 0.5])), 0, "anisotropy", (4, 4))
    assert pits[..., 2].max() < 0.05


@pytest.mark.parametrize("shape", [{"type": "sphere", "radius": 2}, {"type": "cylinder", "radius": 0.5, "height": 3}])
def test_curved_shapes_have_their_frames(shape: Json, plate: Callable[..., Json]) -> None:
    """A wall that rises by `slope` pattern units a unit of q everywhere: in the world by slope sigma / |dP/dq|."""
    slope = 0.2
    ramp = {"type": "polyline", "points": [[-4, 0], [4, 8 * slope], [4, 0]]}
    data = plate([line([3, 0.5], [-2, 0.5], ramp)], mapping={"scale": [1, 1]})
    data["objects"][0]["shape"] = shape
    rows = 8
    normal = maps.texture(compiled(data), 0, "normal", (4, rows))[:, 1]
    v = 1.0 - (np.arange(rows * maps.K) + 0.5) / (rows * maps.K)
    r = shape["radius"]
    ring = 2 * math.pi * r * (np.sin(math.pi * v) if shape["type"] == "sphere" else np.ones(len(v)))
    rise = math.pi * r if shape["type"] == "sphere" else shape["height"]
    slopes = slope * np.sqrt(ring * rise) / rise
    tilted, upright = (
        (part / np.sqrt(1.0 + slopes**2)).reshape(rows, maps.K).mean(axis=1) for part in (slopes, np.ones(len(v)))
    )
    np.testing.assert_allclose(np.abs(normal[:, 1] / normal[:, 2]), tilted / upright, rtol=1e-5)


def test_a_mesh_has_no_map(plate: Callable[..., Json]) -> None:
    data = plate([line([0, 0.5], [1, 0.5], {"type": "v", "width": 0.2, "depth": 0.1})])
    data["objects"][0]["shape"] = {"type": "mesh", "file": "a.obj"}
    report = schema.check(data)
    assert report.scene is not None
    file = b"v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\nf 1/1 2/2 3/3\n"
    scene = compile_scene(report.scene, (1, 1), PatternCache(), lambda _: file)
    with pytest.raises(RenderError, match="/objects/0/shape/type"):
        maps.texture(scene, 0, "normal", (4, 4))
