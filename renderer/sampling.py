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

from renderer.geometry.view import view_of
from renderer.kernel import borrow, kernel
from renderer.shading import to_world, white
from renderer.tables import Camera, Floats, Lighting

FIRST = 32  # of a pixel, to begin with, at least
EIGHTHS = 8
EVEN = 0.75  # errors shrink by the number of samples to this power, at least: that of an edge
EDGE = 0.2  # ... twice what n samples err by of one of a quarter of white, times n^EVEN: over the square root of six
EIGHTH = EIGHTHS**-0.5  # of what eighths differ by is the error of their mean, were they independent; they are better
SURE = 0.45  # how much of the tolerance the standard error may take: what is known of the light itself may err too
UNSEEN = 0.14  # of white over n: what the parts that no sample has met may be
LEAP = 8  # as many times the samples are taken in one round, at most


Sampler = Callable[[NDArray[np.int64], NDArray[np.int64]], Floats]
"""The mean radiance (n, 3) of footprints (n,), of the samples (n, 2) of each from the first to before the last."""


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
    eighths = EIGHTHS if tolerance > 0.0 and most >= 2 * EIGHTHS else 1
    sums, counts = np.zeros((eighths, total, 3)), np.zeros((eighths, total), np.int64)
    pixels, group = np.unique(pixel, return_inverse=True)
    groups = len(pixels)
    area = np.bincount(group, weight)
    whiteness = np.bincount(group, weight * bright)
    target = SURE * tolerance * whiteness / np.sqrt(area)
    last = 1 << int(math.log2(most)) if eighths > 1 else most
    wanted = np.full(groups, most)
    if eighths > 1:  # before that none is done
        wanted[:] = min(1 << math.ceil(math.log2(max(FIRST, UNSEEN / (SURE * tolerance)))), last)
    taken, error = np.zeros(groups, np.int64), np.zeros(groups)
    going = np.ones(groups, np.bool_)
    while going.any():
        part = np.flatnonzero(going[group])
        each = np.maximum(np.ceil(wanted[group[part]] * weight[part] / eighths), 1.0).astype(np.int64)
        _grow(part, each, sums, counts, sample)
        if eighths == 1:
            break
        value = (sums.sum(axis=2) / np.maximum(3 * counts, 1))[:, part]
        found = np.array([np.bincount(group[part], weight[part] * one, groups) for one in value])
        now = EIGHTH * found.std(axis=0, ddof=1)
        before = error * np.power(np.maximum(taken, 1) / wanted, EVEN)
        now = np.where(taken > 0, np.sqrt(0.5 * (now * now + before * before)), now)
        now = np.hypot(now, UNSEEN * whiteness / wanted)
        error, taken = np.where(going, now, error), np.where(going, wanted, taken)
        going &= (error > target) & (wanted < last)
        more = np.floor(np.log2(np.maximum(error / np.maximum(target, 1e-300), 1.0)) / EVEN).clip(1, math.log2(LEAP))
        wanted = np.where(going, np.minimum(wanted * np.exp2(more).astype(np.int64), last), wanted)
    count = counts.sum(axis=0)
    told = np.divide(error, SURE * whiteness, out=np.zeros(groups), where=whiteness > 0.0)
    return Sampled(sums.sum(axis=0) / np.maximum(count, 1)[:, None], told[group], count)


def _grow(
    part: NDArray[np.int64], each: NDArray[np.int64], sums: Floats, counts: NDArray[np.int64], sample: Sampler
) -> None:
    """Take samples until each eighth of those of the footprints `part` has so many: a power of two, as it had before.

    The old eighths become the first ones, by two or four in one or not all of it.
    """
    eighths, column = len(sums), np.arange(len(part))
    place = np.arange(eighths)[:, None] // np.maximum(each // np.maximum(counts[0, part], 1), 1)
    had, value = np.zeros((eighths, len(part)), np.int64), np.zeros((eighths, len(part), 3))
    np.add.at(had, (place, column), counts[:, part])
    np.add.at(value, (place, column), sums[:, part])
    eighth, which = np.nonzero(had < each)
    numbers = np.stack([eighth * each[which] + had[eighth, which], (eighth + 1) * each[which]], axis=1)
    new = numbers[:, 1] - numbers[:, 0]
    value[eighth, which] += sample(part[which], numbers) * new[:, None]
    had[eighth, which] += new
    sums[:, part], counts[:, part] = value, had


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
