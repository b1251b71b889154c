"""Convex regions of the plane that a strip may have to be cut by as a whole: bands, and what is removed within them.

What one straight piece covers or removes, its caps included, is a rectangle as a rule. Cutting by that leaves fewer and
larger faces than cutting by each of its strips.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from renderer.geometry.domain import Domain
from renderer.geometry.polygon import CORNERS, Counts, area, clipped, edges, enclose
from renderer.geometry.strips import STRIPS, Strips
from renderer.kernel import fixed, leaf
from renderer.tables import Floats

BANDS, REMOVALS = fixed(0), fixed(1)
ALIKE = 1e-12  # areas as near to one another are the same


class Regions(NamedTuple):
    """Memory of one thread."""

    made: Counts  # (2,) how many BANDS and REMOVALS there are
    edge: Floats  # (2, STRIPS, CORNERS, 3) half-planes
    edges: Counts  # (2, STRIPS) how many
    box: Floats  # (2, STRIPS, 4) p0, q0, p1, q1
    tag: Counts  # (2, STRIPS, 3) place of the piece in `Nearby`, rank, band; -1: all of the piece
    apart: Counts  # (STRIPS,) of a piece: 1 where its bands do not overlap
    sheet: Floats  # (CORNERS, 2) for clipping


@leaf
def regions_of() -> Regions:
    return Regions(
        np.zeros(2, np.int64), np.empty((2, STRIPS, CORNERS, 3)), np.empty((2, STRIPS), np.int64),
        np.empty((2, STRIPS, 4)), np.empty((2, STRIPS, 3), np.int64), np.zeros(STRIPS, np.int64),
        np.empty((CORNERS, 2)),
    )  # fmt: skip


@leaf
def unite(
    kind: int, place: int, polygons: Floats, counts: Counts, first: int, last: int, straight: bool, tx: float,
    ty: float, short: float, domain: Domain, strips: Strips, regions: Regions,
) -> None:  # fmt: skip
    """Add what the bands, or the strips that remove, first <= i < last of a piece cover: a rectangle along its tangent
    (tx, ty), cut by the domain, where together they are one; else each.

    short: edges of no more than this length have no direction.
    """
    n, total, rank = 0, 0.0, np.int64(0)
    low_s = low_b = math.inf
    high_s = high_b = -math.inf
    for i in range(first, last):
        if kind == REMOVALS and strips.tag[i, 4] == 0:
            continue
        n += 1
        total += area(polygons[i], counts[i])
        rank = strips.band_rank[i] if kind == BANDS else strips.tag[i, 3]
        for k in range(counts[i]):
            x, y = polygons[i, k, 0], polygons[i, k, 1]
            s, b = x * tx + y * ty, y * tx - x * ty
            low_s, high_s, low_b, high_b = min(low_s, s), max(high_s, s), min(low_b, b), max(high_b, b)
    if n == 0:
        return
    at, sheet = regions.made[kind], regions.sheet
    if straight and n > 1 and high_s - low_s > short and high_b - low_b > short:
        for k in range(4):
            s, b = (low_s if k == 0 or k == 3 else high_s), (low_b if k < 2 else high_b)
            sheet[k, 0], sheet[k, 1] = s * tx - b * ty, s * ty + b * tx
        count = clipped(sheet, 4, domain.planes, 0, 2 * domain.made[0], strips.two)
        if count and abs(area(sheet, count) - total) <= ALIKE * total:
            edge = regions.edge[kind, at]
            for k in range(4):
                sign, limit = (1.0, low_s) if k == 0 else (-1.0, -high_s) if k == 1 else (1.0, low_b)
                if k == 3:
                    sign, limit = -1.0, -high_b
                edge[k, 0], edge[k, 1] = (sign * tx, sign * ty) if k < 2 else (-sign * ty, sign * tx)
                edge[k, 2] = -limit
            regions.edges[kind, at] = 4
            enclose(sheet, count, regions.box[kind, at])
            tag = regions.tag[kind, at]
            tag[0], tag[1], tag[2] = place, rank, -1
            regions.made[kind] = at + 1
            if kind == BANDS:
                regions.apart[place] = 1
            return
    for i in range(first, last):
        if kind == REMOVALS and strips.tag[i, 4] == 0:
            continue
        count = edges(polygons[i], counts[i], short, regions.edge[kind, at])
        if count < 3:
            continue
        regions.edges[kind, at] = count
        enclose(polygons[i], counts[i], regions.box[kind, at])
        tag = regions.tag[kind, at]
        tag[0], tag[1], tag[2] = place, rank, i if kind == BANDS else strips.tag[i, 6]
        at += 1
    regions.made[kind] = at
