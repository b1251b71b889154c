"""Placements: where copies go, and what a similarity does to a path."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from renderer.biarc import ends
from renderer.repeats import PLACEMENT, concentric, grid, linear, place, place_all, scatter, splitmix64
from renderer.tables import SEGMENT, Chain

BOUNDS = (-1.0, 2.0, 3.0, 2.5)

# A line of length 2 along p, then a quarter circle of radius 0.5 to the left.
HOOK = np.array([(1, 0, 1, 0, 2, 0), (3, 0, 1, 0, math.pi / 4, 2)], SEGMENT)


def test_a_row() -> None:
    rows = linear(3, (0.5, -2))
    assert rows.tolist() == [(0, 0, 0, 1), (0.5, -2, 0, 1), (1, -4, 0, 1)]
    assert len(linear(0, (1, 1))) == 0


def test_a_grid() -> None:
    rows = grid((2, 3), ((10, 1), (0, 5)))
    assert rows["dp"].tolist() == [0, 0, 0, 10, 10, 10]
    assert rows["dq"].tolist() == [0, 5, 10, 1, 6, 11]


def test_concentric_circles() -> None:
    assert concentric(4, 0.5, 1).tolist() == [1, 1.5, 2, 2.5]
    with pytest.raises(ValueError, match="expected radii above 0, found 0"):
        concentric(3, -0.5, 1)


def test_negative_counts_are_refused() -> None:
    with pytest.raises(ValueError, match="expected a count of 0 or more, found -1"):
        linear(-1, (1, 1))
    with pytest.raises(ValueError, match="found -2"):
        grid((-2, -3), ((1, 0), (0, 1)))


def test_splitmix64_is_the_published_generator() -> None:
    # The outputs for the seed 1234567 that Rosetta Code's task "Pseudo-random numbers/Splitmix64" asks for.
    assert splitmix64(np.array([1234567], np.uint64), 5).tolist() == [
        6457827717110365317,
        3203168211198807973,
        9817491932198370423,
        4593380528125082431,
        16408922859458223821,
    ]


def mixed(z: int) -> int:
    """splitmix64's finish, in Python's whole numbers."""
    z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9 % 2**64
    z = (z ^ (z >> 27)) * 0x94D049BB133111EB % 2**64
    return z ^ (z >> 31)


@given(st.integers(0, 2**64 - 1))
def test_scatter_is_what_whole_numbers_give(seed: int) -> None:
    rows = scatter(3, seed, BOUNDS, (-90, 180), (0.5, 2))
    state = mixed(seed)
    numbers = [(mixed((state + n * 0x9E3779B97F4A7C15) % 2**64) >> 11) / 2**53 for n in range(1, 13)]
    for row, (a, b, c, d) in zip(rows, np.reshape(numbers, (3, 4)), strict=True):
        assert row["dp"] == -1 + a * 4
        assert row["dq"] == 2 + b * 0.5
        assert row["angle"] == (-90 + c * 270) * (math.pi / 180)
        assert row["scale"] == 0.5 + d * 1.5


def test_scatter_stays_as_it_is() -> None:
    rows = scatter(2, 1, (0, 0, 1, 1), (0, 360), (1, 2))
    assert [float(value).hex() for value in rows[0].tolist()] == [
        "0x1.7fdf0061bb85ap-1",
        "0x1.7d54b3920bcaap-2",
        "0x1.607d2418c85cdp+1",
        "0x1.f440fe3b62c7ap+0",
    ]


def test_more_copies_leave_the_first_as_they_are() -> None:
    few, many = (scatter(count, 7, BOUNDS, (0, 360), (1, 3)) for count in (10, 1000))
    assert few.tolist() == many[:10].tolist()


def test_scatter_keeps_its_bounds() -> None:
    rows = scatter(5000, 3, BOUNDS, (30, 60), (0.25, 0.5))
    for name, low, high in (("dp", -1, 3), ("dq", 2, 2.5), ("scale", 0.25, 0.5)):
        assert low <= rows[name].min() < rows[name].max() <= high
    assert math.radians(30) <= rows["angle"].min() < rows["angle"].max() <= math.radians(60)
    assert set(scatter(9, 3, (4, 5, 4, 5), (0, 0), (1, 1)).tolist()) == {(4, 5, 0, 1)}


@pytest.mark.parametrize("seed", [0, 1, 2, 12345, 2**64 - 1])
def test_scatter_is_uniform(seed: int) -> None:
    count, bins = 20_000, 20
    rows = scatter(count, seed, (0, 0, 1, 1), (0, 360), (1, 2))
    expected = count / bins**2
    unit = {"dp": rows["dp"], "dq": rows["dq"], "angle": rows["angle"] / (2 * math.pi), "scale": rows["scale"] - 1}
    # Pairs of columns, and each column with its neighbour's: chi-square of 399 degrees of freedom; mean 399, standard
    # deviation sqrt(2 * 399) = 28. Five of those either way.
    pairs = [(unit[a], unit[b]) for a, b in (("dp", "dq"), ("dq", "angle"), ("angle", "scale"), ("scale", "dp"))]
    pairs += [(values[:-1], values[1:]) for values in unit.values()]
    for a, b in pairs:
        counts = np.histogram2d(a, b, bins, ((0, 1), (0, 1)))[0]
        assert abs(((counts - expected) ** 2 / expected).sum() - 399) < 5 * 28.3


def test_neighbouring_seeds_have_nothing_in_common() -> None:
    numbers = [scatter(2000, seed, (0, 0, 1, 1), (0, 0), (1, 1))["dp"] for seed in range(10)]
    correlation = np.corrcoef(numbers) - np.eye(10)
    assert np.abs(correlation).max() < 5 / math.sqrt(2000)
    assert len(np.unique(numbers)) == 20_000


@pytest.mark.parametrize(
    ("bounds", "angle", "scale", "message"),
    [
        ((1, 0, 0, 1), (0, 1), (1, 1), "p bounds that run upwards, found 1 to 0"),
        ((0, 1, 1, 0), (0, 1), (1, 1), "q bounds"),
        ((0, 0, 1, 1), (1, 0), (1, 1), "angles"),
        ((0, 0, 1, 1), (0, 1), (2, 1), "scales that run upwards"),
        ((0, 0, 1, 1), (0, 1), (0, 1), "scales above 0"),
        ((0, 0, math.nan, 1), (0, 1), (1, 1), "p bounds"),
    ],
)
def test_bad_ranges_are_refused(
    bounds: tuple[float, float, float, float], angle: tuple[float, float], scale: tuple[float, float], message: str
) -> None:
    with pytest.raises(ValueError, match=message):
        scatter(1, 0, bounds, angle, scale)


def test_a_placement_turns_then_scales_then_moves() -> None:
    placed = place(Chain(HOOK, closed=False), np.array([(10, 20, math.pi / 2, 3)], PLACEMENT)[0])
    assert placed.closed is False
    assert placed.segments.tolist() == [
        pytest.approx((10, 23, 0, 1, 6, 0)),
        pytest.approx((10, 29, 0, 1, 3 * math.pi / 4, 2 / 3)),
    ]
    assert place(Chain(HOOK, closed=True), linear(1, (0, 0))[0]).closed is True


similar = st.tuples(st.floats(-5, 5), st.floats(-5, 5), st.floats(-7, 7), st.floats(0.1, 10))


@given(st.lists(similar, min_size=1, max_size=4))
def test_ends_go_where_the_similarity_takes_them(placements: list[tuple[float, float, float, float]]) -> None:
    placed = place_all(HOOK, np.array(placements, PLACEMENT))
    assert placed.shape == (2 * len(placements),)
    points, tangents = ends(HOOK)
    for index, (dp, dq, angle, scale) in enumerate(placements):
        turn = complex(math.cos(angle), math.sin(angle))
        for row in range(2):
            point, tangent = ends(placed[2 * index + row : 2 * index + row + 1])
            moved = complex(*points[row]) * turn * scale + complex(dp, dq)
            assert complex(*point[0]) == pytest.approx(moved, abs=1e-12)
            assert complex(*tangent[0]) == pytest.approx(complex(*tangents[row]) * turn, abs=1e-12)
    # Turns of an arc are kept, lengths scaled.
    assert placed["length"] * placed["curvature"] == pytest.approx(np.tile([0, math.pi / 2], len(placements)))
    assert placed["length"][::2] == pytest.approx([2 * placement[3] for placement in placements])


def test_no_placement_no_path() -> None:
    assert len(place_all(HOOK, linear(0, (1, 1)))) == 0
    assert place_all(HOOK, linear(1, (1, 1))).tolist() == HOOK.tolist()
