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
        ("start_mitre", "f8"),  # tan of half the turn at a CORNER, positive for a left turn: the piece begins
        ("finish_mitre", "f8"),  # at s = mitre * b and ends at s = length - mitre * b; 0 for other ends
        ("size", "f4"),  # scale of the whole cross-section given by the placement (scatter); 1 otherwise
        ("half", "f4"),  # no |b| of the cross-section is larger anywhere along the piece, pattern units
        ("groove", "i4"),  # row of the GROOVE table
        ("start_end", "u1"), ("finish_end", "u1"),  # SMOOTH, CORNER, FLAT or PROFILE
        ("closed", "u1"),  # 1: a whole circle, no ends at all
        ("ended", "u1"),  # 1: one of the ends is PROFILE, whose cap goes on past it
        ("start_step", "u1"), ("finish_step", "u1"),  # 1: the next piece's height may differ along the mitre
    ]
)  # fmt: skip
"""A line or arc of a placed path. (s, b) are its local coordinates: s arc length from the start point, b the signed
distance to the left of the path. At a mitre they are those of the straight tangent at that end, on arcs too."""

# Kinds of the scale f(t).
SCALE_CONSTANT, SCALE_LINEAR, SCALE_SINE, SCALE_TABLE = 0, 1, 2, 3

GROOVE = np.dtype(
    [
        ("profile", "i4"),  # row of PROFILE
        ("priority", "i4"),  # rank: 0 is the lowest priority of the pattern, consecutive
        ("slot", "i4"),  # first entry of the groove's facets in Pattern.facet_slot
        ("like", "i4"),  # the first groove with the same profile and materials
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
        ("left", "f8"), ("right", "f8"),  # the least and the greatest b: C_0.b and C_n.b, but where it overhangs
        ("height", "f8"), ("depth", "f8"),  # the highest point above and the lowest below w = 0, both >= 0
    ]
)  # fmt: skip
"""Facet i of a profile joins its points i and i + 1."""

PART = np.dtype(
    [
        ("b0", "f8"), ("b1", "f8"),  # from b0 to b1 > b0
        ("low0", "f8"), ("low1", "f8"),  # w of the lower side at b0 and at b1
        ("high0", "f8"), ("high1", "f8"),  # w of the upper side there; inf: it has none
        ("lower", "i4"), ("upper", "i4"),  # the facets on which these sides lie; -1: the plane below, or no upper side
        ("removes", "i4"),  # 1: material is removed, 0: it is added
    ]
)  # fmt: skip
"""A trapezoid of a profile that overhangs, pattern units at scale 1. Those that remove do not overlap one another, nor
do those that add, nor either kind the other; their union is what the groove removes, and what it adds above w = 0.
Their left and right sides lie on vertical facets, or on neighbours."""


class Grid(NamedTuple):
    """The uniform grid over the paths (000, 4.1): which pieces' centre lines cross a cell."""

    origin: Floats  # (2,) lower left corner, pattern units
    cell: Floats  # (2,) size of a cell, pattern units
    shape: Ints  # (2,) cells along p and q
    tile: Floats  # (2,) period along p and q; 0, 0 where the pattern does not repeat
    first: Ints  # (nx * ny + 1,) where the list of cell (ix, iy), row iy * nx + ix, begins in `items`
    items: Ints  # rows of PIECE, ascending within a cell
    crossings: Floats  # (m, 2) where centre lines cross, pattern units, in the order of the cells
    crossing_first: Ints  # (nx * ny + 1,) where those of a cell begin; (0,) where there are none


NO_GRID = Grid(
    np.zeros(2), np.ones(2), np.zeros(2, np.int32), np.zeros(2), np.zeros(1, np.int32), np.zeros(0, np.int32),
    np.zeros((0, 2)), np.zeros(0, np.int32),
)  # fmt: skip


FAMILY = np.dtype(
    [
        ("x", "f8"), ("y", "f8"),  # a point of the first path of the first period: its start; rings: their centre
        ("tx", "f8"), ("ty", "f8"),  # T, the unit tangent of straight paths; (0, 0): rings, B points to their centre
        ("radius", "f8"),  # rings: the largest radius, which is the first along B; else 0
        ("period", "f8"),  # along B, > 0
        ("count", "f8"),  # periods; inf: the tile repeats them for ever
        ("length", "f8"),  # of each straight path; inf: no end is ever met
        ("slip", "f8"),  # so much farther along T does each period begin than the one before
        ("start", "f8"), ("finish", "f8"),  # where the first period's cross-sections begin and end along B, from (x, y)
        # or the largest ring
        ("height", "f8"), ("depth", "f8"),  # the highest point above w = 0 and the lowest below, both >= 0
        ("half", "f8"),  # the least half-width of its grooves
        ("first", "i4"), ("last", "i4"),  # its grooves: rows of MEMBER, first <= row < last, from left to right
        ("folds", "i4"),  # 1: periods and their grooves are the same all along and do not overlap; 0: in others' way
    ]
)  # fmt: skip
"""Grooves that a repeat sets side by side at one distance: straight and parallel, or circles about one centre. Frame
and lengths are those of the pattern plane, pattern units; period k lies at k * period along B."""

MEMBER = np.dtype(
    [
        ("offset", "f8"),  # where its path lies along B in the first period, from the family's point
        ("turned", "f8"),  # -1: the path runs against T; else 1
        ("scale", "f8"),  # of its cross-section
        ("piece", "i4"), ("stride", "i4"),  # row of PIECE in the first period, and from one period to the next
    ]
)  # fmt: skip
"""A groove of a family's period."""


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
    parallel: bool  # all pieces are lines of one direction
    near: int  # no more pieces than this are looked at near one stretch of a ray
    # Where profiles overhang (their b runs back: points of theirs are then no height field), what they make:
    parts: NDArray[np.void] = np.zeros(0, PART)  # a profile at a time: those that remove, then those that add; by b0, w
    part_first: Ints = np.zeros(0, np.int32)  # (k + 1,) where each profile's parts begin, none if it is a height field;
    # (0,) where no profile overhangs
    families: NDArray[np.void] = np.zeros(0, FAMILY)
    members: NDArray[np.void] = np.zeros(0, MEMBER)
    rest: Grid = NO_GRID  # over the pieces that are in no family; where there are no families, none


BARE = Pattern(
    NO_GRID, np.zeros(0, PIECE), np.zeros(0, GROOVE), np.zeros(0, PROFILE_ROW), np.zeros((0, 2)), np.zeros(0, np.int32),
    np.zeros((0, 2)), 0.0, 0.0, 0.0, 0.0, True, 0,
)  # fmt: skip
"""The pattern of a surface without grooves."""


MATERIAL = np.dtype(
    [
        ("base_color", "f8", (3,)),
        ("emissive", "f8", (3,)),
        ("metallic", "f8"),
        ("alpha", "f8"),  # roughness squared; 0: ideal, no response to direct light
        ("f0", "f8"), ("f90", "f8"),  # Fresnel reflectance of the dielectric, head on and grazing
        ("transmission", "f8"), ("ior", "f8"),
    ]
)  # fmt: skip

DIRECTIONAL, POINT = 0, 1
MAX_LIGHTS = 64  # bits of FOOTPRINT.blocked

LIGHT = np.dtype(
    [
        ("kind", "i4"),
        ("vector", "f8", (3,)),  # DIRECTIONAL: unit vector to the light; POINT: its position, world units
        ("color", "f8", (3,)),  # DIRECTIONAL: irradiance on a plane facing it; POINT: intensity
    ]
)

RECTANGLE, SPHERE, CYLINDER, MESH = 0, 1, 2, 3

OBJECT = np.dtype(
    [
        ("shape", "i4"),
        ("size", "f8", (2,)),  # rectangle: width, height; sphere: radius; cylinder: radius, height
        ("rotation", "f8", (3, 3)),  # columns: the object's axes in the world
        ("translation", "f8", (3,)),
        ("mapping", "f8", (4,)),  # pattern = uv * (m0, m1) + (m2, m3)
        ("material", "i4"),  # row of MATERIAL
        ("pattern", "i4"),  # index of the scene's compiled patterns; -1: bare
        ("clear", "i4"),  # 1: a material of its surface lets light into the body
    ]
)

HIT = np.dtype(
    [
        ("object", "i4"),  # row of OBJECT; -1: nothing was hit
        ("face", "i4"),  # mesh: triangle; cylinder: 0 the side, 1 a cap; else 0
        ("t", "f8"),  # distance along the ray in lengths of its direction
        ("u", "f8"), ("v", "f8"),  # texture coordinates; on a cap: local x and y
        ("normal", "f8", (3,)),  # geometric, world, unit, to the outside
    ]
)  # fmt: skip

FRAME = np.dtype(
    [
        ("object", "i4"),
        ("grooved", "i4"),  # 0: a cylinder's cap or the back of an opaque surface, which carry no pattern
        ("within", "i4"),  # 1: seen from within a clear body, from below; the back of an opaque surface is turned round
        ("origin", "f8", (3,)),  # a point of the surface, world
        ("pq", "f8", (2,)),  # its pattern coordinates
        ("axes", "f8", (3, 3)),  # columns: dP/dp, dP/dq, sigma N: world units a pattern unit
        ("dual", "f8", (3, 3)),  # inverse of `axes`: rows carry world vectors, and normals back, to pattern space
        ("eye", "f8", (3,)),  # the camera in pattern space (absolute p, q; w)
        ("form", "f8", (3,)),  # a, b, c: (a dp^2 + 2 b dp dq + c dq^2) / 2 is how far the surface falls below the
        # plane, pattern units (the second fundamental form over sigma); 0 where it is flat
        ("drift", "f8", (3,)),  # how a sphere's coordinates bend along the surface, and sigma changes: Christoffel's
        # symbols q_pp and p_pq, and d ln(sigma) / dq, per pattern unit
    ]
)
"""The tangent plane at a surface point: X = origin + axes (x - (pq, 0)). A flat object has one for all its pixels."""

# How sight passes by at an outline (FOOTPRINT.open).
THROUGH = 1  # it may, through the grooves
BESIDE = 2  # it may meet ridges beside the bare shape: only a part of the footprint is on it

FOOTPRINT = np.dtype(
    [
        ("pixel", "i4"),  # row-major in the tile
        ("frame", "i4"),  # row of FRAME
        ("blocked", "u8"),  # bit l: another object stands between the surface and light l,
        ("torn", "u8"),  # ... or between that and the highest or the lowest points of the grooves, but not both
        ("open", "u1"),  # THROUGH or BESIDE, at the outline of a sphere or a cylinder
        ("x", "f8"), ("y", "f8"), ("size", "f8"),  # its square on the screen: left, top, edge; in pixels
        ("weight", "f8"),  # the part of the pixel that it stands for: its own, but on an edge that is not split further
    ]
)  # fmt: skip
"""A square of the screen all of which sees one smooth surface: a pixel, or a part of one on a silhouette. Or a pixel at
the outline of a shape with ridges, which stand over it."""


class Camera(NamedTuple):
    """A pinhole: the ray through screen point (x, y), in pixels from the top left, is corner + x right + y down."""

    origin: Floats  # (3,) world
    corner: Floats  # (3,)
    right: Floats  # (3,)
    down: Floats  # (3,)


RAY = np.dtype(
    [
        ("origin", "f8", (3,)), ("way", "f8", (3,)),  # world; `way` is a unit vector
        ("through", "f8", (3,)),  # what radiance from there counts in the footprint, RGB
        ("row", "i8"),  # EIGHTHS times the footprint's index, and which of them its sample is in
        ("number", "i8"),  # of the footprint's samples
        ("bounces", "i4"),  # that are left, the one on what it meets counted
        ("object", "i4"),  # row of OBJECT that it leaves; -1: the camera's
        ("within", "i4"),  # 1: it goes on inside that object's body
        ("clear", "f8"),  # how far it goes before it has left the groove it comes from, world units
    ]
)  # fmt: skip
"""A ray that has left an object's surface for the rest of the scene, or for the inside of its body."""


GLOSS_LEVELS = 8
IRRADIANCE = GLOSS_LEVELS + 1


class Surroundings(NamedTuple):
    """A picture of the sky, and what it comes to for surfaces that nothing stands before.

    Tables are equirectangular, rows from the zenith down; columns begin in the world's y direction and turn towards x.
    Table 0 is the picture itself. Table k up to GLOSS_LEVELS is its mean over the lobe of a metal of roughness
    k / GLOSS_LEVELS that is seen head on, by the mirror's direction. Table IRRADIANCE is that over the cosine, by the
    normal: the radiance of a white matt surface.
    """

    texels: NDArray[np.float32]  # (n, 3) of all tables, row by row
    tables: Ints  # (IRRADIANCE + 1, 3) first row of `texels`, height, width; (0, 3) where there is no picture
    scale: float  # on all of them
    turn: float  # counterclockwise about the world's z axis, in whole turns
    white: float  # radiance of a white matt surface turned to where that is most, mean of the channels


NO_SURROUNDINGS = Surroundings(np.zeros((0, 3), np.float32), np.zeros((0, 3), np.int32), 0.0, 0.0, 0.0)


class Lighting(NamedTuple):
    """All that shines."""

    lights: NDArray[np.void]  # (n,) LIGHT, n <= 64
    sky: Floats  # (3,) radiance of the constant sky
    surroundings: Surroundings = NO_SURROUNDINGS
    left: float = 0.0  # the sky that rays find instead: radiance of a white matt surface under it, mean of the channels


METHODS = ("none", "base", "segment", "line", "csg", "geometry", "relief", "area", "lines")
"""What the AOV `method` counts: the index of the method that a pixel took; `none` where the camera sees no object."""
NONE, BASE, SEGMENT_METHOD, LINE, CSG, GEOMETRY, RELIEF, AREA, LINES = range(9)
NOT_MINE = 255  # ... of a footprint that a kernel leaves to the next method
CROWDED = 254  # ... as there is more near it than the kernel was to take, or has room for
