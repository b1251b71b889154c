"""What the special cases are measured by: scenes, references, and how bright white is."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest

import schema
from bench.scenes import load
from bench.special import accuracy, promise, reference, scenes
from bench.stability.sweep import beyond
from renderer import pipeline
from renderer.compile import PatternCache
from service.chart import measure


def test_the_truth_from_far_is_csg_s() -> None:
    """Two seeds of each: they differ by no more than their own noise, four deviations, over all pixels."""
    case = next(case for case in accuracy.cases() if case.far is not None)
    assert case.far is not None
    truth = [accuracy.straight(case.scene, case.far, seed).radiance.astype(np.float64) for seed in (1, 2)]
    csg = pipeline.render(case.scene, method="csg", samples=64, resolution=scenes.FAR).radiance.astype(np.float64)
    again = pipeline.render(
        case.scene.model_copy(update={"render": case.scene.render.model_copy(update={"seed": 7})}), method="csg",
        samples=64, resolution=scenes.FAR,
    ).radiance.astype(np.float64)  # fmt: skip
    noise = math.sqrt(float(np.mean((csg - again) ** 2)) / 2.0)
    off = (csg - truth[0])[..., 0]
    assert float(np.sqrt(np.mean((truth[0] - truth[1]) ** 2))) < 0.1 * noise
    assert abs(off.mean()) < 4.0 * noise / math.sqrt(off.size)
    assert math.sqrt(float(np.mean(off**2))) < 1.3 * noise


def test_more_than_ten_grooves_are_in_a_pixel_from_far() -> None:
    """The nearest row of the plate that is seen has the smallest pixels: their side over the grooves' distance."""
    far = next(iter(accuracy.FAR.values()))
    scene = scenes.far(far)
    origin, target = (np.array(place, float) for place in (scene.camera.origin, scene.camera.target))
    forward = (target - origin) / np.linalg.norm(target - origin)
    down = math.asin(-forward[2]) + 0.5 * math.radians(scenes.FAR_FOV)
    distance = origin[2] / math.sin(down)
    side = distance * 2.0 * math.tan(0.5 * math.radians(scenes.FAR_FOV)) / scenes.FAR[1]
    assert side * math.cos(0.5 * math.radians(scenes.FAR_FOV)) / far.pitch * len(far.slopes) > 10.0


def test_few_and_many_scratches_cover_the_same() -> None:
    """Ten times smaller each way, a hundred times as many."""
    few, many = (scenes.scattered(count).patterns["cut"].grooves[0] for count in (100, 10_000))
    assert isinstance(few.path, schema.PolylinePath)
    assert isinstance(many.path, schema.PolylinePath)
    assert few.path.points[0][0] == pytest.approx(10.0 * many.path.points[0][0])
    assert isinstance(few.profile, schema.ScratchProfile)
    assert isinstance(many.profile, schema.ScratchProfile)
    assert few.profile.width == pytest.approx(10.0 * many.profile.width)


def test_white_under_the_examples_lights() -> None:
    """Figure 14 has two suns: the sum of their irradiances over pi, wherever the plate is seen."""
    scene = load("parallel")
    white = promise.white(scene, PatternCache())
    suns = sum(np.mean(light.irradiance) for light in scene.lights if isinstance(light, schema.DirectionalLight))
    seen = np.isfinite(white)
    assert 0.5 < seen.mean() <= 1.0
    assert white[seen] == pytest.approx(suns / math.pi)


def test_references_are_kept(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Passes until the mean is good enough, and none the next time; another scene has its own."""
    monkeypatch.setattr(reference, "FOLDER", tmp_path)
    scene = scenes.close("crossing")
    generator, seeds = np.random.Generator(np.random.PCG64(0)), []

    def draw(seed: int) -> pipeline.Picture:
        seeds.append(seed)
        noisy = 0.5 + 3e-4 * generator.standard_normal((6, 8, 3))
        return pipeline.Picture(noisy.astype(np.float32), {}, {"total": 0.0}, 0, {})

    first = reference.converged(scene, "noise", draw)
    everywhere = np.ones((6, 8), np.bool_)
    assert measure.noise(first, everywhere) <= reference.ENOUGH or first.count == reference.MOST
    assert len(set(seeds)) == len(seeds) == first.count > reference.LEAST
    again = reference.converged(scene, "noise", draw)
    assert len(seeds) == first.count
    assert (again.mean == first.mean).all()
    reference.converged(scenes.close("tee"), "noise", draw)
    assert len(seeds) > first.count


def test_a_firefly_lies_beyond_the_range() -> None:
    truth = np.array([[0.2, 0.3], [0.25, 0.3]])
    picture = truth.copy()
    assert beyond(picture, truth, truth) == 0.0
    picture[0, 0] = 0.5
    assert beyond(picture, truth, truth) == pytest.approx(0.2)
    picture[0, 0] = 0.05
    assert beyond(picture, truth, truth) == pytest.approx(-0.15)
