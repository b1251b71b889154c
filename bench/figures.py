"""Scenes after figures of papers 000 and 001 that are no examples."""

from __future__ import annotations

import json
import math
from typing import Any

import schema
from bench.scenes import EXAMPLES

Json = dict[str, Any]


def farther() -> schema.Scene:
    """Figure 16: the tiles of figure 15 from farther away, under two near point lights."""
    told = _example("tiles")
    told["camera"] |= {"origin": [-1.2, -4.6, 2.9], "target": [0.1, 0.3, 0], "fov": 42}
    told["lights"] = [
        {"type": "point", "position": [-1.3, -0.6, 0.9], "intensity": [3.2, 2.6, 1.9]},
        {"type": "point", "position": [1.6, 1.4, 0.8], "intensity": [1.5, 1.9, 2.6]},
    ]
    told["render"] |= {"exposure": 2.0}
    return _scene(told)


def polished() -> schema.Scene:
    """Figure 17: the grooves of figure 14, whose stone is a mirror by two fifths."""
    told = _example("parallel")
    told["materials"]["stone"] |= {"metallic": 0.4, "roughness": 0}
    told["render"] |= {"bounces": 1}
    return _scene(told)


def mirrors() -> schema.Scene:
    """Figure 15's tiles as mirrors, in matt mortar: what figure 17 is to figure 14, for crossings."""
    told = _example("tiles")
    told["materials"]["tile"] |= {"base_color": [0.9, 0.85, 0.8], "metallic": 1, "roughness": 0}
    told["render"] |= {"bounces": 1}
    return _scene(told)


def glass(bounces: int, *, reflects: bool = True, transmits: bool = True) -> schema.Scene:
    """Figure 20: a tumbler, cut on the outside, on a tiled floor before two walls."""
    around, height = 2.0 * math.pi * 0.6, 1.6  # of the tumbler: its pattern's units are the world's
    step = around / 18
    cuts = [
        _line([step / 2, 0.15], [step / 2, 1.0], {"type": "v", "width": 0.16, "depth": 0.03},
              repeat={"type": "linear", "count": 18, "step": [step, 0]}),
        *(_line([-0.2, q], [around + 0.2, q], {"type": "v", "width": 0.06, "depth": 0.015}) for q in (1.12, 1.22)),
    ]  # fmt: skip
    told = _room(
        {"base_color": [1, 1, 1] if transmits else [0, 0, 0], "specular": float(reflects), "roughness": 0, "ior": 1.5,
         "transmission": float(transmits)},
        {"shape": {"type": "cylinder", "radius": 0.6, "height": height}, "translate": [0, 0, height / 2 + 0.02],
         "mapping": {"scale": [around, height]}},
        cuts, bounces,
    )  # fmt: skip
    return _scene(told)


def ball() -> schema.Scene:
    """Figure 11 of paper 001: a ball of glass, grooves along meridians and around, within walls."""
    cuts = [
        _line([0.25, 2], [0.25, 22], {"type": "v", "width": 0.3, "depth": 0.06},
              repeat={"type": "linear", "count": 48, "step": [1, 0]}),
        _line([-1, 4], [49, 4], {"type": "v", "width": 0.3, "depth": 0.06},
              repeat={"type": "linear", "count": 9, "step": [0, 2]}),
    ]  # fmt: skip
    told = _room(
        {"base_color": [1, 1, 1], "roughness": 0, "ior": 1.5, "transmission": 1},
        {"shape": {"type": "sphere", "radius": 0.8}, "translate": [0, 0, 0.85], "mapping": {"scale": [48, 24]}},
        cuts, 5,
    )  # fmt: skip
    return _scene(told)


def polished_floor() -> schema.Scene:
    """The tiled floor of figure 20 as a mirror, with the walls' bricks in it."""
    told = _room({}, {"shape": {"type": "sphere", "radius": 0.5}, "translate": [0, 0, 0.52]}, [], 1)
    told["objects"][0] = told["objects"][0] | {"material": "floor", "pattern": None}
    told["objects"][1]["material"] = "glass"
    told["materials"]["glass"] = {"base_color": [0.85, 0.82, 0.8], "metallic": 1, "roughness": 0}
    del told["patterns"]["cuts"]
    told["camera"] |= {"origin": [0.9, -2.6, 1.6], "target": [-0.2, 0.2, -0.3], "fov": 40}
    return _scene(told)


def _room(material: Json, body: Json, cuts: list[Json], bounces: int) -> Json:
    """A body on a tiled floor before two walls of brick."""
    joint = {"type": "trapezoid", "width": 0.03, "floor": 0.015, "depth": 0.012}
    tiles = [
        _line([0.25, -1], [0.25, 9], joint, repeat={"type": "linear", "count": 16, "step": [0.5, 0]}),
        _line([-1, 0.25], [9, 0.25], joint, repeat={"type": "linear", "count": 16, "step": [0, 0.5]}),
    ]
    side = {"shape": {"type": "rectangle", "size": [8, 4]}, "mapping": {"scale": [8, 4]}, "pattern": "tiles"}
    floor = {"shape": {"type": "rectangle", "size": [8, 8]}, "mapping": {"scale": [8, 8]}, "pattern": "tiles"}
    return {
        "intaglio": 1,
        "camera": {"origin": [0.4, -3.6, 1.9], "target": [0, 0, 0.75], "fov": 36, "resolution": [320, 240]},
        "lights": [
            {"type": "directional", "direction": [0.5, 0.7, -1], "irradiance": [2.2, 2.1, 1.9]},
            {"type": "constant", "radiance": [0.5, 0.52, 0.55]},
        ],
        "materials": {
            "glass": material, "floor": {"base_color": [0.55, 0.4, 0.28], "specular": 0},
            "red": {"base_color": [0.6, 0.18, 0.12], "specular": 0},
            "blue": {"base_color": [0.16, 0.26, 0.5], "specular": 0},
        },
        "patterns": {"cuts": {"grooves": cuts}, "tiles": {"grooves": tiles}},
        "objects": [
            body | {"material": "glass", "pattern": "cuts"},
            floor | {"material": "floor"},
            side | {"rotate": [90, 0, 0], "translate": [0, 2.5, 2], "material": "blue"},
            side | {"rotate": [90, 0, 90], "translate": [-2.5, 0, 2], "material": "red"},
        ],
        "render": {"method": "auto", "bounces": bounces},
    }  # fmt: skip


def _line(start: list[float], end: list[float], profile: Json, **more: Any) -> Json:
    return {"path": {"type": "polyline", "points": [start, end]}, "profile": profile, **more}


def _example(name: str) -> Any:
    return json.loads((EXAMPLES / f"{name}.json").read_text())


def _scene(told: Any) -> schema.Scene:
    report = schema.check(told)
    assert report.scene is not None, [problem.line() for problem in report.problems]
    return report.scene
