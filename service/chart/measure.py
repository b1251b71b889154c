"""From pictures to errors, without the reference's own noise.

Of K passes of the reference, each an unbiased picture T + n, let R be the mean, V the variance of one pass at a pixel;
of k pictures of a method, likewise, X and U. R's noise has the variance v = V/K, X's has u = U/k, and both are
measured. So

    bias^2     = mean((X - R)^2 - u - v)      over pixels and channels
    variance   = mean(U)
    RMSE^2     = bias^2 + variance            of one picture, expected over seeds

have no bias of their own: it is as if all pairs of passes had been taken, mean over i != j of (X - R_i)(X - R_j). What
remains is scatter. For normal noise the mean over N pixels of a term's noise part has the variance

    1/N^2 sum(4 d^2 (u + v) + 2 (u + v)^2 + 2 u^2 / (k - 1) + 2 v^2 / (K - 1)),   d = X's true error,

(channels taken as wholly dependent, which overstates it). With d = u = 0 it is what an error of nothing would scatter
by; its fourth root is the FLOOR of the measurement, an RMSE. An error below FIFTH times the floor is not a measurement
here: it is given as a bound.

Sums of squares v^2 are taken from the measured V, whose squares are too large by (K + 1) / (K - 1) on average.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from service.chart.record import Record

Floats = NDArray[np.float64]
Mask = NDArray[np.bool_]

FIFTH = 5.0  # the smallest error that is measured is so many times the floor
SIGMAS = 3.0  # standard errors added to what is given as a bound
EPSILON = 0.01  # MRSE divides by R^2 + EPSILON mean(R)^2


class Measured(NamedTuple):
    """An error: a value, or where the reference does not resolve it, a bound (value None)."""

    value: float | None
    at_most: float

    @property
    def least(self) -> float:
        """The value, or else the bound."""
        return self.at_most if self.value is None else self.value


class Errors(NamedTuple):
    """All of one setting; the root of MRSE is not taken. sigma: the root of the variance, None where it is unknown."""

    rmse: Measured
    bias: Measured | None
    sigma: float | None
    mrse: Measured


def floor(reference: Record, mask: Mask, weights: Floats | None = None) -> float:
    """The RMSE that an exact picture would scatter by: see above. Infinite where there are not two passes."""
    if reference.count < 2:
        return math.inf
    noise = _pixels(reference.variance / reference.count, mask, weights)
    square = 2.0 * reference.count / (reference.count + 1) * float(np.sum(noise**2))
    return float((square / len(noise) ** 2) ** 0.25)


def noise(reference: Record, mask: Mask) -> float:
    """The RMSE of the reference itself: the root of the mean of v."""
    if reference.count < 2:
        return math.inf
    return math.sqrt(float(np.mean(_pixels(reference.variance / reference.count, mask))))


def errors(picture: Record, reference: Record, mask: Mask, sampled: bool) -> Errors:
    """The errors over the pixels of `mask` (H, W). sampled: whether pictures differ from seed to seed."""
    base = reference.mean[mask].mean() if mask.any() else 0.0
    weights = 1.0 / (reference.mean**2 + EPSILON * base**2 + 1e-300)
    square, variance = _total(picture, reference, mask, None, sampled)
    relative, _ = _total(picture, reference, mask, weights, sampled)
    least = floor(reference, mask)
    known = not sampled or picture.count > 1
    return Errors(
        rmse=_root(square, least),
        bias=_root(_bias(picture, reference, mask, None, sampled), least) if known else None,
        sigma=math.sqrt(variance) if known else None,
        mrse=_value(relative, floor(reference, mask, weights)),
    )


class _Square(NamedTuple):
    """A mean square and its standard error."""

    mean: float
    error: float


def _bias(picture: Record, reference: Record, mask: Mask, weights: Floats | None, sampled: bool) -> _Square:
    count, passes = picture.count, reference.count
    if passes < 2:
        return _Square(math.inf, math.inf)
    # With one picture of a sampled method, u is not known: then this is its whole mean square.
    own = picture.variance / count if sampled and count > 1 else np.zeros_like(picture.mean)
    u = _pixels(own, mask, weights)
    v = _pixels(reference.variance / passes, mask, weights)
    z = _pixels((picture.mean - reference.mean) ** 2, mask, weights) - u - v
    # E[v_measured^2] = v^2 (K + 1) / (K - 1): 2 v^2 + 2 v^2 / (K - 1) of the truth is 2 K / (K + 1) of the measured.
    scatter = 4.0 * np.maximum(z, 0.0) * (u + v) + 4.0 * u * v + 2.0 * passes / (passes + 1) * v**2
    if sampled and count > 1:
        scatter += 2.0 * count / (count + 1) * u**2
    return _Square(float(np.mean(z)), math.sqrt(float(np.sum(scatter))) / len(z))


def _total(
    picture: Record, reference: Record, mask: Mask, weights: Floats | None, sampled: bool
) -> tuple[_Square, float]:
    """The mean square error of one picture, and the variance in it."""
    bias = _bias(picture, reference, mask, weights, sampled)
    if not sampled or picture.count < 2:
        return bias, 0.0
    each = _pixels(picture.variance, mask, weights)
    variance = float(np.mean(each))
    # The variance's own scatter: 2 U^2 / (k - 1) a pixel, U^2 as measured being (k + 1) / (k - 1) times too large.
    scatter = math.sqrt(2.0 / (picture.count + 1) * float(np.sum(each**2))) / len(each)
    return _Square(bias.mean + variance, math.hypot(bias.error, scatter)), variance


def _root(square: _Square, least: float) -> Measured:
    most = math.sqrt(max(square.mean, 0.0) + SIGMAS * square.error)
    value = math.sqrt(max(square.mean, 0.0))
    resolved = _resolved(value, square, least)
    return Measured(value if resolved else None, most)


def _value(square: _Square, least: float) -> Measured:
    resolved = _resolved(math.sqrt(max(square.mean, 0.0)), square, least)
    return Measured(square.mean if resolved else None, max(square.mean, 0.0) + SIGMAS * square.error)


def _resolved(root: float, square: _Square, least: float) -> bool:
    return math.isfinite(root) and root >= FIFTH * least and square.mean >= SIGMAS * square.error


def _pixels(values: Floats, mask: Mask, weights: Floats | None = None) -> Floats:
    """The mean over the channels, of the pixels in the mask (n,)."""
    chosen = values[mask] if weights is None else values[mask] * weights[mask]
    return np.asarray(chosen.mean(axis=1), np.float64)
