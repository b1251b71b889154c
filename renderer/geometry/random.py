"""Numbers that look random and depend on the place alone: the same for any tile, thread and machine."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from renderer.kernel import fixed, leaf

WORD = np.uint64(0xFFFFFFFF)  # the bits of coordinates,
RESOLUTION = 1.0 / 4294967296.0  # and what the last of them is worth
EIGHTHS = fixed(8)  # into which a place's samples fall, as many each: what they differ by tells the error of their mean
PLACE = -1  # the step of a path at which its place in the footprint is drawn


@leaf
def mix(state: np.uint64) -> np.uint64:
    """The finalizer of SplitMix64 (Steele, Lea and Flood 2014)."""
    state = (state ^ (state >> np.uint64(30))) * np.uint64(0xBF58476D1CE4E5B9)
    state = (state ^ (state >> np.uint64(27))) * np.uint64(0x94D049BB133111EB)
    return state ^ (state >> np.uint64(31))


@leaf
def seed_of(seed: int, x: float, y: float) -> np.uint64:
    """The state to begin with at the screen point (x, y), pixels; places differ from 1/1024 pixel on."""
    state = mix(np.uint64(seed) + np.uint64(0x9E3779B97F4A7C15))
    state = mix(state ^ np.uint64(np.int64(x * 1024.0)))
    return mix(state ^ (np.uint64(np.int64(y * 1024.0)) << np.uint64(32)))


@leaf
def jitter(state: np.uint64) -> tuple[np.uint64, float]:
    """The next state, and a number from [0, 1) that it gives."""
    state = state + np.uint64(0x9E3779B97F4A7C15)
    return state, np.float64(mix(state) >> np.uint64(11)) * (1.0 / 9007199254740992.0)


@leaf
def turned_round(x: np.uint64) -> np.uint64:
    """32 bits, the last first."""
    x = (x >> np.uint64(1) & np.uint64(0x55555555)) | (x & np.uint64(0x55555555)) << np.uint64(1)
    x = (x >> np.uint64(2) & np.uint64(0x33333333)) | (x & np.uint64(0x33333333)) << np.uint64(2)
    x = (x >> np.uint64(4) & np.uint64(0x0F0F0F0F)) | (x & np.uint64(0x0F0F0F0F)) << np.uint64(4)
    x = (x >> np.uint64(8) & np.uint64(0x00FF00FF)) | (x & np.uint64(0x00FF00FF)) << np.uint64(8)
    return x >> np.uint64(16) | (x & np.uint64(0xFFFF)) << np.uint64(16)


@leaf
def scrambled(x: np.uint64, seed: np.uint64) -> np.uint64:
    """32 bits, each of which is kept or flipped by what `seed` makes of those above it (Owen 1995): by the hash of
    Laine and Karras 2011, in which bits change higher ones alone, with the constants of Burley 2020."""
    x = turned_round(x) + (seed & WORD)
    x ^= x * np.uint64(0x6C50B47C)
    x ^= x * np.uint64(0xB82F1E52)
    x ^= x * np.uint64(0xC7AFE638)
    x ^= x * np.uint64(0x8D22F6E6)
    return turned_round(x & WORD)


def _third() -> NDArray[np.uint32]:
    """What each byte of a point's number adds to Sobol's third coordinate (4, 256), of the polynomial t^2 + t + 1."""
    table = np.zeros((4, 256), np.uint32)
    number, across, next_across = np.arange(256), 1 << 31, 3 << 30
    for bit in range(32):
        table[bit // 8] ^= np.where(number >> bit % 8 & 1, across, 0).astype(np.uint32)
        across, next_across = next_across, next_across ^ across ^ across >> 2
    return table


THIRD = _third()


@leaf
def second(x: np.uint64) -> np.uint64:
    """Sobol's second coordinate, of the polynomial t + 1, from the first: by Pascal's triangle modulo 2."""
    x ^= x << np.uint64(16) & WORD
    x ^= (x & np.uint64(0x00FF00FF)) << np.uint64(8)
    x ^= (x & np.uint64(0x0F0F0F0F)) << np.uint64(4)
    x ^= (x & np.uint64(0x33333333)) << np.uint64(2)
    return x ^ (x & np.uint64(0x55555555)) << np.uint64(1)


@leaf
def drawn(i: int, step: int, seed: int, x: float, y: float) -> tuple[float, float, float]:
    """The i-th path's point (lobe, u, v) of the unit cube for one of its steps, at a place (x, y).

    A place's paths fill the cube evenly, the first n for every n, best for a power of two, and in each step in another
    order, so that where a path goes in one says nothing of the next. The points are Sobol's, scrambled and shuffled
    (Burley 2020, "Practical hash-based Owen scrambling"); the last two coordinates alone are a (0, 2)-sequence.
    """
    state = mix(seed_of(seed, x, y) + np.uint64(step))
    k = scrambled(np.uint64(i), state)
    u = turned_round(k)
    v = second(u)
    lobe = np.uint64(0)
    for byte in range(4):
        lobe ^= np.uint64(THIRD[byte, (k >> np.uint64(8 * byte)) & np.uint64(255)])
    state, a = mix(state), mix(state + np.uint64(1))
    u, v, lobe = scrambled(u, a), scrambled(v, state), scrambled(lobe, state >> np.uint64(32))
    return lobe * RESOLUTION, u * RESOLUTION, v * RESOLUTION
