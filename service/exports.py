"""An object's solid or one of its maps as a file: what the command and the route have in common."""

from __future__ import annotations

import re
import time
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, Literal

import numpy as np

import schema
from renderer import export, maps
from renderer.compile import PatternCache, compile_scene
from renderer.errors import Cancelled, RenderError
from service import mapfiles, solids
from service.overrides import MAX_SIDE
from service.pictures import Wish
from service.problems import scene_error
from service.settings import Settings
from service.store import PREFIX, MeshStore

Kind = Literal["solid", "height", "normal", "anisotropy"]
Format = Literal["glb", "stl", "ply", "obj", "png", "exr"]
SOLID = "solid"
SIZE = (1024, 1024)
TYPES = solids.TYPES | mapfiles.TYPES
NO_PICTURE = Wish(suffix=".png", method="base", samples=None, texels=None, resolution=(1, 1))


def suffixes(kind: str) -> tuple[str, ...]:
    """Of the files that a kind is written to, the usual one first."""
    return tuple(solids.TYPES if kind == SOLID else mapfiles.TYPES)


@dataclass(frozen=True)
class Order:
    """What is asked for."""

    kind: str = SOLID
    suffix: str = ".glb"
    object: int = 0
    size: tuple[int, int] = SIZE  # texels of a map
    thickness: float | None = None  # of a plate or an open mesh, world units
    limit: int = export.LIMIT  # triangles of a solid


def chosen(scene: schema.Scene, index: int | None) -> int:
    """The object that is meant: the only one there is, or that has a pattern. A ValueError lists what there is."""
    count = len(scene.objects)
    carrying = [row for row, thing in enumerate(scene.objects) if thing.pattern is not None] or list(range(count))
    if index is None and len(carrying) == 1:
        return carrying[0]
    if index is None or not 0 <= index < count:
        listed = [f"{row} ({scene.objects[row].shape.type}, {scene.objects[row].pattern})" for row in carrying[:20]]
        found = "none" if index is None else str(index)
        raise ValueError(f"expected the number of an object, one of {', '.join(listed)}, found {found}")
    return index


def size_of_text(text: str) -> tuple[int, int]:
    """Texels from N or WxH; a ValueError says what is wrong."""
    match = re.fullmatch(r"([1-9][0-9]{0,4})(?:x([1-9][0-9]{0,4}))?", text, re.ASCII)
    width, height = (int(match[1]), int(match[2] or match[1])) if match else (0, 0)
    if not match or max(width, height) > MAX_SIDE:
        raise ValueError(f"expected N or WxH, each side 1 to {MAX_SIDE}, found {text[:80]!r}")
    return width, height


def make(
    scene: schema.Scene,
    order: Order,
    *,
    meshes: Callable[[str], bytes] | None = None,
    patterns: PatternCache | None = None,
    threads: int | None = None,
    cancelled: Callable[[], bool] | None = None,
) -> tuple[bytes, dict[str, Any]]:
    """The file, and what there is to tell about it.

    Raises RenderError where there is no such solid or map, Cancelled where `cancelled` says so.
    """
    start = time.perf_counter()
    compiled = compile_scene(scene, (1, 1), patterns if patterns is not None else PatternCache(), meshes)
    told: dict[str, Any] = {"object": order.object, "kind": order.kind}
    if order.kind == SOLID:
        body = export.body(compiled, order.object, thickness=order.thickness, limit=order.limit)
        if cancelled is not None and cancelled():
            raise Cancelled
        names = list(scene.materials)
        told |= {
            "triangles": len(body.triangles),
            "vertices": len(body.vertices),
            "materials": [names[row] for row in np.unique(body.material)],
            "bounds": [body.vertices.min(axis=0).tolist(), body.vertices.max(axis=0).tolist()],
            "volume": export.volume(body),
        }
        data = solids.encode(body, scene.materials, order.suffix)
    else:
        values = maps.texture(compiled, order.object, order.kind, order.size, threads=threads, cancelled=cancelled)
        told["size"] = list(order.size)
        if order.kind == "height":
            told["low"], told["high"] = mapfiles.bounds(values)
        data = mapfiles.encode(order.kind, values, order.suffix)
    return data, told | {"bytes": len(data), "seconds": time.perf_counter() - start}


def serve(
    scene: schema.Scene,
    order: Order,
    settings: Settings,
    meshes: MeshStore,
    patterns: PatternCache,
    stopped: Callable[[], bool],
) -> bytes:
    """The file for a request."""

    def mesh(name: str) -> bytes:
        data = meshes.get(name.removeprefix(PREFIX))
        if data is None:
            raise FileNotFoundError(name)
        return data

    try:
        return make(scene, order, meshes=mesh, patterns=patterns, threads=settings.threads, cancelled=stopped)[0]
    except RenderError as error:
        raise scene_error(error.faults) from None
