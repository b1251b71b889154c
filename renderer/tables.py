"""The plain tables that the compiled scene is made of: what kernels read, and nothing else.

Shapes, units and frames are stated here once. Angles are radians, colours linear RGB, lengths of a pattern in
pattern units, lengths of the world in world units. Every table is a contiguous numpy array, so that a kernel
takes it as it is.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Ints = NDArray[np.int32]

SEGMENT = np.dtype(
    [
        ("x", "f8"), ("y", "f8"),  # start point, pattern units
        ("tx", "f8"), ("ty", "f8"),  # unit tangent at the start point
        ("length", "f8"),  # arc length, pattern units
        ("curvature", "f8"),  # signed: positive turns left (towards B = T turned 90 degrees to the left); 0: a line
    ]
)  # fmt: skip
"""A line or a circular arc of at most 120 degrees; a whole circle is one arc of length 2 pi / |curvature|."""


class Chain(NamedTuple):
    """One continuous path (a subpath of SVG data): consecutive segments that share end points.

    Where the tangents of neighbours differ, the path has a corner, which is mitred.
    """

    segments: NDArray[np.void]  # (n,) SEGMENT, n >= 1, lengths > 0
    closed: bool  # the end meets the start


# How a piece ends (PIECE.start_end, PIECE.finish_end).
SMOOTH = 0  # the next piece goes on with the same tangent
CORNER = 1  # the next piece goes on in another direction: mitred
FLAT = 2  # cut square
PROFILE = 3  # closed with the profile's right half, mitred around the end

PIECE = np.dtype(
    [
        ("x", "f8"), ("y", "f8"), ("tx", "f8"), ("ty", "f8"), ("length", "f8"), ("curvature", "f8"),  # as SEGMENT
        ("t0", "f4"), ("t1", "f4"),  # path parameter (0..1) at the start and at the finish
        ("start_mitre", "f4"),  # tan of half the turn at a CORNER, positive for a left turn: the piece begins
        ("finish_mitre", "f4"),  # at s = mitre * b and ends at s = length - mitre * b; 0 for other ends
        ("size", "f4"),  # scale of the whole cross-section given by the placement (scatter); 1 otherwise
        ("groove", "i4"),  # row of the GROOVE table
        ("start_end", "u1"), ("finish_end", "u1"),  # SMOOTH, CORNER, FLAT or PROFILE
        ("closed", "u1"),  # 1: a whole circle, no ends at all
        ("_pad", "u1"),
    ]
)  # fmt: skip
"""A line or arc of a placed path. (s, b) are its local coordinates: s arc length from the start point, b the signed
distance to the left of the path."""

# Kinds of the scale f(t).
SCALE_CONSTANT, SCALE_LINEAR, SCALE_SINE, SCALE_TABLE = 0, 1, 2, 3

GROOVE = np.dtype(
    [
        ("profile", "i4"),  # row of PROFILE
        ("priority", "i4"),  # rank: 0 is the lowest priority of the pattern, consecutive
        ("slot", "i4"),  # first entry of the groove's facets in Pattern.facet_slot
        ("scale_kind", "i4"),
        ("scale_a", "f8"), ("scale_b", "f8"), ("scale_c", "f8"),  # linear: start, end; sine: amplitude, periods,
        # phase (radians)
        ("table_start", "i4"), ("table_count", "i4"),  # rows of Pattern.scale_table (t, value)
        ("scale_max", "f8"),  # the largest value of f
    ]
)  # fmt: skip

PROFILE_ROW = np.dtype(
    [
        ("start", "i4"), ("count", "i4"),  # points of the polyline, rows of Pattern.points
        ("inner_first", "i4"), ("inner_last", "i4"),  # internal facets: first <= facet < last (equal: none)
        ("left", "f8"), ("right", "f8"),  # C_0.b and C_n.b
        ("height", "f8"), ("depth", "f8"),  # the highest point above and the lowest below w = 0, both >= 0
    ]
)  # fmt: skip
"""Facet i of a profile joins its points i and i + 1."""


class Grid(NamedTuple):
    """The uniform grid over the paths (000, 4.1): which pieces' centre lines cross a cell."""

    origin: Floats  # (2,) lower left corner, pattern units
    cell: Floats  # (2,) size of a cell, pattern units
    shape: Ints  # (2,) cells along p and q
    tile: Floats  # (2,) period along p and q; 0, 0 where the pattern does not repeat
    first: Ints  # (nx * ny + 1,) where the list of cell (ix, iy), row iy * nx + ix, begins in `items`
    items: Ints  # rows of PIECE, ascending within a cell
    special: NDArray[np.uint8]  # (nx * ny,) 1 where paths cross or end in the cell


class Pattern(NamedTuple):
    """A compiled pattern, the same for every camera, light and material."""

    grid: Grid
    pieces: NDArray[np.void]  # (n,) PIECE
    grooves: NDArray[np.void]  # (g,) GROOVE
    profiles: NDArray[np.void]  # (k,) PROFILE_ROW
    points: Floats  # (m, 2) profile points (b, w)
    facet_slot: Ints  # material slot of each facet of each groove: -1 the object's own, else a row of the names
    scale_table: Floats  # (r, 2) rows (t, value)
    height: float  # the highest point of any cross-section above w = 0, scale included
    depth: float  # the lowest below, positive
    width: float  # the largest |b| of any cross-section, scale included
    reach: float  # the farthest that a cross-section gets from its centre line, ends and mitres included
