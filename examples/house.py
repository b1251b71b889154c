"""The example `house`, after figure 21 of the report: brick, tile, timber and paving are grooves on a few flat walls.

Lengths are metres. What is not flat and rectangular, the end wall under its gable, is a mesh of three triangles.
"""

from __future__ import annotations

import math
from typing import Any

Json = dict[str, Any]

WIDE, DEEP, EAVES, RIDGE = 5.0, 4.0, 2.6, 4.4
BEHIND = 0.01
OVERHANG = 0.35
SLOPE = math.degrees(math.atan2(RIDGE - EAVES, DEEP / 2))

FRONT, RIGHT = [90, 0, 0], [90, 0, 90]  # turns of a rectangle that stands, seen from -y and from +x

MATERIALS = {
    "brick": {"base_color": [0.42, 0.14, 0.08], "specular": 0},
    "mortar": {"base_color": [0.62, 0.58, 0.52], "specular": 0},
    "tile": {"base_color": [0.3, 0.1, 0.06], "specular": 0},
    "paint": {"base_color": [0.82, 0.8, 0.74], "specular": 0},
    "pane": {"base_color": [0.02, 0.025, 0.03], "roughness": 0, "ior": 1.8},
    "water": {"base_color": [0.01, 0.07, 0.1], "roughness": 0, "ior": 1.33},
    "stone": {"base_color": [0.5, 0.45, 0.37], "specular": 0},
    "kerb": {"base_color": [0.68, 0.64, 0.57], "specular": 0},
    "grass": {"base_color": [0.09, 0.17, 0.04], "specular": 0},
    "timber": {"base_color": [0.2, 0.3, 0.24], "specular": 0},
}


def line(start: list[float], end: list[float], profile: Json, **more: Any) -> Json:
    return {"path": {"type": "polyline", "points": [start, end]}, "profile": profile, **more}


def rows(count: int, step: list[float]) -> Json:
    return {"type": "linear", "count": count, "step": step}


def joint(width: float, depth: float) -> Json:
    return {"type": "trapezoid", "width": width, "floor": 0.6 * width, "depth": depth}


def patterns() -> dict[str, Json]:
    """In metres, but the bricks': one brick with its joint is 1 by 1 there, of a wall 4 by 12 a metre."""
    mortar = {"material": [None, "mortar", None]}
    brick = joint(0.06, 0.035)
    bricks = [
        line([-1, 0], [21, 0], joint(0.14, 0.035), **mortar, repeat=rows(55, [0, 1])),
        *(
            line(
                [x, y],
                [x, y + 1],
                brick,
                **mortar,
                repeat={"type": "grid", "counts": [21, 27], "steps": [[1, 0], [0, 2]]},
            )
            for x, y in ((0.25, 0), (0.75, 1))
        ),
    ]
    course = {"type": "polyline", "points": [[-0.16, 0], [0.15, -0.05], [0.16, 0]]}
    tiles = [
        line([-1, 0.16], [7, 0.16], course, repeat=rows(10, [0, 0.32])),
        line([0.11, -1], [0.11, 5], {"type": "v", "width": 0.03, "depth": 0.05}, repeat=rows(26, [0.22, 0])),
    ]
    slabs = [
        line([-1, 0.4], [11, 0.4], joint(0.03, 0.012), repeat=rows(8, [0, 0.8])),
        line([0.4, -1], [0.4, 8], joint(0.03, 0.012), repeat=rows(12, [0.8, 0])),
    ]
    bar, post = {"type": "trapezoid", "width": 0.05, "floor": 0.035, "depth": -0.03}, 0.11
    stile = {"type": "trapezoid", "width": post, "floor": 0.08, "depth": -0.05}
    window = [
        line([0, y], [1, y], stile, material="paint", ends="flat") for y in (post / 2, 1 - post / 2)
    ] + [
        line([x, 0], [x, 1], stile, material="paint", ends="flat") for x in (post / 2, 1 - post / 2)
    ] + [
        line([0, 0.5], [1, 0.5], bar, material="paint"),
        line([0.3, 0], [0.3, 1], bar, material="paint"),
        line([0.5, 0], [0.5, 1], bar, material="paint"),
        line([0.7, 0], [0.7, 1], bar, material="paint"),
    ]  # fmt: skip
    door = [
        line([0.1, 0], [0.1, 2.2], {"type": "v", "width": 0.03, "depth": 0.02},
             repeat={"type": "linear", "count": 9, "step": [0.1, 0]}),
        line([0, 0.35], [1, 0.35], {"type": "trapezoid", "width": 0.16, "floor": 0.12, "depth": -0.02}),
        line([0, 1.75], [1, 1.75], {"type": "trapezoid", "width": 0.16, "floor": 0.12, "depth": -0.02}),
    ]  # fmt: skip
    edge = [[0.15, 0.15], [3.85, 0.15], [3.85, 2.25], [0.15, 2.25]]
    rim = {
        "path": {"type": "polyline", "points": edge, "closed": True},
        "profile": {"type": "trapezoid", "width": 0.3, "floor": 0.24, "depth": -0.08}, "material": "kerb",
    }  # fmt: skip
    return {
        "bricks": {"grooves": bricks},
        "tiles": {"grooves": tiles},
        "slabs": {"grooves": slabs},
        "window": {"grooves": window},
        "door": {"grooves": door},
        "pool": {"grooves": [rim]},
    }


def wall(size: tuple[float, float], at: list[float], rotate: list[float], **more: Any) -> Json:
    """A rectangle, its pattern in metres."""
    return {
        "shape": {"type": "rectangle", "size": list(size)}, "translate": at, "rotate": rotate,
        "mapping": {"scale": list(size)}, **more,
    }  # fmt: skip


def laid(wide: float, high: float) -> Json:
    """The mapping of a wall of bricks."""
    return {"scale": [4 * wide, 12 * high]}


def end_wall() -> str:
    """The wall under the gable as OBJ, seen from +x, with uv: 0 to 1 over DEEP by RIDGE.

    It ends behind the front wall: edges in the same plane would be neither's.
    """
    side = DEEP / 2 - BEHIND
    corners = [(-side, 0.0), (side, 0.0), (side, EAVES), (0.0, RIDGE), (-side, EAVES)]
    lines = ["# the end wall of a house; written by make.py"]
    lines += [f"v {WIDE / 2 - BEHIND:g} {y:g} {z:g}" for y, z in corners]
    lines += [f"vt {y / DEEP + 0.5:.9f} {z / RIDGE:.9f}" for y, z in corners]
    return "\n".join([*lines, "f 1/1 2/2 3/3", "f 1/1 3/3 5/5", "f 5/5 3/3 4/4"]) + "\n"


def house() -> Json:
    """A house by a pool."""
    half, front = WIDE / 2, -DEEP / 2
    rafter = math.hypot(DEEP / 2, RIDGE - EAVES) * (1 + OVERHANG / (DEEP / 2))
    eave = 0.5 * (1 + OVERHANG / (DEEP / 2))  # the middle of a slope, in parts of the way down from the ridge
    high = RIDGE - eave * (RIDGE - EAVES) + 0.03
    roof = {"material": "tile", "pattern": "tiles"}
    chimney = {"material": "brick", "pattern": "bricks"}
    objects = [
        {
            "shape": {"type": "rectangle", "size": [WIDE, EAVES]},
            "translate": [0, front, EAVES / 2],
            "rotate": FRONT,
            "mapping": laid(WIDE, EAVES),
            "material": "brick",
            "pattern": "bricks",
        },
        {
            "shape": {"type": "mesh", "file": "end_wall.obj"},
            "mapping": laid(DEEP, RIDGE),
            "material": "brick",
            "pattern": "bricks",
        },
        wall((WIDE + 2 * OVERHANG, rafter), [0, -eave * DEEP / 2, high], [SLOPE, 0, 0], **roof),
        wall((WIDE + 2 * OVERHANG, rafter), [0, eave * DEEP / 2, high], [SLOPE, 0, 180], **roof),
        *(
            wall((1.0, 1.0), [x, front - 0.03, 1.5], FRONT, material="pane", pattern="window")
            | {"shape": {"type": "rectangle", "size": [1.1, 1.3]}}
            for x in (-1.6, 1.6)
        ),
        wall((1.0, 1.0), [half + 0.03, 0, 1.5], RIGHT, material="pane", pattern="window")
        | {"shape": {"type": "rectangle", "size": [1.3, 1.3]}},
        wall((1.0, 2.1), [0, front - 0.03, 1.05], FRONT, material="timber", pattern="door"),
        {
            "shape": {"type": "rectangle", "size": [0.7, 1.8]},
            "translate": [1.3, -0.05, 4.1],
            "rotate": FRONT,
            "mapping": laid(0.7, 1.8),
            **chimney,
        },
        {
            "shape": {"type": "rectangle", "size": [0.6, 1.8]},
            "translate": [1.65, 0.25, 4.1],
            "rotate": RIGHT,
            "mapping": laid(0.6, 1.8),
            **chimney,
        },
        {
            "shape": {"type": "rectangle", "size": [0.8, 0.7]},
            "translate": [1.3, 0.25, 5.0],
            "material": "kerb",
        },
        wall((9.6, 6.4), [0.4, -4.4, 0], [0, 0, 0], material="stone", pattern="slabs"),
        wall((4.0, 2.4), [1.2, -4.6, 0.02], [0, 0, 0], material="water", pattern="pool"),
        {"shape": {"type": "rectangle", "size": [80, 80]}, "translate": [0, 20, -0.03], "material": "grass"},
    ]
    return {
        "intaglio": 1,
        "camera": {"origin": [6.6, -10.8, 3.3], "target": [0.5, -1.3, 1.6], "fov": 38, "resolution": [640, 480]},
        "lights": [
            {"type": "directional", "direction": [-0.55, 0.9, -0.8], "irradiance": [3.3, 3.0, 2.5]},
            {"type": "constant", "radiance": [0.42, 0.55, 0.75]},
        ],
        "materials": MATERIALS,
        "patterns": patterns(),
        "objects": objects,
        "render": {"method": "auto", "samples": 1024, "bounces": 1, "tolerance": 0.01},
    }
