"""Writes the examples that are too long to write by hand: vinyl, single, hieroglyphs, brushed and house (with their
meshes, vase.obj and end_wall.obj).

    python examples/make.py

The same files every time: all that is random has a seed.
"""

from __future__ import annotations

import json
import math
import random
import re
from pathlib import Path
from typing import Any

from house import end_wall, house

HERE = Path(__file__).parent
Json = dict[str, Any]


def text(value: Any, room: int = 112, indent: int = 0) -> str:
    """JSON with what fits on a line on one line."""
    flat = json.dumps(value)
    if len(flat) + indent <= room or not isinstance(value, dict | list) or not value:
        return flat
    pad, inner = " " * indent, " " * (indent + 2)
    if isinstance(value, dict):
        items = [f"{json.dumps(key)}: {text(item, room, indent + 2)}" for key, item in value.items()]
        return "{\n" + ",\n".join(inner + item for item in items) + f"\n{pad}}}"
    return "[\n" + ",\n".join(inner + text(item, room, indent + 2) for item in value) + f"\n{pad}]"


# ---- vinyl: paper 000, figure 19. One pattern unit is the step from a groove of a record to the next. ---------------

TRACK, GAP, FIRST = 100, 7, 183.0  # grooves a track; bare rings between tracks and beside them, pattern units
TRACKS = 5
PLATE = 1560.0  # side of the square that a record lies on
DISH = 0.02  # what is bare lies so deep, only to be of another material than the plate
V = {"type": "v", "width": 1, "depth": 0.2}
SAW = {"type": "polyline", "points": [[-0.5, 0], [0.26, -0.36], [0.5, 0]]}
BROAD = {"type": "trapezoid", "width": 1, "floor": 0.3, "depth": 0.16}
STEEP = {"type": "v", "width": 1, "depth": 0.62}


def ring(inner: float, outer: float, material: str) -> Json:
    """A bare ring, or a disc where `inner` is 0."""
    width = outer - inner
    return {
        "path": {"type": "circle", "center": [0, 0], "radius": (inner + outer) / 2},
        "profile": {"type": "trapezoid", "width": width, "floor": width, "depth": DISH},
        "material": material,
    }


def circles(radius: float, count: int, profile: Json) -> Json:
    """`count` grooves side by side, the first about `radius`."""
    groove = {"path": {"type": "circle", "center": [0, 0], "radius": radius}, "profile": profile, "material": "vinyl"}
    return groove | {"repeat": {"type": "concentric", "count": count, "step": 1}} if count > 1 else groove


def record(label: str, profiles: list[Json], seed: int) -> Json:
    """One record: its label, the bare rings and the tracks, each groove with one of the profiles at random."""
    dice = random.Random(seed)
    grooves = [ring(8, 130, label), ring(130, FIRST, "vinyl")]
    for track in range(TRACKS):
        begin = FIRST + track * (TRACK + GAP)
        start, run, profile = begin, 0, dice.choice(profiles)
        for groove in range(TRACK + 1):
            chosen = dice.choice(profiles) if groove < TRACK else None
            if run and chosen is not profile:
                grooves.append(circles(start + 0.5, run, profile))
                start, run = start + run, 0
            profile, run = chosen or profile, run + 1
        grooves.append(ring(begin + TRACK, begin + TRACK + GAP, "vinyl"))
    return {"grooves": grooves}


def vinyl() -> Json:
    """Three records on a table."""
    plates = [
        {
            "shape": {"type": "rectangle", "size": [2.2, 2.2]},
            "translate": [2.36 * (index - 1), 0, 0],
            "rotate": [0, 0, turn],
            "mapping": {"scale": [PLATE, PLATE], "offset": [-PLATE / 2, -PLATE / 2]},
            "material": "sleeve",
            "pattern": name,
        }
        for index, (name, turn) in enumerate((("symmetric", -4), ("asymmetric", 3), ("random", -2)))
    ]
    table = {
        "shape": {"type": "rectangle", "size": [40, 40]}, "translate": [0, 0, -0.03], "material": "table",
    }  # fmt: skip
    return {
        "intaglio": 1,
        "camera": {"origin": [-3.75, -2.7, 2.0], "target": [-0.93, -0.12, 0], "fov": 42, "resolution": [640, 480]},
        "lights": [
            {"type": "directional", "direction": [0.3, -0.75, -0.85], "irradiance": [4.2, 3.9, 3.4]},
            {"type": "point", "position": [-2.5, -2, 3], "intensity": [9, 11, 15]},
            {"type": "constant", "radiance": [0.05, 0.05, 0.06]},
        ],
        "materials": {
            "vinyl": {"base_color": [0.012, 0.012, 0.014], "roughness": 0.3},
            "sleeve": {"base_color": [0.3, 0.255, 0.19], "roughness": 0.9, "specular": 0.3},
            "table": {"base_color": [0.1, 0.045, 0.022], "roughness": 0.8, "specular": 0.4},
            "red": {"base_color": [0.55, 0.05, 0.03], "roughness": 0.7, "specular": 0.5},
            "blue": {"base_color": [0.04, 0.13, 0.36], "roughness": 0.7, "specular": 0.5},
            "gold": {"base_color": [0.6, 0.38, 0.08], "roughness": 0.7, "specular": 0.5},
        },
        "patterns": {
            "symmetric": record("red", [V], 1),
            "asymmetric": record("blue", [SAW], 2),
            "random": record("gold", [BROAD, SAW, STEEP], 3),
        },
        "objects": [*plates, table],
        "render": {"method": "auto", "samples": 36},
    }


def single() -> Json:
    """One side of few grooves, near enough that a mesh of them can be traced beside them."""
    inner, count = 42.0, 96
    outer = inner + count
    side = 2.0 * (outer + 4.0)
    grooves = [ring(4, inner - 6, "red"), ring(inner - 6, inner, "vinyl"), ring(outer, outer + 3, "vinyl")]
    for start, run, profile in ((0, 30, SAW), (30, 14, V), (44, 32, BROAD), (76, 20, V)):
        grooves.append(circles(inner + start + 0.5, run, profile))
    return {
        "intaglio": 1,
        "camera": {"origin": [-0.3, -1.9, 1.15], "target": [0, -0.1, 0], "fov": 40, "resolution": [640, 480]},
        "lights": [
            {"type": "directional", "direction": [0.3, -0.75, -0.85], "irradiance": [4.2, 3.9, 3.4]},
            {"type": "point", "position": [-1.5, 1, 1.4], "intensity": [5, 6, 8]},
        ],
        "materials": {
            "vinyl": {"base_color": [0.05, 0.05, 0.055], "roughness": 0.4},
            "sleeve": {"base_color": [0.3, 0.255, 0.19], "roughness": 0.9, "specular": 0.3},
            "red": {"base_color": [0.55, 0.05, 0.03], "roughness": 0.7, "specular": 0.5},
        },
        "patterns": {"side": {"grooves": grooves}},
        "objects": [
            {
                "shape": {"type": "rectangle", "size": [2, 2]},
                "mapping": {"scale": [side, side], "offset": [-side / 2, -side / 2]},
                "material": "sleeve",
                "pattern": "side",
            }
        ],
        "render": {"method": "auto", "samples": 36},
    }


# ---- hieroglyphs: line drawings in the unit square, y up -------------------------------------------------------------

GLYPHS = {
    "ankh": "M .5 .52 C .16 .74 .2 1 .5 1 C .8 1 .84 .74 .5 .52 L .5 0 M .16 .52 L .84 .52",
    "eye": "M 0 .56 C .2 .84 .7 .88 1 .6 C .66 .36 .25 .38 0 .56 M .02 .8 C .25 1.02 .75 1.04 1 .82 "
    "M .62 .6 C .62 .74 .4 .74 .4 .6 C .4 .48 .62 .48 .62 .6 M .46 .41 L .42 .08 "
    "M .64 .42 C .68 .12 .86 0 1 .08 C 1.1 .16 1.06 .3 .94 .27 C .86 .24 .88 .15 .95 .16",
    "falcon": "M .52 .98 C .66 1 .74 .93 .74 .87 L .83 .8 L .72 .78 C .69 .74 .75 .66 .74 .57 C .73 .42 .62 .33 .5 .31 "
    "L .17 .04 L .09 .12 L .34 .52 C .4 .62 .43 .7 .41 .8 C .4 .92 .46 .97 .52 .98 "
    "M .42 .68 C .6 .6 .56 .4 .27 .2 M .5 .31 L .5 0 L .68 0 M .6 .35 L .6 .1 L .76 .1 M .6 .88 L .64 .88",
    "reed": "M .42 0 L .42 .46 C .14 .62 .24 .9 .5 1 C .74 .86 .72 .6 .42 .46",
    "water": "M 0 .42 L .1 .6 L .2 .42 L .3 .6 L .4 .42 L .5 .6 L .6 .42 L .7 .6 L .8 .42 L .9 .6 L 1 .42",
    "basket": "M 0 .62 L 1 .62 C .96 .22 .7 .14 .5 .14 C .3 .14 .04 .22 0 .62",
    "sun": "M 1 .5 C 1 .776 .776 1 .5 1 C .224 1 0 .776 0 .5 C 0 .224 .224 0 .5 0 C .776 0 1 .224 1 .5 "
    "M .6 .5 C .6 .63 .4 .63 .4 .5 C .4 .37 .6 .37 .6 .5",
    "viper": "M 0 .3 C .12 .5 .26 .5 .38 .34 C .5 .18 .62 .2 .68 .36 C .72 .5 .7 .6 .74 .7 C .8 .8 .92 .78 1 .68 "
    "M .78 .78 L .74 .92 M .86 .79 L .9 .92",
}
NUMBER = re.compile(r"-?\d*\.?\d+")


def placed(drawing: str, x: float, y: float, width: float, height: float) -> str:
    """A drawing of the unit square in the box at (x, y)."""
    coordinates = iter(range(len(drawing)))

    def move(number: re.Match[str]) -> str:
        value = float(number.group())
        return f"{x + width * value if next(coordinates) % 2 == 0 else y + height * value:.4g}"

    return NUMBER.sub(move, drawing)


def glyphs(order: list[str], column: float, top: float, size: float, gap: float) -> list[Json]:
    """A column of drawings, one below the other, centred on p = column."""
    chisel = {"type": "v", "width": 0.075 * size, "depth": 0.045 * size}
    grooves = []
    for row, name in enumerate(order):
        d = placed(GLYPHS[name], column - size / 2, top - size - row * (size + gap), size, size)
        grooves.append({"path": {"type": "svg", "d": d}, "profile": chisel})
    return grooves


def hieroglyphs() -> Json:
    """Two columns on a paved floor, the drawings in the order they were chiselled."""
    around, height = 2 * math.pi, 7.0  # circumference and height of a column of radius 1: its pattern's units
    orders = [
        ["sun", "falcon", "water", "ankh", "basket"],
        ["reed", "eye", "viper", "falcon", "sun"],
        ["eye", "ankh", "reed", "water", "viper"],
        ["falcon", "basket", "sun", "reed", "eye"],
        ["water", "viper", "ankh", "eye", "falcon"],
        ["basket", "reed", "falcon", "viper", "ankh"],
    ]
    columns = []
    line = {"type": "round", "width": 0.07, "depth": 0.03, "facets": 6}
    step = around / len(orders)
    for index, order in enumerate(orders):
        middle = (index + 0.5) * step
        columns += glyphs(order, middle, 5.72, 0.66, 0.2)
    for index in range(len(orders) + 1):  # the first one twice: half of it on either side of the seam
        path = {"type": "polyline", "points": [[index * step, 1.32], [index * step, 5.86]]}
        columns.append({"path": path, "profile": line})
    band = {"type": "trapezoid", "width": 0.12, "floor": 0.06, "depth": 0.045}
    for level in (1.2, 1.0, 5.98, 6.18):
        path = {"type": "polyline", "points": [[-1, level], [around + 1, level]]}
        columns.append({"path": path, "profile": band})
    joint = {"type": "v", "width": 0.05, "depth": 0.03}
    paving = [
        {
            "path": {"type": "polyline", "points": [start, end]},
            "profile": joint,
            "repeat": {"type": "linear", "count": 40, "step": step_},
        }
        for start, end, step_ in (([-20, -20], [20, -20], [0, 1]), ([-20, -20], [-20, 20], [1, 0]))
    ]
    mapping = {"scale": [around, height]}
    return {
        "intaglio": 1,
        "camera": {"origin": [-1.1, -7.6, 3.6], "target": [0.35, 0, 3.3], "fov": 38, "resolution": [640, 480]},
        "lights": [
            {"type": "directional", "direction": [1, 0.36, -0.5], "irradiance": [4, 3.4, 2.5]},
            {"type": "point", "position": [3.6, -4.5, 4.6], "intensity": [7, 8.5, 12]},
            {"type": "constant", "radiance": [0.07, 0.085, 0.12]},
        ],
        "materials": {
            "sandstone": {"base_color": [0.66, 0.5, 0.33], "roughness": 1, "specular": 0},
            "paving": {"base_color": [0.4, 0.33, 0.25], "roughness": 1, "specular": 0},
        },
        "patterns": {"writing": {"grooves": columns}, "paving": {"grooves": paving}},
        "objects": [
            {
                "shape": {"type": "cylinder", "radius": 1, "height": height},
                "translate": [x, y, height / 2],
                "rotate": [0, 0, turn],
                "mapping": mapping,
                "material": "sandstone",
                "pattern": "writing",
            }
            for x, y, turn in ((-0.75, 0, -130), (2.9, 3.7, -73))
        ]
        + [
            {
                "shape": {"type": "rectangle", "size": [40, 40]},
                "mapping": {"scale": [24, 24], "offset": [-12, -12]},
                "material": "paving",
                "pattern": "paving",
            }
        ],
        "render": {"method": "auto", "samples": 64},
    }


# ---- brushed: a spun vase ------------------------------------------------------------------------------------------

OUTLINE = [  # radius and height from the foot up over the lip and a little inside; a Catmull-Rom spline joins them
    (0.0, 0.0), (0.34, 0.0), (0.42, 0.03), (0.4, 0.1), (0.42, 0.2), (0.62, 0.42), (0.76, 0.72), (0.74, 1.02),
    (0.55, 1.3), (0.36, 1.5), (0.3, 1.66), (0.34, 1.8), (0.47, 1.9), (0.49, 1.93), (0.45, 1.92), (0.32, 1.8),
    (0.26, 1.6),
]  # fmt: skip
AROUND, ALONG = 72, 4  # faces around, and between two points of the outline


def outline() -> list[tuple[float, float, float]]:
    """Radius, height and length so far."""
    points = []
    last = len(OUTLINE) - 1
    for index in range(last):
        a, b, c, d = (OUTLINE[min(max(index + k, 0), last)] for k in (-1, 0, 1, 2))
        for part in range(ALONG if index < last - 1 else ALONG + 1):
            t = part / ALONG
            points.append(
                tuple(
                    0.5 * (2 * q + (r - p) * t + (2 * p - 5 * q + 4 * r - s) * t * t + (3 * (q - r) + s - p) * t**3)
                    for p, q, r, s in zip(a, b, c, d, strict=True)
                )
            )
    length, result = 0.0, []
    for index, (radius, height) in enumerate(points):
        length += math.dist(points[index], points[index - 1]) if index else 0.0
        result.append((max(radius, 1e-3), height, length))
    return result


def vase() -> str:
    """The vase as OBJ, z up, with uv (the way around, the length along the outline) and smooth normals."""
    rows = outline()
    whole = rows[-1][2]
    lines = ["# a vase, turned about z; written by make.py"]
    for index, (radius, height, length) in enumerate(rows):
        before, after = rows[max(index - 1, 0)], rows[min(index + 1, len(rows) - 1)]
        rise, out = after[1] - before[1], after[0] - before[0]
        norm = math.hypot(rise, out)
        for step in range(AROUND + 1):
            angle = 2 * math.pi * step / AROUND
            x, y = math.cos(angle), math.sin(angle)
            lines.append(f"v {radius * x:.5f} {radius * y:.5f} {height:.5f}")
            lines.append(f"vt {step / AROUND:.5f} {length / whole:.5f}")
            lines.append(f"vn {rise / norm * x:.4f} {rise / norm * y:.4f} {-out / norm:.4f}")
    for row in range(len(rows) - 1):
        for step in range(AROUND):
            a = row * (AROUND + 1) + step + 1
            b, c, d = a + 1, a + AROUND + 2, a + AROUND + 1
            lines += [f"f {i}/{i}/{i} {j}/{j}/{j} {k}/{k}/{k}" for i, j, k in ((a, b, c), (a, c, d))]
    return "\n".join(lines) + "\n"


def brushed() -> Json:
    """A vase of brass, brushed on the lathe: one tile of grooves of many widths, all around."""
    dice = random.Random(11)
    grooves, q, tile = [], 0.0, 1.0
    while q < tile - 0.03:
        width = round(dice.uniform(0.008, 0.03), 4)
        middle = round(q + width / 2, 4)
        low = round(dice.uniform(-0.3, 0.3) * width, 4)
        depth = round(dice.uniform(0.1, 0.24) * width, 4)
        profile = {"type": "polyline", "points": [[-width / 2, 0], [low, -depth], [width / 2, 0]]}
        path = {"type": "polyline", "points": [[0, middle], [tile, middle]]}
        grooves.append({"path": path, "profile": profile, "ends": "flat"})
        q += width
    return {
        "intaglio": 1,
        "camera": {"origin": [0.5, -4.4, 2.1], "target": [0, 0, 0.93], "fov": 31, "resolution": [640, 480]},
        "lights": [
            {"type": "directional", "direction": [0.8, 1, -0.7], "irradiance": [3.4, 3.2, 3]},
            {"type": "point", "position": [2.4, -1.2, 2.2], "intensity": [4, 4.4, 5.2]},
            {"type": "constant", "radiance": [0.12, 0.125, 0.14]},
        ],
        "materials": {
            "brass": {"base_color": [0.88, 0.66, 0.33], "metallic": 1, "roughness": 0.38},
            "table": {"base_color": [0.2, 0.2, 0.22], "roughness": 0.7},
        },
        "patterns": {"brush": {"tile": [tile, tile], "grooves": grooves}},
        "objects": [
            {
                "shape": {"type": "mesh", "file": "vase.obj"},
                "mapping": {"scale": [6, 6]},
                "material": "brass",
                "pattern": "brush",
            },
            {"shape": {"type": "rectangle", "size": [30, 30]}, "material": "table"},
        ],
        "render": {"method": "auto", "samples": 64},
    }


def main() -> None:
    """Write all files."""
    (HERE / "vase.obj").write_text(vase())
    (HERE / "end_wall.obj").write_text(end_wall())
    for scene in (vinyl, single, hieroglyphs, brushed, house):
        (HERE / f"{scene.__name__}.json").write_text(text(scene()) + "\n")


if __name__ == "__main__":
    main()
