"""Grooves and scenes that the laws are tried on: a few by hand, and any number at random."""

from __future__ import annotations

import math
from itertools import accumulate
from typing import Any

import numpy as np
from hypothesis import strategies as st
from numpy.typing import NDArray

Json = dict[str, Any]
Floats = NDArray[np.float64]

SINGLE = 2e-6
"""Pictures are single precision: sums of a few numbers of about 1."""

SKEW = [[-0.06, 0.0], [-0.03, 0.04], [0.03, -0.12], [0.12, 0.05], [0.15, 0.0]]
RIDGE = [[-0.1, 0.0], [-0.03, 0.08], [0.1, 0.0]]
BOX = [[-0.1, 0.0], [-0.1, -0.12], [0.07, -0.12], [0.07, 0.0]]
DITCH = [[-0.1, 0.0], [0.02, -0.13], [0.05, -0.06], [0.1, 0.0]]
WHITE = {"base_color": [1, 1, 1], "specular": 0, "roughness": 1}
SKY = {"type": "constant", "radiance": [1, 1, 1]}


def line(*points: list[float], profile: list[list[float]] = SKEW, **more: Any) -> Json:
    path = {"type": "polyline", "points": list(points)}
    return {"path": path, "profile": {"type": "polyline", "points": profile}, **more}


def family(profile: list[list[float]] = SKEW, step: float = 0.33, count: int = 6, **more: Any) -> Json:
    """Parallel grooves along q."""
    repeat = {"type": "linear", "count": count, "step": [step, 0]}
    return line([0.26, -1], [0.26, 3], profile=profile, repeat=repeat, **more)


def ring(radius: float, profile: list[list[float]] = SKEW, **more: Any) -> Json:
    path = {"type": "circle", "center": [1.1, 0.8], "radius": radius}
    return {"path": path, "profile": {"type": "polyline", "points": profile}, **more}


MIXED = [
    family(DITCH, 0.61, 3),
    line([-1, 0.9], [3, 1.2], profile=RIDGE, material="brick"),
    line([0.4, 0.3], [1.2, 1.5], [1.6, 0.5], material=["brick", None, "moss", None]),
    line([0.2, 1.5], [0.6, 1.4], profile=BOX, ends="flat", priority=1),
    ring(0.4, DITCH),
]
"""A little of everything: crossings, ridges, walls, corners, ends, priorities, arcs."""
PALETTE = {
    "stone": {"base_color": [0.7, 0.65, 0.6], "specular": 0},
    "brick": {"base_color": [0.8, 0.3, 0.2], "specular": 0},
    "moss": {"base_color": [0.1, 0.5, 0.2], "roughness": 0.5},
}


def rms(values: Floats) -> float:
    return float(np.sqrt(np.mean(values**2)))


def only_flips(one: Floats, other: Floats, samples: int) -> None:
    """Two pictures of the same samples: only rounding differs, which may put a sample beyond an edge here and there."""
    difference = np.abs(one - other).max(axis=2)
    assert (difference < 1e-5).mean() > 0.995
    assert difference.max() < 2.5 * one.max() / samples


def only_noise(one: Floats, other: Floats, again: Floats) -> None:
    """`other` differs from `one` by no more than `again` does, the picture `one` from another seed: four deviations."""
    theirs, noise = ((one - other) ** 2).mean(axis=2), ((one - again) ** 2).mean(axis=2)
    assert noise.max() > 0.0
    excess, shift = theirs - noise, (one - other).mean(axis=2)
    assert excess.mean() < 4.0 * excess.std() / excess.size**0.5
    assert abs(shift.mean()) < 4.0 * shift.std() / shift.size**0.5


# --- at random ---

NUMBER = st.floats(-3, 3, allow_nan=False)
POINT = st.tuples(NUMBER, NUMBER).map(list)
SIGN = st.sampled_from([-1, 1])


def outline(steps: list[tuple[float, float]]) -> list[list[float]]:
    """A profile of random steps along b (0: a vertical wall) and heights."""
    places = list(accumulate(step for step, _ in steps))
    middle = 0.5 * places[-1]
    points = [[-middle - 0.02, 0.0], *([b - middle, w] for b, (_, w) in zip(places, steps, strict=True))]
    points = [p for i, p in enumerate(points) if i == 0 or p != points[i - 1]]
    return [*points, [middle + 0.02, 0.0]]


OUTLINES = st.lists(
    st.tuples(st.sampled_from([0.0, 0.02, 0.05, 0.1]), st.floats(-0.15, 0.15).map(lambda w: round(w, 3))),
    min_size=1, max_size=5,
).map(outline)  # fmt: skip
SCALES = st.sampled_from(
    [
        {"type": "constant"},
        {"type": "constant", "value": 0},
        {"type": "linear", "start": 0, "end": 2},
        {"type": "sine", "amplitude": 1, "periods": 7},
        {"type": "table", "t": [0, 0.5, 1], "values": [0, 1, 0]},
    ]
)
REPEATS = st.sampled_from(
    [
        None,
        None,
        {"type": "linear", "count": 5, "step": [0.21, 0.02]},
        {"type": "grid", "counts": [3, 2], "steps": [[0.4, 0], [0.1, 0.7]]},
        {"type": "scatter", "count": 6, "seed": 3, "bounds": [-1, -1, 2, 2], "scale": [0.2, 1.5]},
    ]
)


def grooves(size: st.SearchStrategy[float]) -> st.SearchStrategy[Json]:
    """Grooves of all kinds, of such widths, depths and radii."""
    profiles = st.one_of(
        st.builds(lambda w, d, s: {"type": "v", "width": w, "depth": d * s}, size, size, SIGN),
        st.builds(lambda w, d, s: {"type": "trapezoid", "width": w, "floor": w, "depth": d * s}, size, size, SIGN),
        st.builds(lambda w, d, s: {"type": "round", "width": w, "depth": d * s, "facets": 5}, size, size, SIGN),
        st.builds(
            lambda w, d, l, h: {"type": "scratch", "width": w, "depth": d, "lip_width": l, "lip_height": h},
            size, size, size, size,
        ),
        st.builds(lambda w: {"type": "polyline", "points": [[w, 0], [w, 0.1], [2 * w, -0.1], [2 * w, 0]]}, size),
        st.builds(lambda w: {"type": "polyline", "points": [[-2 * w, 0], [-w, -0.1], [-w, 0.1], [-0.5 * w, 0]]}, size),
        OUTLINES.map(lambda points: {"type": "polyline", "points": points}),
    )  # fmt: skip
    paths = st.one_of(
        st.builds(
            lambda points, closed: {"type": "polyline", "points": points, "closed": closed and len(points) > 2},
            st.lists(POINT, min_size=2, max_size=4, unique_by=tuple), st.booleans(),
        ),
        st.builds(lambda c, r: {"type": "circle", "center": c, "radius": r}, POINT, size),
        st.builds(
            lambda c, r: {"type": "spiral", "center": c, "inner_radius": 0, "outer_radius": r, "turns": 1.5},
            POINT, size,
        ),
        st.just({"type": "svg", "d": "M0,0 C1,2 1,0 0,1 L0,0.5 A0.3,0.2 0 1 0 1,1"}),
    )  # fmt: skip
    return st.builds(
        lambda path, profile, scale, ends, priority, material, repeat: {
            "path": path, "profile": profile, "scale": scale, "ends": ends, "priority": priority, "material": material,
        } | ({"repeat": repeat} if repeat else {}),
        paths, profiles, SCALES, st.sampled_from(["flat", "profile"]), st.integers(0, 2),
        st.sampled_from([None, "other"]), REPEATS,
    )  # fmt: skip


GROOVES = grooves(st.sampled_from([1e-6, 1e-3, 0.05, 0.2, 1.0]))
LARGE_GROOVES = grooves(st.sampled_from([0.1, 0.2, 0.6]))
DIRECTIONS = st.one_of(
    st.sampled_from([[1, 0, 0], [1, 0, -1], [0, 0, -1], [1, 0, -1e-3], [0.1, 0.2, 1], [-1, 0, -2], [0, 1, -0.02]]),
    st.tuples(NUMBER, NUMBER, st.floats(-3, -1e-4)).map(list),
)
SUNS = DIRECTIONS.map(lambda d: {"type": "directional", "direction": d, "irradiance": [3, 2, 1]})
LIGHTS = st.one_of(
    SUNS,
    st.builds(
        lambda p: {"type": "point", "position": p, "intensity": [1, 1, 1]},
        st.sampled_from([[0, 0, 0.01], [0, 0, 0], [0.3, 0.1, -1], [5, 5, 1e-3], [0, 0, 2]]),
    ),
    st.just(SKY),
)
ORIGINS = st.sampled_from(
    [
        [0, 0, 3], [0.1, -2, 1], [0, -3, 3 * math.tan(math.radians(0.1))], [0, 0, 1e-3], [0.2, 0.1, 0.05],
        [-0.7, 0.6, 0.2], [0, 0, 500], [3, 1, -1],
    ]
)  # fmt: skip
