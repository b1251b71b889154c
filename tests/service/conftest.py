"""A tiny scene, a renderer that does as it is told, and the service in the same process or behind a socket."""

from __future__ import annotations

import socket
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from typing import Any

import numpy as np
import pytest
import uvicorn
from fastapi.testclient import TestClient

import schema
from renderer import pipeline
from renderer.errors import Cancelled
from service.app import create
from service.settings import Settings

SETTINGS = Settings(warm_up=False, time_limit=60.0, body_limit=1 << 20, mesh_limit=1 << 16)


@dataclass
class FakeRenderer:
    """Renders grey; with `block` set, only when it is told to stop or to go on."""

    block: bool = False
    go_on: threading.Event = field(default_factory=threading.Event)
    started: threading.Semaphore = field(default_factory=lambda: threading.Semaphore(0))
    cancelled: threading.Event = field(default_factory=threading.Event)
    calls: list[dict[str, Any]] = field(default_factory=list)
    error: Exception | None = None

    def __call__(self, scene: schema.Scene, **options: Any) -> pipeline.Picture:
        self.calls.append(options)
        self.started.release()
        if self.error is not None:
            raise self.error
        while self.block and not self.go_on.is_set():
            if options["cancelled"]():
                self.cancelled.set()
                raise Cancelled
            time.sleep(0.01)
        width, height = options["resolution"] or scene.camera.resolution
        return pipeline.Picture(
            radiance=np.full((height, width, 3), 0.5, np.float32),
            aovs={"method": np.zeros((height, width), np.uint8)},
            seconds={"cast": 0.1, "kernels": 0.0, "total": 0.1},
            pattern_bytes=100,
            shares={"base": 1.0},
        )


@pytest.fixture
def fake(monkeypatch: pytest.MonkeyPatch) -> FakeRenderer:
    renderer = FakeRenderer()
    monkeypatch.setattr(pipeline, "render", renderer)
    monkeypatch.setattr(pipeline, "warm_up", lambda **_: 0.0)
    return renderer


@contextmanager
def open_client(settings: Settings = SETTINGS) -> Iterator[TestClient]:
    with TestClient(create(settings), base_url="http://127.0.0.1", raise_server_exceptions=False) as client:
        yield client


@pytest.fixture
def client() -> Iterator[TestClient]:
    with open_client() as opened:
        yield opened


@contextmanager
def open_server(settings: Settings = SETTINGS) -> Iterator[str]:
    """The service behind a real socket; gives its address."""
    listener = socket.create_server(("127.0.0.1", 0))
    server = uvicorn.Server(uvicorn.Config(create(settings), log_level="warning", timeout_graceful_shutdown=2))
    thread = threading.Thread(target=server.run, kwargs={"sockets": [listener]})
    thread.start()
    wait_for(lambda: server.started)
    try:
        yield f"http://127.0.0.1:{listener.getsockname()[1]}"
    finally:
        server.should_exit = True
        thread.join()


def wait_for(condition: Callable[[], bool], seconds: float = 10.0) -> None:
    deadline = time.monotonic() + seconds
    while not condition():
        assert time.monotonic() < deadline, "waited in vain"
        time.sleep(0.01)


def assert_problem(response: Any, status: int, pointer: str | None = None) -> dict[str, Any]:
    """The response is an RFC 9457 problem document of this status; with a pointer, of exactly one problem there."""
    assert response.status_code == status, response.text
    assert response.headers["content-type"] == "application/problem+json"
    document = response.json()
    assert set(document) == {"type", "title", "status", "detail", "problems"}
    assert document["status"] == status
    assert document["title"]
    assert document["detail"]
    for problem in document["problems"]:
        assert set(problem) == {"pointer", "expected", "found"}
        assert problem["expected"]
        assert problem["found"]
    if pointer is not None:
        assert [problem["pointer"] for problem in document["problems"]] == [pointer]
    assert isinstance(document, dict)
    return document
