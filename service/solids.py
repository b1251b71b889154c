"""A solid as a file: GLB, STL, PLY or OBJ.

All four hold the same single-precision points in world units. STL, PLY and OBJ keep the world's axes, z up; in GLB,
where y is up, the node's matrix turns them. Written here rather than by trimesh, which would round colours to 8 bits
and give every material points of its own, so that nothing is closed any more.
"""

from __future__ import annotations

import json
import struct
from collections.abc import Mapping
from typing import Any

import numpy as np

import schema
from renderer.export import Body

TYPES = {".glb": "model/gltf-binary", ".stl": "model/stl", ".ply": "application/x-ply", ".obj": "model/obj"}
UPRIGHT = [1, 0, 0, 0, 0, 0, -1, 0, 0, 1, 0, 0, 0, 0, 0, 1]  # by columns: (x, y, z) to (x, z, -y)


def encode(body: Body, materials: Mapping[str, schema.Material], suffix: str) -> bytes:
    """The file. `materials` are the scene's, in its order."""
    return {".glb": _glb, ".stl": _stl, ".ply": _ply, ".obj": _obj}[suffix](body, materials)


def _glb(body: Body, materials: Mapping[str, schema.Material]) -> bytes:
    """glTF 2.0: one mesh, a primitive a material, all with the same points. No normals: facets are flat."""
    points = body.vertices.astype("<f4")
    used = np.unique(body.material)
    parts = [body.triangles[body.material == row].astype("<u4") for row in used]
    binary = points.tobytes() + b"".join(part.tobytes() for part in parts)
    views, accessors, start = [], [], 0
    for index, part in enumerate([points, *parts]):
        views.append({"buffer": 0, "byteOffset": start, "byteLength": part.nbytes, "target": 34963 if index else 34962})
        accessor = {"bufferView": index, "componentType": 5125, "count": part.size, "type": "SCALAR"}
        if not index:
            bounds = {"min": part.min(axis=0).tolist(), "max": part.max(axis=0).tolist()}
            accessor |= {"componentType": 5126, "count": len(part), "type": "VEC3", **bounds}
        accessors.append(accessor)
        start += part.nbytes
    listed = list(materials.items())
    described = [_material(*listed[row]) for row in used]
    document = {
        "asset": {"version": "2.0", "generator": "intaglio"},
        "scene": 0,
        "scenes": [{"nodes": [0]}],
        "nodes": [{"mesh": 0, "name": "solid", "matrix": UPRIGHT}],
        "meshes": [
            {
                "name": "solid",
                "primitives": [
                    {"attributes": {"POSITION": 0}, "indices": index + 1, "material": index}
                    for index in range(len(parts))
                ],
            }
        ],
        "materials": described,
        "accessors": accessors,
        "bufferViews": views,
        "buffers": [{"byteLength": len(binary)}],
    }
    extensions = sorted({name for material in described for name in material.get("extensions", {})})
    if extensions:
        document["extensionsUsed"] = extensions
    text = json.dumps(document, separators=(",", ":")).encode()
    text += b" " * (-len(text) % 4)
    chunks = struct.pack("<I4s", len(text), b"JSON") + text + struct.pack("<I4s", len(binary), b"BIN\0") + binary
    return struct.pack("<4sII", b"glTF", 2, 12 + len(chunks)) + chunks


def _material(name: str, material: schema.Material) -> dict[str, Any]:
    """A material in glTF's terms, which are the scene's own."""
    glow = max(1.0, *material.emissive)
    extensions = {
        "KHR_materials_specular": {"specularFactor": material.specular} if material.specular != 1.0 else None,
        "KHR_materials_ior": {"ior": material.ior} if material.ior != 1.5 else None,
        "KHR_materials_transmission": {"transmissionFactor": material.transmission} if material.transmission else None,
        "KHR_materials_emissive_strength": {"emissiveStrength": glow} if glow > 1.0 else None,
    }
    made = {
        "name": name,
        "pbrMetallicRoughness": {
            "baseColorFactor": [*material.base_color, 1.0],
            "metallicFactor": material.metallic,
            "roughnessFactor": material.roughness,
        },
        "emissiveFactor": [value / glow for value in material.emissive],
        "extensions": {key: value for key, value in extensions.items() if value},
    }
    return {key: value for key, value in made.items() if value}


def _stl(body: Body, _: Mapping[str, schema.Material]) -> bytes:
    """Binary STL, which knows no materials."""
    corners = body.vertices[body.triangles]
    a, b, c = (corners[:, k].astype(np.float64) for k in range(3))
    normals = np.cross(b - a, c - a)
    normals /= np.linalg.norm(normals, axis=1, keepdims=True).clip(1e-300)
    rows = np.zeros(len(corners), [("normal", "<f4", (3,)), ("corners", "<f4", (3, 3)), ("attribute", "<u2")])
    rows["normal"], rows["corners"] = normals, corners
    return b"intaglio, world units".ljust(80) + struct.pack("<I", len(rows)) + rows.tobytes()


def _ply(body: Body, materials: Mapping[str, schema.Material]) -> bytes:
    """Binary PLY; a face's `material` counts the comments that name them."""
    rows = np.zeros(len(body.triangles), [("count", "u1"), ("corners", "<i4", (3,)), ("material", "<i4")])
    rows["count"], rows["corners"], rows["material"] = 3, body.triangles, body.material
    lines = [
        "ply", "format binary_little_endian 1.0", "comment intaglio, world units",
        *(f"comment material {_word(name)}" for name in materials),
        f"element vertex {len(body.vertices)}", "property float x", "property float y", "property float z",
        f"element face {len(rows)}", "property list uchar int vertex_indices", "property int material",
        "end_header", "",
    ]  # fmt: skip
    return "\n".join(lines).encode() + body.vertices.astype("<f4").tobytes() + rows.tobytes()


def _obj(body: Body, materials: Mapping[str, schema.Material]) -> bytes:
    """OBJ with the materials' names as `usemtl`; there is no .mtl file."""
    lines = ["# intaglio, world units", "o solid"]
    lines += [f"v {x:.9g} {y:.9g} {z:.9g}" for x, y, z in body.vertices.tolist()]
    names = list(materials)
    for row in np.unique(body.material):
        lines.append(f"usemtl {_word(names[row])}")
        lines += [f"f {a} {b} {c}" for a, b, c in (body.triangles[body.material == row] + 1).tolist()]
    return ("\n".join(lines) + "\n").encode()


def _word(name: str) -> str:
    """A name as one printable word."""
    return "".join(letter if letter.isprintable() and not letter.isspace() else "_" for letter in name)
