"""Numbers that look random and depend on the place alone: the same for any tile, thread and machine."""

from __future__ import annotations

import math

import numpy as np

from renderer.kernel import leaf


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
def strewn(i: int, seed: int, x: float, y: float) -> tuple[float, float, float]:
    """The i-th of points that fill the unit cube evenly, the first n for every n (Roberts 2018, the sequence R3), moved
    at random for each place (x, y)."""
    state, a = jitter(seed_of(seed, x, y))
    state, b = jitter(state)
    state, c = jitter(state)
    a, b, c = a + 0.8191725133961645 * i, b + 0.6710436067037893 * i, c + 0.5497004779019703 * i
    return a - math.floor(a), b - math.floor(b), c - math.floor(c)


@leaf
def drawn(i: int, step: int, seed: int, x: float, y: float) -> tuple[float, float, float]:
    """A point of the unit cube at random, another one for each step of each path i at each place (x, y)."""
    state = mix(seed_of(seed, x, y) + np.uint64(i) * np.uint64(0xD1342543DE82EF95) + np.uint64(step))
    state, a = jitter(state)
    state, b = jitter(state)
    state, c = jitter(state)
    return a, b, c
