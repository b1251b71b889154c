"""Flat mirrors show other objects as the eye's mirror image sees them (DESIGN 2.1; 000, 6.2).

Where a footprint sees nothing but the plane of a rectangle, all its rays go on from one point, the eye's image in that
plane, through the same square of the screen. So what it shows are footprints again, for a camera that is mirrored, and
what they see is found as what the camera sees: grooves by their areas, edges split; from mirror to mirror.

The report samples what other objects show. Here that is left for curved mirrors and facets of grooves: footprints are
the pixel's own and fit to each other, so that nothing is left out or counted twice.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from renderer.geometry.folds import any_within
from renderer.geometry.query import find, nearby
from renderer.geometry.view import on_plane, sky_behind, through_screen, view_of
from renderer.kernel import borrow, fixed, keep, kernel, leaf
from renderer.shading import Vector, dot, mirrored, unit
from renderer.tables import Camera, Floats, Lighting, Pattern

SOME = fixed(64)  # pieces that are looked at near a footprint; where more are near it is taken to see one
WEAKEST = fixed(6)  # halves
LEAST = 0.25  # of a pixel's side: what smaller parts show is left to rays, or mirrors would split each other's edges


def camera_behind(camera: Camera, mirror: np.void) -> Camera:
    """The camera's image in the plane of a rectangle, a row of OBJECT: what it sees is what is mirrored there."""
    normal, place = mirror["rotation"][:, 2], mirror["translation"]
    origin = camera.origin - 2.0 * float(normal @ (camera.origin - place)) * normal
    return Camera(origin, *(way - 2.0 * float(normal @ way) * normal for way in camera[1:]))


@kernel
def shows_others(
    pattern: Pattern, footprints: NDArray[np.void], chosen: NDArray[np.int64], frames: NDArray[np.void], camera: Camera
) -> NDArray[np.bool_]:
    """Which of the footprints `chosen` (n,) of a rectangle see its plane alone, past no ridge and no groove, and show
    none of them; only whole squares, which are looked at all over, and none of the smallest."""
    owned = nearby(pattern, SOME)
    found = borrow(owned)
    pattern, frames, camera = borrow(pattern), borrow(frames), borrow(camera)
    plain = np.zeros(len(chosen), np.bool_)
    for j in range(len(chosen)):
        footprint = footprints[chosen[j]]
        if footprint.size < LEAST or footprint.weight != footprint.size * footprint.size:
            continue
        frame = frames[footprint.frame]
        view = view_of(footprint, frame, camera)
        radius = 0.0  # what is mirrored leaves as far away as the eye sees over what is higher
        for k in range(4):
            p, q = on_plane(view, float(k & 1), float(k >> 1))
            over = pattern.height * math.hypot(frame.eye[0] - p, frame.eye[1] - q) / frame.eye[2]
            radius = max(radius, math.hypot(p - view.p, q - view.q) + over)
        far = radius + pattern.reach
        count = find(pattern, found, view.p - far, view.q - far, view.p + far, view.q + far, SOME)
        plain[j] = count >= 0 and not any_within(pattern, found, count, view, radius)
    keep(owned)
    return plain


@leaf
def sent_on(footprint: np.void, camera: Camera, normal: Floats, material: np.void) -> Vector:
    """The part of radiance, RGB, that a mirror of this normal sends on in the middle of a footprint."""
    middle = 0.5 * footprint.size
    way = unit(through_screen(camera, footprint.x + middle, footprint.y + middle))
    return mirrored(material, abs(dot((normal[0], normal[1], normal[2]), way)))


@kernel
def weakness(
    footprints: NDArray[np.void], chosen: NDArray[np.int64], camera: Camera, normal: Floats, material: np.void
) -> NDArray[np.int64]:
    """How often a half (n,), up to WEAKEST, still is the largest part of radiance that a mirror of this normal sends on
    in the footprints `chosen` (n,)."""
    weak = np.zeros(len(chosen), np.int64)
    for j in range(len(chosen)):
        part = sent_on(footprints[chosen[j]], camera, normal, material)
        most = max(part[0], part[1], part[2])
        while weak[j] < WEAKEST and most <= 0.5:
            weak[j], most = weak[j] + 1, 2.0 * most
    return weak


@kernel
def reflect_shown(
    shown: NDArray[np.void], seen: Floats, camera: Camera, lighting: Lighting, normal: Floats, material: np.void,
    footprints: NDArray[np.void], chosen: NDArray[np.int64], left_out: NDArray[np.bool_], radiance: Floats,
) -> None:  # fmt: skip
    """Add to the radiance, error and cost (m, 5) of the footprints `chosen` (n,) what a mirror of this normal sends on
    of what it shows: FOOTPRINTs, whose `pixel` says in which of the n, with their own (k, 5); else the sky. None to
    those that are left out (n,).

    camera: the mirrored one.
    """
    lighting = borrow(lighting)
    light, covered = np.zeros((len(chosen), 5)), np.zeros(len(chosen))
    for i in range(len(shown)):
        j = shown[i].pixel
        share = shown[i].weight / footprints[chosen[j]].weight
        covered[j] += share
        for c in range(4):
            light[j, c] += share * seen[i, c]
        light[j, 4] += seen[i, 4]
    for j in range(len(chosen)):
        if left_out[j]:
            continue
        footprint = footprints[chosen[j]]
        part = sent_on(footprint, camera, normal, material)
        rest = 1.0 - covered[j]
        if rest > 0.0:
            sky = sky_behind(lighting, camera, footprint.x, footprint.y, footprint.size)
            for c in range(3):
                light[j, c] += rest * sky[c]
        for c in range(3):
            radiance[chosen[j], c] += part[c] * light[j, c]
        radiance[chosen[j], 3] += max(part[0], part[1], part[2]) * light[j, 3]
        radiance[chosen[j], 4] += light[j, 4]
