"""The surface of the local solid around footprints, made once for all that need no more of it."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from renderer.geometry.domain import AXES, Domain, aim, domain_of, holds, settle, spread
from renderer.geometry.faces import Faces, envelope, faces_of
from renderer.geometry.query import Nearby, find, nearby
from renderer.geometry.strips import Strips, divide, lay, strips_of
from renderer.geometry.view import View
from renderer.kernel import fixed, leaf
from renderer.tables import Floats, Pattern

CAPACITY = fixed(512)  # pieces near a domain
CHORD = 0.008  # how far chords leave arcs, in widths of the footprint
AROUND = (7.0, 2.0, 0.0)  # how much more than a footprint needs the faces are made for, in its sizes
BEYOND = (0.5, 0.1, 0.0)  # ... or in the sizes of what it needs
FEW = (12, 32, 512)  # while no more pieces than this are near


class Local(NamedTuple):
    """The faces over a domain, and what they are made from; memory of one thread."""

    found: Nearby
    domain: Domain
    strips: Strips
    faces: Faces
    slab: Floats  # (AXES, 2) what a footprint needs
    made: Floats  # (1,) the size of the footprint that the faces were made for, pattern units; 0: there are none


@leaf
def local_of(pattern: Pattern) -> Local:
    return Local(
        nearby(pattern, CAPACITY), domain_of(), strips_of(), faces_of(), np.empty((AXES, 2)), np.zeros(1)
    )  # fmt: skip


HELD, MADE, FULL = 0, 1, 2


@leaf
def surround(
    pattern: Pattern, frame: np.void, view: View, lights: NDArray[np.void], size: float, local: Local
) -> int:  # fmt: skip
    """See to it that the faces hold all that a footprint of this size (pattern units) needs: HELD as they were, MADE
    anew, or FULL, where that is too much."""
    held = local.made[0] > 0.0 and 0.5 * local.made[0] <= size <= 2.0 * local.made[0]
    held = held and spread(pattern, frame, view, lights, local.domain, local.slab)
    if held and holds(local.domain, local.slab):
        return HELD
    aim(frame, view, lights, local.domain)
    local.made[0] = 0.0
    if not spread(pattern, frame, view, lights, local.domain, local.slab) or not make(pattern, size, local):
        return FULL
    local.made[0] = size
    return MADE


@leaf
def make(pattern: Pattern, size: float, local: Local) -> bool:
    """Make the faces of what a footprint needs, `slab`, and of somewhat more where little is near: `domain`.

    size: of the footprint, pattern units. False where there is too much.
    """
    domain, slab, found, strips, faces = local.domain, local.slab, local.found, local.strips, local.faces
    m = pattern.reach
    stepped = pattern.height > 0.0
    for groove in pattern.grooves:
        stepped = stepped or groove.priority > 0
    for k in range(len(AROUND)):
        more = max(AROUND[k] * size, BEYOND[k] * max(slab[0, 1] - slab[0, 0], slab[1, 1] - slab[1, 0]))
        settle(domain, slab, more)
        rim = domain.slab
        count = find(pattern, found, rim[0, 0] - m, rim[1, 0] - m, rim[0, 1] + m, rim[1, 1] + m, FEW[k])
        room = count >= 0
        for i in range(max(count, 0)):  # what overhangs is no height field
            profile = pattern.grooves[pattern.pieces[found.piece[i]].groove].profile
            room = room and (
                len(pattern.part_first) == 0 or pattern.part_first[profile] == pattern.part_first[profile + 1]
            )
        strips.made[0] = strips.made[1] = strips.made[2] = 0
        for i in range(max(count, 0)):
            if not room:
                break
            chunks = divide(
                pattern, found.piece[i], found.shift[i, 0], found.shift[i, 1], rim, CHORD * size, strips.chunks
            )
            room = room and chunks >= 0
            for j in range(chunks):
                room = room and lay(pattern, found.piece[i], i, strips.chunks[j], domain, stepped, strips)
        if room and envelope(strips, domain, pattern.height + pattern.depth, faces):
            return True
    return False
