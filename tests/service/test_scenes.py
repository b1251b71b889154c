"""Validation, rendering, patterns and meshes."""

from __future__ import annotations

import dataclasses
import io
import json
from typing import Any

import numpy as np
import pytest
from fastapi.testclient import TestClient
from PIL import Image

from renderer.errors import Fault, RenderError

from .conftest import SETTINGS, FakeRenderer, assert_problem, open_client

TRIANGLE = b"v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\nf 1/1 2/2 3/3\n"
SKY = b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 2\n" + bytes([128, 128, 128, 128] * 2)


def test_validate(client: TestClient, scene: dict[str, Any]) -> None:
    assert client.post("/api/validate", json=scene).json() == {"valid": True, "problems": [], "warnings": []}


def test_validate_lists_all_problems(client: TestClient, scene: dict[str, Any]) -> None:
    scene["camera"]["fov"] = -1
    scene["objects"][0]["material"] = "wood"
    answer = client.post("/api/validate", json=scene)
    assert answer.status_code == 200
    assert answer.json()["valid"] is False
    assert {"/camera/fov", "/objects/0/material"} == {problem["pointer"] for problem in answer.json()["problems"]}


@pytest.mark.parametrize("body", [b"", b"{", b"\xff", b"[" * 100_000, b"NaN", b"null", b"[]", b'"a"', b"\x00"])
def test_no_scene_at_all(client: TestClient, body: bytes) -> None:
    answer = client.post("/api/validate", content=body)
    assert answer.status_code == 200
    assert answer.json()["valid"] is False
    assert answer.json()["problems"]
    assert_problem(client.post("/api/render", content=body), 422)
    assert_problem(client.post("/api/patterns", content=body), 422)


def test_render_png(client: TestClient, scene: dict[str, Any]) -> None:
    answer = client.post("/api/render", json=scene)
    assert answer.status_code == 200, answer.text
    assert answer.headers["content-type"] == "image/png"
    assert "total;dur=" in answer.headers["server-timing"]
    picture = np.asarray(Image.open(io.BytesIO(answer.content)))
    assert picture.shape == (12, 16, 3)
    assert picture.max() > 0


def test_render_is_repeatable(client: TestClient, scene: dict[str, Any]) -> None:
    pictures = [client.post("/api/render", json=scene).content for _ in range(2)]
    assert pictures[0] == pictures[1]


@pytest.mark.parametrize(
    ("accept", "kind", "magic"),
    [
        ("image/x-exr", "image/x-exr", b"\x76\x2f\x31\x01"),
        ("application/x-npy", "application/x-npy", b"\x93NUMPY"),
        ("image/*", "image/png", b"\x89PNG"),
        ("text/html, */*;q=0.1", "image/png", b"\x89PNG"),
        ("image/png;q=0.5, image/x-exr", "image/x-exr", b"\x76\x2f\x31\x01"),
        ("image/png;q=0, image/*", "image/x-exr", b"\x76\x2f\x31\x01"),
    ],
)
def test_accept(client: TestClient, scene: dict[str, Any], accept: str, kind: str, magic: bytes) -> None:
    answer = client.post("/api/render", json=scene, headers={"Accept": accept})
    assert answer.headers["content-type"] == kind
    assert answer.content.startswith(magic)


@pytest.mark.parametrize("accept", ["text/html", "image/jpeg", "image/png;q=0", "image/png;q=x"])
def test_not_acceptable(client: TestClient, scene: dict[str, Any], accept: str) -> None:
    assert_problem(client.post("/api/render", json=scene, headers={"Accept": accept}), 406)


def test_parameters(client: TestClient, scene: dict[str, Any], fake: FakeRenderer) -> None:
    answer = client.post("/api/render?method=relief&samples=9&texels=64&resolution=20x10", json=scene)
    assert Image.open(io.BytesIO(answer.content)).size == (20, 10)
    assert {key: fake.calls[0][key] for key in ("method", "samples", "texels", "resolution", "threads")} == {
        "method": "relief",
        "samples": 9,
        "texels": 64,
        "resolution": (20, 10),
        "threads": SETTINGS.threads,
    }


@pytest.mark.parametrize(
    "query",
    [
        "method=best",
        "samples=0",
        "samples=x",
        "samples=65537",
        "texels=15",
        "texels=8193",
        "resolution=0x4",
        "resolution=4",
        "resolution=",
    ],
)
def test_wrong_parameters(client: TestClient, scene: dict[str, Any], fake: FakeRenderer, query: str) -> None:
    document = assert_problem(client.post(f"/api/render?{query}", json=scene), 422)
    assert query.split("=")[0] in json.dumps(document)
    assert not fake.calls


def test_wrong_scene(client: TestClient, scene: dict[str, Any], fake: FakeRenderer) -> None:
    scene["objects"][0]["pattern"] = "missing"
    document = assert_problem(client.post("/api/render", json=scene), 422, "/objects/0/pattern")
    assert document["type"] == "urn:intaglio:scene"
    assert not fake.calls


def test_scene_that_cannot_be_rendered(client: TestClient, scene: dict[str, Any], fake: FakeRenderer) -> None:
    fake.error = RenderError(Fault("/objects/0/shape", "a flat shape", "a sphere"))
    assert_problem(client.post("/api/render", json=scene), 422, "/objects/0/shape")


def test_a_bug_is_a_problem_document_too(client: TestClient, scene: dict[str, Any], fake: FakeRenderer) -> None:
    fake.error = ZeroDivisionError("a secret")
    assert "secret" not in json.dumps(assert_problem(client.post("/api/render", json=scene), 500))


def test_too_many_pixels(scene: dict[str, Any], fake: FakeRenderer) -> None:
    with open_client(dataclasses.replace(SETTINGS, pixel_limit=1000, sample_limit=50_000)) as client:
        assert client.post("/api/render", json=scene).status_code == 200
        assert_problem(client.post("/api/render?resolution=50x50", json=scene), 422, "/camera/resolution")
        assert_problem(client.post("/api/render?samples=300&method=csg", json=scene), 422)
        for method in ("line", "auto"):  # which take none
            assert client.post(f"/api/render?samples=300&method={method}", json=scene).status_code == 200


@pytest.mark.parametrize("path", ["validate", "render", "patterns", "meshes?name=a.obj"])
@pytest.mark.parametrize("chunked", [False, True])
def test_body_too_large(client: TestClient, path: str, chunked: bool) -> None:
    size = (SETTINGS.mesh_limit if path.startswith("meshes") else SETTINGS.body_limit) + 1
    body = b" " * size
    content = (body[i : i + 1000] for i in range(0, size, 1000)) if chunked else body
    assert_problem(client.post(f"/api/{path}", content=content), 413)


@pytest.mark.parametrize("file", ["a.obj", "/etc/passwd", "../a.obj", "upload:../a.obj", "upload:" + "0" * 32 + ".obj"])
def test_scene_may_not_name_files(client: TestClient, scene: dict[str, Any], fake: FakeRenderer, file: str) -> None:
    scene["objects"][0]["shape"] = {"type": "mesh", "file": file}
    assert_problem(client.post("/api/render", json=scene), 422, "/objects/0/shape/file")
    assert not fake.calls


@pytest.mark.parametrize("file", ["/etc/passwd", "sky.exr", "upload:" + "0" * 32 + ".exr", "upload:a.obj"])
def test_envmap_of_the_machine_is_refused(
    client: TestClient, scene: dict[str, Any], fake: FakeRenderer, file: str
) -> None:
    scene["lights"].append({"type": "envmap", "file": file})
    assert_problem(client.post("/api/render", json=scene), 422, "/lights/1/file")
    assert not fake.calls


def test_envmap(client: TestClient, scene: dict[str, Any], fake: FakeRenderer) -> None:
    raw = client.post("/api/envmaps?name=sky.HDR", content=SKY)
    assert raw.status_code == 201
    assert raw.json() == client.post("/api/envmaps", files={"file": ("sky.hdr", SKY)}).json()
    assert raw.json()["bytes"] == len(SKY)
    scene["lights"].append({"type": "envmap", "file": raw.json()["file"]})
    assert client.post("/api/render", json=scene).status_code == 200
    assert fake.calls[0]["meshes"](raw.json()["file"]) == SKY


def test_envmap_is_rendered(client: TestClient, scene: dict[str, Any]) -> None:
    for data, status in ((SKY, 200), (SKY[:-1], 422)):
        file = client.post("/api/envmaps?name=sky.hdr", content=data).json()["file"]
        scene["lights"] = [{"type": "envmap", "file": file}]
        answer = client.post("/api/render", json=scene)
        assert answer.status_code == status
    assert_problem(answer, 422, "/lights/0/file")


def test_wrong_envmaps(client: TestClient) -> None:
    assert_problem(client.post("/api/envmaps?name=a.obj", content=SKY), 415)
    assert_problem(client.post("/api/envmaps?name=a.exr", content=b""), 422)


def test_mesh(client: TestClient, scene: dict[str, Any], fake: FakeRenderer) -> None:
    raw = client.post("/api/meshes?name=triangle.OBJ", content=TRIANGLE)
    assert raw.status_code == 201
    form = client.post("/api/meshes", files={"file": ("triangle.obj", TRIANGLE)})
    assert form.json() == raw.json()
    assert raw.json()["bytes"] == len(TRIANGLE)
    scene["objects"][0]["shape"] = {"type": "mesh", "file": raw.json()["file"]}
    assert client.post("/api/render", json=scene).status_code == 200
    assert fake.calls[0]["meshes"](raw.json()["file"]) == TRIANGLE


def test_mesh_is_rendered(client: TestClient, scene: dict[str, Any]) -> None:
    file = client.post("/api/meshes?name=triangle.obj", content=TRIANGLE).json()["file"]
    scene["objects"][0]["shape"] = {"type": "mesh", "file": file}
    assert client.post("/api/render", json=scene).status_code == 200


def test_broken_mesh(client: TestClient, scene: dict[str, Any]) -> None:
    for data in (b"\x00\x01\x02", b"v 0 0 0\nf 1 2 3\n", TRIANGLE.replace(b"vt", b"#")):
        file = client.post("/api/meshes?name=broken.obj", content=data).json()["file"]
        scene["objects"][0]["shape"] = {"type": "mesh", "file": file}
        assert_problem(client.post("/api/render", json=scene), 422, "/objects/0/shape/file")


def test_wrong_meshes(client: TestClient) -> None:
    assert_problem(client.post("/api/meshes", content=TRIANGLE), 415)
    assert_problem(client.post("/api/meshes?name=a.stl", content=TRIANGLE), 415)
    assert_problem(client.post("/api/meshes?name=a.obj", content=b""), 422)
    form = {"Content-Type": "multipart/form-data; boundary=x"}
    assert_problem(client.post("/api/meshes", content=b"nonsense", headers=form), 400)
    assert_problem(client.post("/api/meshes", content=TRIANGLE, headers={"Content-Type": "multipart/form-data"}), 400)
    no_file = b'--x\r\nContent-Disposition: form-data; name="a"\r\n\r\n1\r\n--x--\r\n'
    assert_problem(client.post("/api/meshes", content=no_file, headers=form), 400)


def test_old_meshes_go(scene: dict[str, Any], fake: FakeRenderer) -> None:
    with open_client(dataclasses.replace(SETTINGS, mesh_store=250)) as client:
        files = [
            client.post("/api/meshes?name=a.obj", content=b"#" * (100 + i)).json()["file"] for i in range(3)
        ]  # 303 bytes
        statuses = []
        for file in files:
            scene["objects"][0]["shape"] = {"type": "mesh", "file": file}
            statuses.append(client.post("/api/render", json=scene).status_code)
        assert statuses == [422, 200, 200]


def test_pattern(client: TestClient, scene: dict[str, Any]) -> None:
    pattern = scene["patterns"]["tiles"]
    pattern["grooves"][0]["material"] = "brass"  # a name that only the scene knows
    first = client.post("/api/patterns", json=pattern)
    assert first.status_code == 200, first.text
    assert first.json()["grooves"] == 1
    assert first.json()["pieces"] >= 1
    assert 0 < first.json()["bytes"] < 10_000
    again = client.post("/api/patterns", json=pattern).json()
    assert again["id"] == first.json()["id"]
    pattern["grooves"][0]["profile"]["depth"] = 0.05
    assert client.post("/api/patterns", json=pattern).json()["id"] != again["id"]


def test_wrong_pattern_has_pointers_of_its_own(client: TestClient, scene: dict[str, Any]) -> None:
    pattern = scene["patterns"]["tiles"]
    pattern["grooves"][0]["profile"]["width"] = -1
    assert_problem(client.post("/api/patterns", json=pattern), 422, "/grooves/0/profile/width")


def test_pattern_in_world_space_needs_an_object(client: TestClient, scene: dict[str, Any]) -> None:
    pattern = scene["patterns"]["tiles"]
    pattern["grooves"][0]["path"] = {"type": "polyline", "space": "world", "points": [[0, 0, 0], [1, 0, 0]]}
    assert_problem(client.post("/api/patterns", json=pattern), 422, "/grooves/0/path/space")


def test_pattern_and_render_share_a_cache(client: TestClient, scene: dict[str, Any]) -> None:
    cache = client.app.state.shop.patterns  # type: ignore[attr-defined]
    client.post("/api/patterns", json=scene["patterns"]["tiles"])
    built = dict(cache.builds)
    scene["camera"]["fov"] = 30
    assert client.post("/api/render", json=scene).status_code == 200
    assert dict(cache.builds) == built
