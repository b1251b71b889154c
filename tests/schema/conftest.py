"""The contract's own example scene, and one that names everything the format has."""

import copy
import json
from typing import Any

import pytest

EXAMPLE = """{
  "intaglio": 1,
  "camera": {"origin": [0, -3, 2], "target": [0, 0, 0], "up": [0, 0, 1], "fov": 40, "resolution": [640, 480]},
  "lights": [
    {"type": "directional", "direction": [-1, 0, -1], "irradiance": [3, 3, 3]},
    {"type": "point", "position": [1, 1, 2], "intensity": [5, 5, 5]},
    {"type": "constant", "radiance": [0.1, 0.1, 0.1]}
  ],
  "materials": {
    "stone": {"base_color": [0.7, 0.7, 0.7], "metallic": 0, "roughness": 1, "specular": 0},
    "brass": {"base_color": [0.9, 0.7, 0.4], "metallic": 1, "roughness": 0.3},
    "glass": {"base_color": [1, 1, 1], "roughness": 0, "transmission": 1, "ior": 1.5}
  },
  "patterns": {
    "tiles": {
      "tile": null,
      "grooves": [
        {"path": {"type": "polyline", "points": [[0.25, -1], [0.25, 5]], "closed": false},
         "profile": {"type": "v", "width": 0.16, "depth": 0.08},
         "scale": {"type": "constant"},
         "material": null,
         "priority": 0,
         "ends": "profile",
         "repeat": {"type": "linear", "count": 9, "step": [0.43, 0]}}
      ]
    }
  },
  "objects": [
    {"shape": {"type": "rectangle", "size": [4, 4]}, "translate": [0, 0, 0], "rotate": [0, 0, 0],
     "mapping": {"scale": [4, 4], "offset": [0, 0]}, "material": "stone", "pattern": "tiles"}
  ],
  "render": {"method": "auto", "bounces": 0, "tolerance": 0.002, "exposure": 1.0}
}"""

V = {"type": "v", "width": 0.1, "depth": 0.05}
CIRCLE = {"type": "circle", "center": [0, 0], "radius": 1}
LINE = {"type": "polyline", "points": [[0, 0], [1, 0]]}
EVERY_GROOVE: list[dict[str, Any]] = [
    {"path": {**LINE, "closed": False, "space": "pattern"}, "profile": V, "material": ["stone", None]},
    {
        "path": {"type": "polyline", "points": [[0, 0, 1], [1, 0, 1]], "space": "world"},
        "profile": {"type": "polyline", "points": [[-1, 0], [-1, -1], [1, -1], [1, 0]]},
        "scale": {"type": "linear", "start": 0, "end": 2},
        "repeat": {"type": "grid", "counts": [2, 3], "steps": [[1, 0], [0, 1]]},
    },
    {
        "path": CIRCLE,
        "profile": {"type": "trapezoid", "width": 0.2, "floor": 0.1, "depth": -0.1},
        "scale": {"type": "sine", "amplitude": 0.5, "periods": 8, "phase": 90},
        "material": "brass",
        "repeat": {"type": "concentric", "count": 5, "step": 0.5},
    },
    {
        "path": {"type": "spiral", "center": [0, 0], "inner_radius": 1, "outer_radius": 2, "turns": 4, "angle": 30},
        "profile": {"type": "round", "width": 0.1, "depth": 0.05, "facets": 8},
        "scale": {"type": "table", "t": [0, 0.5, 1], "values": [1, 2, 1]},
        "ends": "flat",
    },
    {
        "path": {"type": "svg", "d": "M0 0 C 1 2 3 4 5 6 z", "flip_y": True},
        "profile": {"type": "scratch", "width": 0.1, "depth": 0.05, "lip_width": 0.02, "lip_height": 0.01},
        "priority": -3,
        "repeat": {
            "type": "scatter", "count": 5, "seed": 7, "bounds": [0, 0, 1, 1], "angle": [0, 90], "scale": [0.5, 2]
        },
    },
]  # fmt: skip


@pytest.fixture
def scene() -> dict[str, Any]:
    """The contract's example, to be changed."""
    data: dict[str, Any] = json.loads(EXAMPLE)
    return data


@pytest.fixture(scope="session")
def example_text() -> str:
    """The same as text, with a groove of every kind."""
    data = json.loads(EXAMPLE)
    data["patterns"]["tiles"]["grooves"] += EVERY_GROOVE
    return json.dumps(data)


@pytest.fixture
def groove(scene: dict[str, Any]) -> dict[str, Any]:
    """The example's one groove."""
    found: dict[str, Any] = scene["patterns"]["tiles"]["grooves"][0]
    return found


@pytest.fixture
def everything(scene: dict[str, Any]) -> dict[str, Any]:
    """A scene with every path, profile, scale, repeat, light and shape."""
    scene["lights"].append({"type": "envmap", "file": "sky.exr", "scale": 2, "rotate": 90})
    scene["patterns"]["all"] = {"tile": [4, 4], "grooves": copy.deepcopy(EVERY_GROOVE)}
    shapes: list[dict[str, Any]] = [
        {"type": "sphere", "radius": 1},
        {"type": "cylinder", "radius": 1, "height": 2},
        {"type": "mesh", "file": "pot.obj"},
    ]
    scene["objects"] += [{"shape": shape, "material": "glass", "pattern": "all"} for shape in shapes]
    scene["render"] |= {"samples": 16, "seed": 3, "method": "csg"}
    return scene
