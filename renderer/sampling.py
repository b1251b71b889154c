"""As many samples a pixel as bring its predicted error within the tolerance, for what is sampled in rounds.

A footprint's samples are numbered, and spread evenly, the first n for every n (`geometry.random.drawn`). They fall into
eighths of as many each, which are as even. What these differ by tells the error of their mean, and how many more
it takes. All parts of a pixel go on or stop together: of small ones few samples are taken, which tell nothing alone.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from renderer.geometry.random import EIGHTHS
from renderer.geometry.view import view_of
from renderer.kernel import borrow, kernel
from renderer.shading import to_world, white
from renderer.tables import Camera, Floats, Lighting

FIRST = 32  # of a pixel, to begin with, at least
EVEN = 0.75  # errors shrink by the number of samples to this power, at least: that of an edge
EDGE = 0.2  # ... twice what n samples err by of one of a quarter of white, times n^EVEN: over the square root of six
EIGHTH = EIGHTHS**-0.5  # of what eighths differ by is the error of their mean, were they independent; they are better
SURE = 0.46  # how much of the tolerance the standard error may take: what is known of the light itself may err too
LEAST = 0.5  # ... of what parts of a pixel may take: by the roots of their areas, as their errors are independent
UNSEEN = 0.14  # of white over n: what the parts that no sample has met may be
LEAP = 8  # as many times the samples are taken in one round, at most
# (EIGHTHS, EIGHTHS) of n samples, fewer than there are eighths, the eighth of the one that each shares
SHARED = np.array([np.arange(EIGHTHS) * n // EIGHTHS * EIGHTHS // max(n, 1) for n in range(EIGHTHS)])


Sampler = Callable[[NDArray[np.int64], NDArray[np.int64]], Floats]
"""What samples of footprints (n,) add up to in each eighth (n, EIGHTHS, 3), radiance: of each those (n, 2) from the
first to before the last, which make so many in all: the i-th of n is in eighth i EIGHTHS // n."""


class Sampled(NamedTuple):
    """What the samples of footprints have told."""

    mean: Floats  # (n, 3)
    error: Floats  # (n,) predicted, as a part of a white surface's radiance; 0 where nothing is known
    taken: NDArray[np.int64]  # (n,) samples


def sampled(
    pixel: NDArray[np.int32], weight: Floats, bright: Floats, tolerance: float, most: int, sample: Sampler
) -> Sampled:
    """Sample footprints (n,), each of this weight in its pixel, until each pixel's error is within the tolerance.

    bright: what a white surface sends there. most: samples a pixel, at most, and where the tolerance is 0 no fewer; of
    its parts one each, at least.
    """
    total = len(weight)
    adaptive = tolerance > 0.0 and most >= 2 * EIGHTHS
    sums, count = np.zeros((total, EIGHTHS, 3)), np.zeros(total, np.int64)
    pixels, group = np.unique(pixel, return_inverse=True)
    groups = len(pixels)
    area = np.bincount(group, weight)
    whiteness = np.bincount(group, weight * bright)
    target = SURE * tolerance * whiteness / area * np.maximum(np.sqrt(area), LEAST)
    last = 1 << int(math.log2(most)) if adaptive else most
    wanted = np.full(groups, most)
    if adaptive:  # before that none is done
        wanted[:] = min(1 << math.ceil(math.log2(max(FIRST, UNSEEN / (SURE * tolerance)))), last)
    taken, error = np.zeros(groups, np.int64), np.zeros(groups)
    going = np.ones(groups, np.bool_)
    while going.any():
        part = np.flatnonzero(going[group])
        more = np.maximum(np.ceil(wanted[group[part]] * weight[part]), 1.0)
        _grow(part, np.exp2(np.ceil(np.log2(more))) if adaptive else more, sums, count, sample)
        if not adaptive:
            break
        now = _spread(group[part], groups, weight[part], sums[part], count[part])
        before = error * np.power(np.maximum(taken, 1) / wanted, EVEN)
        now = np.where(taken > 0, np.sqrt(0.5 * (now * now + before * before)), now)
        now = np.hypot(now, UNSEEN * whiteness / wanted)
        error, taken = np.where(going, now, error), np.where(going, wanted, taken)
        going &= (error > target) & (wanted < last)
        more = np.floor(np.log2(np.maximum(error / np.maximum(target, 1e-300), 1.0)) / EVEN).clip(1, math.log2(LEAP))
        wanted = np.where(going, np.minimum(wanted * np.exp2(more).astype(np.int64), last), wanted)
    told = np.divide(error, SURE * whiteness, out=np.zeros(groups), where=whiteness > 0.0)
    return Sampled(sums.sum(axis=1) / np.maximum(count, 1)[:, None], told[group], count)


def _grow(part: NDArray[np.int64], wanted: Floats, sums: Floats, count: NDArray[np.int64], sample: Sampler) -> None:
    """Take samples until there are so many of the footprints `part`, whose eighths become the first ones."""
    more = wanted > count[part]
    if not more.any():
        return
    part, before, now = part[more], count[part[more]], wanted[more].astype(np.int64)
    old, shrinks = sums[part], before / now
    sums[part] = sample(part, np.stack([before, now], axis=1))
    for eighth in range(EIGHTHS):
        sums[part, (eighth * shrinks).astype(np.int64)] += old[:, eighth]
    count[part] = now


def _spread(
    group: NDArray[np.int64], groups: int, weight: Floats, sums: Floats, count: NDArray[np.int64]
) -> Floats:  # fmt: skip
    """The standard error of what the footprints (n,) of each group add up to, from the sums (n, EIGHTHS, 3) of so many
    samples.

    Of the smallest parts there are fewer samples than eighths, which share them: one of each, at least. Of these the
    error is what they differ by among themselves.
    """
    few = count < EIGHTHS
    value = sums[..., 0] + sums[..., 1] + sums[..., 2]
    value[few] = np.take_along_axis(value[few], SHARED[count[few]], axis=1)
    value *= (1.0 / (3 * np.maximum(count // EIGHTHS, 1)))[:, None]
    found = np.array([np.bincount(group, weight * one, groups) for one in value.T])
    group, weight, value, count = group[few], weight[few], value[few, 0], count[few]
    area = np.maximum(np.bincount(group, weight, groups), 1e-300)
    apart = value - (np.bincount(group, weight * value, groups) / area)[group]
    square = np.bincount(group, weight * apart * apart, groups) / area
    square *= np.bincount(group, weight * weight / count, groups)
    error: Floats = np.sqrt(EIGHTH * EIGHTH * found.var(axis=0, ddof=1) + square)
    return error


@kernel
def whiteness(
    footprints: NDArray[np.void], chosen: NDArray[np.int64], frames: NDArray[np.void], camera: Camera,
    lighting: Lighting,
) -> Floats:  # fmt: skip
    """What a white surface sends (n,) where the footprints `chosen` (n,) are."""
    lighting = borrow(lighting)
    found = np.empty(len(chosen))
    for j in range(len(chosen)):
        footprint = footprints[chosen[j]]
        frame = frames[footprint.frame]
        view = view_of(footprint, frame, camera)
        found[j] = white(lighting, to_world(frame, view.p, view.q, 0.0))
    return found
