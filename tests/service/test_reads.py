"""Everything that only reads: health, schema, examples, the page."""

from __future__ import annotations

import dataclasses
import json
from pathlib import Path
from typing import Any

import pytest
from fastapi.testclient import TestClient

import schema

from .conftest import SETTINGS, FakeRenderer, assert_problem, open_client, wait_for


def test_health(fake: FakeRenderer, scene: dict[str, Any]) -> None:
    with open_client() as client:
        health = client.get("/api/health").json()
        assert health == {"status": "ok", "version": "0.1.0", "kernels": "compiling", "renders": 0}
        assert client.post("/api/render", json=scene).status_code == 200
        assert client.get("/api/health").json() == {**health, "kernels": "ready"}


def test_kernels_are_loaded_at_the_start(fake: FakeRenderer) -> None:
    with open_client(dataclasses.replace(SETTINGS, warm_up=True)) as client:
        wait_for(lambda: client.get("/api/health").json()["kernels"] == "ready")


def test_schema_is_the_validation_tools(client: TestClient) -> None:
    assert client.get("/api/schema").json() == schema.json_schema()


def test_examples(tmp_path: Path) -> None:
    (tmp_path / "b.json").write_text('{"b": 1}')
    (tmp_path / "a.json").write_text('{"a": 1}')
    (tmp_path / "notes.txt").write_text("no scene")
    with open_client(dataclasses.replace(SETTINGS, examples=tmp_path)) as client:
        assert client.get("/api/examples").json() == {"examples": ["a", "b"]}
        assert client.get("/api/examples/a").json() == {"a": 1}
        for name in ("c", "notes.txt", "..%2Fa", "%2e%2e", "a.json"):
            assert_problem(client.get(f"/api/examples/{name}"), 404)


def test_our_examples_are_valid(client: TestClient) -> None:
    for name in client.get("/api/examples").json()["examples"]:
        report = client.post("/api/validate", content=client.get(f"/api/examples/{name}").content).json()
        assert report["problems"] == []


def test_page_not_built(tmp_path: Path) -> None:
    with open_client(dataclasses.replace(SETTINGS, page=tmp_path / "dist")) as client:
        answer = client.get("/")
        assert answer.status_code == 200
        assert "make serve" in answer.text
        assert_problem(client.get("/assets/a.js"), 404)


def test_page(tmp_path: Path) -> None:
    (tmp_path / "dist" / "assets").mkdir(parents=True)
    (tmp_path / "dist" / "index.html").write_text("<p>the page</p>")
    (tmp_path / "dist" / "assets" / "a.js").write_text("1")
    (tmp_path / "secret").write_text("secret")
    with open_client(dataclasses.replace(SETTINGS, page=tmp_path / "dist")) as client:
        assert client.get("/").text == "<p>the page</p>"
        assert client.get("/").headers["cache-control"] == "no-cache"
        assert client.get("/index.html").text == "<p>the page</p>"
        script = client.get("/assets/a.js")
        assert "javascript" in script.headers["content-type"]
        assert "immutable" in script.headers["cache-control"]
        for path in ("/secret", "/../secret", "/%2e%2e/secret", "/assets/%2e%2e/%2e%2e/secret"):
            assert_problem(client.get(path), 404)


@pytest.mark.parametrize("path", ["/api", "/api/", "/api/nothing", "/nothing", "/api/examples/none"])
def test_not_found(client: TestClient, path: str) -> None:
    assert_problem(client.get(path), 404)


@pytest.mark.parametrize(
    ("method", "path"),
    [("GET", "/api/render"), ("PUT", "/api/validate"), ("POST", "/api/health"), ("DELETE", "/api/meshes")],
)
def test_wrong_method(client: TestClient, method: str, path: str) -> None:
    answer = client.request(method, path)
    assert_problem(answer, 405)
    assert answer.headers["allow"]


def test_openapi_has_the_scenes_models(client: TestClient) -> None:
    document = client.get("/api/openapi.json").json()
    schemas = document["components"]["schemas"]
    assert {"Scene", "Camera", "Pattern", "Groove", "ProblemDocument", "Validation", "UploadedMesh"} <= schemas.keys()
    body = document["paths"]["/api/render"]["post"]["requestBody"]["content"]["application/json"]["schema"]
    assert body == {"$ref": "#/components/schemas/Scene"}
    references = [part.split('"')[0] for part in json.dumps(document).split('"$ref": "')[1:]]
    for reference in references:
        assert reference.removeprefix("#/components/schemas/") in schemas, reference
    for operations in document["paths"].values():
        for operation in operations.values():
            success = next(a for status, a in operation["responses"].items() if status.startswith("2"))
            assert success["content"]


def test_an_example_brings_its_mesh(client: TestClient) -> None:
    files = [
        item["shape"]["file"]
        for item in client.get("/api/examples/brushed").json()["objects"]
        if "file" in item["shape"]
    ]
    assert files
    assert all(file.startswith("upload:") for file in files)
    scene = client.get("/api/examples/brushed").json()
    scene["camera"]["resolution"] = [16, 12]
    assert client.post("/api/render?samples=4", json=scene).status_code == 200
