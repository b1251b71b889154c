"""From a scene's text to the bytes of a picture: what the routes do off the event loop."""

from __future__ import annotations

import hashlib
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from http import HTTPStatus
from typing import Any

import schema
from renderer import compile as compiler
from renderer import film, pipeline
from renderer.errors import RenderError
from schema.text import data_of_text
from service import overrides
from service.documents import CompiledPattern, Finding
from service.problems import ProblemError, findings, scene_error
from service.settings import Settings
from service.store import PREFIX, SKY_SUFFIXES, SUFFIXES, MeshStore

TYPES = {".png": "image/png", ".exr": "image/x-exr", ".npy": "application/x-npy"}
_NAME = "pattern"  # what a pattern that comes alone is called in the scene made around it


@dataclass(frozen=True)
class Wish:
    """What a request asks for beside the scene."""

    suffix: str
    method: str | None
    samples: int | None
    texels: int | None
    resolution: tuple[int, int] | None


def checked(text: bytes) -> schema.Scene:
    """The scene, or all its problems."""
    report = schema.check_text(text)
    if report.scene is None or report.problems:
        raise scene_error(report.problems)
    return report.scene


def checked_for_service(text: bytes, wish: Wish, settings: Settings, meshes: MeshStore) -> schema.Scene:
    """As `checked`, and the scene asks for no file of this machine and no more than the service gives."""
    scene = checked(text)
    problems = _foreign_files(scene, meshes)
    if problems:
        raise scene_error(problems)
    width, height = wish.resolution or scene.camera.resolution
    method = wish.method or scene.render.method
    samples = (wish.samples or scene.render.samples_of(method)) if method in overrides.SAMPLED else 1
    for count, limit, what in (
        (width * height, settings.pixel_limit, "pixels"),
        (width * height * samples, settings.sample_limit, "samples in all pixels"),
    ):
        if count > limit:
            raise ProblemError(
                HTTPStatus.UNPROCESSABLE_ENTITY,
                f"The picture is too large for this service: at most {limit} {what}.",
                [schema.Problem("/camera/resolution", f"at most {limit} {what}", str(count))],
            )
    return scene


def reader(meshes: MeshStore) -> Callable[[str], bytes]:
    """What gives the bytes of an uploaded file by the name that a scene has for it."""

    def mesh(name: str) -> bytes:
        data = meshes.get(name.removeprefix(PREFIX))
        if data is None:
            raise FileNotFoundError(name)
        return data

    return mesh


def paint(
    scene: schema.Scene,
    wish: Wish,
    settings: Settings,
    meshes: MeshStore,
    patterns: compiler.PatternCache,
    stopped: Callable[[], bool],
) -> tuple[bytes, pipeline.Picture]:
    """The picture as a file of the wished kind."""
    try:
        picture = pipeline.render(
            scene,
            method=wish.method,
            samples=wish.samples,
            texels=wish.texels,
            threads=settings.threads,
            resolution=wish.resolution,
            cancelled=stopped,
            meshes=reader(meshes),
            patterns=patterns,
        )
    except RenderError as error:
        raise scene_error(error.faults) from None
    return film.encode(picture.radiance, wish.suffix, scene.render.exposure), picture


def checked_pattern(text: bytes) -> tuple[schema.Pattern, list[Finding]]:
    """A pattern that comes without a scene, and its warnings: checked in the smallest scene that uses it."""
    pattern, problems = data_of_text(text)
    if problems:
        raise scene_error(problems)
    report = schema.check(
        {
            "intaglio": 1,
            "camera": {"origin": [0, 0, 2], "target": [0, 0, 0], "up": [0, 1, 0], "fov": 40, "resolution": [8, 8]},
            "lights": [{"type": "directional", "direction": [0, 0, -1], "irradiance": [1, 1, 1]}],
            "materials": {name: {"base_color": [0.5, 0.5, 0.5]} for name in {"object", *_materials(pattern)}},
            "patterns": {_NAME: pattern},
            "objects": [{"shape": {"type": "rectangle", "size": [1, 1]}, "material": "object", "pattern": _NAME}],
        }
    )
    if report.scene is None or report.problems:
        raise scene_error(_relative(findings(report.problems)))
    found = report.scene.patterns[_NAME]
    worldly = [
        schema.Problem(f"/grooves/{index}/path/space", '"pattern": without an object there is no world', '"world"')
        for index, groove in enumerate(found.grooves)
        if groove.path.type == "polyline" and groove.path.space == "world"
    ]
    if worldly:
        raise scene_error(worldly)
    return found, _relative(findings(report.warnings))


def compiled(
    pattern: schema.Pattern, warnings: list[Finding], patterns: compiler.PatternCache, _: Callable[[], bool]
) -> CompiledPattern:
    """Compiles a pattern into the cache, or finds it there, and tells what came of it."""
    start = time.perf_counter()
    try:
        found = patterns.pattern(pattern)
    except RenderError as error:
        raise scene_error(_relative(findings(error.faults))) from None
    seconds = time.perf_counter() - start
    columns, rows = found.tables.grid.shape
    return CompiledPattern(
        id=hashlib.sha256(pattern.model_dump_json().encode()).hexdigest()[:32],
        grooves=len(pattern.grooves),
        pieces=len(found.tables.pieces),
        bytes=found.bytes,
        grid=(int(columns), int(rows)),
        seconds=seconds,
        warnings=warnings,
    )


def _relative(listed: Sequence[Finding]) -> list[Finding]:
    """Pointers into the pattern instead of into the scene around it."""
    prefix = f"/patterns/{_NAME}"
    return [f.model_copy(update={"pointer": f.pointer.removeprefix(prefix)}) for f in listed]


def _materials(pattern: Any) -> set[str]:
    """The materials that the grooves name; nothing is known about the pattern yet."""
    names: set[str] = set()
    grooves = pattern.get("grooves") if isinstance(pattern, dict) else None
    for groove in grooves if isinstance(grooves, list) else []:
        named = groove.get("material") if isinstance(groove, dict) else None
        names.update(name for name in (named if isinstance(named, list) else [named]) if isinstance(name, str))
    return names


def _foreign_files(scene: schema.Scene, meshes: MeshStore) -> list[schema.Problem]:
    """Files in the scene that are no uploads."""
    problems = []
    for pointer, name in schema.files(scene):
        kind, route, suffixes = "a mesh", "meshes", SUFFIXES
        if pointer.startswith("/lights"):
            kind, route, suffixes = "an envmap", "envmaps", SKY_SUFFIXES
        if not name.startswith(PREFIX) or not name.endswith(suffixes):
            expected = f"{PREFIX}ID.SUFFIX, as POST /api/{route} gives it; the service reads no files"
            problems.append(schema.Problem(pointer, expected, repr(name)))
        elif meshes.get(name.removeprefix(PREFIX)) is None:
            problems.append(schema.Problem(pointer, f"{kind} uploaded (POST /api/{route})", f"no upload {name!r}"))
    return problems
