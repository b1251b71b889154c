"""Points that paths go by: even over a place's paths for every step, and of no two steps alike."""

from __future__ import annotations

import numpy as np
import pytest

from renderer.geometry.random import drawn
from renderer.tables import Floats
from tests.renderer.parts import alone

PLACES = 400


def points(step: int, paths: int) -> Floats:
    """Those of a step of all places and paths: (PLACES, paths, 3)."""
    draw = alone(drawn)
    return np.array(
        [[draw(i, step, 7, place % 20 + 0.5, place // 20) for i in range(paths)] for place in range(PLACES)]
    )


@pytest.mark.parametrize(("across", "down"), [(64, 1), (16, 4), (8, 8), (2, 32)])
def test_every_box_of_a_grid_has_a_point(across: int, down: int) -> None:
    """Of 64 points, one in each of 64 equal boxes, as a (0, 2)-sequence has it; in every slice of the lobes one too."""
    of_places = points(2, 64)[:40]
    for lobe, u, v in of_places.transpose(0, 2, 1):
        assert len(set((u * across).astype(int) * down + (v * down).astype(int))) == 64
        assert len(set((lobe * 64).astype(int))) == 64


@pytest.mark.parametrize("paths", [16, 64])
def test_each_step_sees_half_of_what_is_around_in_half_of_the_paths(paths: int) -> None:
    """What is lit up to an edge across the cube: at random its part errs by sqrt(1/4 / n)."""
    at_random = np.sqrt(0.25 / paths)
    for step in (0, 1, 5):
        lit = (points(step, paths) @ (0.0, 1.0, 1.0) < 1.0).mean(axis=1)
        assert np.sqrt(((lit - 0.5) ** 2).mean()) < 0.6 * at_random
        assert abs(lit.mean() - 0.5) < 4.0 * at_random / np.sqrt(PLACES)


@pytest.mark.parametrize(("first", "second"), [(0, 1), (0, 3), (1, 2), (4, 5)])
def test_where_a_path_goes_says_nothing_of_its_next_step(first: int, second: int) -> None:
    """Half of those that go left in one step go left in the next: a quarter of all, as far as chance has it."""
    a, b = points(first, 64) < 0.5, points(second, 64) < 0.5
    for axis in range(3):
        for other in range(3):
            both = (a[..., axis] & b[..., other]).mean(axis=1)
            assert abs(both.mean() - 0.25) < 4.0 * np.sqrt(0.25 * 0.75 / 64 / PLACES)
            assert np.sqrt(((both - 0.25) ** 2).mean()) < np.sqrt(0.25 * 0.75 / 64)  # no worse than at random
