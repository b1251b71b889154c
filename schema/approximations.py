"""Where a valid scene is rendered only approximately, or not all of it."""

import math
from collections.abc import Iterator

from . import svg
from .errors import Problem, pointer
from .materials import Material
from .parts import Parts, Place
from .paths import CirclePath, Path, PolylinePath, SpiralPath, SvgPath
from .patterns import Groove
from .repeats import ConcentricRepeat
from .scene import Scene

SHARPEST_TURN = math.radians(168)  # a mitre there is ten times as long as the groove is wide


def _warning(place: Place, expected: str, found: str) -> Problem:
    return Problem(pointer(*place), expected, found, "warning")


def tight_paths(parts: Parts) -> Iterator[Problem]:
    """Paths bent tighter than their groove is wide. One warning a groove: the tightest place."""
    for place, groove in parts.grooves:
        half = groove.half_width()
        found = _tightest(groove.path, groove)
        if found is not None and found[1] < half:
            at, radius = found
            expected = f"a radius of curvature of at least {half:g}, half the groove's width"
            yield _warning((*place, "path", *at), expected, f"{radius:g}, bent tighter than the groove is wide")
        if isinstance(groove.path, PolylinePath):
            yield from _sharp_corner(place, groove.path)


def _tightest(path: Path, groove: Groove) -> tuple[Place, float] | None:
    if isinstance(path, CirclePath):
        repeat = groove.repeat
        grown = (repeat.count - 1) * repeat.step if isinstance(repeat, ConcentricRepeat) else 0.0
        return ("radius",), path.radius + min(0.0, grown)
    if isinstance(path, SpiralPath):
        # r = inner + a * angle; its radius of curvature grows with r.
        inner, a = path.inner_radius, (path.outer_radius - path.inner_radius) / (2 * math.pi * path.turns)
        return ("inner_radius",), (inner * inner + a * a) ** 1.5 / (inner * inner + 2 * a * a)
    if isinstance(path, SvgPath):
        return ("d",), min(segment.tightest_radius() for segment in svg.segments(path.d))
    return None


def _sharp_corner(place: Place, path: PolylinePath) -> Iterator[Problem]:
    # Points that coincide with the one before turn nothing.
    corners = [(i, point) for i, point in enumerate(path.points) if i == 0 or point != path.points[i - 1]]
    if path.closed:
        if corners[-1][1] == corners[0][1]:
            corners.pop()
        corners = [corners[-1], *corners, corners[0]]
    sharpest, at = max(
        ((_turn(a, b, c), i) for (_, a), (i, b), (_, c) in zip(corners, corners[1:], corners[2:], strict=False)),
        default=(0.0, 0),
    )
    if sharpest > SHARPEST_TURN:
        expected = f"a corner that turns by at most {math.degrees(SHARPEST_TURN):g} degrees"
        found = f"a turn by {math.degrees(sharpest):.4g} degrees, which no mitre fits"
        yield _warning((*place, "path", "points", at), expected, found)


def _turn(a: tuple[float, ...], b: tuple[float, ...], c: tuple[float, ...]) -> float:
    """The angle between a to b and b to c; 0 for those under a right angle, to be quick where there are many."""
    along = (b[0] - a[0]) * (c[0] - b[0]) + (b[1] - a[1]) * (c[1] - b[1])
    if len(a) == 3:
        along += (b[2] - a[2]) * (c[2] - b[2])
    return math.acos(max(-1.0, along / (math.dist(a, b) * math.dist(b, c)))) if along < 0 else 0.0


def left_out(scene: Scene) -> Iterator[Problem]:
    """What is not seen in this scene."""
    for name in sorted(_used_materials(scene)):
        material = scene.materials[name]
        if scene.render.bounces == 0 and material.transmission > 0 and material.metallic < 1:
            found = f"{material.transmission:g}: refraction is seen by bounces alone, and there are none"
            yield _warning(("materials", name, "transmission"), "0, as render.bounces is 0", found)
        if scene.render.bounces == 0 and material.roughness == 0 and _has_mirror(material):
            found = "0: an ideal mirror is seen by bounces alone, and there are none"
            yield _warning(("materials", name, "roughness"), "more than 0, as render.bounces is 0", found)


def _has_mirror(material: Material) -> bool:
    return material.metallic > 0 or material.specular > 0


def _used_materials(scene: Scene) -> set[str]:
    used = {item.material for item in scene.objects}
    for pattern in {item.pattern for item in scene.objects if item.pattern is not None}:
        for groove in scene.patterns[pattern].grooves:
            named = groove.material if isinstance(groove.material, tuple) else (groove.material,)
            used |= {name for name in named if name is not None}
    return used
