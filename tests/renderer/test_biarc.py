"""Biarcs: what they join, and how near to a curve they stay."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from renderer.biarc import LARGEST_ARC, arc_over, at, biarc, deviation, distance, ends, fit, turned
from renderer.tables import SEGMENT, Floats

angles = st.floats(-1.5, 1.5)
coordinates = st.floats(-10, 10)


def direction(angle: float) -> Floats:
    return np.array([[math.cos(angle), math.sin(angle)]])


def sine(u: Floats) -> tuple[Floats, Floats]:
    """One wave of length 2 pi and height 2."""
    x = 2 * np.pi * u
    speed = np.stack([np.ones_like(x), np.cos(x)], axis=1)
    return np.stack([x, np.sin(x)], axis=1), speed / np.hypot(*speed.T)[:, None]


@given(coordinates, coordinates, st.floats(0.01, 10), st.floats(-3.1, 3.1), angles, angles)
def test_a_biarc_joins_points_and_tangents(x: float, y: float, d: float, chord: float, a: float, b: float) -> None:
    p0, t0, t1 = np.array([[x, y]]), direction(chord + a), direction(chord + b)
    p1 = p0 + d * direction(chord)
    arcs, half = biarc(p0, t0, p1, t1)
    (points, tangents), (first, second) = ends(arcs), (arcs[0, 0], arcs[0, 1])
    assert [first["x"], first["y"], first["tx"], first["ty"]] == [x, y, *t0[0]]
    assert points[0, 0] == pytest.approx([second["x"], second["y"]], abs=1e-12)
    assert tangents[0, 0] == pytest.approx([second["tx"], second["ty"]], abs=1e-14)
    assert points[0, 1] == pytest.approx(p1[0], abs=1e-12)
    assert tangents[0, 1] == pytest.approx(t1[0], abs=1e-12)
    assert half[0] == pytest.approx(np.abs(arcs["curvature"] * arcs["length"]).max() / 2, abs=1e-9)


def test_a_symmetric_biarc_is_one_circle() -> None:
    # A quarter of the unit circle, from (1, 0) to (0, 1).
    arcs, half = biarc(np.array([[1.0, 0]]), np.array([[0.0, 1]]), np.array([[0.0, 1]]), np.array([[-1.0, 0]]))
    assert arcs["curvature"] == pytest.approx(np.ones((1, 2)))
    assert arcs["length"] == pytest.approx(np.full((1, 2), math.pi / 4))
    assert half == pytest.approx([math.pi / 8])


def test_points_that_coincide_have_no_biarc() -> None:
    p, t = np.zeros((1, 2)), np.array([[1.0, 0]])
    assert np.isinf(biarc(p, t, p, t)[1]).all()


@given(st.floats(0.1, 5), st.floats(-1.04, 1.04))
def test_an_arc_over_a_chord_is_as_the_circle_says(radius: float, half: float) -> None:
    chord = 2 * radius * abs(math.sin(half))
    size, curvature = arc_over(np.array([chord]), np.array([half]))
    assert size[0] == pytest.approx(2 * radius * abs(half), rel=1e-12)
    if abs(half) > 1e-100:
        assert curvature[0] == pytest.approx(math.copysign(1 / radius, half))


@given(st.floats(-1, 1), st.floats(-3, 3), st.floats(-3, 3))
def test_distances_are_those_to_a_dense_polyline(curvature: float, x: float, y: float) -> None:
    arc = np.array([(0.3, -0.2, math.cos(0.7), math.sin(0.7), 2.0, curvature)], SEGMENT)
    points = at(np.repeat(arc, 4001), np.linspace(0, 2, 4001))[0]
    nearest = np.hypot(*(points - [x, y]).T).min()
    assert distance(arc, np.array([[x, y]]))[0] == pytest.approx(nearest, abs=3e-4)


def test_distances_from_a_nearly_straight_arc_lose_nothing() -> None:
    arc = np.array([(0, 0, 1, 0, 1, 1e-13)], SEGMENT)
    points = np.array([[0.5, 1e-9], [-3e-9, 4e-9], [1, -2e-9]])
    assert distance(arc, points) == pytest.approx([1e-9, 5e-9, 2e-9], rel=1e-3)


@pytest.mark.parametrize("tolerance", [1.0, 1e-2, 1e-4, 1e-6])
def test_a_fit_stays_within_the_tolerance(tolerance: float) -> None:
    segments = fit(sine, tolerance)
    points = sine(np.linspace(0, 1, 20_001))[0]
    off = np.min([distance(segment, points) for segment in segments], axis=0)
    assert off.max() <= tolerance
    assert (np.abs(segments["curvature"] * segments["length"]) <= LARGEST_ARC + 1e-9).all()


def test_a_fit_needs_few_arcs() -> None:
    # A short biarc of length h deviates by |change of curvature| h^3 / 324, so the integral of the cube root along the
    # curve is the least number of biarcs. Here it is taken over the sine's own curvature.
    x = np.linspace(0, 2 * np.pi, 100_001)
    speed = np.sqrt(1 + np.cos(x) ** 2)
    change = np.abs(np.gradient(-np.sin(x) / speed**3, x)) / speed
    integral = float(np.sum(np.cbrt(change / 324) * speed) * (x[1] - x[0]))
    for tolerance in (1e-4, 1e-6, 1e-8):
        assert 1 < len(fit(sine, tolerance)) / 2 / (integral / tolerance ** (1 / 3)) < 1.3


def test_a_fit_is_continuous() -> None:
    segments = fit(sine, 1e-5)
    points, tangents = ends(segments)
    assert points[:-1, 0] == pytest.approx(segments["x"][1:], abs=1e-12)
    assert points[:-1, 1] == pytest.approx(segments["y"][1:], abs=1e-12)
    assert tangents[:-1, 0] == pytest.approx(segments["tx"][1:], abs=1e-12)
    assert tangents[:-1, 1] == pytest.approx(segments["ty"][1:], abs=1e-12)


def test_a_fit_ends_where_and_as_it_is_told() -> None:
    start, finish = (np.array([0.0, 0]), direction(0.78)[0]), (np.array([2 * np.pi, 0]), direction(0.79)[0])
    segments = fit(sine, 1e-3, start=start, finish=finish)
    points, tangents = ends(segments)
    assert [segments["tx"][0], segments["ty"][0]] == pytest.approx(start[1])
    assert points[-1] == pytest.approx(finish[0], abs=1e-12)
    assert tangents[-1] == pytest.approx(finish[1], abs=1e-12)


def test_fixed_parameters_stay_ends() -> None:
    segments = fit(sine, 1e-2, [0, 0.3, 1], fixed=[0, 0.3, 1])
    assert np.hypot(segments["x"] - 0.6 * np.pi, segments["y"] - math.sin(0.6 * np.pi)).min() < 1e-12


def test_a_straight_curve_is_one_line() -> None:
    def line(u: Floats) -> tuple[Floats, Floats]:
        return np.stack([3 * u, 4 * u], axis=1), np.broadcast_to(np.array([0.6, 0.8]), (len(u), 2))

    segments = fit(line, 1e-3)
    assert segments.tolist() == [pytest.approx((0, 0, 0.6, 0.8, 5, 0))]


def test_a_cusp_ends_in_lines_but_ends() -> None:
    def cusp(u: Floats) -> tuple[Floats, Floats]:  # x = v^2, y = v^3, v from -0.3 to 0.7: no tangent at v = 0
        v = u - 0.3
        speed = np.stack([2 * v, 3 * v * v], axis=1)
        size = np.hypot(*speed.T)[:, None]
        return np.stack([v**2, v**3], axis=1), np.where(size > 0, speed / np.where(size > 0, size, 1), 1)

    points = cusp(np.linspace(0, 1, 5001))[0]
    segments = fit(cusp, 1e-4)
    assert np.min([distance(segment, points) for segment in segments], axis=0).max() <= 1e-4
    assert len(segments) < 100


def test_what_cannot_be_done_is_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    with pytest.raises(ValueError, match="expected a tolerance above 0, found 0"):
        fit(sine, 0)

    def rough(u: Floats) -> tuple[Floats, Floats]:  # no biarc ever meets its zigzag
        return np.stack([u, np.where(np.arange(len(u)) % 2, 1.0, -1.0)], axis=1), np.tile([1.0, 0.0], (len(u), 1))

    monkeypatch.setattr("renderer.biarc.MOST_SEGMENTS", 1000)
    with pytest.raises(ValueError, match="at most 1000 arcs, found one of about 2048 at the tolerance 1e-06"):
        fit(rough, 1e-6)


def test_the_deviation_is_measured_to_the_nearer_arc() -> None:
    arcs, _ = biarc(np.zeros((1, 2)), direction(0.5), np.array([[1.0, 0]]), direction(-0.5))

    def raised(u: Floats) -> tuple[Floats, Floats]:  # the same circle with a radius larger by 0.01
        radius = 0.5 / math.sin(0.5)
        angle = math.pi / 2 + 0.5 - u
        out = np.stack([np.cos(angle), np.sin(angle)], axis=1)
        return np.array([0.5, -radius * math.cos(0.5)]) + (radius + 0.01) * out, turned(out, -math.pi / 2)

    assert deviation(raised, np.zeros(1), np.ones(1), arcs) == pytest.approx([0.01])
