"""The editor's files: what the page's build left in its folder."""

from __future__ import annotations

from pathlib import Path

from fastapi import APIRouter, Request, Response
from fastapi.responses import HTMLResponse
from starlette.convertors import Convertor, register_url_convertor
from starlette.staticfiles import StaticFiles

NOT_BUILT = """<!doctype html>
<html lang="en">
<title>intaglio</title>
<h1>intaglio</h1>
<p>The service runs, but the editor's page has not been built. <code>make serve</code> builds it and starts both;
with node at hand, <code>npm ci &amp;&amp; npm run build</code> in <code>web/</code> does too.</p>
<p>The REST service is here all the same: <a href="/api/health">/api/health</a>,
<a href="/api/openapi.json">/api/openapi.json</a>.</p>
</html>
"""
HEADERS = {
    "X-Content-Type-Options": "nosniff",
    "X-Frame-Options": "DENY",
    "Referrer-Policy": "no-referrer",
}


class _OutsideApi(Convertor[str]):
    """A path that is not the REST service's, so that an unknown path or method there stays an error of its own."""

    regex = "(?!api(?:/|$)).*"

    def convert(self, value: str) -> str:
        return value

    def to_string(self, value: str) -> str:
        return value


register_url_convertor("outside_api", _OutsideApi())


def router(folder: Path) -> APIRouter:
    """Serves the files of `folder`, which may be built later."""
    files = StaticFiles(directory=folder, html=True, check_dir=False)
    routes = APIRouter(include_in_schema=False)

    @routes.api_route("/{path:outside_api}", methods=["GET", "HEAD"])
    async def page(request: Request, path: str) -> Response:
        if path in ("", "index.html") and not (folder / "index.html").is_file():
            return HTMLResponse(NOT_BUILT, headers=HEADERS)
        response = await files.get_response(path or "index.html", request.scope)
        response.headers.update(HEADERS)
        hashed = path.startswith("assets/")  # Vite puts a hash of the content into these names
        response.headers["Cache-Control"] = "public, max-age=31536000, immutable" if hashed else "no-cache"
        return response

    return routes
