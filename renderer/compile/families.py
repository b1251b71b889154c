"""Regular families of grooves: copies side by side at one distance, told from the repeats that make them.

What a family is hangs on the paths alone and is kept with them; whether it folds, and how wide and deep it is, comes
with the profiles.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

import schema
from renderer.tables import FAMILY, FLAT, MEMBER, PROFILE, SCALE_CONSTANT, Floats, Ints

FEWEST = 32  # copies of a repeat that are worth folding
MEMBERS = 64  # grooves of one period at most
HAIR = 1e-9  # of the period: no gap, no overlap


class Families(NamedTuple):
    """The regular families among a pattern's pieces, without what hangs on the profiles."""

    families: NDArray[np.void]  # (f,) FAMILY
    members: NDArray[np.void]  # (m,) MEMBER
    rest: Ints  # rows of the pieces that are in none, ascending


@dataclass
class _Family:
    """A family in the making."""

    key: tuple[object, ...]  # families of one key may share their periods
    row: dict[str, float]
    members: list[tuple[float, float, int, int]]  # offset, turned, piece, stride
    pieces: list[NDArray[np.int64]] = field(default_factory=list)


def regular(pattern: schema.Pattern, pieces: NDArray[np.void]) -> Families:
    """The families of a pattern, whose grooves' placed pieces (n,) PIECE lie groove by groove."""
    found = list(_tiled(pattern.tile, pieces) if pattern.tile else _joined(_repeated(pattern, pieces)))
    families = np.zeros(len(found), FAMILY)
    members: list[tuple[float, float, float, int, int]] = []
    rest = np.ones(len(pieces), np.bool_)
    for row, family in zip(families, found, strict=True):
        for name, value in family.row.items():
            row[name] = value
        family.members.sort()
        low = family.members[0][0]
        row["x"], row["y"] = row["x"] - low * row["ty"], row["y"] + low * row["tx"]
        if row["radius"] > 0.0:
            row["radius"] -= low
        row["first"], row["last"] = len(members), len(members) + len(family.members)
        members += [(offset - low, turned, 1.0, piece, stride) for offset, turned, piece, stride in family.members]
        rest[np.concatenate(family.pieces)] = False
    return Families(families, np.array(members, MEMBER), np.flatnonzero(rest).astype(np.int32))


def _repeated(pattern: schema.Pattern, pieces: NDArray[np.void]) -> Iterator[_Family]:
    """Families made by one groove's repeat."""
    for index, groove in enumerate(pattern.grooves):
        repeat = groove.repeat
        if not isinstance(repeat, schema.LinearRepeat | schema.ConcentricRepeat) or repeat.count < FEWEST:
            continue
        own = np.flatnonzero(pieces["groove"] == index)
        if len(own) != repeat.count:
            continue  # paths of many pieces
        base = pieces[own[0]]
        if isinstance(repeat, schema.LinearRepeat):
            tx, ty = float(base["tx"]), float(base["ty"])
            across, slip = repeat.step[1] * tx - repeat.step[0] * ty, repeat.step[0] * tx + repeat.step[1] * ty
            if base["curvature"] != 0.0 or across == 0.0:
                continue
            upward = across > 0.0
            first = pieces[own[0 if upward else -1]]
            row = {
                "x": float(first["x"]), "y": float(first["y"]), "tx": tx, "ty": ty, "period": abs(across),
                "count": repeat.count, "length": float(base["length"]), "slip": slip if upward else -slip,
            }  # fmt: skip
            key: tuple[object, ...] = (tx, ty, row["period"], row["count"], row["length"], row["slip"])
        elif isinstance(groove.path, schema.CirclePath) and repeat.step != 0.0:
            upward = repeat.step < 0.0  # B points to the centre
            first = pieces[own[0 if upward else -1]]
            x, y = groove.path.center
            row = {
                "x": x, "y": y, "radius": 1.0 / float(first["curvature"]), "period": abs(repeat.step),
                "count": repeat.count, "length": math.inf,
            }  # fmt: skip
            key = (x, y, row["period"], row["count"])
        else:
            continue
        piece, stride = (int(own[0]), 1) if upward else (int(own[-1]), -1)
        yield _Family(key, row, [(0.0, 1.0, piece, stride)], [own])


def _joined(families: Iterator[_Family]) -> list[_Family]:
    """Families whose periods can be taken together are one."""
    found: list[_Family] = []
    for family in families:
        for other in found:
            if family.key != other.key or len(other.members) >= MEMBERS:
                continue
            a, b = family.row, other.row
            if "radius" in a:
                offset, on = b["radius"] - a["radius"], 0.0
            else:
                dx, dy = a["x"] - b["x"], a["y"] - b["y"]
                offset, on = dy * a["tx"] - dx * a["ty"], dx * a["tx"] + dy * a["ty"]
            period = a["period"]
            if abs(on) > HAIR * period or any(abs(offset - m[0]) >= (1.0 - HAIR) * period for m in other.members):
                continue
            other.members.append((offset, *family.members[0][1:]))
            other.pieces += family.pieces
            break
        else:
            found.append(family)
    return found


def _tiled(tile: tuple[float, float], pieces: NDArray[np.void]) -> Iterator[_Family]:
    """The family of a tile's straight grooves that run through it along one of its sides, from border to border."""
    open_ends = (pieces["start_end"] == FLAT) & (pieces["finish_end"] == FLAT) & (pieces["curvature"] == 0.0)
    for axis in range(2):
        tx, ty = (1.0, 0.0) if axis == 0 else (0.0, 1.0)
        along = np.abs(pieces["ty"] if axis == 0 else pieces["tx"]) < 1e-12
        own = np.flatnonzero(open_ends & along & (pieces["length"] >= tile[axis] * (1.0 - HAIR)))
        if not 0 < len(own) <= FEWEST * MEMBERS:
            continue
        period = tile[1 - axis]
        offsets = np.mod(pieces["y"][own] if axis == 0 else -pieces["x"][own], period)
        turned = np.sign(pieces["tx"][own] if axis == 0 else pieces["ty"][own])
        members: list[tuple[float, float, int, int]] = []
        for k in np.argsort(offsets, kind="stable"):
            row = int(own[k])
            same = members and pieces["groove"][members[-1][2]] == pieces["groove"][row]
            if same and offsets[k] - members[-1][0] < HAIR * period:
                continue  # grooves that coincide are one
            members.append((float(offsets[k]), float(turned[k]), row, 0))
        n = len(members)
        places, grooves = np.array([m[0] for m in members]), [pieces["groove"][m[2]] for m in members]
        even = np.abs(np.diff(places) - period / n) < HAIR * period
        if n > 1 and even.all() and len(set(grooves)) == 1 and len({m[1] for m in members}) == 1:
            members, period = members[:1], period / n
        if len(members) > MEMBERS:
            continue
        row_of = {
            "x": 0.0, "y": 0.0, "tx": tx, "ty": ty, "period": period, "count": math.inf, "length": math.inf,
        }  # fmt: skip
        yield _Family((), row_of, members, [own])


def dressed(
    found: Families, pieces: NDArray[np.void], grooves: NDArray[np.void], profiles: NDArray[np.void], points: Floats
) -> tuple[NDArray[np.void], NDArray[np.void]]:
    """The families and their members with their cross-sections, whose pieces have their ends."""
    families, members = found.families.copy(), found.members.copy()
    for family in families:
        own = members[family["first"] : family["last"]]
        groove = grooves[pieces["groove"][own["piece"]]]
        profile = profiles[groove["profile"]]
        own["scale"] = groove["scale_a"]
        left = np.where(own["turned"] > 0.0, profile["left"], -profile["right"]) * groove["scale_max"]
        right = np.where(own["turned"] > 0.0, profile["right"], -profile["left"]) * groove["scale_max"]
        start, finish = own["offset"] + left, own["offset"] + right
        family["start"], family["finish"] = start.min(), finish.max()
        family["height"] = np.max(profile["height"] * groove["scale_max"])
        family["depth"] = np.max(profile["depth"] * groove["scale_max"])
        family["half"] = np.min(np.maximum(np.abs(left), np.abs(right)))
        hair = HAIR * family["period"]
        apart = bool((finish[:-1] <= start[1:] + hair).all() and finish[-1] <= start[0] + family["period"] + hair)
        # Where upright walls touch, nothing stands between: what is seen then goes on from groove to groove.
        ends = np.array([_upright(p, points) for p in profile])
        ends = np.where(own["turned"][:, None] > 0.0, ends, ends[:, ::-1])
        gap = np.append(start[1:], start[0] + family["period"]) - finish
        apart = apart and not (ends[:, 1] & np.roll(ends[:, 0], -1) & (gap <= hair)).any()
        same = bool((groove["scale_kind"] == SCALE_CONSTANT).all() and (own["scale"] > 0.0).all())
        whole = all(
            _through(pieces[row], profiles[g["profile"]], points) for row, g in zip(own["piece"], groove, strict=True)
        )
        family["folds"] = apart and same and (whole or math.isfinite(family["count"])) and _level(profile, points)
        members[family["first"] : family["last"]] = own
    return families, members


def _upright(profile: np.void, points: Floats) -> tuple[bool, bool]:
    """Whether the profile's first and its last facet are vertical."""
    b = points[profile["start"] : profile["start"] + profile["count"], 0]
    return bool(b[0] == b[1]), bool(b[-1] == b[-2])


def _level(profiles: NDArray[np.void], points: Floats) -> bool:
    """Whether none of the profiles (k,) overhangs."""
    return all((np.diff(points[p["start"] : p["start"] + p["count"], 0]) >= 0.0).all() for p in profiles)


def _through(piece: np.void, profile: np.void, points: Floats) -> bool:
    """Whether a piece that goes on where it ends leaves nothing of its ends to be seen: they are cut square, or its
    cap, which is the right half again, is nowhere deeper than the groove."""
    if piece["start_end"] != PROFILE:
        return True
    own = points[profile["start"] : profile["start"] + profile["count"]]
    return bool(np.allclose(own * (-1.0, 1.0), own[::-1], rtol=0.0, atol=1e-12 * float(np.abs(own).max())))
