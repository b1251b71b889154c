"""The parts of a scene that parse, each with its place, also where the whole does not."""

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any, TypeVar

from pydantic import ValidationError

from .base import MAX_ENTRIES, Model
from .patterns import MAX_GROOVES, Groove
from .scene import Camera, Object, Scene

Place = tuple[str | int, ...]
M = TypeVar("M", bound=Model)


@dataclass(frozen=True, slots=True)
class Parts:
    """What checks across the scene look at."""

    camera: Camera | None
    objects: list[tuple[Place, Object]]
    grooves: list[tuple[Place, Groove]]


def parts_of_scene(scene: Scene) -> Parts:
    """All parts of a scene that parses."""
    objects: list[tuple[Place, Object]] = [(("objects", i), item) for i, item in enumerate(scene.objects)]
    grooves: list[tuple[Place, Groove]] = [
        (("patterns", name, "grooves", i), groove)
        for name, pattern in scene.patterns.items()
        for i, groove in enumerate(pattern.grooves)
    ]
    return Parts(scene.camera, objects, grooves)


def parts_of_data(data: Any) -> Parts:
    """The parts that parse of a scene that does not."""
    top = entries(data)
    camera = parsed(Camera, top.get("camera"))
    found = [(("objects", i), parsed(Object, raw)) for i, raw in enumerate(items(top.get("objects")))]
    objects: list[tuple[Place, Object]] = [(place, item) for place, item in found if item is not None]
    grooves: list[tuple[Place, Groove]] = []
    for place, raw in raw_grooves(data):
        groove = parsed(Groove, raw)
        if groove is not None:
            grooves.append((place, groove))
    return Parts(camera, objects, grooves)


def raw_grooves(data: Any) -> Iterator[tuple[Place, Any]]:
    """Every groove's data, whatever they are."""
    for name, pattern in entries(entries(data).get("patterns")).items():
        for index, raw in enumerate(items(entries(pattern).get("grooves"))):
            yield ("patterns", name, "grooves", index), raw


def parsed(model: type[M], raw: Any) -> M | None:
    """The record, or nothing where the data are none."""
    try:
        return model.model_validate(raw)
    except ValidationError:
        return None


def entries(raw: Any) -> dict[str, Any]:
    """An object's entries; none of anything else, nor of an object that is refused for its size."""
    return raw if isinstance(raw, dict) and len(raw) <= MAX_ENTRIES else {}


def items(raw: Any) -> list[Any]:
    """An array's items; none of anything else, nor of an array that is refused for its size."""
    return raw if isinstance(raw, list) and len(raw) <= MAX_GROOVES else []
