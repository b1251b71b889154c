"""Other sites' pages are refused; each request leaves one line in the log."""

from __future__ import annotations

import dataclasses
import logging
from typing import Any

import pytest
from fastapi.testclient import TestClient

from .conftest import SETTINGS, FakeRenderer, assert_problem, open_client


@pytest.mark.parametrize("host", ["evil.example", "evil.example:80", "", "127.0.0.1.evil.example", "[", "10.0.0.1"])
def test_foreign_host(client: TestClient, host: str) -> None:
    assert_problem(client.get("/api/health", headers={"Host": host}), 421)


@pytest.mark.parametrize("host", ["localhost", "localhost:8000", "127.0.0.1:1", "[::1]:8000", "LOCALHOST"])
def test_own_host(client: TestClient, host: str) -> None:
    assert client.get("/api/health", headers={"Host": host}).status_code == 200


def test_any_host_on_an_open_address() -> None:
    with open_client(dataclasses.replace(SETTINGS, host="0.0.0.0")) as client:
        assert client.get("/api/health", headers={"Host": "intaglio.example"}).status_code == 200
    with open_client(dataclasses.replace(SETTINGS, host="0.0.0.0", hosts=("intaglio.example",))) as client:
        assert client.get("/api/health", headers={"Host": "intaglio.example"}).status_code == 200
        assert_problem(client.get("/api/health", headers={"Host": "evil.example"}), 421)


@pytest.mark.parametrize("origin", ["http://evil.example", "null", "http://127.0.0.1:9999", "http://localhost", "x"])
@pytest.mark.parametrize("path", ["render", "validate", "meshes", "patterns"])
def test_foreign_origin(client: TestClient, scene: dict[str, Any], path: str, origin: str) -> None:
    assert_problem(client.post(f"/api/{path}", json=scene, headers={"Origin": origin}), 403)


def test_own_origin(client: TestClient, scene: dict[str, Any]) -> None:
    headers = {"Origin": "http://localhost:8000", "Host": "localhost:8000"}
    assert client.post("/api/validate", json=scene, headers=headers).status_code == 200
    assert "access-control-allow-origin" not in client.get("/api/health", headers=headers).headers


def test_allowed_origin(scene: dict[str, Any]) -> None:
    with open_client(dataclasses.replace(SETTINGS, origins=("https://friend.example",))) as client:
        answer = client.post("/api/validate", json=scene, headers={"Origin": "https://friend.example"})
        assert answer.status_code == 200


def test_log(client: TestClient, scene: dict[str, Any], fake: FakeRenderer, caplog: pytest.LogCaptureFixture) -> None:
    with caplog.at_level(logging.INFO, logger="intaglio"):
        client.post("/api/render", json=scene)
        client.get("/api/a%0Ab%C3%A9")
    lines = [record.getMessage().split() for record in caplog.records if record.name == "intaglio"]
    assert [(line[0], line[1], line[2]) for line in lines] == [
        ("POST", "/api/render", "200"),
        ("GET", "/api/a\\nb\\xe9", "404"),
    ]
    assert lines[0][3].endswith("s")
    assert lines[0][4] == "192px"
