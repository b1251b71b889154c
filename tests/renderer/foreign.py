"""Mitsuba 3 on the triangles that method `geometry` renders: a tracer that shares no line of code with ours.

The scene is made of `mi.load_dict`: each material's triangles, in world coordinates, as a mesh with face normals, on
curved objects with normals at the triangles' corners; a perspective camera with our vertical field of view; lights by
their names, which are Mitsuba's own. `diffuse` is base_color / pi, as is ours where `specular` is 0. A constant sky is
left out: ours reaches facets unoccluded, Mitsuba's does not.
"""

from __future__ import annotations

import os
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

import schema
from renderer import body, mesh
from renderer.compile import PatternCache, compile_scene
from renderer.tables import Floats, Ints, Pattern

LLVM = [f"/usr/lib/x86_64-linux-gnu/libLLVM-{version}.so" for version in (21, 20, 19, 18, 17)]
"""Older ones abort."""


def load() -> Any:
    """Mitsuba, with the fastest variant that runs here."""
    found = next((path for path in LLVM if Path(path).exists()), None)
    if found is not None:
        os.environ.setdefault("DRJIT_LIBLLVM_PATH", found)
    import mitsuba

    mitsuba.set_variant("llvm_ad_rgb" if "DRJIT_LIBLLVM_PATH" in os.environ else "scalar_rgb")
    return mitsuba


class Part(NamedTuple):
    """The triangles of one material, in world coordinates."""

    colour: tuple[float, ...]  # base_color
    corners: Floats  # (n, 3, 3)
    normals: Floats | None  # (n, 3, 3) unit, at the corners; None: the triangles' own


def parts(scene: schema.Scene) -> list[Part]:
    """The triangles of the scene's one object."""
    compiled = compile_scene(scene, scene.camera.resolution, PatternCache(), None)
    (item,), (pattern,) = scene.objects, compiled.patterns
    normals: Floats | None = None
    if isinstance(item.shape, schema.Rectangle):
        corners, slot = _plate(item, pattern)
    else:
        made = body.build(
            0, compiled.objects[0], pattern, compiled.triangles, compiled.camera.origin, compiled.lighting.lights, 0
        )
        corners, slot = made.origin + made.corners @ made.axes.T, made.slot
        normals = np.where(made.cell[:, None, None] < 0, body.facing(corners)[:, None], _carried(made) @ made.axes.T)
    material = compiled.slots[0][slot + 1]
    return [
        Part(
            tuple(compiled.materials["base_color"][row]), corners[material == row],
            None if normals is None else normals[material == row],
        )
        for row in np.unique(material)
    ]  # fmt: skip


def _plate(item: schema.Object, pattern: Pattern) -> tuple[Floats, Ints]:
    """World corners (n, 3, 3) and slots of a rectangle, which is not turned.

    (u, v) = ((p, q) - offset) / scale; a unit of height is sqrt(|dP/dp x dP/dq|) (DESIGN 1.1).
    """
    assert isinstance(item.shape, schema.Rectangle)
    assert not any(item.rotate)
    size, scale, offset = (np.array(pair) for pair in (item.shape.size, item.mapping.scale, item.mapping.offset))
    margin = 0.1 + max(4.0 * pattern.reach, 8.0 * (pattern.height + pattern.depth))
    solid = mesh.build(pattern, (*offset, *(offset + scale)), margin=margin)
    unit = size / scale
    world = np.empty_like(solid.vertices)
    world[:, :2] = (solid.vertices[:, :2] - offset) * unit - 0.5 * size
    world[:, 2] = solid.vertices[:, 2] * np.sqrt(unit.prod())
    return (world + item.translate)[solid.triangles], solid.slot


def _carried(made: body.Body) -> Floats:
    """The normals (n, 3, 3) at the corners of a sphere's or a cylinder's triangles, in the object's axes.

    What is flat in pattern space is carried by `body.carry`, of which central differences give the derivatives; across
    them stand the normals. Between corners they are linear, the truth's go with the map: 1/8 of the square of a cell
    apart, 1e-5. Only facets that are flat in pattern space: no arcs.
    """
    assert not made.bend.any()
    step = 1e-6
    moves = [step * np.eye(3)[axis] for axis in range(3)]
    p, q, w = (
        body.carry(made.base, made.coordinates + move, made.cell)
        - body.carry(made.base, made.coordinates - move, made.cell)
        for move in moves
    )
    n = made.normals[:, None]
    carried = np.cross(q, w) * n[..., :1] + np.cross(w, p) * n[..., 1:2] + np.cross(p, q) * n[..., 2:]
    length = np.linalg.norm(carried, axis=2, keepdims=True)
    return np.asarray(carried / np.maximum(length, 1e-300))


def foreign_scene(mi: Any, scene: schema.Scene, sampler: str = "independent", around: Floats | None = None) -> Any:
    """around: the picture (h, w, 3) of an envmap, which is seen, and which the scene itself leaves out. Mitsuba has its
    first and its last row at the poles."""
    depth = 2 + scene.render.bounces  # rays a path, direct light with 2
    camera = scene.camera
    width, height = camera.resolution
    content: dict[str, Any] = {
        "type": "scene",
        "integrator": {"type": "path", "max_depth": depth, "rr_depth": 1000, "hide_emitters": around is None},
        "sensor": {
            "type": "perspective", "fov": camera.fov, "fov_axis": "y", "near_clip": 1e-3, "far_clip": 1e3,
            "to_world": mi.ScalarTransform4f().look_at(
                origin=list(camera.origin), target=list(camera.target), up=list(camera.up)
            ),
            "film": {"type": "hdrfilm", "width": width, "height": height, "pixel_format": "rgb",
                     "component_format": "float32", "rfilter": {"type": "box"}},
            "sampler": {"type": sampler},
        },
    }  # fmt: skip
    for index, light in enumerate(scene.lights):
        if isinstance(light, schema.DirectionalLight):
            content[f"light{index}"] = {
                "type": "directional", "direction": list(light.direction),
                "irradiance": {"type": "rgb", "value": list(light.irradiance)},
            }  # fmt: skip
        elif isinstance(light, schema.PointLight):
            content[f"light{index}"] = {
                "type": "point", "position": list(light.position),
                "intensity": {"type": "rgb", "value": list(light.intensity)},
            }  # fmt: skip
    if around is not None:
        content["around"] = {
            "type": "envmap", "bitmap": mi.Bitmap(np.ascontiguousarray(around, np.float32)),
            "to_world": mi.ScalarTransform4f().rotate([1, 0, 0], 90),
        }  # fmt: skip
    for index, part in enumerate(parts(scene)):
        count = len(part.corners) * 3
        made = mi.Mesh(
            f"part{index}", count, len(part.corners), props=_matt(mi, part.colour),
            has_vertex_normals=part.normals is not None, has_vertex_texcoords=False,
        )  # fmt: skip
        values = mi.traverse(made)
        values["vertex_positions"] = np.ascontiguousarray(part.corners.reshape(-1), np.float32)
        if part.normals is not None:
            values["vertex_normals"] = np.ascontiguousarray(part.normals.reshape(-1), np.float32)
        values["faces"] = np.arange(count, dtype=np.uint32)
        values.update()
        content[f"part{index}"] = made
    return mi.load_dict(content)


def _matt(mi: Any, colour: tuple[float, ...]) -> Any:
    props = mi.Properties()
    reflectance = {"type": "rgb", "value": [float(c) for c in colour]}
    props["bsdf"] = mi.load_dict({"type": "diffuse", "reflectance": reflectance})
    return props


def picture(mi: Any, scene: Any, samples: int, seed: int) -> Floats:
    """Radiance (H, W, 3)."""
    return np.array(mi.render(scene, spp=samples, seed=seed), np.float64)
