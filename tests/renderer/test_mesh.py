"""The solid as a mesh, against closed forms and against a height field written straight from DESIGN 1.2."""

from __future__ import annotations

import math
import time
from itertools import pairwise
from typing import Any

import numpy as np
import pytest
import trimesh
from embreex.mesh_construction import TriangleMesh
from embreex.rtcore_scene import EmbreeScene
from numpy.typing import NDArray

from renderer.mesh import SolidMesh, build
from renderer.tables import (
    CORNER,
    FLAT,
    GROOVE,
    PIECE,
    PROFILE,
    PROFILE_ROW,
    SCALE_CONSTANT,
    SCALE_LINEAR,
    SCALE_SINE,
    SCALE_TABLE,
    SMOOTH,
    Grid,
    Pattern,
)

Points = list[tuple[float, float]]
V: Points = [(-0.1, 0.0), (0.0, -0.08), (0.1, 0.0)]
TRAPEZOID: Points = [(-0.12, 0.0), (-0.05, -0.06), (0.05, -0.06), (0.12, 0.0)]
BOX: Points = [(-0.1, 0.0), (-0.1, -0.08), (0.1, -0.08), (0.1, 0.0)]
RIDGE: Points = [(-0.1, 0.0), (0.0, 0.07), (0.1, 0.0)]
WALL: Points = [(-0.06, 0.0), (-0.06, 0.05), (0.06, 0.05), (0.06, 0.0)]
SCRATCH: Points = [(-0.14, 0.0), (-0.1, 0.04), (0.0, -0.08), (0.1, 0.04), (0.14, 0.0)]
SKEW: Points = [(-0.06, 0.0), (-0.03, 0.03), (0.03, -0.08), (0.12, 0.05), (0.15, 0.0)]


def internal(points: Points) -> tuple[int, int]:
    """The internal facets: external are those from each end while the polyline does not descend."""
    first, last = 0, len(points) - 1
    while first < last and points[first + 1][1] >= points[first][1]:
        first += 1
    while last > first and points[last - 1][1] >= points[last][1]:
        last -= 1
    return first, last


class Maker:
    """Tables by hand."""

    def __init__(self, tile: tuple[float, float] = (0.0, 0.0)) -> None:
        self.tile = tile
        self.pieces: list[NDArray[np.void]] = []
        self.grooves: list[tuple[Any, ...]] = []
        self.profiles: list[tuple[Any, ...]] = []
        self.points: Points = []
        self.slots: list[int] = []
        self.table: Points = []

    def groove(
        self, profile: Points, priority: int = 0, slots: list[int] | None = None, kind: int = SCALE_CONSTANT,
        numbers: tuple[float, float, float] = (0.0, 0.0, 0.0), table: Points | None = None,
    ) -> int:  # fmt: skip
        w = [y for _, y in profile]
        self.profiles.append(
            (len(self.points), len(profile), *internal(profile), profile[0][0], profile[-1][0], max(w), -min(w))
        )
        self.points += profile
        table = table or []
        most = {SCALE_LINEAR: max(numbers[:2]), SCALE_SINE: 1 + abs(numbers[0])}.get(kind, 1.0)
        most = max(v for _, v in table) if table else most
        self.grooves.append(
            (len(self.profiles) - 1, priority, len(self.slots), 0, kind, *numbers, len(self.table), len(table), most)
        )
        self.slots += slots or [-1] * (len(profile) - 1)
        self.table += table
        return len(self.grooves) - 1

    def piece(
        self, groove: int, start: tuple[float, float], angle: float, length: float, curvature: float = 0.0,
        ends: tuple[int, int] = (FLAT, FLAT), mitres: tuple[float, float] = (0.0, 0.0),
        t: tuple[float, float] = (0.0, 1.0), size: float = 1.0, closed: bool = False,
    ) -> None:  # fmt: skip
        row = np.zeros(1, PIECE)
        row["x"], row["y"], row["tx"], row["ty"] = *start, math.cos(angle), math.sin(angle)
        row["length"], row["curvature"], row["size"], row["groove"] = length, curvature, size, groove
        row["t0"], row["t1"] = t
        row["start_mitre"], row["finish_mitre"] = mitres
        row["start_end"], row["finish_end"] = ends
        row["closed"], row["ended"] = closed, PROFILE in ends
        self.pieces.append(row)

    def line(self, groove: int, a: tuple[float, float], b: tuple[float, float], **more: Any) -> None:
        self.piece(groove, a, math.atan2(b[1] - a[1], b[0] - a[0]), math.dist(a, b), **more)

    def polyline(self, groove: int, points: Points, ends: int = PROFILE) -> None:
        total = sum(math.dist(a, b) for a, b in pairwise(points))
        run = 0.0
        angles = [math.atan2(b[1] - a[1], b[0] - a[0]) for a, b in pairwise(points)]
        mitre = [0.0, *(math.tan(0.5 * (d - c)) for c, d in pairwise(angles)), 0.0]
        for i, angle in enumerate(angles):
            length = math.dist(points[i], points[i + 1])
            kinds = (ends if i == 0 else CORNER, ends if i == len(angles) - 1 else CORNER)
            self.piece(
                groove, points[i], angle, length, ends=kinds, mitres=(mitre[i], mitre[i + 1]),
                t=(run / total, (run + length) / total),
            )  # fmt: skip
            run += length

    def pattern(self) -> Pattern:
        none = np.zeros(0, np.int32)
        grid = Grid(np.zeros(2), np.ones(2), none, np.array(self.tile), none, none, np.zeros((0, 2)), none)
        pieces = np.concatenate([np.zeros(0, PIECE), *self.pieces])
        points = np.array(self.points).reshape(-1, 2)
        most = max((g[-1] for g in self.grooves), default=1.0) * max(
            (float(p["size"][0]) for p in self.pieces), default=1.0
        )
        height, depth = max(points[:, 1].max(initial=0.0), 0.0) * most, max(-points[:, 1].min(initial=0.0), 0.0) * most
        width = np.abs(points[:, 0]).max(initial=0.0) * most
        return Pattern(
            grid, pieces, np.array(self.grooves, GROOVE), np.array(self.profiles, PROFILE_ROW),
            points, np.array(self.slots, np.int32), np.array(self.table, np.float64).reshape(-1, 2),
            float(height), float(depth), float(width), 2.0 * float(width), False, len(self.pieces),
        )  # fmt: skip


# --- the independent reference ---


def scale_at(pattern: Pattern, piece: np.void, s: float) -> float:
    groove = pattern.grooves[piece["groove"]]
    along = min(max(s / float(piece["length"]), 0.0), 1.0)  # past the ends it keeps the end's value
    t = float(piece["t0"]) + (float(piece["t1"]) - float(piece["t0"])) * along
    a, b, c = float(groove["scale_a"]), float(groove["scale_b"]), float(groove["scale_c"])
    f = 1.0
    if groove["scale_kind"] == SCALE_LINEAR:
        f = a + (b - a) * t
    elif groove["scale_kind"] == SCALE_SINE:
        f = 1.0 + a * math.sin(2 * math.pi * b * t + c)
    elif groove["scale_kind"] == SCALE_TABLE:
        rows = pattern.scale_table[groove["table_start"] : groove["table_start"] + groove["table_count"]]
        f = float(np.interp(t, rows[:, 0], rows[:, 1]))
    return f * float(piece["size"])


def profile_at(pattern: Pattern, piece: np.void, b: float) -> tuple[float, bool] | None:
    """w of the cross-section at b (scale 1), and whether an internal facet is there; None beside the groove."""
    row = pattern.profiles[pattern.grooves[piece["groove"]]["profile"]]
    points = pattern.points[row["start"] : row["start"] + row["count"]]
    for i in range(len(points) - 1):
        (b0, w0), (b1, w1) = points[i], points[i + 1]
        if b0 <= b <= b1 and b1 > b0:
            return float(w0 + (b - b0) / (b1 - b0) * (w1 - w0)), bool(row["inner_first"] <= i < row["inner_last"])
    return None


def local(piece: np.void, p: float, q: float, s: float, turn: float) -> tuple[float, float]:
    """(x, b) of a point in the frame that stands at (s, turn) along a piece."""
    k = float(piece["curvature"])
    tx, ty = float(piece["tx"]), float(piece["ty"])
    if k == 0.0:
        x, y = float(piece["x"]) + s * tx, float(piece["y"]) + s * ty
    else:
        cx, cy = float(piece["x"]) - ty / k, float(piece["y"]) + tx / k
        tx, ty = tx * math.cos(turn) - ty * math.sin(turn), ty * math.cos(turn) + tx * math.sin(turn)
        x, y = cx + ty / k, cy - tx / k
    return (p - x) * tx + (q - y) * ty, (q - y) * tx - (p - x) * ty


def reads(pattern: Pattern, piece: np.void, p: float, q: float) -> list[tuple[float, bool]]:
    """(w, internal) of the piece over a point: nothing, or one entry."""
    k, length = float(piece["curvature"]), float(piece["length"])
    row = pattern.profiles[pattern.grooves[piece["groove"]]["profile"]]
    if k == 0.0:
        s, b = local(piece, p, q, 0.0, 0.0)
    else:
        cx, cy = float(piece["x"]) - float(piece["ty"]) / k, float(piece["y"]) + float(piece["tx"]) / k
        b = (abs(1 / k) - math.hypot(p - cx, q - cy)) * math.copysign(1.0, k)
        x0, y0 = (float(piece["x"]) - cx) * k, (float(piece["y"]) - cy) * k
        x1, y1 = (p - cx) * k, (q - cy) * k
        angle = math.atan2(x0 * y1 - y0 * x1, x0 * x1 + y0 * y1)  # signed: positive to the left
        if k < 0.0:
            angle = -angle
        if piece["closed"]:
            angle %= 2 * math.pi
        elif angle < -(2 * math.pi - length * abs(k)) / 2:
            angle += 2 * math.pi
        s = angle / abs(k)
    inside = [False, False]
    for end in (0, 1):
        kind = PROFILE if piece["closed"] else int(piece[("start_end", "finish_end")[end]])
        at = end * length
        x, bt = local(piece, p, q, at, at * k)
        out = x if end else -x
        near = k == 0.0 or abs(s - at) <= 0.5 * length
        if piece["closed"]:
            inside[end] = True
        elif kind == CORNER and near:
            mitre = float(piece[("start_mitre", "finish_mitre")[end]])
            inside[end] = out <= -mitre * bt
        else:
            inside[end] = s <= length if end else s >= 0.0
        if kind == PROFILE and near and out > 0.0 and not piece["closed"] and row["right"] > 0.0:
            f = scale_at(pattern, piece, at)
            if f == 0.0:
                return []
            x, bt = out / f, bt / f
            side = float(row["right"] if bt > 0.0 else max(0.0, -row["left"]))
            if side == 0.0:
                got = None
            elif x / float(row["right"]) >= abs(bt) / side:
                got = profile_at(pattern, piece, x)
            else:
                got = profile_at(pattern, piece, bt)
            return [(got[0] * f, got[1])] if got else []
    if not all(inside):
        return []
    f = scale_at(pattern, piece, s)
    got = profile_at(pattern, piece, b / f)
    return [(got[0] * f, got[1])] if got else []


def height(pattern: Pattern, p: float, q: float) -> float:
    """The surface over a point."""
    tile = pattern.grid.tile
    shifts = [(0.0, 0.0)]
    if tile[0] > 0:
        shifts = [(i * tile[0], j * tile[1]) for i in range(-3, 4) for j in range(-3, 4)]
    surface = 0.0
    for level in sorted(set(pattern.grooves["priority"].tolist())):
        every = [
            one
            for piece in pattern.pieces
            if pattern.grooves[piece["groove"]]["priority"] == level
            for dp, dq in shifts
            for one in reads(pattern, piece, p - dp, q - dq)
        ]
        if every:
            alone = max(0.0, *(w for w, _ in every)) if len(every) > 1 else max(0.0, every[0][0])
            alone = min([alone, *(w for w, inner in every if inner)])
            surface = alone
    return surface


# --- measures of a mesh ---


def volume(mesh: SolidMesh) -> float:
    a, b, c = (mesh.vertices[mesh.triangles[:, i]] for i in range(3))
    return float(np.einsum("ij,ij->i", a, np.cross(b, c)).sum() / 6.0)


def watertight(mesh: SolidMesh) -> bool:
    edges = np.concatenate([mesh.triangles[:, [0, 1]], mesh.triangles[:, [1, 2]], mesh.triangles[:, [2, 0]]]).astype(
        np.int64
    )
    n = len(mesh.vertices)
    there = np.sort(edges[:, 0] * n + edges[:, 1])
    back = np.sort(edges[:, 1] * n + edges[:, 0])
    return bool(np.array_equal(there, back))


def removed(maker: Maker, window: tuple[float, float, float, float] = (-1, -1, 1, 1)) -> tuple[float, SolidMesh]:
    """What the grooves take from the plate (negative: what they add)."""
    mesh = build(maker.pattern(), window, margin=0.25)
    assert watertight(mesh)
    low, high = mesh.vertices.min(axis=0), mesh.vertices.max(axis=0)
    assert low[:2] == pytest.approx([window[0] - 0.25, window[1] - 0.25], abs=1e-12)
    assert high[:2] == pytest.approx([window[2] + 0.25, window[3] + 0.25], abs=1e-12)
    area = (high[0] - low[0]) * (high[1] - low[1])
    return float(area * -low[2] - volume(mesh)), mesh


def heights(mesh: SolidMesh, points: np.ndarray[Any, Any]) -> tuple[np.ndarray[Any, Any], np.ndarray[Any, Any]]:
    """The mesh's height over points, and the triangle there, by rays straight down."""
    scene = EmbreeScene(robust=True)
    TriangleMesh(scene, mesh.vertices.astype(np.float32), mesh.triangles.astype(np.int32))
    origins = np.concatenate([points, np.full((len(points), 1), 2.0)], axis=1).astype(np.float32)
    down = np.tile(np.array([[0, 0, -1]], np.float32), (len(points), 1))
    got = scene.run(origins, down, output=1)
    return 2.0 - np.asarray(got["tfar"], np.float64), np.asarray(got["primID"])


def agree(maker: Maker, window: tuple[float, float, float, float] = (-1, -1, 1, 1), n: int = 1500) -> SolidMesh:
    """The mesh's heights are the reference's at random points (all but the few that fall on a cliff)."""
    pattern = maker.pattern()
    mesh = build(pattern, window, margin=0.25, arc_tolerance=2e-5)
    assert watertight(mesh)
    points = np.random.default_rng(1).uniform(window[:2], window[2:], (n, 2))
    got, _ = heights(mesh, points)
    want = np.array([height(pattern, float(np.float32(p)), float(np.float32(q))) for p, q in points])
    wrong = np.flatnonzero(np.abs(got - want) > 2.5e-4)
    assert len(wrong) <= n // 500, [(points[i], got[i], want[i]) for i in wrong[:8]]
    return mesh


# --- closed forms ---


def test_plate() -> None:
    taken, mesh = removed(Maker())
    assert taken == pytest.approx(0.0, abs=1e-12)
    assert len(mesh.triangles) == 12
    assert (mesh.slot == -1).all()


def test_v_groove_between_flat_ends() -> None:
    m = Maker()
    m.line(m.groove(V), (-0.7, 0.1), (0.6, 0.4))
    taken, _ = removed(m)
    assert taken == pytest.approx(0.2 * 0.08 / 2 * math.dist((-0.7, 0.1), (0.6, 0.4)), rel=1e-5)


def test_ridge_adds() -> None:
    m = Maker()
    m.line(m.groove(RIDGE), (-0.7, 0.1), (0.6, 0.4))
    assert removed(m)[0] == pytest.approx(-0.2 * 0.07 / 2 * math.dist((-0.7, 0.1), (0.6, 0.4)), rel=1e-5)


@pytest.mark.parametrize("angle", [90.0, 37.0])
def test_crossing_v_grooves(angle: float) -> None:
    """The overlap of two V grooves is the sum's excess: over the rhombus of both strips, min(d1, d2) of the depths."""
    m = Maker()
    g = m.groove(V)
    c, s = math.cos(math.radians(angle)), math.sin(math.radians(angle))
    m.line(g, (-0.9, 0.0), (0.9, 0.0))
    m.line(g, (-0.9 * c, -0.9 * s), (0.9 * c, 0.9 * s))
    # With depths d(1 - |u|) and d(1 - |v|), u and v uniform over [-1, 1], the mean of the smaller is d / 3; the strips
    # of half-width h cross in a rhombus of area 4 h^2 / sin(angle).
    shared = 4 * 0.1**2 / s * 0.08 / 3
    assert removed(m)[0] == pytest.approx(2 * 0.008 * 1.8 - shared, rel=1e-6)


def test_profile_end_is_half_a_pyramid() -> None:
    m = Maker()
    m.line(m.groove(V), (-0.5, 0.0), (0.5, 0.0), ends=(PROFILE, FLAT))
    # The end is half of a pyramid with a base of 0.2 x 0.2 and a height of 0.08.
    assert removed(m)[0] == pytest.approx(0.008 + 0.2 * 0.2 * 0.08 / 3 / 2, rel=1e-6)


def test_abutting_grooves_leave_no_wall() -> None:
    m = Maker()
    g = m.groove(V)
    ridge = m.groove(RIDGE)
    for i in range(-3, 4):
        m.line(g, (0.2 * i, -0.5), (0.2 * i, 0.5))
    m.line(ridge, (-0.7, 0.0), (0.7, 0.0))
    taken, mesh = removed(m)
    assert taken == pytest.approx(7 * 0.008, rel=1e-4)
    inside = np.abs(mesh.vertices[:, 0]) < 0.69
    assert mesh.vertices[inside, 2].max() < 1e-6


def test_coincident_grooves_are_one() -> None:
    m = Maker()
    g = m.groove(SCRATCH)
    m.line(g, (-0.5, 0.1), (0.5, 0.1))
    once = removed(m)[0]
    m.line(g, (-0.5, 0.1), (0.5, 0.1))
    m.line(g, (-0.4, 0.1), (0.4, 0.1))
    assert removed(m)[0] == pytest.approx(once, rel=1e-7)


def test_annulus_by_pappus() -> None:
    m = Maker()
    m.piece(m.groove(TRAPEZOID), (0.6, 0.0), math.pi / 2, 2 * math.pi * 0.6, 1 / 0.6, closed=True)
    area = (0.24 + 0.1) / 2 * 0.06
    assert removed(m)[0] == pytest.approx(area * 2 * math.pi * 0.6, rel=1e-3)


def test_cone_of_a_circle_smaller_than_its_groove() -> None:
    """b ends at the centre: what is left of a V groove on a circle of half its half-width."""
    m = Maker()
    m.piece(m.groove(V), (0.05, 0.0), math.pi / 2, 2 * math.pi * 0.05, 1 / 0.05, closed=True)
    # Depth 0.08 (1 - |r - 0.05| / 0.1) for r from 0 to 0.15.
    r = np.linspace(0.0, 0.15, 200001)
    want = np.trapezoid(0.08 * (1 - np.abs(r - 0.05) / 0.1) * 2 * math.pi * r, r)
    assert removed(m)[0] == pytest.approx(want, rel=2e-3)


def test_linear_scale_is_a_frustum() -> None:
    m = Maker()
    m.line(m.groove(V, kind=SCALE_LINEAR, numbers=(0.5, 1.5, 0.0)), (-0.5, 0.0), (0.5, 0.0))
    assert removed(m)[0] == pytest.approx(0.008 * (0.25 + 0.75 + 2.25) / 3, rel=1e-6)


def test_sine_scale() -> None:
    m = Maker()
    m.line(m.groove(V, kind=SCALE_SINE, numbers=(0.4, 3.0, 0.5)), (-0.5, 0.0), (0.5, 0.0))
    assert removed(m)[0] == pytest.approx(0.008 * (1 + 0.16 / 2), rel=2e-3)


def test_higher_priority_replaces() -> None:
    m = Maker()
    low, high = m.groove(BOX), m.groove(RIDGE, priority=1)
    m.line(low, (-0.8, 0.0), (0.8, 0.0))
    m.line(high, (0.0, -0.8), (0.0, 0.8))
    # The ridge stands whole, on a fill that blocks the box groove over its band.
    assert removed(m)[0] == pytest.approx(0.016 * (1.6 - 0.2) - 0.007 * 1.6, rel=1e-6)
    m = Maker()
    low, high = m.groove(WALL), m.groove(V, priority=1)
    m.line(low, (-0.8, 0.0), (0.8, 0.0))
    m.line(high, (0.0, -0.8), (0.0, 0.8))
    assert removed(m)[0] == pytest.approx(0.008 * 1.6 - 0.12 * 0.05 * (1.6 - 0.2), rel=1e-6)


# --- the height field ---


def cross(profiles: list[Points], priorities: list[int], ends: int) -> Maker:
    m = Maker()
    for i, (profile, priority) in enumerate(zip(profiles, priorities, strict=True)):
        angle = 0.3 + 1.1 * i
        at = (0.1 * i, -0.05 * i)
        c, s = 0.6 * math.cos(angle), 0.6 * math.sin(angle)
        m.line(m.groove(profile, priority), (at[0] - c, at[1] - s), (at[0] + c, at[1] + s), ends=(ends, ends))
    return m


ALL = [V, TRAPEZOID, BOX, RIDGE, WALL, SCRATCH, SKEW]


@pytest.mark.parametrize("ends", [FLAT, PROFILE])
@pytest.mark.parametrize("profile", range(len(ALL)))
def test_heights_of_a_crossing(profile: int, ends: int) -> None:
    for other in range(profile + 1):
        agree(cross([ALL[profile], ALL[other]], [0, 0], ends), n=600)


@pytest.mark.parametrize("ends", [FLAT, PROFILE])
def test_heights_of_priorities(ends: int) -> None:
    agree(cross([SCRATCH, WALL, SKEW], [0, 1, 2], ends))
    agree(cross([SKEW, SCRATCH, BOX], [0, 1, 1], ends))
    agree(cross([RIDGE, SCRATCH, V, TRAPEZOID], [1, 0, 2, 1], ends))


@pytest.mark.parametrize("profile", [V, BOX, RIDGE, SCRATCH, SKEW])
def test_heights_of_a_mitred_path(profile: Points) -> None:
    m = Maker()
    m.polyline(m.groove(profile), [(-0.7, -0.5), (0.1, -0.4), (0.5, 0.2), (0.4, 0.7), (-0.5, 0.3), (-0.2, 0.75)])
    agree(m)


def test_segments_shorter_than_their_mitres() -> None:
    m = Maker()
    m.polyline(m.groove(V), [(-0.5, 0.0), (0.0, 0.0), (0.03, 0.02), (0.05, 0.5)])
    m.polyline(m.groove(SCRATCH), [(-0.5, -0.5), (0.0, -0.5), (0.02, -0.48), (0.0, -0.46), (-0.5, -0.3)])
    agree(m)


@pytest.mark.parametrize("profile", [V, BOX, RIDGE, SCRATCH, SKEW])
@pytest.mark.parametrize("turn", [1.0, -1.0])
def test_heights_of_arcs(profile: Points, turn: float) -> None:
    m = Maker()
    g = m.groove(profile)
    m.piece(g, (0.0, -0.4), 0.0, 0.8, turn / 0.5, ends=(PROFILE, SMOOTH), t=(0.0, 0.5))
    a = turn * 0.8 / 0.5
    at = (0.5 * abs(math.sin(a)), -0.4 + turn * 0.5 * (1 - math.cos(a)))
    m.piece(g, at, a, 0.3, -turn / 0.4, ends=(SMOOTH, PROFILE), t=(0.5, 1.0))
    m.line(g, (-0.7, 0.1), (0.7, 0.0), ends=(PROFILE, PROFILE))
    agree(m)


def test_heights_of_arcs_with_corners() -> None:
    """Two arcs that meet at an angle, as a lens: mitred in the frames of their ends."""
    m = Maker()
    for profile, x in ((V, -0.5), (SKEW, 0.45)):
        g = m.groove(profile)
        half = 0.6  # the angle to either side of the middle
        mitre = math.tan(0.5 * (math.pi - 2 * half))
        for side in (0.0, math.pi):
            start = (x - math.sin(half) * 0.6 * math.cos(side), -math.sin(half) * 0.6 * math.sin(side))
            m.piece(g, start, side - half, 2 * half * 0.6, 1 / 0.6, ends=(CORNER, CORNER), mitres=(mitre, mitre))
    agree(m)


@pytest.mark.parametrize(
    ("kind", "numbers", "table"),
    [
        (SCALE_LINEAR, (0.4, 1.3, 0.0), None),
        (SCALE_SINE, (0.4, 4.0, 0.5), None),
        (SCALE_TABLE, (0.0, 0.0, 0.0), [(0.0, 0.0), (0.2, 1.0), (0.6, 0.5), (1.0, 1.2)]),
    ],
)
def test_heights_of_scales(kind: int, numbers: tuple[float, float, float], table: Points | None) -> None:
    m = Maker()
    for profile in (SCRATCH, V, RIDGE):
        g = m.groove(profile, kind=kind, numbers=numbers, table=table)
        y = 0.3 * (g - 1)
        m.line(g, (-0.6, y), (0.6, y + 0.15), ends=(PROFILE, PROFILE), size=0.8)
    m.piece(m.groove(SKEW, kind=kind, numbers=numbers, table=table), (-0.1, -0.8), 0.0, 1.0, 1.0, ends=(PROFILE, FLAT))
    agree(m)


@pytest.mark.parametrize(("kind", "numbers"), [(SCALE_LINEAR, (0.3, 1.5, 0.0)), (SCALE_SINE, (0.4, 4.0, 0.5))])
@pytest.mark.parametrize("profile", [V, RIDGE, SKEW])
def test_heights_of_scales_in_sharp_corners(profile: Points, kind: int, numbers: tuple[float, float, float]) -> None:
    """Past a line's end the scale stays, also where a mitre leads that far."""
    m = Maker()
    m.polyline(m.groove(profile, kind=kind, numbers=numbers), [(-0.7, 0.3), (0.6, -0.2), (-0.3, 0.5), (-0.7, -0.4)])
    agree(m)


def test_heights_of_tiles() -> None:
    m = Maker(tile=(0.7, 0.5))
    m.line(m.groove(V), (0.1, 0.1), (0.55, 0.3), ends=(PROFILE, PROFILE))
    m.line(m.groove(SCRATCH, 1), (0.3, 0.0), (0.3, 0.5))
    agree(m, (-0.6, -0.4, 0.6, 0.5), n=500)


def test_window_crops_long_paths() -> None:
    m = Maker()
    g = m.groove(SCRATCH)
    m.line(g, (-1000.0, 0.1), (1000.0, 0.2))
    m.piece(g, (0.0, 0.3), 0.0, 2 * math.pi * 50.0, 1 / 50.0, closed=True)
    assert len(agree(m).triangles) < 5000


def test_nothing_stands_above_the_surface() -> None:
    """No thin walls left: around a vertex the surface gets as high as the vertex."""
    m = Maker()
    peak: Points = [(-0.1, 0.0), (-0.05, -0.03), (0.0, 0.05), (0.05, -0.03), (0.1, 0.0)]
    for profile, y in ((SKEW, -0.4), (peak, 0.1)):
        g = m.groove(profile, kind=SCALE_LINEAR, numbers=(0.6, 1.0, 0.0))
        m.piece(g, (-0.6, y), 0.3, 1.1, -0.8, ends=(PROFILE, FLAT))
        m.line(g, (-0.6, y + 0.2), (0.7, y), ends=(FLAT, PROFILE))
    pattern = m.pattern()
    mesh = build(pattern, (-1, -1, 1, 1), arc_tolerance=2e-5, margin=0.25)
    inside = (np.abs(mesh.vertices[:, :2]).max(axis=1) < 1.0) & (mesh.vertices[:, 2] > -0.12)
    vertices = mesh.vertices[inside]
    for p, q, w in vertices[np.random.default_rng(2).permutation(len(vertices))[:800]]:
        turns = [0.1 + 0.785 * i for i in range(8)]
        around = [height(pattern, p + r * math.cos(a), q + r * math.sin(a)) for r in (2e-6, 1e-4) for a in turns]
        assert w <= max(around) + 5e-4, (p, q, w)


# --- materials ---


def test_slots() -> None:
    m = Maker()
    m.line(m.groove(SCRATCH, slots=[3, 4, -1, 5]), (-0.6, 0.0), (0.6, 0.0), ends=(PROFILE, FLAT))
    m.line(m.groove(WALL, slots=[6, 7, 8]), (0.3, -0.6), (0.3, 0.6))
    mesh = build(m.pattern(), (-1, -1, 1, 1))
    points = np.array([[-0.2, -0.12], [-0.2, -0.05], [-0.2, 0.05], [-0.2, 0.12], [0.31, 0.4], [0.8, 0.8], [-0.72, 0.01],
                       [-0.65, 0.02], [0.31, 0.06], [0.31, -0.06]])  # fmt: skip
    _, hit = heights(mesh, points)
    assert mesh.slot[hit].tolist() == [3, 4, -1, 5, 7, -1, 5, -1, -1, 4]
    normal = np.cross(
        mesh.vertices[mesh.triangles[:, 1]] - mesh.vertices[mesh.triangles[:, 0]],
        mesh.vertices[mesh.triangles[:, 2]] - mesh.vertices[mesh.triangles[:, 0]],
    )
    area = np.linalg.norm(normal, axis=1) / 2
    middle = mesh.vertices[mesh.triangles].mean(axis=1)
    side = np.abs(normal[:, 0]) > 1.999 * area
    # The ridge's own sides are facets; where the scratch cuts through it, and at the flat ends, nothing is.
    for slot, x in ((6, 0.36), (8, 0.24)):
        here = side & (np.abs(middle[:, 0] - x) < 1e-9) & (mesh.slot == slot)
        # The scratch takes what is above its internal facets, and its lips stand in front of some more.
        assert area[here].sum() == pytest.approx(0.05 * 1.2 - 0.05 * 0.2 - 0.04 * 0.04, rel=1e-6)
    end = side & (np.abs(middle[:, 0] - 0.6) < 1e-9)
    assert area[end].sum() > 0
    assert (mesh.slot[end] == -1).all()


def test_cliffs_of_a_priority_are_the_objects_own() -> None:
    m = Maker()
    m.line(m.groove(BOX, 0, slots=[1, 2, 3]), (-0.8, 0.0), (0.8, 0.0))
    m.line(m.groove(RIDGE, 1, slots=[4, 5]), (0.0, -0.8), (0.0, 0.8))
    mesh = build(m.pattern(), (-1, -1, 1, 1))
    middle = mesh.vertices[mesh.triangles].mean(axis=1)
    cliff = (np.abs(np.abs(middle[:, 0]) - 0.1) < 1e-6) & (middle[:, 2] < -1e-4) & (np.abs(middle[:, 1]) < 0.1)
    cliff &= middle[:, 2] > -0.079
    assert cliff.any()
    assert (mesh.slot[cliff] == -1).all()


# --- robustness, limits, speed ---


def test_it_is_a_solid_for_others() -> None:
    mesh = build(cross([SCRATCH, WALL, SKEW], [0, 1, 1], PROFILE).pattern(), (-1, -1, 1, 1))
    other = trimesh.Trimesh(mesh.vertices, mesh.triangles, process=False)
    assert other.is_watertight
    assert other.is_winding_consistent
    assert other.volume > 0.0


def test_refuses_what_is_too_large() -> None:
    m = Maker()
    g = m.groove(V)
    for i in range(400):
        m.line(g, (-1.0, -1 + 0.005 * i), (1.0, -1 + 0.005 * i))
        m.line(g, (-1 + 0.005 * i, -1.0), (-1 + 0.005 * i, 1.0))
    with pytest.raises(ValueError, match=r"would need \d+ triangles, more than 1000000"):
        build(m.pattern(), (-1, -1, 1, 1), limit=1_000_000)


def test_window_must_have_an_area() -> None:
    with pytest.raises(ValueError, match="window"):
        build(Maker().pattern(), (0, 0, 0, 1))


def test_many_parallel_grooves_are_quick() -> None:
    m = Maker()
    g = m.groove([(-0.002, 0.0), (0.0, -0.0015), (0.002, 0.0)])
    for i in range(250):
        m.line(g, (-0.498 + 0.004 * i, -5.0), (-0.498 + 0.004 * i, 5.0), ends=(PROFILE, PROFILE))
    begin = time.process_time()
    mesh = build(m.pattern(), (-0.5, -0.5, 0.5, 0.5))
    assert time.process_time() - begin < 8.0
    assert watertight(mesh)


def test_many_crossing_grooves_are_quick() -> None:
    rng = np.random.default_rng(3)
    m = Maker()
    g = m.groove([(x * 0.1, w * 0.1) for x, w in SCRATCH])
    for _ in range(60):
        angle, at = rng.uniform(0, math.pi), rng.uniform(-0.5, 0.5, 2)
        c, s = math.cos(angle), math.sin(angle)
        m.line(g, (at[0] - c, at[1] - s), (at[0] + c, at[1] + s), ends=(PROFILE, PROFILE))
    begin = time.process_time()
    mesh = build(m.pattern(), (-0.5, -0.5, 0.5, 0.5))
    assert time.process_time() - begin < 20.0
    assert watertight(mesh)
