"""What stands before every request: who may ask, and one line in the log."""

from __future__ import annotations

import ipaddress
import logging
import time
from urllib.parse import urlsplit

from starlette.datastructures import Headers
from starlette.types import ASGIApp, Message, Receive, Scope, Send

from service.problems import ProblemError, response
from service.settings import Settings

log = logging.getLogger("intaglio")


class Guard:
    """Refuses other sites' pages: a foreign Origin on anything that is not a mere read, and, where the service
    listens on a loopback address only, a foreign Host header (DNS rebinding)."""

    def __init__(self, app: ASGIApp, settings: Settings) -> None:
        self.app = app
        self.origins = frozenset(settings.origins)
        self.hosts = frozenset({"localhost", "127.0.0.1", "::1", settings.host, *settings.hosts})
        self.any_host = not is_loopback(settings.host) and not settings.hosts

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        if scope["type"] == "http":
            refusal = self._refusal(scope["method"], Headers(scope=scope))
            if refusal is not None:
                await response(refusal)(scope, receive, send)
                return
        await self.app(scope, receive, send)

    def _refusal(self, method: str, headers: Headers) -> ProblemError | None:
        host = headers.get("host", "")
        if not self.any_host and _host_name(host) not in self.hosts:
            return ProblemError(421, f"This service does not go by the name {host[:100]!r}.")
        origin = headers.get("origin")
        if origin is None or method in ("GET", "HEAD") or origin in self.origins:
            return None
        if urlsplit(origin).netloc.lower() == host.lower() and host:
            return None
        return ProblemError(403, f"Pages of {origin[:100]!r} may not use this service.")


class Log:
    """One line a request: method, path, status, seconds and, for a render, its pixels."""

    def __init__(self, app: ASGIApp) -> None:
        self.app = app

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        if scope["type"] != "http":
            await self.app(scope, receive, send)
            return
        start = time.perf_counter()
        status = 500
        state = scope.setdefault("state", {})

        async def note(message: Message) -> None:
            nonlocal status
            if message["type"] == "http.response.start":
                status = message["status"]
            await send(message)

        try:
            await self.app(scope, receive, note)
        finally:
            line = f"{scope['method']} {scope['path'][:200]!s} {status} {time.perf_counter() - start:.3f}s"
            if "pixels" in state:
                line += f" {state['pixels']}px"
            log.info("%s", line.encode("ascii", "backslashreplace").decode().replace("\n", "\\n").replace("\r", "\\r"))


def is_loopback(host: str) -> bool:
    """Whether only this machine reaches `host`."""
    try:
        return ipaddress.ip_address(host).is_loopback
    except ValueError:
        return host == "localhost"


def _host_name(host: str) -> str:
    """The name in a Host header, without port and brackets."""
    try:
        return urlsplit(f"//{host}").hostname or ""
    except ValueError:
        return ""
