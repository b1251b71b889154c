"""Request bodies: never more in memory than the limit."""

from __future__ import annotations

from collections.abc import AsyncGenerator

from fastapi import Request
from starlette.datastructures import UploadFile
from starlette.formparsers import MultiPartException, MultiPartParser

from service.problems import ProblemError

_CHUNK = 1 << 16


async def read(request: Request, limit: int) -> bytes:
    """The whole body; 413 as soon as it is known to be longer than `limit`."""
    declared = request.headers.get("content-length", "")
    if declared.isdigit() and int(declared) > limit:
        raise _too_large(limit)
    body = bytearray()
    async for chunk in request.stream():
        if len(body) + len(chunk) > limit:
            raise _too_large(limit)
        body += chunk
    return bytes(body)


async def read_upload(request: Request, limit: int) -> tuple[bytes, str]:
    """An uploaded file and its name (empty where it has none): the body as it is, or the first file of a form."""
    body = await read(request, limit)
    if not request.headers.get("content-type", "").lower().startswith("multipart/form-data"):
        return body, ""

    async def stream() -> AsyncGenerator[bytes, None]:
        for start in range(0, len(body), _CHUNK):
            yield body[start : start + _CHUNK]

    try:
        form = await MultiPartParser(request.headers, stream(), max_files=1, max_fields=8).parse()
    except (MultiPartException, KeyError, ValueError, UnicodeError):
        raise ProblemError(400, "The form cannot be read: expected multipart/form-data with one file.") from None
    try:
        for _, value in form.multi_items():
            if isinstance(value, UploadFile):
                return await value.read(), value.filename or ""
    finally:
        await form.close()
    raise ProblemError(400, "The form has no file.")


def _too_large(limit: int) -> ProblemError:
    return ProblemError(413, f"The body is longer than {limit} bytes.", headers={"Connection": "close"})
