"""Everything of a scene but its patterns becomes tables: camera, lights, materials, objects and their meshes."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

import schema
from renderer import meshfile, skyfile
from renderer.compile.patterns import MOST_NEAR, PatternCache
from renderer.errors import Fault, RenderError
from renderer.geometry.shapes import NO_TRIANGLES, Triangles
from renderer.meshfile import TriangleSoup
from renderer.surface import Surface
from renderer.surroundings import surroundings
from renderer.tables import (
    CYLINDER,
    DIRECTIONAL,
    LIGHT,
    MATERIAL,
    MAX_LIGHTS,
    MESH,
    NO_SURROUNDINGS,
    OBJECT,
    POINT,
    RECTANGLE,
    SPHERE,
    Camera,
    Floats,
    Lighting,
    Pattern,
    Surroundings,
)

SMOOTHEST = 1e-3  # roughness; GGX of less, a lobe of a millionth of a radian, is rounding


class CompiledScene(NamedTuple):
    """All that a render reads."""

    camera: Camera
    resolution: tuple[int, int]
    objects: NDArray[np.void]  # (n,) OBJECT
    triangles: Triangles
    materials: NDArray[np.void]  # (m,) MATERIAL
    lighting: Lighting
    patterns: tuple[Pattern, ...]
    slots: tuple[NDArray[np.int32], ...]  # an object each: rows of MATERIAL for its own and its pattern's slots


def compile_scene(
    scene: schema.Scene, resolution: tuple[int, int], patterns: PatternCache, meshes: Callable[[str], bytes] | None
) -> CompiledScene:
    """The tables of a scene. `meshes` gives the bytes of a file by its name, of a mesh or an envmap.

    Raises RenderError where a file cannot be had, or used.
    """
    names = {name: row for row, name in enumerate(scene.materials)}
    objects = np.zeros(len(scene.objects), OBJECT)
    compiled: dict[int, Pattern] = {}
    tables: list[Pattern] = []
    slots = []
    soups: list[tuple[int, TriangleSoup]] = []
    read: dict[str, TriangleSoup] = {}
    for row, model in enumerate(scene.objects):
        obj = objects[row]
        place(obj, model)
        obj["material"] = names[model.material]
        obj["pattern"] = -1
        slot = [obj["material"]]
        shape = model.shape
        if isinstance(shape, schema.Mesh):
            if shape.file not in read:
                read[shape.file] = _read_mesh(f"/objects/{row}/shape/file", shape.file, meshes)
            soup = read[shape.file]
            if soup.uv is None and model.pattern is not None:
                raise RenderError(Fault(f"/objects/{row}/shape/file", "a mesh with uv, as it has a pattern", "no uv"))
            soups.append((row, soup))
        if model.pattern is not None:
            surface = Surface(obj, read.get(shape.file) if isinstance(shape, schema.Mesh) else None)
            kept = patterns.pattern(
                scene.patterns[model.pattern], surface.project,
                model.model_dump_json(include={"shape", "translate", "rotate", "mapping"}),
            )  # fmt: skip
            if kept.tables.near > MOST_NEAR:
                raise RenderError(
                    Fault(
                        f"/patterns/{model.pattern.replace('~', '~0').replace('/', '~1')}/tile",
                        f"a tile in which at most {MOST_NEAR} grooves of all its repetitions come near a point",
                        str(kept.tables.near),
                    )
                )
            if id(kept) not in compiled:
                compiled[id(kept)] = kept.tables
                tables.append(kept.tables)
            obj["pattern"] = next(i for i, table in enumerate(tables) if table is kept.tables)
            slot += [names[name] for name in kept.materials]
        slots.append(np.array(slot, np.int32))
    materials = np.concatenate([_material(material) for material in scene.materials.values()])
    clear = (1.0 - materials["metallic"]) * materials["transmission"] > 0.0
    for row, rows in enumerate(slots):
        objects[row]["clear"] = clear[rows].any()
    return CompiledScene(
        camera=_camera(scene.camera, resolution),
        resolution=resolution,
        objects=objects,
        triangles=_triangles(objects, soups),
        materials=materials,
        lighting=_lighting(scene.lights, meshes),
        patterns=tuple(tables),
        slots=tuple(slots),
    )


def place(obj: np.void, model: schema.Object) -> None:
    """Write where an object stands, its shape and its mapping into its row of OBJECT."""
    shape = model.shape
    if isinstance(shape, schema.Rectangle):
        obj["shape"], obj["size"] = RECTANGLE, shape.size
    elif isinstance(shape, schema.Sphere):
        obj["shape"], obj["size"] = SPHERE, (shape.radius, 0.0)
    elif isinstance(shape, schema.Cylinder):
        obj["shape"], obj["size"] = CYLINDER, (shape.radius, shape.height)
    else:
        obj["shape"] = MESH
    rotation = np.eye(3)
    for axis, degrees in enumerate(model.rotate):  # about the fixed x, then y, then z axis
        turn = np.eye(3)
        i, j = (axis + 1) % 3, (axis + 2) % 3
        c, s = math.cos(math.radians(degrees)), math.sin(math.radians(degrees))
        turn[i, i], turn[i, j], turn[j, i], turn[j, j] = c, -s, s, c
        rotation = turn @ rotation
    obj["rotation"], obj["translation"] = rotation, model.translate
    obj["mapping"] = (*model.mapping.scale, *model.mapping.offset)


def _read_mesh(pointer: str, name: str, meshes: Callable[[str], bytes] | None) -> TriangleSoup:
    if meshes is None:
        raise RenderError(Fault(pointer, "no mesh file, as none can be read here", repr(name)))
    try:
        return meshfile.read(name, meshes(name))
    except OSError as error:
        raise RenderError(Fault(pointer, "a file that can be read", f"{name!r}: {error.strerror or error}")) from None
    except meshfile.MeshFileError as error:
        raise RenderError(Fault(pointer, error.expected, error.found)) from None


def _triangles(objects: NDArray[np.void], soups: list[tuple[int, TriangleSoup]]) -> Triangles:
    """All mesh objects' triangles in the world."""
    parts = []
    for row, soup in soups:
        turn = objects[row]["rotation"].T
        uv = np.zeros((len(soup.corners), 3, 2)) if soup.uv is None else soup.uv
        owner = np.full(len(uv), row, np.int32)
        parts.append((soup.corners @ turn + objects[row]["translation"], uv, soup.normals @ turn, owner))
    if not parts:
        return NO_TRIANGLES
    corners, uvs, normals, owners = zip(*parts, strict=True)
    return Triangles(*(np.ascontiguousarray(np.concatenate(column)) for column in (corners, uvs, normals, owners)))


def _camera(camera: schema.Camera, resolution: tuple[int, int]) -> Camera:
    width, height = resolution
    origin = np.array(camera.origin, float)
    forward = np.array(camera.target, float) - origin
    forward /= np.linalg.norm(forward)
    right = np.cross(forward, np.array(camera.up, float))
    right /= np.linalg.norm(right)
    up = np.cross(right, forward)
    step = 2.0 * math.tan(math.radians(camera.fov) / 2.0) / height  # a pixel's width at distance 1
    corner = forward - right * (0.5 * width * step) + up * (0.5 * height * step)
    return Camera(origin, corner, right * step, -up * step)


def _material(material: schema.Material) -> NDArray[np.void]:
    """The row of MATERIAL (1,), as glTF 2.0 with KHR_materials_specular and _ior has it."""
    row = np.zeros(1, MATERIAL)
    row["base_color"], row["emissive"] = material.base_color, material.emissive
    row["metallic"], row["transmission"], row["ior"] = material.metallic, material.transmission, material.ior
    if material.roughness > 0.0:
        row["alpha"] = max(material.roughness, SMOOTHEST) ** 2
    row["f0"] = material.specular * ((material.ior - 1.0) / (material.ior + 1.0)) ** 2
    row["f90"] = material.specular
    return row


def _lighting(lights: Sequence[schema.Light], files: Callable[[str], bytes] | None) -> Lighting:
    rows = []
    sky, around = np.zeros(3), NO_SURROUNDINGS
    for index, light in enumerate(lights):
        row = np.zeros(1, LIGHT)
        if isinstance(light, schema.DirectionalLight):
            away = -np.array(light.direction, float)
            row["kind"], row["vector"], row["color"] = DIRECTIONAL, away / np.linalg.norm(away), light.irradiance
            rows.append(row)
        elif isinstance(light, schema.PointLight):
            row["kind"], row["vector"], row["color"] = POINT, light.position, light.intensity
            rows.append(row)
        elif isinstance(light, schema.ConstantLight):
            sky += light.radiance
        else:
            around, suns = _surroundings(f"/lights/{index}/file", light, files)
            for sun in suns:
                row["kind"], row["vector"], row["color"] = DIRECTIONAL, sun[:3], sun[3:]
                rows.append(row.copy())
    if len(rows) > MAX_LIGHTS:
        raise RenderError(Fault("/lights", f"at most {MAX_LIGHTS} directional and point lights", str(len(rows))))
    return Lighting(np.concatenate(rows) if rows else np.zeros(0, LIGHT), sky, around)


def _surroundings(
    pointer: str, light: schema.EnvmapLight, files: Callable[[str], bytes] | None
) -> tuple[Surroundings, Floats]:
    if files is None:
        raise RenderError(Fault(pointer, "no envmap, as no file can be read here", repr(light.file)))
    try:
        return surroundings(light.file, files(light.file), light.scale, light.rotate)
    except OSError as error:
        found = f"{light.file!r}: {error.strerror or error}"
        raise RenderError(Fault(pointer, "a file that can be read", found)) from None
    except skyfile.SkyFileError as error:
        raise RenderError(Fault(pointer, error.expected, error.found)) from None
