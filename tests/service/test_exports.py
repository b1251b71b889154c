"""Exported files, read back by other readers than ours; over REST."""

from __future__ import annotations

import dataclasses
import io
import json
import struct
from typing import Any

import numpy as np
import pytest
import trimesh
from fastapi.testclient import TestClient
from PIL import Image

from renderer.export import unpaired

from .conftest import SETTINGS, assert_problem, open_client

Json = dict[str, Any]


@pytest.fixture
def carved() -> Json:
    """A plate of 2 x 1 with two grooves of two materials that cross, moved and turned."""

    def groove(points: list[list[float]], **more: Any) -> Json:
        profile = {"type": "v", "width": 0.2, "depth": 0.1}
        return {"path": {"type": "polyline", "points": points}, "profile": profile, **more}

    return {
        "intaglio": 1,
        "camera": {"origin": [0, -3, 2], "target": [0, 0, 0]},
        "materials": {
            "stone": {"base_color": [0.7, 0.6, 0.5]},
            "not used": {},
            "red brass": {"base_color": [0.9, 0.123456, 0.4], "metallic": 1, "roughness": 0.3, "emissive": [4, 0, 0],
                          "specular": 0.5, "ior": 1.4, "transmission": 0.25},
        },
        "patterns": {"cross": {"grooves": [groove([[1, -1], [1, 2]]), groove([[0.2, 0.4], [1.7, 0.7]],
                                                                             material="red brass")]}},
        "objects": [{"shape": {"type": "rectangle", "size": [2, 1]}, "mapping": {"scale": [2, 1]}, "rotate": [0, 0, 90],
                     "translate": [0.5, 0, 0.25], "material": "stone", "pattern": "cross"}],
    }  # fmt: skip


def read(data: bytes, kind: str) -> trimesh.Trimesh:
    """The file as one mesh in its own axes, points at the same place merged."""
    loaded = trimesh.load(io.BytesIO(data), file_type=kind)
    mesh = loaded.to_mesh() if isinstance(loaded, trimesh.Scene) else loaded
    mesh.merge_vertices(merge_norm=True, merge_tex=True)
    return mesh


@pytest.mark.parametrize("kind", ["glb", "stl", "ply", "obj"])
def test_solids(client: TestClient, carved: Json, kind: str) -> None:
    answer = client.post(f"/api/export?format={kind}", json=carved)
    assert answer.status_code == 200, answer.text
    assert answer.headers["content-disposition"] == f'attachment; filename="object0.{kind}"'
    mesh = read(answer.content, kind)
    assert mesh.is_watertight
    assert mesh.is_winding_consistent
    assert not len(unpaired(mesh.faces))
    # 0.4 thick, four depths; the first groove takes 0.1 * 0.1 * 1 away.
    assert 0.0 < 2 * 1 * 0.4 - 0.01 - mesh.volume < 0.02
    low, high = np.array([0.0, -1.0, -0.15]), np.array([1.0, 1.0, 0.25])
    if kind == "glb":  # y is up, the world's y points backwards
        low, high = np.array([0.0, -0.15, -1.0]), np.array([1.0, 0.25, 1.0])
    np.testing.assert_allclose(mesh.bounds, [low, high], atol=1e-6)


def test_glb_has_the_materials(client: TestClient, carved: Json) -> None:
    data = client.post("/api/export", json=carved, headers={"Accept": "model/gltf-binary"}).content
    magic, version, total, length, kind = struct.unpack("<4sIII4s", data[:20])
    assert (magic, version, total, kind) == (b"glTF", 2, len(data), b"JSON")
    document = json.loads(data[20 : 20 + length])
    stone, brass = document["materials"]
    assert stone == {
        "name": "stone",
        "pbrMetallicRoughness": {
            "baseColorFactor": [0.7, 0.6, 0.5, 1.0],
            "metallicFactor": 0.0,
            "roughnessFactor": 1.0,
        },
        "emissiveFactor": [0.0, 0.0, 0.0],
    }
    assert brass["name"] == "red brass"
    assert brass["pbrMetallicRoughness"]["baseColorFactor"] == [0.9, 0.123456, 0.4, 1.0]
    assert brass["emissiveFactor"] == [1.0, 0.0, 0.0]
    assert brass["extensions"] == {
        "KHR_materials_specular": {"specularFactor": 0.5},
        "KHR_materials_ior": {"ior": 1.4},
        "KHR_materials_transmission": {"transmissionFactor": 0.25},
        "KHR_materials_emissive_strength": {"emissiveStrength": 4.0},
    }
    assert sorted(brass["extensions"]) == document["extensionsUsed"]
    assert [part["material"] for part in document["meshes"][0]["primitives"]] == [0, 1]
    # The primitives share their points: together they are closed without any merging.
    scene = trimesh.load(io.BytesIO(data), file_type="glb", process=False)
    assert {len(part.vertices) for part in scene.geometry.values()} == {document["accessors"][0]["count"]}
    assert not len(unpaired(np.concatenate([part.faces for part in scene.geometry.values()])))


def test_obj_and_ply_name_the_materials(client: TestClient, carved: Json) -> None:
    text = client.post("/api/export?format=obj", json=carved).text
    assert [line for line in text.splitlines() if line.startswith("usemtl")] == ["usemtl stone", "usemtl red_brass"]
    header = client.post("/api/export?format=ply", json=carved).content.split(b"end_header")[0].decode()
    assert [line for line in header.splitlines() if line.startswith("comment material")] == [
        "comment material stone", "comment material not_used", "comment material red_brass",
    ]  # fmt: skip


def test_height_png_tells_its_scale(client: TestClient, carved: Json) -> None:
    answer = client.post("/api/export?kind=height&size=40x20", json=carved)
    assert answer.headers["content-type"] == "image/png"
    assert answer.headers["content-disposition"] == 'attachment; filename="object0-height.png"'
    with Image.open(io.BytesIO(answer.content)) as image:
        assert image.size == (40, 20)
        assert image.mode == "I;16"
        low, high = float(image.text["low"]), float(image.text["high"])  # type: ignore[attr-defined]
        values = low + np.asarray(image, np.float64) / 65535 * (high - low)
    assert (values.min(), values.max()) == (low, high)
    assert high == 0.0
    # The texels beside the groove's floor are the mean of 0 to a quarter of its half width: an eighth of 0.1 above it.
    assert low == pytest.approx(-0.0750, abs=0.03)
    exact = exr(client.post("/api/export?kind=height&size=40x20&format=exr", json=carved).content)["Y"]
    np.testing.assert_allclose(values, exact, atol=0.51 * (high - low) / 65535)


def exr(data: bytes) -> dict[str, Any]:
    import tempfile

    import OpenEXR

    with tempfile.NamedTemporaryFile(suffix=".exr") as file:
        file.write(data)
        file.flush()
        return {name: channel.pixels for name, channel in OpenEXR.File(file.name).channels().items()}


@pytest.mark.parametrize("kind", ["normal", "anisotropy"])
def test_vectors_as_png_and_exr(client: TestClient, carved: Json, kind: str) -> None:
    png = client.post(f"/api/export?kind={kind}&size=16", json=carved, headers={"Accept": "image/*"}).content
    values = np.asarray(Image.open(io.BytesIO(png)), np.float64) / 255
    assert values.shape == (16, 16, 3)
    exact = exr(client.post(f"/api/export?kind={kind}&size=16&format=exr", json=carved).content)["RGB"]
    if kind == "normal":
        np.testing.assert_allclose(np.linalg.norm(exact, axis=2), 1.0, atol=1e-6)
        values = 2.0 * values - 1.0
    np.testing.assert_allclose(values, exact, atol=1.01 / 255)


@pytest.mark.parametrize(
    "query",
    ["format=png", "kind=height&format=glb", "kind=depth", "format=fbx", "size=0", "size=9000", "size=x", "object=1",
     "object=-1", "thickness=0", "kind=height&size=4096x4096"],
)  # fmt: skip
def test_wrong_parameters(client: TestClient, carved: Json, query: str) -> None:
    document = assert_problem(client.post(f"/api/export?{query}", json=carved), 422)
    words = json.dumps(document)
    assert any(part.split("=")[0] in words for part in query.split("&"))


def test_not_acceptable(client: TestClient, carved: Json) -> None:
    assert_problem(client.post("/api/export", json=carved, headers={"Accept": "image/png"}), 406)


def test_too_thin_or_too_large(carved: Json) -> None:
    with open_client(dataclasses.replace(SETTINGS, triangle_limit=20)) as client:
        document = assert_problem(client.post("/api/export", json=carved), 422, "/objects/0")
        assert "more than 20" in document["problems"][0]["found"]
        document = assert_problem(client.post("/api/export?thickness=0.05", json=carved), 422, "/objects/0")
        assert "thickness" in document["problems"][0]["found"]


def test_which_object(client: TestClient, carved: Json) -> None:
    carved["objects"].append({**carved["objects"][0], "pattern": None, "translate": [9, 0, 0]})
    assert client.post("/api/export?kind=height&size=4", json=carved).status_code == 200
    carved["objects"].append(carved["objects"][0])
    document = assert_problem(client.post("/api/export?kind=height&size=4", json=carved), 422)
    assert "one of 0 (rectangle, cross), 2 (rectangle, cross), found none" in document["detail"]
    stl = client.post("/api/export?object=1&format=stl", json=carved).content
    assert read(stl, "stl").bounds[1, 0] == pytest.approx(9.5)


def test_uploaded_mesh(client: TestClient, carved: Json) -> None:
    """The plate as two triangles: the same solid."""
    square = (
        b"v -1 -.5 0\nv 1 -.5 0\nv 1 .5 0\nv -1 .5 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nf 1/1 2/2 3/3\nf 1/1 3/3 4/4\n"
    )
    plate = read(client.post("/api/export?format=stl&thickness=0.5", json=carved).content, "stl")
    file = client.post("/api/meshes?name=square.obj", content=square).json()["file"]
    carved["objects"][0]["shape"] = {"type": "mesh", "file": file}
    mesh = read(client.post("/api/export?format=stl&thickness=0.5", json=carved).content, "stl")
    assert mesh.is_watertight
    np.testing.assert_allclose(mesh.bounds, plate.bounds, atol=1e-6)
    assert mesh.volume == pytest.approx(plate.volume, abs=1e-5)
    assert_problem(client.post("/api/export?format=stl&thickness=0.05", json=carved), 422, "/objects/0")
    assert_problem(client.post("/api/export?kind=height&size=4", json=carved), 422, "/objects/0/shape/type")
