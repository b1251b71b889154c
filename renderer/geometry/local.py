"""The surface of the local solid around footprints, made once for all of a block of the screen where it is flat.

Which faces serve a footprint depends on its place alone, so that pictures are the same for any tile.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from renderer.geometry.cells import Cells, carve, cells_of
from renderer.geometry.curve import is_curved
from renderer.geometry.domain import Domain, aim, domain_of, settle, spread
from renderer.geometry.faces import EDGE, Faces, envelope, faces_of
from renderer.geometry.query import Nearby, find, nearby
from renderer.geometry.regions import BANDS, REMOVALS, Regions, regions_of, unite
from renderer.geometry.straight import straighten
from renderer.geometry.strips import Strips, divide, lay, overhangs, strips_of
from renderer.geometry.view import GRAZING, View, slope_at, thinnest, view_of
from renderer.kernel import fixed, leaf
from renderer.tables import FOOTPRINT, SCALE_CONSTANT, Camera, Floats, Pattern

CAPACITY = fixed(2048)  # pieces near a domain
CHORD = 4.0  # how far chords leave arcs, in widths of the footprint and tolerances; the error is about a fifth of it
BLOCKS = (8, 2, 0)  # the faces are made for squares of so many pixels, aligned on the screen; 0: for the footprint
BOWED_MARGIN = 0.1  # of a domain over a curved base, on either side: rays are straightened again once it is there
FEW = (16, 48, 2048)  # while no more pieces than this are near


class Local(NamedTuple):
    """The faces over a domain, and what they are made from; memory of one thread."""

    found: Nearby
    domain: Domain
    strips: Strips
    regions: Regions
    cells: Cells
    faces: Faces
    square: NDArray[np.void]  # (1,) FOOTPRINT: what the faces are made for
    at: Floats  # (BLOCKS, 3) the block of each size last tried, in its sizes, and whether its faces are held: 1


@leaf
def local_of(pattern: Pattern) -> Local:
    return Local(
        nearby(pattern, CAPACITY), domain_of(), strips_of(), regions_of(), cells_of(), faces_of(),
        np.zeros(1, FOOTPRINT), np.full((len(BLOCKS), 3), math.inf),
    )  # fmt: skip


HELD, MADE, FULL = 0, 1, 2


@leaf
def surround(
    pattern: Pattern, frame: np.void, footprint: np.void, flat: bool, camera: Camera, lights: NDArray[np.void],
    tolerance: float, most: int, far: float, source: Floats, local: Local,
) -> tuple[int, View]:  # fmt: skip
    """See to it that the faces hold all that a footprint needs: HELD as they were, MADE anew, or FULL, where that takes
    more than `most` strips, or is more than there is room for. The view is that of the square which they are made for.

    flat: its frame is that of all footprints. far: how much farther than what is seen, hides and shades they reach.
    source: (lights + 1, 4) where straight rays come from (`straighten`).
    """
    square, at = local.square[0], local.at
    view = view_of(footprint, frame, camera)
    if frame.eye[2] <= 0.0:
        return FULL, view
    for k in range(len(BLOCKS)):
        side = BLOCKS[k]
        if side > 0:
            x, y = math.floor(footprint.x / side), math.floor(footprint.y / side)
            tried = at[k, 0] == x and at[k, 1] == y
            if tried and at[k, 2] == 1.0:
                return HELD, view
            if tried or not flat:
                continue
            at[k, 0], at[k, 1], at[k, 2] = x, y, 0.0
            square.x, square.y, square.size = x * side, y * side, side
            if is_grazing(square, frame, camera):
                continue
        else:
            square.x, square.y, square.size = footprint.x, footprint.y, footprint.size
        view = view_of(square, frame, camera)
        straighten(pattern, frame, view, lights, source)
        for j in range(len(BLOCKS)):
            if at[j, 2] == 1.0:
                at[j, 0] = math.inf
        aim(view, source, local.domain)
        size = thinnest(view, 1.0 / max(side, 1))
        finite = spread(pattern, view, source, BOWED_MARGIN if is_curved(frame) else 0.0, far, local.domain)
        if finite and make(pattern, size, FEW[k], tolerance, most, local):
            at[k, 2] = 1.0
            return MADE, view
    return FULL, view


@leaf
def is_grazing(square: np.void, frame: np.void, camera: Camera) -> bool:
    """Whether a square comes near the horizon of its plane."""
    x, y, half = square.x, square.y, 0.5 * square.size
    middle = slope_at(x + half, y + half, frame, camera)
    most = middle
    for k in range(4):
        most = max(most, slope_at(x + 2.0 * half * (k & 1), y + 2.0 * half * (k >> 1), frame, camera))
    return most > GRAZING * middle


@leaf
def make(pattern: Pattern, size: float, few: int, tolerance: float, most: int, local: Local) -> bool:
    """Make the faces above the domain for footprints of this size, pattern units. False where more than `few` pieces or
    `most` strips are near, or there is no room."""
    domain, found, strips, faces = local.domain, local.found, local.strips, local.faces
    m = pattern.reach
    stepped = pattern.height > 0.0
    for groove in pattern.grooves:
        stepped = stepped or groove.priority > 0
    settle(domain)
    rim = domain.slab
    count = find(pattern, found, rim[0, 0] - m, rim[1, 0] - m, rim[0, 1] + m, rim[1, 1] + m, few)
    room = count >= 0
    undercut = False
    for i in range(max(count, 0)):
        undercut = undercut or overhangs(pattern, pattern.grooves[pattern.pieces[found.piece[i]].groove].profile)
    strips.made[0] = strips.made[1] = strips.made[2] = 0
    local.regions.made[0] = local.regions.made[1] = 0
    short = EDGE * max(rim[0, 1] - rim[0, 0], rim[1, 1] - rim[1, 0])
    for i in range(max(count, 0)):
        if not room:
            break
        x, y = found.shift[i, 0], found.shift[i, 1]
        first, band = strips.made[0], strips.made[1]
        chunks = divide(pattern, found.piece[i], x, y, rim, CHORD * tolerance * size, strips.chunks)
        room = chunks >= 0
        for j in range(chunks):
            room = room and strips.made[0] <= most
            room = room and lay(pattern, found.piece[i], i, strips.chunks[j], domain, stepped, strips)
        if room and not undercut:
            piece = pattern.pieces[found.piece[i]]
            straight = piece.curvature == 0.0 and pattern.grooves[piece.groove].scale_kind == SCALE_CONSTANT
            local.regions.apart[i] = 0
            unite(
                BANDS, i, strips.band, strips.band_count, band, strips.made[1], straight, piece.tx, piece.ty, short,
                domain, strips, local.regions,
            )  # fmt: skip
            unite(
                REMOVALS, i, strips.polygon, strips.corners, first, strips.made[0], straight, piece.tx, piece.ty,
                short, domain, strips, local.regions,
            )  # fmt: skip
    if room and undercut:
        return carve(pattern, found, strips, domain, local.cells, faces)
    return room and envelope(strips, local.regions, domain, pattern.height + pattern.depth, faces)
