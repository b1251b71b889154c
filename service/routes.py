"""The REST face."""

from __future__ import annotations

import json
import re
from dataclasses import dataclass, field
from functools import partial
from pathlib import Path
from typing import Annotated, Any

import anyio
import anyio.to_thread
from fastapi import APIRouter, Query, Request, Response
from fastapi.responses import JSONResponse

import schema
from renderer import compile as compiler
from service import bodies, charts, exports, overrides, pictures
from service.charts import ChartWish
from service.documents import CompiledPattern, Examples, Health, UploadedEnvmap, UploadedMesh, Validation
from service.pictures import TYPES, Wish
from service.problems import MEDIA_TYPE, ProblemError, findings
from service.renders import ClientGone, Renders
from service.settings import Settings
from service.store import PREFIX, SKY_SUFFIXES, SUFFIXES, MeshStore

VERSION = "0.1.0"
SCENE_BODY = {"requestBody": {"required": True, "content": {"application/json": {"schema": {"$ref": "#/scene"}}}}}
PATTERN_BODY = {"requestBody": {"required": True, "content": {"application/json": {"schema": {"$ref": "#/pattern"}}}}}
SUFFIX_OF = {kind: suffix for suffix, kind in TYPES.items()}
_BINARY = {"schema": {"type": "string", "format": "binary"}}
FileQuery = Annotated[
    str | None, Query(description="the file's name, for its suffix; a form's file has one", max_length=255)
]
FILE_BODY = {
    "requestBody": {
        "required": True,
        "content": {
            "application/octet-stream": _BINARY,
            "multipart/form-data": {
                "schema": {
                    "type": "object",
                    "properties": {"file": {"type": "string", "format": "binary"}},
                    "required": ["file"],
                }
            },
        },
    }
}
_EXAMPLE = re.compile(r"[A-Za-z0-9][A-Za-z0-9_.-]*")

router = APIRouter(prefix="/api")


@dataclass
class Shop:
    """What the requests share; one a process, at `app.state.shop`."""

    settings: Settings
    renders: Renders
    meshes: MeshStore
    patterns: compiler.PatternCache
    checks: anyio.CapacityLimiter = field(default_factory=lambda: anyio.CapacityLimiter(2))


def shop(request: Request) -> Shop:
    """The one that `request` goes to."""
    found = request.app.state.shop
    assert isinstance(found, Shop)
    return found


def problems(*statuses: int) -> dict[int | str, dict[str, Any]]:
    """OpenAPI's words for the errors that a route may answer with."""
    reference = {"schema": {"$ref": "#/components/schemas/ProblemDocument"}}
    return {s: {"description": "Problem document", "content": {MEDIA_TYPE: reference}} for s in statuses}


@router.get("/health")
async def health(request: Request) -> Health:
    """Whether the service is alive; answers at once, whatever is being rendered."""
    return Health(
        status="ok",
        version=VERSION,
        kernels="ready" if request.app.state.kernels_ready.is_set() else "compiling",
        renders=shop(request).renders.taken,
    )


@router.get("/schema", response_class=JSONResponse)
async def json_schema() -> dict[str, Any]:
    """The JSON Schema of a scene file."""
    return schema.json_schema()


@router.get("/examples")
async def examples(request: Request) -> Examples:
    """The names of the example scenes."""
    return Examples(examples=await anyio.to_thread.run_sync(_examples, shop(request).settings.examples))


@router.get(
    "/examples/{name}",
    response_class=JSONResponse,
    responses={
        200: {"description": "A scene", "content": {"application/json": {"schema": {"$ref": "#/scene"}}}},
        **problems(404, 422),
    },
)
async def example(request: Request, name: str) -> Response:
    """One of the example scenes."""
    folder = shop(request).settings.examples
    if name not in await anyio.to_thread.run_sync(_examples, folder):
        raise ProblemError(404, f"There is no example {name[:100]!r}.")
    text = await anyio.to_thread.run_sync(_example, folder, name, shop(request).meshes)
    return Response(text, media_type="application/json")


@router.post("/validate", openapi_extra=SCENE_BODY, responses=problems(413))
async def validate(request: Request) -> Validation:
    """All problems and warnings of a scene; 200 for a wrong one too."""
    here = shop(request)
    text = await bodies.read(request, here.settings.body_limit)
    report = await anyio.to_thread.run_sync(schema.check_text, text, limiter=here.checks)
    return Validation(valid=not report.problems, problems=findings(report.problems), warnings=findings(report.warnings))


@router.post(
    "/render",
    openapi_extra=SCENE_BODY,
    response_class=Response,
    responses={
        200: {
            "description": "The picture: PNG (sRGB), EXR or NPY (linear), by Accept. Server-Timing has the stages.",
            "content": dict.fromkeys(TYPES.values(), _BINARY),
        },
        **problems(406, 413, 422, 503),
    },
)
async def render(
    request: Request,
    method: Annotated[str | None, Query(description="instead of the scene's", max_length=32)] = None,
    samples: Annotated[
        int | None, Query(description="samples a pixel, of methods lines, csg, geometry and relief", ge=1, le=65536)
    ] = None,
    texels: Annotated[
        int | None, Query(description="texels along method relief's texture, instead of the scene's", ge=16, le=8192)
    ] = None,
    resolution: Annotated[str | None, Query(description="WxH, instead of the camera's", max_length=16)] = None,
) -> Response:
    """Waits for the picture of a scene. The render stops when the client goes."""
    here = shop(request)
    wish = Wish(
        SUFFIX_OF[negotiate(request.headers.get("accept"))],
        _method(method),
        samples,
        texels,
        None if resolution is None else _resolution(resolution),
    )
    text = await bodies.read(request, here.settings.body_limit)
    scene = await anyio.to_thread.run_sync(
        pictures.checked_for_service, text, wish, here.settings, here.meshes, limiter=here.checks
    )
    width, height = wish.resolution or scene.camera.resolution
    request.scope["state"]["pixels"] = width * height
    work = partial(pictures.paint, scene, wish, here.settings, here.meshes, here.patterns)
    try:
        data, picture = await here.renders.run(work, request)
    except ClientGone:
        return Response(status_code=499)
    timing = ", ".join(f"{stage};dur={1000 * seconds:.1f}" for stage, seconds in picture.seconds.items())
    return Response(data, media_type=TYPES[wish.suffix], headers={"Server-Timing": timing, "Vary": "Accept"})


@router.post(
    "/chart",
    openapi_extra=SCENE_BODY,
    response_class=Response,
    responses={
        200: {
            "description": "The chart by Accept: the picture, or all numbers with the bounds of what is not resolved.",
            "content": {"image/png": _BINARY, "application/json": {"schema": {"type": "object"}}},
        },
        **problems(406, 413, 422, 503),
    },
)
async def chart(
    request: Request,
    methods: Annotated[str | None, Query(description="M,M in place of all", max_length=200)] = None,
    resolution: Annotated[str | None, Query(description="WxH, small; 64 wide otherwise", max_length=16)] = None,
    seconds: Annotated[
        float | None, Query(description="of rendering; as many as the service gives otherwise", ge=1, le=600)
    ] = None,
) -> Response:
    """Measures speed against accuracy in small. Stops when the client goes."""
    here = shop(request)
    wish = ChartWish(
        negotiate(request.headers.get("accept"), tuple(charts.FILES)),
        None if methods is None else [name for name in methods.split(",") if _method(name)],
        None if resolution is None else _resolution(resolution),
        seconds,
    )
    text = await bodies.read(request, here.settings.body_limit)
    size = Wish(suffix=".png", method="base", samples=None, texels=None, resolution=(1, 1))
    scene = await anyio.to_thread.run_sync(
        pictures.checked_for_service, text, size, here.settings, here.meshes, limiter=here.checks
    )
    width, height = charts.size(scene, wish, here.settings)
    request.scope["state"]["pixels"] = width * height
    try:
        data = await here.renders.run(partial(charts.draw, scene, wish, here.settings, here.meshes), request)
    except ClientGone:
        return Response(status_code=499)
    return Response(data, media_type=wish.media, headers={"Vary": "Accept"})


@router.post(
    "/export",
    openapi_extra=SCENE_BODY,
    response_class=Response,
    responses={
        200: {
            "description": "The solid (GLB, STL, PLY, OBJ) or the map (PNG, EXR), by format or else by Accept.",
            "content": dict.fromkeys(exports.TYPES.values(), _BINARY),
        },
        **problems(406, 413, 422, 503),
    },
)
async def export(
    request: Request,
    number: Annotated[
        int | None, Query(alias="object", description="which, from 0; else the only one with a pattern", ge=0, le=65535)
    ] = None,
    kind: Annotated[exports.Kind, Query(description="the solid, or which map")] = "solid",
    format: Annotated[exports.Format | None, Query(description="instead of by Accept")] = None,
    size: Annotated[str | None, Query(description="texels of a map, N or WxH; 1024", max_length=16)] = None,
    thickness: Annotated[
        float | None, Query(description="of a rectangle or an open mesh, world units", gt=0, le=1e6)
    ] = None,
) -> Response:
    """Writes an object's solid, or a map of it, as a file."""
    here = shop(request)
    fitting = exports.suffixes(kind)
    if format is None:
        media = negotiate(request.headers.get("accept"), tuple(exports.TYPES[suffix] for suffix in fitting))
        suffix = next(suffix for suffix in fitting if exports.TYPES[suffix] == media)
    elif f".{format}" in fitting:
        suffix = f".{format}"
    else:
        raise _parameter(f"format: expected {', '.join(fitting)}, as the kind is {kind}, found {format}")
    try:
        texels = exports.SIZE if size is None else exports.size_of_text(size)
    except ValueError as error:
        raise _parameter(f"size: {error}") from None
    if texels[0] * texels[1] > here.settings.texel_limit:
        raise _parameter(f"size: expected at most {here.settings.texel_limit} texels, found {texels[0] * texels[1]}")
    text = await bodies.read(request, here.settings.body_limit)
    scene = await anyio.to_thread.run_sync(
        pictures.checked_for_service, text, exports.NO_PICTURE, here.settings, here.meshes, limiter=here.checks
    )
    try:
        row = exports.chosen(scene, number)
    except ValueError as error:
        raise _parameter(f"object: {error}") from None
    order = exports.Order(kind, suffix, row, texels, thickness, here.settings.triangle_limit)
    try:
        data = await here.renders.run(
            partial(exports.serve, scene, order, here.settings, here.meshes, here.patterns), request
        )
    except ClientGone:
        return Response(status_code=499)
    name = f"object{row}{'' if kind == exports.SOLID else f'-{kind}'}{suffix}"
    headers = {"Content-Disposition": f'attachment; filename="{name}"', "Vary": "Accept"}
    return Response(data, media_type=exports.TYPES[suffix], headers=headers)


@router.post("/patterns", openapi_extra=PATTERN_BODY, responses=problems(413, 422, 503))
async def compile_pattern(request: Request) -> CompiledPattern:
    """Compiles one pattern, as a scene's `patterns` has it, into the same cache that renders use."""
    here = shop(request)
    text = await bodies.read(request, here.settings.body_limit)
    pattern, warnings = await anyio.to_thread.run_sync(pictures.checked_pattern, text, limiter=here.checks)
    work = partial(pictures.compiled, pattern, warnings, here.patterns)
    try:
        return await here.renders.run(work, request)
    except ClientGone:
        raise ProblemError(499, "The client has gone.") from None


@router.post("/meshes", status_code=201, openapi_extra=FILE_BODY, responses=problems(400, 413, 415, 422))
async def upload_mesh(request: Request, name: FileQuery = None) -> UploadedMesh:
    """Takes in a mesh (OBJ, PLY, GLB), as the body itself or as the file of a form. Kept until the store is full."""
    stored, size = await _stored(request, name, SUFFIXES, "mesh")
    return UploadedMesh(id=Path(stored).stem, file=PREFIX + stored, bytes=size)


@router.post("/envmaps", status_code=201, openapi_extra=FILE_BODY, responses=problems(400, 413, 415, 422))
async def upload_envmap(request: Request, name: FileQuery = None) -> UploadedEnvmap:
    """Takes in a picture of the sky (EXR, HDR, PNG), as `/meshes` does a mesh, and keeps it beside those."""
    stored, size = await _stored(request, name, SKY_SUFFIXES, "picture")
    return UploadedEnvmap(id=Path(stored).stem, file=PREFIX + stored, bytes=size)


async def _stored(request: Request, name: str | None, suffixes: tuple[str, ...], what: str) -> tuple[str, int]:
    """Keeps the file of a request: its name in the store, and its size."""
    here = shop(request)
    data, own_name = await bodies.read_upload(request, here.settings.mesh_limit)
    suffix = Path(name or own_name).suffix.lower()
    if suffix not in suffixes:
        raise ProblemError(415, f"Expected a file name (?name=) that ends in {', '.join(suffixes)}.")
    if not data:
        raise ProblemError(422, f"The {what} is empty.")
    return await anyio.to_thread.run_sync(here.meshes.put, data, suffix), len(data)


def negotiate(accept: str | None, kinds: tuple[str, ...] = tuple(TYPES.values())) -> str:
    """The media type that an Accept header likes best; the first where it does not say."""
    best, best_quality = "", 0.0
    for kind in kinds:
        quality = _quality(kind, accept or "*/*")
        if quality > best_quality:
            best, best_quality = kind, quality
    if not best:
        raise ProblemError(406, f"Expected one of {', '.join(kinds)} in Accept.")
    return best


def _quality(kind: str, accept: str) -> float:
    """How much a header likes a media type: the most specific of its ranges counts."""
    ranges = {kind: 3, f"{kind.split('/')[0]}/*": 2, "*/*": 1}
    rank, quality = 0, 0.0
    for part in accept.split(","):
        name, *parameters = [piece.strip().lower() for piece in part.split(";")]
        if ranges.get(name, 0) <= rank:
            continue
        rank, quality = ranges[name], 1.0
        for parameter in parameters:
            if parameter.startswith("q="):
                try:
                    quality = float(parameter[2:])
                except ValueError:
                    quality = 0.0
    return quality


def _method(name: str | None) -> str | None:
    fault = overrides.method_fault(name) if name is not None else None
    if fault:
        raise _parameter(f"method: {fault}")
    return name


def _resolution(text: str) -> tuple[int, int]:
    try:
        return overrides.resolution(text)
    except ValueError as error:
        raise _parameter(f"resolution: {error}") from None


def _parameter(detail: str) -> ProblemError:
    return ProblemError(422, f"A parameter of the request is wrong: {detail}.")


def _examples(folder: Path) -> list[str]:
    return sorted(path.stem for path in folder.glob("*.json") if _EXAMPLE.fullmatch(path.stem))


def _example(folder: Path, name: str, meshes: MeshStore) -> bytes:
    """The scene, its files uploaded: the service reads none from a path that a scene names."""
    scene = json.loads((folder / f"{name}.json").read_bytes())
    for thing in [*(item["shape"] for item in scene.get("objects", [])), *scene.get("lights", [])]:
        file = thing.get("file")
        if file is not None:
            thing["file"] = PREFIX + meshes.put((folder / file).read_bytes(), Path(file).suffix)
    return json.dumps(scene, indent=2).encode()
