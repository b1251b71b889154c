"""The application: settings in, an ASGI application out."""

from __future__ import annotations

import threading
from collections.abc import AsyncIterator
from contextlib import asynccontextmanager
from typing import Any

from fastapi import FastAPI
from starlette.middleware import Middleware

from renderer import compile as compiler
from renderer import pipeline
from service import openapi, page, problems, routes
from service.guard import Guard, Log
from service.renders import Renders
from service.settings import Settings
from service.store import MeshStore


def create(settings: Settings | None = None) -> FastAPI:
    """The service, with nothing running yet: its threads start with the application's lifespan."""
    settings = settings or Settings.from_environment()

    @asynccontextmanager
    async def lifespan(app: FastAPI) -> AsyncIterator[None]:
        ready = app.state.kernels_ready = threading.Event()

        def prepare() -> None:
            pipeline.warm_up()
            ready.set()

        shop = app.state.shop = routes.Shop(
            settings,
            Renders(settings.renders, settings.queue, settings.time_limit, prepare),
            MeshStore(settings.mesh_store),
            compiler.PatternCache(),
        )
        if settings.warm_up:
            shop.renders.warm_up()
        yield
        shop.renders.close()

    app = FastAPI(
        title="intaglio",
        version=routes.VERSION,
        description="Renders grooved surfaces.",
        lifespan=lifespan,
        openapi_url="/api/openapi.json",
        docs_url=None,
        redoc_url=None,
        middleware=[Middleware(Log), Middleware(Guard, settings=settings)],
    )
    problems.install(app)
    app.include_router(routes.router)
    app.include_router(page.router(settings.page))

    def document() -> dict[str, Any]:
        if app.openapi_schema is None:
            app.openapi_schema = openapi.document(app)
        return app.openapi_schema

    app.openapi = document  # type: ignore[method-assign]
    return app
