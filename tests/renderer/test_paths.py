"""Paths as chains of lines and arcs: what is exact is exact, what is not stays within the tolerance."""

from __future__ import annotations

import itertools
import math

import numpy as np
import pytest
import svgelements
from hypothesis import example, given, settings
from hypothesis import strategies as st

from renderer.biarc import LARGEST_ARC, at, distance, ends
from renderer.paths import MITRE_LIMIT, circle, polyline, spiral, svg
from renderer.tables import Chain, Floats

numbers = st.floats(-10, 10).map(lambda value: round(value, 3))
points = st.tuples(numbers, numbers)
tolerances = st.sampled_from([1e-1, 1e-2, 1e-3, 1e-5])


def length(chain: Chain) -> float:
    """The arc length of a chain, pattern units."""
    return math.fsum(chain.segments["length"])


def points_on(chain: Chain, spacing: float) -> Floats:
    """Points (n, 2) along a chain, at most `spacing` apart, the ends of all segments among them."""
    points = [np.array([[chain.segments["x"][0], chain.segments["y"][0]]])]
    for segment in chain.segments:
        count = max(1, math.ceil(segment["length"] / spacing))
        points.append(at(np.full(count, segment), segment["length"] * np.arange(1, count + 1) / count)[0])
    return np.concatenate(points)


# -- chains -----------------------------------------------------------------------------------------------------


def corners(chain: Chain) -> list[tuple[float, float]]:
    """The start points of a chain's segments and, where it is open, its end."""
    result = [(float(segment["x"]), float(segment["y"])) for segment in chain.segments]
    return result if chain.closed else [*result, tuple(ends(chain.segments[-1:])[0][0].tolist())]


def turns(chain: Chain) -> Floats:
    """The angles (radians) by which a chain turns at its joints; the last is that of the closing joint."""
    leaving = ends(chain.segments)[1]
    x, y = np.roll(chain.segments["tx"], -1), np.roll(chain.segments["ty"], -1)
    angles = np.arctan2(leaving[:, 0] * y - leaving[:, 1] * x, leaving[:, 0] * x + leaving[:, 1] * y)
    return np.asarray(angles if chain.closed else angles[:-1])


def check(chains: list[Chain]) -> None:
    """What holds for all chains: see renderer.tables."""
    for chain in chains:
        segments = chain.segments
        assert len(segments) >= 1
        assert (segments["length"] > 0).all()
        assert np.hypot(segments["tx"], segments["ty"]) == pytest.approx(1, abs=1e-12)
        if len(segments) > 1 or not chain.closed:
            assert (np.abs(segments["length"] * segments["curvature"]) <= LARGEST_ARC + 1e-9).all()
        finish = ends(segments)[0]
        scale = max(1.0, np.abs(finish).max())
        starts = np.stack([segments["x"], segments["y"]], axis=1)
        following = np.roll(starts, -1, axis=0) if chain.closed else starts[1:]
        assert np.abs(following - finish[: len(following)]).max(initial=0) <= 1e-12 * scale
        assert (np.abs(np.tan(turns(chain) / 2)) <= MITRE_LIMIT * (1 + 1e-9)).all()


def off(chains: list[Chain], samples: Floats) -> float:
    """The largest distance of the samples (n, 2) from the chains."""
    segments = np.concatenate([chain.segments for chain in chains])
    parts = np.array_split(samples, math.ceil(len(samples) * len(segments) / 100_000))
    return float(max(distance(segments[:, None], part).min(axis=0).max() for part in parts))


def hausdorff(chains: list[Chain], control: list[tuple[float, float]], count: int) -> float:
    """The Hausdorff distance between chains and a Bézier, measured from `count` points of either."""
    drawn = np.concatenate([points_on(chain, sum(map(length, chains)) / count) for chain in chains])
    coarse = np.linspace(0, 1, count)
    samples = bezier(control, coarse)
    back = 0.0
    for point in drawn:  # the nearest point of the lines between far denser samples, about each nearest one
        apart = np.pad(((samples - point) ** 2).sum(axis=1), 1, constant_values=np.inf)
        near = coarse[(apart[1:-1] <= apart[:-2]) & (apart[1:-1] <= apart[2:])]
        windows = [np.linspace(max(u - 2 / count, 0), min(u + 2 / count, 1), 101) for u in near]
        a = bezier(control, np.concatenate(windows)).reshape(len(near), 101, 2)
        a, v = a[:, :-1], np.diff(a, axis=1)
        along = np.clip(((point - a) * v).sum(axis=2) / np.maximum((v**2).sum(axis=2), 1e-300), 0, 1)
        back = max(back, float(np.linalg.norm(a + along[..., None] * v - point, axis=2).min()))
    return max(back, off(chains, samples))


def bezier(control: list[tuple[float, float]], u: Floats) -> Floats:
    p = [np.array(point, float)[None] for point in control]
    while len(p) > 1:
        p = [(1 - u[:, None]) * a + u[:, None] * b for a, b in itertools.pairwise(p)]
    return p[0]


# -- polylines ---------------------------------------------------------------------------------------------------


def test_a_polyline_keeps_its_corners() -> None:
    (chain,) = polyline([(0, 0), (3, 0), (3, 4), (6, 8)], closed=False)
    assert corners(chain) == [(0, 0), (3, 0), (3, 4), pytest.approx((6, 8))]
    assert chain.segments["length"].tolist() == [3, 4, 5]
    assert chain.segments["tx"].tolist() == [1, 0, 0.6]
    assert not chain.segments["curvature"].any()
    assert not chain.closed
    assert length(chain) == 12


def test_repeated_points_are_dropped_and_collinear_ones_kept() -> None:
    (chain,) = polyline([(0, 0), (0, 0), (1, 0), (2, 0), (2, 0), (2, 0)], closed=False)
    assert corners(chain) == [(0, 0), (1, 0), (2, 0)]


@pytest.mark.parametrize("again", [[], [(0, 0)], [(0, 0), (0, 0)]])
def test_a_closed_polyline_joins_its_last_point_to_its_first(again: list[tuple[float, float]]) -> None:
    (chain,) = polyline([(0, 0), (3, 0), (3, 4), *again], closed=True)
    assert chain.closed
    assert chain.segments["length"].tolist() == [3, 4, 5]
    check([chain])


@pytest.mark.parametrize("closed", [True, False])
@pytest.mark.parametrize("points", [[], [(1, 2)], [(1, 2), (1, 2)]])
def test_no_length_no_chain(points: list[tuple[float, float]], closed: bool) -> None:
    assert polyline(points, closed) == []


def test_a_reversal_splits() -> None:
    first, second = polyline([(0, 0), (1, 0), (2, 0), (1, 0), (1, 1)], closed=False)
    assert corners(first) == [(0, 0), (1, 0), (2, 0)]
    assert corners(second) == [(2, 0), (1, 0), (1, 1)]


def test_there_and_back_makes_two_open_chains() -> None:
    there, back = polyline([(0, 0), (2, 1)], closed=True)
    assert not there.closed
    assert not back.closed
    assert {corners(there)[0], corners(back)[0]} == {(0, 0), (2, 1)}


@pytest.mark.parametrize("at_start", [0, 1, 2, 3])
def test_a_closed_path_with_one_sharp_corner_opens_there(at_start: int) -> None:
    # A sliver: its tip at (0, 0) turns by 180 degrees - 2 atan(0.01), beyond the limit; the other two are blunt.
    sliver = [(0.0, 0.0), (10.0, -0.1), (10.0, 0.0), (10.0, 0.1)]
    (chain,) = polyline(sliver[at_start:] + sliver[:at_start], closed=True)
    assert not chain.closed
    assert corners(chain) == [(0, 0), (10, -0.1), (10, 0), (10, 0.1), pytest.approx((0, 0), abs=1e-12)]


@pytest.mark.parametrize(("excess", "chains"), [(-1e-6, 1), (1e-6, 2)])
@pytest.mark.parametrize("sense", [1, -1])
def test_the_limit_on_corners(excess: float, chains: int, sense: int) -> None:
    turn = 2 * math.atan(MITRE_LIMIT) + excess
    assert math.degrees(2 * math.atan(MITRE_LIMIT)) == pytest.approx(168.6, abs=0.05)
    points = [(-1.0, 0.0), (0.0, 0.0), (math.cos(turn), sense * math.sin(turn))]
    assert len(polyline(points, closed=False)) == chains


@given(st.lists(points, max_size=12), st.booleans())
def test_chains_of_any_polyline_hold_together(corner: list[tuple[float, float]], closed: bool) -> None:
    chains = polyline(corner, closed)
    check(chains)
    pairs = list(itertools.pairwise([*corner, *corner[:1]] if closed else corner))
    total = sum(math.dist(a, b) for a, b in pairs)
    assert sum(length(chain) for chain in chains) == pytest.approx(total)


@pytest.mark.parametrize("bad", [math.nan, math.inf, 1e200])
def test_numbers_that_are_none_are_refused(bad: float) -> None:
    with pytest.raises(ValueError, match="expected finite numbers within 1e\\+09 of zero"):
        polyline([(0, 0), (1, bad)], closed=False)


# -- circles and spirals -----------------------------------------------------------------------------------------


def test_a_circle_is_one_arc() -> None:
    (chain,) = circle((1, 2), 0.5)
    assert chain.closed
    assert chain.segments.tolist() == [(1.5, 2, 0, 1, pytest.approx(math.pi), 2)]
    on_it = points_on(chain, 0.01) - [1, 2]
    assert np.hypot(*on_it.T) == pytest.approx(0.5)
    assert on_it[len(on_it) // 4] == pytest.approx([0, 0.5], abs=0.01)  # counter-clockwise
    with pytest.raises(ValueError, match="expected a radius above 0, found 0"):
        circle((0, 0), 0)


def spiral_length(inner: float, outer: float, turns: float) -> float:
    """The closed form of an Archimedean spiral's length (r = b t: b / 2 (t sqrt(1 + t^2) + asinh t))."""
    b = (outer - inner) / (2 * math.pi * turns)
    first, last = (r / b * math.sqrt(1 + (r / b) ** 2) + math.asinh(r / b) for r in (inner, outer))
    return b / 2 * (last - first)


def spiral_points(inner: float, outer: float, turns: float, angle: float, count: int) -> Floats:
    u = np.linspace(0, 1, count)
    theta, radius = math.radians(angle) + 2 * math.pi * turns * u, inner + (outer - inner) * u
    return np.stack([radius * np.cos(theta), radius * np.sin(theta)], axis=1)


SPIRALS = [
    (60.0, 146.0, 10.0, 0.0, 1e-3),
    (0.0, 1.0, 5.0, 30.0, 1e-3),
    (0.0, 1.0, 0.001, 0.0, 1e-4),
    (0.5, 3.0, -4.0, 90.0, 1e-6),
    (1.0, 146.0, 1.0, -45.0, 1e-2),
    (0.0, 1.0, 3.0, 0.0, 10.0),
    (1.0, 1.0, 2.3, 10.0, 1e-3),
    (1.0, 1.0 + 1e-9, 2.3, 10.0, 1e-3),
]


@pytest.mark.parametrize(("inner", "outer", "turns", "angle", "tolerance"), SPIRALS)
def test_a_spiral_stays_within_the_tolerance(
    inner: float, outer: float, turns: float, angle: float, tolerance: float
) -> None:
    chains = spiral((0, 0), inner, outer, turns, angle, tolerance)
    (chain,) = chains
    check(chains)
    assert np.abs(turns_of_joints := turns_at(chain)).max(initial=0) < 1e-12, turns_of_joints
    samples = spiral_points(inner, outer, turns, angle, 4001)
    assert off(chains, samples) <= tolerance
    assert corners(chain)[0] == pytest.approx(samples[0].tolist(), abs=1e-12)
    assert corners(chain)[-1] == pytest.approx(samples[-1].tolist(), abs=1e-10)
    if tolerance < 1:
        assert length(chain) == pytest.approx(
            spiral_length(inner, outer, abs(turns)) if outer > inner + 1e-6 else 2 * math.pi * abs(turns), rel=1e-3
        )
    bend = np.sign(chain.segments["curvature"])
    assert set(bend[np.abs(chain.segments["curvature"]) > 1e-9]) <= {math.copysign(1, turns)}


turns_at = turns


@settings(max_examples=50, deadline=None)
@given(st.floats(0, 5), st.floats(0.01, 5), st.floats(-10, 10), st.sampled_from([1e-2, 1e-4]))
def test_any_spiral_stays_within_the_tolerance(inner: float, width: float, turns: float, tolerance: float) -> None:
    if abs(turns) < 1e-3:
        return
    chains = spiral((0, 0), inner, inner + width, turns, 20, tolerance)
    check(chains)
    assert len(chains) == 1
    assert np.abs(turns_at(chains[0])).max(initial=0) < 1e-12
    assert off(chains, spiral_points(inner, inner + width, turns, 20, 1501)) <= tolerance
    # A curve moved aside by d changes its length by d times what it turns: the turns, and at most half a turn more
    # from the direction of the radius at the inner end.
    turned = 2 * math.pi * abs(turns) + math.pi
    expected = spiral_length(inner, inner + width, abs(turns))
    assert length(chains[0]) == pytest.approx(expected, rel=1e-5, abs=tolerance * turned)


def test_a_spiral_about_another_centre_is_moved() -> None:
    (here,), (there,) = spiral((0, 0), 1, 2, 3, 0, 1e-3), spiral((5, -7), 1, 2, 3, 0, 1e-3)
    assert there.segments["x"] == pytest.approx(here.segments["x"] + 5)
    assert there.segments["y"] == pytest.approx(here.segments["y"] - 7)
    assert there.segments["length"] == pytest.approx(here.segments["length"])


def test_a_spiral_needs_few_arcs() -> None:
    # A biarc of the angle phi deviates by b phi^3 / 324 where the radius is large against its growth b: here the
    # number of biarcs is 2 pi 100 (b / 324 / tolerance)^(1/3). The bound leaves 5 % for what is kept in reserve.
    b, tolerance = 86 / (2 * math.pi * 100), 1e-3
    (chain,) = spiral((0, 0), 60, 146, 100, 0, tolerance)
    assert len(chain.segments) / 2 <= 1.08 * 2 * math.pi * 100 * (b / 324 / tolerance) ** (1 / 3)
    # A tolerance that no longer matters: arcs of about 120 degrees. Circles: exactly so.
    assert len(spiral((0, 0), 10, 10.01, 10, 0, 1)[0].segments) <= 32
    assert len(spiral((0, 0), 1, 1, 2, 0, 1e-9)[0].segments) == 6


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ((0, 0, 1), "expected radii 0 <= inner <= outer, outer > 0, found 0 and 0"),
        ((2, 1, 1), "found 2 and 1"),
        ((-1, 1, 1), "found -1 and 1"),
        ((0, 1, 0), "expected a number of turns other than 0"),
        ((0, 1, math.nan), "expected finite numbers"),
    ],
)
def test_bad_spirals_are_refused(arguments: tuple[float, float, float], message: str) -> None:
    with pytest.raises(ValueError, match=message):
        spiral((0, 0), *arguments, 0, 1e-3)


def test_a_spiral_of_too_many_arcs_is_refused_with_their_number() -> None:
    with pytest.raises(ValueError, match=r"at most 200000 arcs, found one of about 2\d{9}$"):
        spiral((0, 0), 0, 1000, 1e8, 0, 1e-9)
    with pytest.raises(ValueError, match=r"at most 200000 arcs, found one of about 3000000$"):
        spiral((0, 0), 1, 1, 1e6, 0, 1e-9)
    with pytest.raises(ValueError, match="expected a tolerance above 0"):
        spiral((0, 0), 0, 1, 1, 0, 0)


# -- SVG path data -----------------------------------------------------------------------------------------------

COMMANDS = {
    "lines": "M 1 2 L 3 4 l 1 -2 H 7 h -1 V 5 v 2",
    "implicit lines": "M 0 0 1 0 1 1 m 2 2 1 0 0 1",
    "cubics": "M0 0 C 1 2 3 2 4 0 S 7 -2 8 0 c 1 2 3 2 4 0 s 3 -2 4 0",
    "quadratics": "M0 0 Q 1 2 2 0 T 4 0 T 6 1 q 1 2 2 0 t 2 1",
    "circular arcs": "M0 0 A 2 2 0 0 1 2 2 A 2 2 0 1 1 4 0 a 1 1 0 0 0 2 0 a 1 1 0 1 0 -1 1",
    "elliptical arcs": "M0 0 A 3 1 30 0 1 2 2 A 3 1 30 1 1 4 0 a 1 2 -20 0 0 2 0 a 1 2.5 70 1 0 -1 1",
    "arcs too small": "M0 0 A 1 1 0 0 1 4 0 A 1 0.5 20 0 1 6 3",
    "subpaths": "M0 0 L 1 0 L 1 1 Z M 3 3 C 4 3 4 4 3 4 z m 1 1 l 1 0 z l -1 -1",
    "tight spelling": "M0,0l1-1.5.5.5L3-1e0C3-2,4-2 4-1a1 1 0 012 0",
}


def sampled(d: str, count: int) -> list[Floats]:
    """Points (n, 2) of each segment that draws, by svgelements' own reckoning."""
    path = svgelements.Path(d)
    return [
        np.array([(p.x, p.y) for p in (segment.point(float(u)) for u in np.linspace(0, 1, count))])
        for segment in path
        if not isinstance(segment, svgelements.Move)
    ]


@pytest.mark.parametrize("flip", [False, True])
@pytest.mark.parametrize("tolerance", [1e-2, 1e-5])
@pytest.mark.parametrize("d", COMMANDS.values(), ids=COMMANDS.keys())
def test_all_commands_draw_what_svgelements_says(d: str, tolerance: float, flip: bool) -> None:
    chains = svg(d, flip, tolerance)
    check(chains)
    samples = sampled(d, 801)
    if flip:
        samples = [points * [1, -1] for points in samples]
    assert off(chains, np.concatenate(samples)[::7]) <= tolerance * (1 + 1e-9) + 1e-9
    drawn = sum(float(np.hypot(*np.diff(points, axis=0).T).sum()) for points in samples)
    assert sum(length(chain) for chain in chains) == pytest.approx(drawn, rel=1e-3)


def test_lines_and_subpaths_are_exact() -> None:
    triangle, open_line, on = svg("M0 0 L 3 0 V 4 Z M 5 5 h 2 m 1 1 M 0 9 z m 1 1 l 1 0", False, 1e-3)
    assert triangle.closed
    assert corners(triangle) == [(0, 0), (3, 0), (3, 4)]
    assert not open_line.closed
    assert corners(open_line) == [(5, 5), (7, 5)]
    assert corners(on) == [(1, 10), (2, 10)]


def test_after_a_close_the_next_subpath_begins_at_its_start() -> None:
    square, line = svg("M1 1 h1 v1 h-1 z l -1 0", False, 1e-3)
    assert square.closed
    assert len(square.segments) == 4
    assert corners(line) == [(1, 1), (0, 1)]


def test_a_path_that_returns_without_a_close_stays_open() -> None:
    (chain,) = svg("M0 0 L1 0 L1 1 L0 0", False, 1e-3)
    assert not chain.closed
    assert len(chain.segments) == 3


def test_rounding_leaves_no_closing_line() -> None:
    (chain,) = svg("M0.1 0.2 l 0.1 0 l 0.1 0.3 l -0.2 -0.3 z", False, 1e-3)
    assert 0.1 + 0.1 + 0.1 - 0.2 != 0.1
    assert chain.closed
    assert len(chain.segments) == 3
    check([chain])


def test_circular_arcs_are_exact() -> None:
    (chain,) = svg("M 5 1 A 2 2 0 0 1 1 1 A 2 2 0 0 1 5 1 Z", False, 1e-3)
    assert chain.closed
    assert len(chain.segments) == 4
    assert chain.segments["curvature"] == pytest.approx(0.5, rel=1e-14)
    assert chain.segments["length"] == pytest.approx(math.pi, rel=1e-14)
    assert np.abs(turns(chain)).max() < 1e-14
    (flipped,) = svg("M 5 1 A 2 2 0 0 1 1 1 A 2 2 0 0 1 5 1 Z", True, 1e-3)
    assert flipped.segments["curvature"] == pytest.approx(-0.5)
    assert (flipped.segments["y"] == -chain.segments["y"]).all()


@pytest.mark.parametrize(("large", "sweep", "turn"), [(0, 1, 90), (0, 0, -90), (1, 1, 270), (1, 0, -270)])
def test_flags_choose_the_arc(large: int, sweep: int, turn: float) -> None:
    (chain,) = svg(f"M 1 0 A 1 1 33 {large} {sweep} 0 1", False, 1e-9)
    assert np.degrees((chain.segments["curvature"] * chain.segments["length"]).sum()) == pytest.approx(turn)
    assert len(chain.segments) == math.ceil(abs(turn) / 120)
    assert ends(chain.segments)[0][-1] == pytest.approx([0, 1], abs=1e-14)


def test_a_nearly_whole_circle_by_one_arc() -> None:
    (chain,) = svg("M 0 0 A 1 1 0 1 0 1e-7 0 Z", False, 1e-3)
    assert chain.closed
    assert length(chain) == pytest.approx(2 * math.pi)


def test_radii_of_zero_draw_lines_and_negative_ones_lose_their_sign() -> None:
    assert svg("M0 0 A 0 1 0 0 1 3 4", False, 1e-3)[0].segments.tolist() == [(0, 0, 0.6, 0.8, 5, 0)]
    assert svg("M0 0 A 1 1 0 0 1 0 0", False, 1e-3) == []
    (plus,), (minus,) = (svg(f"M0 0 A {r} 1 0 0 1 2 1", False, 1e-3) for r in ("2", "-2"))
    assert minus.segments.tolist() == plus.segments.tolist()


def test_a_smooth_command_mirrors_its_own_kind_alone() -> None:
    # SVG 1.1, 8.3.6: after anything but C or S, the first control point of S is the current point; likewise T.
    for d, same in [
        ("M0 0 Q 1 2 2 0 S 3 1 4 0", "M0 0 Q 1 2 2 0 C 2 0 3 1 4 0"),
        ("M0 0 C 0 1 1 2 2 0 T 4 1 T 5 5", "M0 0 C 0 1 1 2 2 0 Q 2 0 4 1 Q 6 2 5 5"),
        ("M0 0 L 1 1 S 3 1 4 0", "M0 0 L 1 1 C 1 1 3 1 4 0"),
        ("M0 0 L 1 1 T 3 1 t 1 1", "M0 0 L 1 1 L 3 1 Q 5 1 4 2"),
    ]:
        left, right = svg(d, False, 1e-4), svg(same, False, 1e-4)
        assert [chain.segments.tolist() for chain in left] == [chain.segments.tolist() for chain in right]


@settings(max_examples=100, deadline=None)
@given(points, points, points, points, tolerances)
@example((0, 0), (1, 1), (0, 1), (1, 0), 1e-3)  # a cusp
@example((0, 0), (1.0001, 1), (0, 1), (1, 0), 1e-5)  # nearly
@example((0, 0), (0, 0), (1, 1), (2, 0), 1e-3)  # no speed at the ends
@example((0, 0), (0, 0), (2, 0), (2, 0), 1e-3)
@example((0, 0), (0, 0), (0, 0), (2, 1), 1e-3)
@example((0, 0), (3, 1), (3, 1), (0, 0), 1e-3)  # there and back
@example((0, 0), (4, 0), (-3, 0), (1, 0), 1e-3)  # back and forth on a line
@example((0, 0), (4, 1e-6), (-3, 0), (1, 0), 1e-3)  # nearly
@example((0, 0), (5, 5), (-5, 5), (0, 0), 1e-3)  # a loop
@example((0, 0), (0, 0), (0, 0), (0, 0), 1e-3)
@example((0, 0), (0.00001, 1), (1, 0.00001), (0, 0), 1e-1)
def test_any_cubic_stays_within_the_tolerance(
    p0: tuple[float, float],
    p1: tuple[float, float],
    p2: tuple[float, float],
    p3: tuple[float, float],
    tolerance: float,
) -> None:
    d = f"M{p0[0]} {p0[1]} C{p1[0]} {p1[1]} {p2[0]} {p2[1]} {p3[0]} {p3[1]}"
    chains = svg(d, False, tolerance)
    check(chains)
    if not chains:
        assert p0 == p1 == p2 == p3
        return
    assert hausdorff(chains, [p0, p1, p2, p3], 120) <= tolerance * (1 + 1e-3) + 1e-9
    assert corners(chains[0])[0] == pytest.approx(p0)
    assert corners(chains[-1])[-1] == pytest.approx(p3, abs=1e-9)
    assert sum(len(chain.segments) for chain in chains) < 500
    for chain in chains:
        assert np.abs(turns(chain)).max(initial=0) < 1e-11


@settings(max_examples=60, deadline=None)
@given(
    points,
    st.floats(0.1, 10).map(lambda value: round(value, 2)),
    st.floats(0.1, 10).map(lambda value: round(value, 2)),
    st.integers(-180, 180),
    st.booleans(),
    st.booleans(),
    st.sampled_from([1e-2, 1e-4]),
)
def test_any_elliptical_arc_stays_within_the_tolerance(
    end: tuple[float, float], rx: float, ry: float, rotation: int, large: bool, sweep: bool, tolerance: float
) -> None:
    if math.hypot(*end) < 0.01:
        return
    d = f"M0 0 A {rx} {ry} {rotation} {large:d} {sweep:d} {end[0]} {end[1]}"
    chains = svg(d, False, tolerance)
    check(chains)
    samples = sampled(d, 501)[0]
    assert off(chains, samples) <= tolerance + 1e-7
    assert sum(length(chain) for chain in chains) == pytest.approx(
        np.hypot(*np.diff(samples, axis=0).T).sum(), rel=0.02, abs=5 * tolerance
    )
    assert sum(len(chain.segments) for chain in chains) < 300


def test_a_cusp_splits_and_a_straight_curve_is_lines() -> None:
    first, second = svg("M0 0 C 1 1 0 1 1 0", False, 1e-3)  # speed 0 at u = 1/2, at (0.5, 0.75)
    assert corners(first)[-1] == pytest.approx((0.5, 0.75))
    assert corners(second)[0] == pytest.approx((0.5, 0.75))
    assert ends(first.segments[-1:])[1][0] == pytest.approx([0, 1], abs=1e-9)
    assert [float(second.segments[0][name]) for name in ("tx", "ty")] == pytest.approx([0, -1], abs=1e-9)

    assert svg("M0 0 C 1 0 2 0 5 0", False, 1e-3)[0].segments.tolist() == [(0, 0, 1, 0, 5, 0)]
    # x = 3 u (1 - u)^2 4 - 3 u^2 (1 - u) 3 + u^3: forth, back and forth.
    u = np.roots([66, -66, 12])
    high, low = np.sort(12 * u * (1 - u) ** 2 - 9 * u * u * (1 - u) + u**3)[::-1]
    parts = svg("M0 0 C 4 0 -3 0 1 0", False, 1e-3)
    assert [corners(part)[0][0] for part in parts] == pytest.approx([0, high, low])
    assert corners(parts[-1])[-1] == pytest.approx((1, 0))


def test_a_curve_needs_few_arcs() -> None:
    # A quarter of a circle by the usual cubic is off by 2.7e-4 radii: one biarc, and no more, meets 1e-3.
    assert len(svg("M 1 0 C 1 0.5523 0.5523 1 0 1", False, 1e-3)[0].segments) == 2
    assert len(svg("M0 0 C 1 0 1 1 2 1", False, 1e-3)[0].segments) <= 12
    assert len(svg("M0 0 C 1 0 2 1 3 0", False, 100)[0].segments) == 2


@pytest.mark.parametrize("d", ["M0 0 C 5 5 -5 5 0 0", "M0 0 C 1e-9 0 1e-9 1e-9 0 1e-9", "M0 0 A 2 1 30 1 0 1 1"])
def test_the_coarsest_tolerance_leaves_something(d: str) -> None:
    chains = svg(d, False, math.inf)
    check(chains)
    assert 1 <= sum(len(chain.segments) for chain in chains) <= 12


def test_smooth_joints_are_smooth_and_corners_stay() -> None:
    # 3 digits of 1/3 and 2/3 make a turn of 5e-4 at the joint, 5 digits one of 5e-6.
    coarse = svg("M0 0 C 0 1 1 2 2 2 C 3 2.0005 4 3 4 4", False, 1e-3)[0]
    assert np.abs(turns(coarse)).max() == pytest.approx(5e-4, rel=1e-3)
    fine = svg("M0 0 C 0 1 1 2 2 2 C 3 2.000005 4 3 4 4", False, 1e-3)[0]
    assert np.abs(turns(fine)).max() < 1e-12


def test_curves_take_the_tangents_of_lines_and_arcs() -> None:
    for d in (
        "M0 0 L 1 0 C 2 0.00001 3 1 3 2",
        "M0 0 C 1 0 2 1 3 1.00001 L 4 2.00002",
        "M0 0 L 1 0 A 1 1 0 0 1 1.99999 0.99999 L 2 2",
        "M0 0 A 1 1 0 0 1 1 1 A 2 2 0 0 1 -1.00001 3.00001 C -1.5 3 -2 3 -3 4",
    ):
        (chain,) = svg(d, False, 1e-3)
        check([chain])
        exact = np.concatenate(sampled(d, 301))
        assert off([chain], exact) <= 1e-3
        joint = np.abs(turns(chain))
        assert (joint[joint < 1e-4] < 1e-12).all()


def test_a_closed_curve_is_smooth_where_it_closes() -> None:
    (ring,) = svg("M 1 0 C 1 1.00001 -1 1 -1 0 C -1 -1 1.00001 -1 1 0 Z", False, 1e-3)
    assert ring.closed
    check([ring])
    assert np.abs(turns(ring)).max() < 1e-12


def test_lines_keep_the_slightest_corner() -> None:
    (chain,) = svg("M0 0 L 1 0 L 2 0.00001", False, 1e-3)
    assert len(chain.segments) == 2
    assert turns(chain)[0] == pytest.approx(1e-5)


@pytest.mark.parametrize(
    ("d", "message"),
    [
        ("L 1 1", "expected path data that begin with M or m, found 'L 1 1' at character 1"),
        ("z", "expected path data that begin with M or m"),
        ("M0 0 l 1 1 foo", "expected a path command, found 'foo' at character 12"),
        ("M0 0 L 1", "expected a number for L, found the end of the path data"),
        ("M0 0 Lz", "expected a number for L, found 'z' at character 7"),
        ("M0 0 H", "expected a number for H, found the end"),
        ("M0 0 V z", "expected a number for V, found 'z'"),
        ("M0 0 A 1 1 0 2 1 1 1", "expected 0 or 1 for A, found '2 1 1 1' at character 14"),
        ("M0 0 A", "expected a number for A, found the end"),
        ("M0 0 C 1 1 2 2 Z", "expected a number for C, found 'Z'"),
        ("M nan 0", "expected a number for M, found 'nan 0'"),
        ("M 1e400 0", "expected a number within 1e\\+09 of zero for M, found '1e400 0'"),
        ("M 0 0 1e9 0 l 1e9 0 l 1e9 0", "expected finite numbers within 1e\\+09"),
        ("M 0 0,,1 1", "expected a path command, found ',,1 1'"),
        ("M 0 0 z 5", "expected a path command, found '5'"),
    ],
)
def test_malformed_data_are_refused_with_their_place(d: str, message: str) -> None:
    with pytest.raises(ValueError, match=message):
        svg(d, False, 1e-3)


@pytest.mark.parametrize("d", ["", "   ", "M 1 1", "M 1 1 z", "M 1 1 L 1 1 M 2 2 C 2 2 2 2 2 2 z"])
def test_nothing_drawn_no_chain(d: str) -> None:
    assert svg(d, False, 1e-3) == []


def test_numbers_may_end_in_a_point() -> None:
    assert svg("M1. 2.L3.e0 2", False, 1e-3)[0].segments.tolist() == [(1, 2, 1, 0, 2, 0)]


@given(st.text("MmLlHhVvCcSsQqTtAaZz0123456789.-+eE, ", max_size=40))
def test_any_text_is_drawn_or_refused(text: str) -> None:
    try:
        chains = svg("M0 0" + text, False, 1e-2)
    except ValueError as error:
        chains = []
        message = str(error)
    else:
        message = "expected"
    assert "expected" in message
    check(chains)


def test_a_tolerance_is_needed() -> None:
    with pytest.raises(ValueError, match="expected a tolerance above 0, found 0"):
        svg("M0 0 L 1 1", False, 0)


def test_points_on_a_chain() -> None:
    (chain,) = svg("M0 0 h 2 a 1 1 0 0 1 1 1", False, 1e-3)
    on_it = points_on(chain, 0.1)
    assert on_it[0] == pytest.approx([0, 0])
    assert on_it[-1] == pytest.approx([3, 1])
    assert np.hypot(*np.diff(on_it, axis=0).T).max() <= 0.1 + 1e-12
    assert at(chain.segments[:1], np.array([0.5]))[0][0] == pytest.approx([0.5, 0])
