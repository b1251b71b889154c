"""Mitsuba 3 on the triangles that method `geometry` renders: a tracer that shares no line of code with ours.

The scene is made of `mi.load_dict`: each material's triangles, in world coordinates, as a mesh with face normals; a
perspective camera with our vertical field of view; lights by their names, which are Mitsuba's own. `diffuse` is
base_color / pi, as is ours where `specular` is 0. A constant sky is left out: ours reaches
facets unoccluded, Mitsuba's does not.
"""

from __future__ import annotations

import os
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

import schema
from renderer import mesh
from renderer.compile import PatternCache, compile_scene

Floats = NDArray[np.float64]

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


def triangles(scene: schema.Scene) -> list[tuple[Floats, tuple[float, ...]]]:
    """World corners (n, 3, 3) by base colour, of the one rectangle of the scene, which is not turned.

    (u, v) = ((p, q) - offset) / scale; a unit of height is sqrt(|dP/dp x dP/dq|) (DESIGN 1.1).
    """
    compiled = compile_scene(scene, scene.camera.resolution, PatternCache(), None)
    (item,), (pattern,) = scene.objects, compiled.patterns
    assert isinstance(item.shape, schema.Rectangle)
    assert not any(item.rotate)
    size, scale, offset = (np.array(pair) for pair in (item.shape.size, item.mapping.scale, item.mapping.offset))
    margin = 0.1 + max(4.0 * pattern.reach, 8.0 * (pattern.height + pattern.depth))
    solid = mesh.build(pattern, (*offset, *(offset + scale)), margin=margin)
    unit = size / scale
    world = np.empty_like(solid.vertices)
    world[:, :2] = (solid.vertices[:, :2] - offset) * unit - 0.5 * size
    world[:, 2] = solid.vertices[:, 2] * np.sqrt(unit.prod())
    corners = (world + item.translate)[solid.triangles]
    material = compiled.slots[0][solid.slot + 1]
    return [(corners[material == row], tuple(compiled.materials["base_color"][row])) for row in np.unique(material)]


def foreign_scene(mi: Any, scene: schema.Scene) -> Any:
    camera = scene.camera
    width, height = camera.resolution
    parts: dict[str, Any] = {
        "type": "scene",
        "integrator": {"type": "path", "max_depth": 2, "hide_emitters": True},  # direct light
        "sensor": {
            "type": "perspective", "fov": camera.fov, "fov_axis": "y", "near_clip": 1e-3, "far_clip": 1e3,
            "to_world": mi.ScalarTransform4f().look_at(
                origin=list(camera.origin), target=list(camera.target), up=list(camera.up)
            ),
            "film": {"type": "hdrfilm", "width": width, "height": height, "pixel_format": "rgb",
                     "component_format": "float32", "rfilter": {"type": "box"}},
            "sampler": {"type": "independent"},
        },
    }  # fmt: skip
    for index, light in enumerate(scene.lights):
        if isinstance(light, schema.DirectionalLight):
            parts[f"light{index}"] = {
                "type": "directional", "direction": list(light.direction),
                "irradiance": {"type": "rgb", "value": list(light.irradiance)},
            }  # fmt: skip
        elif isinstance(light, schema.PointLight):
            parts[f"light{index}"] = {
                "type": "point", "position": list(light.position),
                "intensity": {"type": "rgb", "value": list(light.intensity)},
            }  # fmt: skip
    for index, (corners, colour) in enumerate(triangles(scene)):
        made = mi.Mesh(
            f"part{index}", len(corners) * 3, len(corners),
            props=_matt(mi, colour), has_vertex_normals=False, has_vertex_texcoords=False,
        )  # fmt: skip
        values = mi.traverse(made)
        values["vertex_positions"] = np.ascontiguousarray(corners.reshape(-1), np.float32)
        values["faces"] = np.arange(len(corners) * 3, dtype=np.uint32)
        values.update()
        parts[f"part{index}"] = made
    return mi.load_dict(parts)


def _matt(mi: Any, colour: tuple[float, ...]) -> Any:
    props = mi.Properties()
    reflectance = {"type": "rgb", "value": [float(c) for c in colour]}
    props["bsdf"] = mi.load_dict({"type": "diffuse", "reflectance": reflectance})
    return props


def picture(mi: Any, scene: Any, samples: int, seed: int) -> Floats:
    """Radiance (H, W, 3)."""
    return np.array(mi.render(scene, spp=samples, seed=seed), np.float64)
