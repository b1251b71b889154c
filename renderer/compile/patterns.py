"""A scene's patterns become tables.

Two steps, each kept by content. *Paths*: every path becomes lines and arcs, every repeat is written out, the grid is
built; profiles, scales, materials and priorities have no part in it. *Patterns*: the pieces get their grooves.
A new camera, light or material thus compiles nothing, and a new profile or perturbation leaves the grid as it is.
"""

from __future__ import annotations

import hashlib
import math
import threading
from collections import OrderedDict
from collections.abc import Callable, Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

import schema
from renderer import grid, paths, repeats
from renderer.compile.families import Families, dressed, regular
from renderer.compile.parts import Row, decompose
from renderer.geometry.pieces import LEAST_SCALE
from renderer.tables import (
    CORNER,
    FLAT,
    GROOVE,
    NO_GRID,
    PART,
    PIECE,
    PROFILE,
    PROFILE_ROW,
    SCALE_CONSTANT,
    SCALE_LINEAR,
    SCALE_SINE,
    SCALE_TABLE,
    SMOOTH,
    Chain,
    Floats,
    Grid,
    Ints,
    Pattern,
)
from schema import internal as internal

CURVE_TOLERANCE = 2e-5
"""How far arcs may leave a Bézier or a spiral, as a part of the path's extent."""
WIDTH_TOLERANCE = 1 / 20
"""... and as a part of the groove's width, which decides only for grooves that are narrow for their path."""
MOST_NEAR = 1 << 18  # pieces that one ray looks at in one place
BYTES_KEPT = 256 << 20  # compiled patterns and paths in a cache

Flags = NDArray[np.bool_]

Project = Callable[[Sequence[tuple[float, ...]]], Sequence[tuple[float, float]]]
"""Takes points of world space to an object's pattern plane."""


class Paths(NamedTuple):
    """The placed paths of a pattern: pieces without grooves' properties (GROOVE counts from 0), and their grid."""

    pieces: NDArray[np.void]
    grid: Grid
    families: Families
    rest: Grid  # over the pieces that are in no family


class Compiled(NamedTuple):
    """A pattern's tables, and the names that its material slots stand for."""

    tables: Pattern
    materials: tuple[str, ...]

    @property
    def bytes(self) -> int:
        """Memory of all tables."""
        return table_bytes(self.tables)


def table_bytes(tables: tuple[object, ...]) -> int:
    """Memory of the arrays in nested named tuples."""
    return sum(
        item.nbytes if isinstance(item, np.ndarray) else table_bytes(item) if isinstance(item, tuple) else 8
        for item in tables
    )


class PatternCache:
    """Compiled patterns by content, the oldest dropped beyond `limit` bytes. Safe for many threads."""

    def __init__(self, limit: int = BYTES_KEPT) -> None:
        self.limit = limit
        self.builds = {"paths": 0, "patterns": 0}
        self._lock = threading.Lock()
        self._kept: OrderedDict[str, Paths | Compiled] = OrderedDict()
        self._bytes = 0

    def pattern(self, pattern: schema.Pattern, project: Project | None = None, place: str = "") -> Compiled:
        """The tables of a pattern. `project` and `place`, which names it, serve paths drawn in world space."""
        if not any(_in_world(groove) for groove in pattern.grooves):
            place = ""
        key = _digest(pattern.model_dump_json(), place)
        kept = self._get(key)
        if isinstance(kept, Compiled):
            return kept
        shape = pattern.model_dump_json(include={"tile": True, "grooves": {"__all__": {"path", "repeat"}}})
        tolerances = [_tolerance(groove) for groove in pattern.grooves]
        paths_key = _digest("paths", shape, repr(tolerances), place)
        traced = self._get(paths_key)
        if not isinstance(traced, Paths):
            traced = trace(pattern, tolerances, project)
            self._put(paths_key, traced, "paths")
        compiled = dress(pattern, traced)
        self._put(key, compiled, "patterns")
        return compiled

    def _get(self, key: str) -> Paths | Compiled | None:
        with self._lock:
            if key in self._kept:
                self._kept.move_to_end(key)
            return self._kept.get(key)

    def _put(self, key: str, value: Paths | Compiled, kind: str) -> None:
        with self._lock:
            self.builds[kind] += 1
            if key not in self._kept:
                self._kept[key] = value
                self._bytes += table_bytes(value)
            while self._bytes > self.limit and len(self._kept) > 1:
                self._bytes -= table_bytes(self._kept.popitem(last=False)[1])


def _digest(*parts: str) -> str:
    return hashlib.sha256("\0".join(parts).encode()).hexdigest()


def _in_world(groove: schema.Groove) -> bool:
    return isinstance(groove.path, schema.PolylinePath) and groove.path.space == "world"


def _tolerance(groove: schema.Groove) -> float:
    """How far arcs may leave the groove's path, pattern units; infinite where the groove has no width.

    A power of eight, so that it rarely changes with the profile: never while the path's extent decides.
    """
    if not isinstance(groove.path, schema.SvgPath | schema.SpiralPath):
        return math.inf
    width = 2.0 * groove.half_width()
    return float(8.0 ** math.floor(math.log(width * WIDTH_TOLERANCE, 8.0))) if width > 0.0 else math.inf


def trace(pattern: schema.Pattern, tolerances: Sequence[float], project: Project | None) -> Paths:
    """The pieces of all grooves with their repeats, and the grid over them."""
    parts = []
    widths = []
    for row, (groove, tolerance) in enumerate(zip(pattern.grooves, tolerances, strict=True)):
        placed = _placed(groove, _chains(groove.path, tolerance, project))
        placed["groove"] = row
        parts.append(placed)
        widths.append(2.0 * groove.half_width())
    pieces = np.concatenate(parts)
    width = float(np.average(widths, weights=[max(len(part), 1) for part in parts]))
    width = max(width, 1e-9)
    families = regular(pattern, pieces)
    rest = NO_GRID
    if len(families.rest) and len(families.families):
        rest = grid.build(pieces[families.rest], pattern.tile, width)
        rest = rest._replace(items=families.rest[rest.items])
    return Paths(pieces, grid.build(pieces, pattern.tile, width), families, rest)


def _chains(path: schema.Path, tolerance: float, project: Project | None) -> list[Chain]:
    if isinstance(path, schema.PolylinePath):
        if path.space == "world":
            if project is None:
                raise ValueError("a path in world space needs an object to lie on")
            return paths.polyline(project(path.points), path.closed)
        return paths.polyline([(p[0], p[1]) for p in path.points], path.closed)
    if isinstance(path, schema.CirclePath):
        return paths.circle(path.center, path.radius)
    if isinstance(path, schema.SpiralPath):
        fine = min(tolerance, CURVE_TOLERANCE * 2.0 * path.outer_radius)
        return paths.spiral(path.center, path.inner_radius, path.outer_radius, path.turns, path.angle, fine)
    rough = np.concatenate([_pieces(chain) for chain in paths.svg(path.d, path.flip_y, math.inf)])
    low, high, _ = grid.extents(rough)
    return paths.svg(path.d, path.flip_y, min(tolerance, CURVE_TOLERANCE * float(np.hypot(*(high - low)))))


def _placed(groove: schema.Groove, chains: Sequence[Chain]) -> NDArray[np.void]:
    """The pieces of a groove at all its places."""
    repeat = groove.repeat
    if isinstance(repeat, schema.ConcentricRepeat) and isinstance(groove.path, schema.CirclePath):
        radii = repeats.concentric(repeat.count, repeat.step, groove.path.radius)
        return np.concatenate([_pieces(chain) for r in radii for chain in paths.circle(groove.path.center, float(r))])
    base = np.concatenate([_pieces(chain) for chain in chains]) if chains else np.empty(0, PIECE)
    if repeat is None:
        return base
    if isinstance(repeat, schema.LinearRepeat):
        places = repeats.linear(repeat.count, repeat.step)
    elif isinstance(repeat, schema.GridRepeat):
        places = repeats.grid(repeat.counts, repeat.steps)
    elif isinstance(repeat, schema.ScatterRepeat):
        places = repeats.scatter(repeat.count, repeat.seed, repeat.bounds, repeat.angle, repeat.scale)
    else:
        raise TypeError(type(repeat).__name__)
    placed = np.tile(base, len(places))
    moved = repeats.place_all(base[["x", "y", "tx", "ty", "length", "curvature"]], places)
    for name in ("x", "y", "tx", "ty", "length", "curvature"):
        placed[name] = moved[name]
    placed["size"] = np.repeat(places["scale"], len(base))
    return placed


def _pieces(chain: Chain) -> NDArray[np.void]:
    """The pieces of a chain, with its corners and the path parameter. Open ends are FLAT until the groove says more."""
    segments = chain.segments
    n = len(segments)
    pieces = np.zeros(n, PIECE)
    for name in segments.dtype.names or ():
        pieces[name] = segments[name]
    pieces["size"] = 1.0
    ends = np.cumsum(segments["length"])
    pieces["t0"][1:] = ends[:-1] / ends[-1]
    pieces["t1"] = ends / ends[-1]
    if chain.closed and n == 1 and segments["curvature"][0] != 0.0:
        pieces["closed"] = 1
        return pieces
    angle = segments["length"] * segments["curvature"]
    fx = segments["tx"] * np.cos(angle) - segments["ty"] * np.sin(angle)
    fy = segments["tx"] * np.sin(angle) + segments["ty"] * np.cos(angle)
    nx, ny = np.roll(segments["tx"], -1), np.roll(segments["ty"], -1)
    turn = np.arctan2(fx * ny - fy * nx, fx * nx + fy * ny)
    joint = np.where(np.abs(turn) > 0.5 * paths.SNAP, CORNER, SMOOTH).astype(np.uint8)
    mitre = np.where(joint == CORNER, np.tan(0.5 * turn), 0.0)
    if not chain.closed:
        joint[-1], mitre[-1] = FLAT, 0.0
    pieces["finish_end"], pieces["finish_mitre"] = joint, mitre
    pieces["start_end"], pieces["start_mitre"] = np.roll(joint, 1), np.roll(mitre, 1)
    return pieces


def _steps(pieces: NDArray[np.void], half: Floats, changing: NDArray[np.bool_]) -> tuple[Flags, Flags]:
    """Whether the heights of a piece and the next may differ along their mitre, at its start and at its finish.

    They do where one is bent or changes its scale, or is so short that its mitres meet within the band.
    """
    begins = pieces["t0"] == 0.0
    first = np.flatnonzero(begins)
    last = np.append(first[1:], len(pieces)) - 1
    chain = np.cumsum(begins) - 1
    row = np.arange(len(pieces))
    short = np.abs(pieces["start_mitre"] + pieces["finish_mitre"]) * half > pieces["length"]
    unlike = changing[pieces["groove"]] | (pieces["curvature"] != 0.0) | short

    def stepped(end: NDArray[np.uint8], other: Ints) -> Flags:
        return np.asarray((end == CORNER) & (unlike | unlike[other]))

    before = np.where(begins, last[chain], row - 1)
    after = np.where(row == last[chain], first[chain], row + 1)
    return stepped(pieces["start_end"], before), stepped(pieces["finish_end"], after)


def dress(pattern: schema.Pattern, traced: Paths) -> Compiled:
    """The pattern's tables: traced paths with their grooves' cross-sections."""
    pieces = traced.pieces.copy()
    grooves = np.zeros(len(pattern.grooves), GROOVE)
    profiles = _Profiles()
    names: list[str] = []
    slots: list[int] = []
    tables: list[tuple[float, float]] = []
    alike: dict[tuple[int, ...], int] = {}
    levels = sorted({groove.priority for groove in pattern.grooves})
    for row, groove in enumerate(pattern.grooves):
        g = grooves[row]
        g["profile"] = profiles.row(groove.profile.polyline())
        g["priority"] = levels.index(groove.priority)
        g["slot"] = len(slots)
        count = profiles.rows[g["profile"]]["count"] - 1
        material = groove.material
        for name in (material,) * count if material is None or isinstance(material, str) else material:
            if name is not None and name not in names:
                names.append(name)
            slots.append(-1 if name is None else names.index(name))
        g["like"] = alike.setdefault((int(g["profile"]), *slots[g["slot"] :]), row)
        _scale(g, groove.scale, tables)
    if pattern.grooves:
        ends = np.array([PROFILE if groove.ends == "profile" else FLAT for groove in pattern.grooves], np.uint8)
        for side in ("start_end", "finish_end"):
            pieces[side] = np.where(pieces[side] == FLAT, ends[pieces["groove"]], pieces[side])
    rows = np.array([tuple(row.values()) for row in profiles.rows], PROFILE_ROW)
    of = rows[grooves["profile"]][pieces["groove"]]
    most = grooves["scale_max"][pieces["groove"]] * pieces["size"]
    half = np.maximum(np.abs(of["left"]), np.abs(of["right"])) * most
    mitre = np.maximum(np.abs(pieces["start_mitre"]), np.abs(pieces["finish_mitre"])).astype(float)
    ended = (pieces["start_end"] == PROFILE) | (pieces["finish_end"] == PROFILE)
    pieces["half"] = np.nextafter(half.astype(np.float32), np.float32(np.inf))
    pieces["ended"] = ended
    pieces["start_step"], pieces["finish_step"] = _steps(pieces, half, grooves["scale_kind"] != SCALE_CONSTANT)
    far = half * np.maximum(np.sqrt(1.0 + mitre**2), np.where(ended, math.sqrt(2.0), 1.0))
    lines = bool(np.all(pieces["curvature"] == 0.0))
    sine = pieces["tx"] * pieces["ty"][0] - pieces["ty"] * pieces["tx"][0] if len(pieces) else np.zeros(0)
    points = np.array(profiles.points, float).reshape(-1, 2)
    families, members = dressed(traced.families, pieces, grooves, rows, points)
    tables_out = Pattern(
        grid=traced.grid,
        pieces=pieces,
        grooves=grooves,
        profiles=rows,
        points=points,
        facet_slot=np.array(slots, np.int32),
        scale_table=np.array(tables, float).reshape(-1, 2),
        height=float(np.max(of["height"] * most, initial=0.0)),
        depth=float(np.max(of["depth"] * most, initial=0.0)),
        width=float(np.max(half, initial=0.0)),
        reach=float(np.max(far, initial=0.0)),
        parallel=lines and bool(np.all(np.abs(sine) < 1e-12)),
        near=_near(traced, float(np.max(far, initial=0.0))),
        parts=np.array(profiles.parts, PART),
        part_first=np.array(profiles.part_first if profiles.parts else [], np.int32),
        families=families,
        members=members,
        rest=traced.rest,
    )
    return Compiled(tables_out, tuple(names))


def _near(traced: Paths, reach: float) -> int:
    """The most pieces that are looked at near one stretch of a ray (solid.meet): all, once a repetition of the tile
    whose paths get there. Without a tile more than MOST_NEAR are not."""
    grid = traced.grid
    if grid.tile[0] == 0.0:
        return min(len(traced.pieces), MOST_NEAR)
    stretch = 2.0 * float(grid.cell.max()) + 3.0 * reach
    overlaps = np.floor((grid.cell * grid.shape + stretch) / grid.tile) + 2.0
    return int(min(len(traced.pieces) * float(np.prod(overlaps)), 1e18))


def _scale(g: np.void, scale: schema.Scale, tables: list[tuple[float, float]]) -> None:
    """Write a scale into its row of GROOVE."""
    g["scale_max"] = max(scale.largest(), LEAST_SCALE)
    if isinstance(scale, schema.ConstantScale):
        g["scale_kind"], g["scale_a"] = SCALE_CONSTANT, max(scale.value, LEAST_SCALE)
    elif isinstance(scale, schema.LinearScale):
        g["scale_kind"], g["scale_a"], g["scale_b"] = SCALE_LINEAR, scale.start, scale.end
    elif isinstance(scale, schema.SineScale):
        g["scale_kind"], g["scale_a"], g["scale_b"] = SCALE_SINE, scale.amplitude, scale.periods
        g["scale_c"] = math.radians(scale.phase)
    else:
        g["scale_kind"], g["table_start"], g["table_count"] = SCALE_TABLE, len(tables), len(scale.t)
        tables.extend(zip(scale.t, scale.values, strict=True))


class _Profiles:
    """The distinct profiles of a pattern."""

    def __init__(self) -> None:
        self.rows: list[dict[str, float]] = []
        self.points: list[tuple[float, float]] = []
        self.parts: list[Row] = []
        self.part_first = [0]
        self._known: dict[tuple[tuple[float, float], ...], int] = {}

    def row(self, points: tuple[tuple[float, float], ...]) -> int:
        if points not in self._known:
            self._known[points] = len(self.rows)
            first, last = internal(points)
            overhangs = schema.overhangs(points)
            heights = [w for _, w in points]
            self.rows.append(
                {
                    "start": len(self.points),
                    "count": len(points),
                    "inner_first": first,
                    "inner_last": last,
                    "left": min(b for b, _ in points) if overhangs else points[0][0],
                    "right": max(b for b, _ in points) if overhangs else points[-1][0],
                    "height": max(0.0, *heights),
                    "depth": max(0.0, *(-w for w in heights)),
                }
            )
            self.points.extend(points)
            if overhangs:
                self.parts.extend(decompose(points, first, last))
            self.part_first.append(len(self.parts))
        return self._known[points]
