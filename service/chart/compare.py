"""Equal error: how much longer a sampled method takes to get as near to the truth as another one is."""

from __future__ import annotations

import itertools
import math
from collections.abc import Sequence
from typing import Literal, NamedTuple

import numpy as np

LAST = 3  # points of a curve that its law is taken from
FLAT = -0.1  # an error that falls no faster than samples to this power has come to its floor
FAR = 1000.0  # times the samples measured: what is said to be needed beyond that means nothing


class Point(NamedTuple):
    """One setting of a sampled method."""

    samples: int
    seconds: float
    rmse: float
    bias: float = 0.0  # where it is known to be more than nothing: no number of samples goes below it


class Equal(NamedTuple):
    """What a rival needs for an error. how: whether its curve was measured there. seconds, samples: None: never."""

    how: Literal["measured", "extrapolated", "already", "never"]
    samples: float | None
    seconds: float | None
    slope: float | None  # of the error over samples, in logarithms


def equal(curve: Sequence[Point], rmse: float) -> Equal:
    """What the rival with this curve needs for an RMSE; the curve has one point at least.

    Between two points, a power law through both. Beyond the last, one through the last LAST points, the seconds growing
    with the samples as between the last two. `already`: its cheapest setting is as good. `never`: its bias is larger,
    its error no longer falls, or it would need FAR times the samples.
    """
    points = sorted(curve)
    slope = _slope(points[-LAST:])
    if points[0].rmse <= rmse:
        return Equal("already", points[0].samples, points[0].seconds, slope)
    for before, after in itertools.pairwise(points):
        if after.rmse <= rmse < before.rmse:
            share = math.log(before.rmse / rmse) / math.log(before.rmse / after.rmse)
            samples = before.samples * (after.samples / before.samples) ** share
            return Equal("measured", samples, before.seconds * (after.seconds / before.seconds) ** share, slope)
    last = points[-1]
    now = _slope(points[-2:])
    if slope is None or now is None or max(slope, now) > FLAT or last.bias > rmse:
        return Equal("never", None, None, slope)
    offset = math.log(last.rmse) - slope * math.log(last.samples)
    samples = math.exp(min((math.log(rmse) - offset) / slope, math.log(2.0 * FAR * last.samples)))
    if samples > FAR * last.samples:
        return Equal("never", None, None, slope)
    before = points[-2]
    rate = max((last.seconds - before.seconds) / (last.samples - before.samples), 0.0)
    return Equal("extrapolated", samples, last.seconds + rate * (samples - last.samples), slope)


def _slope(points: Sequence[Point]) -> float | None:
    if len(points) < 2:
        return None
    samples, errors = np.log([p.samples for p in points]), np.log([p.rmse for p in points])
    return float(np.polyfit(samples, errors, 1)[0])
