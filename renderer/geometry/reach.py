"""How far around a footprint matters to parallel grooves, and the grooves that are laid out there."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from renderer.kernel import leaf

ASIDE, TURNED, SPUN = 0.15, 0.05, 0.1
"""What bending paths are worth, in parts of what facets differ by, in 95 % of pixels (measured): of how far they bend
away between a footprint and what is seen through it or shades that, in halves of their width; of the angle by which
they turn there; of that within the footprint, squared."""
CROOKED = 0.2  # so much of it is too much to be told


# A groove near the footprint.
NEAR = np.dtype(
    [
        ("piece", "i8"),
        ("start", "f8"), ("finish", "f8"),  # where its cross-section begins and ends along B, from the centre
        ("axis", "f8"),  # where its path lies
        ("turned", "f8"),  # -1: the path runs against T; else 1
        ("scale", "f8"),
        ("copies", "f8"),  # as many as it stands for; 0: it only hides others and shades them
        ("group", "i8"),  # grooves of one group share a cross-section, where repeats are folded
    ]
)  # fmt: skip


class Reach(NamedTuple):
    """The frame of parallel grooves at the footprint's centre, and how far around it matters; pattern units."""

    tx: float  # T; B is (-ty, tx)
    ty: float
    eye_t: float  # shift along T for a unit of height towards the eye
    low: float  # the footprint along B
    high: float
    length: float  # the farthest it gets from its centre along T, and how far it does on root mean square
    spread: float
    wide_low: float  # ... with what is seen through it, or shades that
    wide_high: float
    long_low: float  # the same along T
    long_high: float


@leaf
def aside_by(turn: float, past: float, half: float) -> float:
    """What paths are worth that bend by `turn` a unit of length, at most, so far past the footprint."""
    return ASIDE * turn * past * past / half + TURNED * turn * past
