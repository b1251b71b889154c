"""HDR-FLIP (Andersson et al. 2021): what an eye sees of an error when it flips between two pictures."""

from __future__ import annotations

import math

import flip_evaluator
import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]

# The tone mapper's (ACES, fitted by Narkowicz) fraction (a x^2 + b x) / (c x^2 + d x + e), as HDR-FLIP takes it.
_A, _B, _C, _D, _E = 0.36 * 2.51, 0.6 * 0.03, 0.36 * 2.43, 0.6 * 0.59, 0.14
_SATURATED = 0.85  # the tone-mapped value that the brightest pixel of the shortest exposure gets
_LEAST = 1e-3  # stops between the first exposure and the last, at least: the library ends the process at none


def exposures(reference: Floats) -> tuple[float, float, int] | None:
    """First and last exposure, in stops, and how many: HDR-FLIP's own choice. None for a picture that is all black.

    Computed here as the library does because it ends the process where the picture is of one brightness.
    """
    luminance = np.clip(reference, 0.0, None) @ np.array([0.2126, 0.7152, 0.0722])
    top, middle = float(luminance.max()), float(np.median(luminance))
    if not top > 0.0:
        return None
    a, b, c = _A - _SATURATED * _C, _B - _SATURATED * _D, -_SATURATED * _E
    white = (-b + math.sqrt(b * b - 4.0 * a * c)) / (2.0 * a)
    start = math.log2(white / top)
    stop = max(math.log2(white / max(middle, 1e-4 * top)), start + _LEAST)
    return start, stop, max(2, math.ceil(stop - start))


def flip(reference: Floats, picture: Floats, stops: tuple[float, float, int]) -> NDArray[np.float32]:
    """The error map (H, W), 0 to 1, at the library's default viewing distance (67 pixels a degree)."""
    one, two = (np.ascontiguousarray(np.clip(image, 0.0, None), np.float32) for image in (reference, picture))
    settings = {"startExposure": stops[0], "stopExposure": stops[1], "numExposures": stops[2]}
    found, _, _ = flip_evaluator.evaluate(one, two, "HDR", False, False, False, settings)
    return np.asarray(found, np.float32)[:, :, 0]
