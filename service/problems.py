"""Errors as problem documents (RFC 9457), the framework's own too."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from http import HTTPStatus
from typing import Protocol

from fastapi import FastAPI, Request
from fastapi.exceptions import RequestValidationError
from fastapi.responses import JSONResponse
from starlette.exceptions import HTTPException

from service.documents import Finding, ProblemDocument

MEDIA_TYPE = "application/problem+json"
SCENE = "urn:intaglio:scene"  # the scene or the pattern has problems
BUSY = "urn:intaglio:busy"  # too many renders at once: try again
TOO_LONG = "urn:intaglio:too-long"  # the render ran into its time limit


class _Found(Protocol):
    """A schema.Problem or a renderer.errors.Fault."""

    @property
    def pointer(self) -> str: ...
    @property
    def expected(self) -> str: ...
    @property
    def found(self) -> str: ...


class ProblemError(Exception):
    """Ends a request with a problem document."""

    def __init__(
        self,
        status: int,
        detail: str,
        problems: Iterable[_Found] = (),
        *,
        kind: str = "about:blank",
        headers: Mapping[str, str] | None = None,
    ) -> None:
        super().__init__(detail)
        self.status = status
        self.detail = detail
        self.problems = findings(problems)
        self.kind = kind
        self.headers = headers


def findings(problems: Iterable[_Found]) -> list[Finding]:
    """Problems as they go over the wire."""
    return [Finding(pointer=p.pointer, expected=p.expected, found=p.found) for p in problems]


def scene_error(problems: Iterable[_Found]) -> ProblemError:
    """The scene is wrong: 422, with all its problems."""
    listed = list(problems)
    count = f"{len(listed)} problem{'' if len(listed) == 1 else 's'}"
    return ProblemError(HTTPStatus.UNPROCESSABLE_ENTITY, f"The scene has {count}.", listed, kind=SCENE)


def response(error: ProblemError) -> JSONResponse:
    """The problem document of `error`."""
    document = ProblemDocument(
        type=error.kind,
        title=_title(error.status),
        status=error.status,
        detail=error.detail,
        problems=error.problems,
    )
    return JSONResponse(document.model_dump(), error.status, headers=error.headers, media_type=MEDIA_TYPE)


def install(app: FastAPI) -> None:
    """Make every error that leaves `app` a problem document."""

    async def problem(_: Request, error: Exception) -> JSONResponse:
        assert isinstance(error, ProblemError)
        return response(error)

    async def http(request: Request, error: Exception) -> JSONResponse:
        assert isinstance(error, HTTPException)
        detail = str(error.detail)
        if detail == _title(error.status_code):
            detail = f"{detail}: {request.method} {request.url.path}"
        return response(ProblemError(error.status_code, detail, headers=error.headers))

    async def parameters(_: Request, error: Exception) -> JSONResponse:
        assert isinstance(error, RequestValidationError)
        problems = [
            Finding(
                pointer="",
                expected=f"{' '.join(str(part) for part in item['loc'])}: {item['msg']}",
                found=repr(item.get("input"))[:100],
            )
            for item in error.errors()
        ]
        return response(ProblemError(HTTPStatus.UNPROCESSABLE_ENTITY, "A parameter of the request is wrong.", problems))

    async def bug(_: Request, error: Exception) -> JSONResponse:
        return response(
            ProblemError(HTTPStatus.INTERNAL_SERVER_ERROR, f"An error of the service: {type(error).__name__}.")
        )

    app.add_exception_handler(ProblemError, problem)
    app.add_exception_handler(HTTPException, http)
    app.add_exception_handler(RequestValidationError, parameters)
    app.add_exception_handler(Exception, bug)


def _title(status: int) -> str:
    try:
        return HTTPStatus(status).phrase
    except ValueError:
        return "Error"
