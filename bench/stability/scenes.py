"""One plate with grooves, seen in a few pixels that are all alike: from factors to a scene.

The camera is far off under the least field of view, and looks at the near rim of the wall that faces it. Lengths are
in groove widths; the world's are WIDTH times that, so that the widest footprint stays within what a scene may say.
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np

from bench.scenes import Floats

Json = dict[str, Any]

WIDTH = 1e-3  # world units a groove width
FOV = 0.1  # degrees, the least that a camera may have
PIXELS = (9, 5)
PITCH = 4.0  # groove widths from one groove to the next
EYE_AZIMUTH, LIGHT_AZIMUTH = 20.0, 110.0  # degrees from the direction across the grooves
MARGIN, CROSSED = 5.0, 12.0  # groove widths of plate around what is seen: no ray gets farther along any groove
WAVE = 0.5  # amplitude of a perturbed groove's width
MOST_GROOVES, MOST_CIRCLES = 300_000, 10_000


class Case(NamedTuple):
    """The factors, and what they are where they do not vary."""

    view: float = 50.0  # the eye's elevation, degrees
    light: float = 40.0  # the light's
    footprint: float = 1.0  # a pixel's longer side on the plane, groove widths
    crossing: float | None = None  # the angle of a second family of grooves to the first, degrees
    run: float = 0.3  # of a wall, groove widths; 0: vertical
    aspect: float = 0.5  # depth over width
    radius: float = math.inf  # of the paths, half-widths
    slope: float = 0.0  # the steepest change of the half-width along the path
    apart: float | None = None  # a second groove beside each, so many groove widths away
    number: float | None = None  # of grooves in a footprint; where footprint is None they touch


class Family(NamedTuple):
    """Straight parallel grooves, world units, the target at (0, 0): their centre lines are at b = low .. high times
    the pitch from `origin`."""

    origin: tuple[float, float]
    angle: float  # of T from the p axis, radians
    pitch: float
    low: int
    high: int


class Setting(NamedTuple):
    """A scene, and what a truth of its own needs to know of it."""

    scene: Json
    families: tuple[Family, ...]  # none: not all straight
    profile: tuple[tuple[float, float], ...]  # world units
    grooves: float  # about how many the plate has on it, crossings counted
    light: tuple[float, float, float]  # unit vector to it


def spherical(azimuth: float, elevation: float) -> tuple[float, float, float]:
    """A unit vector; degrees."""
    a, e = math.radians(azimuth), math.radians(elevation)
    flat = math.cos(e) if elevation != 90.0 else 0.0
    return math.cos(a) * flat, math.sin(a) * flat, math.sin(e)


def profile_of(case: Case) -> tuple[tuple[float, float], ...]:
    """A trapezoid, down to a v: (b, w) in world units."""
    half, floor, deep = 0.5 * WIDTH, (0.5 - case.run) * WIDTH, case.aspect * WIDTH
    bottom = ((-floor, -deep), (floor, -deep)) if floor > 1e-9 * WIDTH else ((0.0, -deep),)
    return ((-half, 0.0), *bottom, (half, 0.0))


def seen(camera: Json, pixels: tuple[int, int]) -> float:
    """How far from the target the plane is seen, world units."""
    origin, forward, right, down = axes(camera, pixels)
    far = 0.0
    for x in (-0.5 * pixels[0], 0.5 * pixels[0]):
        for y in (-0.5 * pixels[1], 0.5 * pixels[1]):
            d = forward + x * right + y * down
            at = origin - d * (origin[2] / d[2])
            far = max(far, float(np.hypot(at[0], at[1])))
    return far


def axes(camera: Json, pixels: tuple[int, int]) -> tuple[Floats, Floats, Floats, Floats]:
    """The pinhole, the middle ray, and what a pixel to the right and down adds to a ray."""
    origin = np.array(camera["origin"], float)
    forward = -origin / np.linalg.norm(origin)
    right = np.cross(forward, camera["up"])
    right /= np.linalg.norm(right)
    step = 2.0 * math.tan(0.5 * math.radians(FOV)) / pixels[1]
    return origin, forward, right * step, np.cross(forward, right) * step


def setting(case: Case, pixels: tuple[int, int] = PIXELS) -> Setting:
    """The scene of a case; ValueError where it makes no sense."""
    footprint, pitch = case.footprint, PITCH
    if case.number is not None:
        pitch = footprint / case.number
    if pitch < 0.05:
        raise ValueError("more than 20 grooves one over another")
    half = 0.5 * WIDTH
    eye = spherical(EYE_AZIMUTH, case.view)
    angle = 2.0 * math.tan(0.5 * math.radians(FOV)) / pixels[1]
    distance = footprint * WIDTH * eye[2] / angle
    away = spherical(EYE_AZIMUTH, 0.0)
    camera: Json = {
        "origin": [distance * e for e in eye],
        "target": [0, 0, 0],
        "up": [0, 0, 1] if case.view < 89.0 else [-away[0], -away[1], 0],
        "fov": FOV,
        "resolution": list(pixels),
    }
    side = 2.0 * (seen(camera, pixels) + (MARGIN if case.crossing is None else CROSSED) * WIDTH)
    step = pitch * WIDTH
    reach = math.ceil((0.8 * side + (case.apart or 0.0) * WIDTH) / step) + 1
    if 2 * reach > MOST_GROOVES:
        raise ValueError(f"{2 * reach} grooves")
    profile = profile_of(case)
    shape = {"type": "polyline", "points": [list(point) for point in profile]}
    at = (half, 0.0)  # where the first groove's axis is; the target is (0, 0)
    grooves: list[Json] = []
    families: list[Family] = []
    shifts = [0.0] if case.apart is None else [0.0, case.apart * WIDTH]
    bends = [case.radius]
    turns = [0.0] if case.crossing is None else [0.0, math.radians(case.crossing)]
    count = 0.0
    for index, turn in enumerate(turns):
        for shift in shifts:
            if index == 0 and math.isfinite(bends[0]):
                grooves.append(_rings(case, shape, at[0] + shift, step, reach))
            else:
                tx, ty = -math.sin(turn), math.cos(turn)  # T; turned to the left
                bx, by = -ty, tx
                sx, sy = at[0] - shift * bx, at[1] - shift * by
                grooves.append(_lines(case, shape, (sx, sy), (tx, ty), step, reach, 1.5 * side + 60.0 * WIDTH))
                families.append(Family((sx, sy), math.atan2(ty, tx), step, -reach, reach))
            count += 2 * reach + 1
    if case.crossing is not None:
        # the crossings on the plate
        count += (side / step) ** 2 * math.sin(turns[1]) * len(shifts) ** 2
    straight = math.isinf(case.radius) and case.slope == 0.0
    light = spherical(LIGHT_AZIMUTH, case.light)
    scene: Json = {
        "intaglio": 1,
        "camera": camera,
        "lights": [{"type": "directional", "direction": [-x for x in light], "irradiance": [math.pi] * 3}],
        "materials": {"white": {"base_color": [1, 1, 1], "specular": 0}},
        "patterns": {"cut": {"grooves": grooves}},
        "objects": [
            {
                "shape": {"type": "rectangle", "size": [side, side]},
                "mapping": {"scale": [side, side], "offset": [-0.5 * side, -0.5 * side]},
                "material": "white",
                "pattern": "cut",
            }
        ],
    }
    return Setting(scene, tuple(families) if straight else (), profile, count, light)


def _lines(
    case: Case, shape: Json, at: tuple[float, float], t: tuple[float, float], step: float, reach: int, length: float
) -> Json:
    """Parallel grooves as one entry of the pattern: from -length to length along T, steps along B."""
    bx, by = -t[1], t[0]
    x, y = at[0] - reach * step * bx, at[1] - reach * step * by
    groove: Json = {
        "path": {
            "type": "polyline",
            "points": [[x - length * t[0], y - length * t[1]], [x + length * t[0], y + length * t[1]]],
        },
        "profile": shape,
        "repeat": {"type": "linear", "count": 2 * reach + 1, "step": [step * bx, step * by]},
    }
    if case.slope > 0.0:
        periods = case.slope * 2.0 * length / (math.pi * WAVE * WIDTH)
        if periods > 1e4:
            raise ValueError(f"{periods:.0f} waves on a path")
        # the steepest place is where the picture is
        groove["scale"] = {"type": "sine", "amplitude": WAVE, "periods": periods, "phase": -180.0 * (periods % 2.0)}
    return groove


def _rings(case: Case, shape: Json, at: float, step: float, reach: int) -> Json:
    """Circles around one centre to the left, of which one passes through (at, 0)."""
    radius = case.radius * 0.5 * WIDTH
    inner = min(reach, math.ceil(radius / step) - 1)
    if inner + reach > MOST_CIRCLES:
        raise ValueError(f"{inner + reach} circles")
    groove: Json = {
        "path": {"type": "circle", "center": [at - radius, 0.0], "radius": radius - inner * step},
        "profile": shape,
        "repeat": {"type": "concentric", "count": inner + reach + 1, "step": step},
    }
    if case.slope > 0.0:
        wanted = case.slope * radius / (0.5 * WIDTH)  # periods times amplitude
        periods = max(1, round(wanted / WAVE))
        groove["scale"] = {"type": "sine", "amplitude": min(wanted / periods, 1.0), "periods": periods}
    return groove
