"""What must hold between the parts of a scene."""

import math
from collections.abc import Iterator
from typing import Any

from .errors import Problem, pointer, shown
from .parts import Parts, Place, entries, items, raw_grooves
from .scene import Object
from .shapes import Cylinder, Sphere
from .words import listed

MAX_LISTED = 10


def unresolved_names(data: Any) -> Iterator[Problem]:
    """Names of materials and patterns that the scene does not have. Reads raw data: half a scene will do."""
    top = entries(data)
    materials, patterns = entries(top.get("materials")), entries(top.get("patterns"))
    # Where the names themselves are unreadable, that is the problem.
    has_materials = materials is top.get("materials")
    has_patterns = patterns is top.get("patterns") or "patterns" not in top
    for index, item in enumerate(items(top.get("objects"))):
        if has_materials:
            yield from _unresolved(("objects", index, "material"), entries(item).get("material"), "material", materials)
        if has_patterns:
            yield from _unresolved(("objects", index, "pattern"), entries(item).get("pattern"), "pattern", patterns)
    if not has_materials:
        return
    for place, groove in raw_grooves(data):
        material = entries(groove).get("material")
        yield from _unresolved((*place, "material"), material, "material", materials)
        for facet, name in enumerate(items(material)):
            yield from _unresolved((*place, "material", facet), name, "material", materials)


def _unresolved(place: Place, name: Any, kind: str, known: dict[str, Any]) -> Iterator[Problem]:
    if not isinstance(name, str) or name in known:
        return
    names = sorted(known)
    more = ", …" if len(names) > MAX_LISTED else ""
    choice = f" ({listed(names[:MAX_LISTED])}{more})" if names else " (there is none)"
    yield Problem(pointer(*place), f"the name of a {kind}{choice}", shown(name))


def camera_inside(parts: Parts) -> Iterator[Problem]:
    """Objects that the camera stands in. Meshes are not looked into."""
    if parts.camera is None:
        return
    for place, item in parts.objects:
        if _is_inside(item, parts.camera.origin):
            found = f"a point inside the {item.shape.type} {pointer(*place)}"
            yield Problem("/camera/origin", "a point outside of all objects", found)


def _is_inside(item: Object, point: tuple[float, ...]) -> bool:
    x, y, z = _to_object(item, point)
    if isinstance(item.shape, Sphere):
        return math.hypot(x, y, z) < item.shape.radius
    if isinstance(item.shape, Cylinder):
        return math.hypot(x, y) < item.shape.radius and abs(z) < item.shape.height / 2
    return False


def _to_object(item: Object, point: tuple[float, ...]) -> tuple[float, float, float]:
    """A point of the world in the object's own frame: moved back, then turned back about z, y and x."""
    x, y, z = (p - t for p, t in zip(point, item.translate, strict=True))
    about_x, about_y, about_z = (math.radians(angle) for angle in item.rotate)
    x, y = _turned(x, y, -about_z)
    z, x = _turned(z, x, -about_y)
    y, z = _turned(y, z, -about_x)
    return x, y, z


def _turned(a: float, b: float, angle: float) -> tuple[float, float]:
    return a * math.cos(angle) - b * math.sin(angle), a * math.sin(angle) + b * math.cos(angle)
