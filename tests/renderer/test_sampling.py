"""Samples in rounds: each is taken once, as many as the tolerance asks for, and the error told is what is left."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from renderer.geometry.random import EIGHTHS, PLACE, drawn
from renderer.kernel import kernel
from renderer.sampling import FIRST, sampled
from renderer.tables import Floats

MOST = 65_536
Numbers = NDArray[np.int64]


@kernel
def below_line(which: Numbers, numbers: Numbers, slope: Floats, height: Floats, found: Floats) -> None:
    """How many of a pixel's samples lie below a line across it, by eighths."""
    for k in range(len(which)):
        for i in range(numbers[k, 0], numbers[k, 1]):
            _, u, v = drawn(i, PLACE, 0, float(which[k]), 0.0)
            if v < height[which[k]] + slope[which[k]] * (u - 0.5):
                found[k, i * EIGHTHS // numbers[k, 1]] += 1.0


def grey(values: Floats) -> Floats:
    return np.repeat(values[..., None], 3, axis=-1)


def by_eighths(numbers: Numbers) -> Floats:
    """How many samples (n, EIGHTHS) of `numbers` (n, 2) fall into each eighth."""
    count = np.zeros((len(numbers), EIGHTHS))
    for row, (first, stop) in zip(count, numbers, strict=True):
        row += np.bincount(np.arange(first, stop) * EIGHTHS // stop, minlength=EIGHTHS)
    return count


@pytest.mark.parametrize("most", [1, 7, 16, 100, 4096])
def test_each_sample_is_taken_once(most: int) -> None:
    weight = np.array([1.0, 0.25, 0.25, 1 / 4096, 1.0])
    pixel = np.array([0, 1, 1, 1, 2], np.int32)
    taken: list[list[int]] = [[] for _ in weight]
    dice = np.random.default_rng(1)

    def sample(which: Numbers, numbers: Numbers) -> Floats:
        for k, (first, stop) in zip(which, numbers, strict=True):
            taken[k] += range(first, stop)
        value = np.where(which[:, None] < 4, dice.random((len(which), EIGHTHS)), 0.5)
        return grey(by_eighths(numbers) * value)

    made = sampled(pixel, weight, np.ones(5), 1e-3, most, sample)
    for k, numbers in enumerate(taken):
        assert sorted(numbers) == list(range(made.taken[k]))
        assert 1 <= len(numbers) <= max(most * weight[k], EIGHTHS)
    assert made.mean[4] == pytest.approx(0.5)
    assert made.taken[4] < made.taken[0] or most < 512  # of what is even all over few are enough


@pytest.mark.parametrize("tolerance", [0.02, 0.005, 0.002])
@pytest.mark.parametrize("bright", [1.0, 3.0])
def test_edges_are_within_the_tolerance(tolerance: float, bright: float) -> None:
    """The area below a line across a pixel. Of n^2 even samples it crosses the strata of n, and leaves a sixth of each
    one's square: so many do for two deviations. Rounds double them, and what tells their error errs itself."""
    dice = np.random.default_rng(2)
    count = 500
    slope, height = dice.uniform(-0.6, 0.6, count), dice.uniform(0.3, 0.7, count)

    def sample(which: Numbers, numbers: Numbers) -> Floats:
        found = np.zeros((len(which), EIGHTHS))
        below_line(which, numbers, slope, height, found)
        return grey(bright * found)

    made = sampled(np.arange(count, dtype=np.int32), np.ones(count), np.full(count, bright), tolerance, MOST, sample)
    off = np.abs(made.mean[:, 0] / bright - height)
    assert np.mean(off <= tolerance) >= 0.95
    assert np.mean(off <= made.error) >= 0.95
    assert made.error.max() <= tolerance
    assert made.taken.mean() < 4.0 * (2.0 / 6.0**0.5 / tolerance) ** (4 / 3) + FIRST


def independent(spread: float) -> Callable[[Numbers, Numbers], Floats]:
    dice = np.random.default_rng(3)

    def sample(which: Numbers, numbers: Numbers) -> Floats:
        count = by_eighths(numbers)
        return grey(count + spread * dice.standard_normal(count.shape) * np.sqrt(count))

    return sample


def test_noise_is_brought_down_to_what_is_asked() -> None:
    """Independent samples, each off by half of white on root mean square: the worst that directions can be."""
    count = 6000
    made = sampled(np.arange(count, dtype=np.int32), np.ones(count), np.ones(count), 0.02, MOST, independent(0.5))
    off = np.abs(made.mean[:, 0] - 1.0)
    assert np.mean(off <= 0.02) >= 0.95
    assert 1000 < made.taken.mean() < 6000  # (0.5 / 0.01)^2 would do, were it known


def test_the_smallest_parts_tell_their_error_together() -> None:
    """Of a pixel in 64 parts fewer samples than eighths are taken of each, if these are enough."""
    count, parts = 1000, 64
    pixel = np.repeat(np.arange(count, dtype=np.int32), parts)
    made = sampled(pixel, np.full(len(pixel), 1.0 / parts), np.ones(len(pixel)), 0.08, MOST, independent(0.5))
    off = np.abs(made.mean[:, 0].reshape(count, parts).mean(axis=1) - 1.0)
    assert made.taken.min() < EIGHTHS
    assert np.mean(off <= 0.08) >= 0.95 - 2.0 * math.sqrt(0.95 * 0.05 / count)
    assert np.mean(off <= made.error[::parts]) >= 0.95 - 2.0 * math.sqrt(0.95 * 0.05 / count)
    assert made.taken.reshape(count, parts).sum(axis=1).mean() < 4.0 * (0.5 / 0.04) ** 2


def test_the_most_is_told_where_it_does_not_do() -> None:
    made = sampled(np.zeros(1, np.int32), np.ones(1), np.ones(1), 1e-4, 64, independent(0.5))
    assert made.taken[0] == 64
    assert made.error[0] > 0.02


def test_no_tolerance_no_rounds() -> None:
    """Each part of a pixel has its share, and one at least; nothing is told of the error."""
    calls: list[Any] = []

    def sample(which: Numbers, numbers: Numbers) -> Floats:
        calls.append(numbers)
        return grey(by_eighths(numbers))

    made = sampled(np.zeros(3, np.int32), np.array([0.5, 0.25, 1e-3]), np.ones(3), 0.0, 100, sample)
    assert made.taken.tolist() == [50, 25, 1]
    assert len(calls) == 1
    assert not made.error.any()
