"""Light from facet to facet and from object to object: the furnace, and `csg`, `auto` and `geometry` side by side.

Both sides are means of RUNS independent pictures, from which comes the variance of each pixel: of pixels that see
noise, z = difference / standard error follows Student's distribution (`test_foreign.student`), and the means of the
pictures differ by no more than four standard errors and BIAS.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from .scenes import DITCH, RIDGE, SKEW, Floats, Json, family, line, ring
from .test_foreign import compared, student

Plate = Callable[..., Json]
Radiance = Callable[..., Floats]

RUNS = 12
SAMPLES = 64
BIAS = 4e-4  # of radiance of about 1: the truth's rays start off the surface, and low rays are lifted by 0.06 degrees

WHITE = {"base_color": [1, 1, 1], "specular": 0}
MATT = {"base_color": [0.7, 0.6, 0.3], "specular": 0}
MATERIALS: dict[str, Json] = {
    "matt": MATT,
    "plastic": {"base_color": [0.7, 0.3, 0.2], "roughness": 0.4},
    "brass": {"base_color": [0.9, 0.7, 0.4], "metallic": 1, "roughness": 0.4},
    "coated": {"base_color": [0.7, 0.3, 0.2], "roughness": 0},
    "glowing": MATT | {"emissive": [0.3, 0.2, 0.1]},
}
SUN = {"type": "directional", "direction": [1, 0.45, -0.9], "irradiance": [2.0, 1.8, 1.6]}
LAMP = {"type": "point", "position": [-0.7, 0.4, 0.9], "intensity": [0.5, 0.6, 0.8]}
SKY = {"type": "constant", "radiance": [0.4, 0.5, 0.6]}
CLOSE = {"origin": [0.1, -1.2, 1.1], "target": [0, 0, 0], "fov": 20, "resolution": [24, 18]}
CUT = [family(SKEW, step=0.5, count=5), line([-1, 0.8], [3, 1.2], profile=RIDGE)]
PATTERNS: dict[str, list[Json]] = {
    "parallel": [family(DITCH, step=0.45, count=6)],
    "crossing": CUT,
    "arcs": [ring(0.5, DITCH), ring(0.2, RIDGE)],
}
BALL = {"shape": {"type": "sphere", "radius": 0.25}, "translate": [0.1, 0.1, 0.3], "material": "ball"}
WALL = {
    "shape": {"type": "rectangle", "size": [2, 2]}, "rotate": [90, 0, 0], "translate": [0, 0.35, 1.2],
    "mapping": {"scale": [2, 2]}, "material": "ball", "pattern": "cut",
}  # fmt: skip


def agree(data: Json, radiance: Radiance, method: str) -> None:
    """`method` and `geometry` differ by noise alone."""
    solids: dict[str, Any] = {}
    theirs = np.array(
        [radiance(data, method="geometry", samples=SAMPLES, seed=100 + seed, solids=solids) for seed in range(RUNS)]
    )
    ours = np.array([radiance(data, method=method, samples=SAMPLES, seed=seed) for seed in range(RUNS)])
    z, (difference, error) = compared(ours, theirs)
    most = student(RUNS - 1, len(z))
    found = f"z^2 {np.mean(z**2):.3f} of {len(z)} pixels, means differ by {difference:.2e}, error {error:.2e}"
    assert len(z) > 100
    assert abs(difference) < 4.0 * error + BIAS, found
    assert np.mean(z**2) < most[0] + 4.0 * most[1], found


@pytest.mark.parametrize("method", ["csg", "auto", "geometry"])
@pytest.mark.parametrize("bounces", [1, 4])
def test_the_furnace(method: str, bounces: int, plate: Plate, radiance: Radiance) -> None:
    """White under a white sky, nothing can be told from anything."""
    scene = plate(
        CUT, materials={"stone": WHITE, "ball": WHITE}, lights=[SKY | {"radiance": [1, 1, 1]}], camera=CLOSE,
        render={"bounces": bounces},
    )  # fmt: skip
    assert radiance(scene, method=method, samples=16) == pytest.approx(1.0, abs=1e-6)
    scene["objects"] += [BALL, WALL]
    image = radiance(scene, method=method, samples=16)
    assert image.max() < 1.0 + 1e-6
    assert image.mean() > 1.0 - (2e-3 if method == "geometry" else 1e-9)  # single precision, where solids touch


@pytest.mark.parametrize(
    "name", ["matt", "brass"]
)  # not where a coat lies on white: glTF's mix gives more than it gets
def test_no_furnace_above_one(name: str, plate: Plate, radiance: Radiance) -> None:
    material = MATERIALS[name] | {"base_color": [1, 1, 1], "emissive": [0, 0, 0]}
    scene = plate(
        CUT, materials={"stone": material}, lights=[SKY | {"radiance": [1, 1, 1]}], camera=CLOSE, render={"bounces": 3}
    )
    assert radiance(scene, method="csg", samples=256).mean() < 1.0 + 1e-3


@pytest.mark.parametrize("pattern", PATTERNS)
@pytest.mark.parametrize("name", MATERIALS)
def test_one_object(name: str, pattern: str, plate: Plate, radiance: Radiance) -> None:
    scene = plate(
        PATTERNS[pattern], materials={"stone": MATERIALS[name]}, lights=[SUN, LAMP, SKY], camera=CLOSE,
        render={"bounces": 2},
    )  # fmt: skip
    agree(scene, radiance, "csg" if pattern != "crossing" else "auto")


@pytest.mark.parametrize(
    ("stone", "ball", "others"),
    [("matt", "brass", [BALL]), ("matt", "matt", [WALL]), ("brass", "glowing", [BALL, WALL])],
)
def test_other_objects(stone: str, ball: str, others: list[Json], plate: Plate, radiance: Radiance) -> None:
    """Their shadows into grooves are another matter: these lights cast none on what is seen."""
    scene = plate(
        CUT, materials={"stone": MATERIALS[stone], "ball": MATERIALS[ball]}, lights=[SKY], camera=CLOSE,
        render={"bounces": 2},
    )  # fmt: skip
    scene["objects"] += others
    agree(scene, radiance, "auto")


def test_a_mesh_meets_itself(plate: Plate, radiance: Radiance) -> None:
    """A floor and a wall of one mesh light each other, and the grooves in them, which end before they meet."""
    corner = """v -0.6 -0.6 0
v 0.6 -0.6 0
v 0.6 0.4 0
v -0.6 0.4 0
v -0.6 0.4 1
v 0.6 0.4 1
vt 0 0
vt 1 0
vt 1 0.5
vt 0 0.5
vt 0 1
vt 1 1
f 1/1 2/2 3/3
f 1/1 3/3 4/4
f 4/4 3/3 6/6
f 4/4 6/6 5/5
"""
    scene = plate(
        [line([0.1, 0.3], [1.1, 0.55], profile=DITCH), line([0.1, 1.3], [1.1, 1.55], profile=DITCH)],
        materials={"stone": MATT}, lights=[SKY], camera=CLOSE, render={"bounces": 2},
    )  # fmt: skip
    scene["objects"][0] |= {"shape": {"type": "mesh", "file": "corner.obj"}, "mapping": {"scale": [1.2, 2]}}
    agree(scene, lambda data, **options: radiance(data, meshes=lambda _: corner.encode(), **options), "auto")


def test_a_ball_mirrors_what_is_around(plate: Plate, radiance: Radiance) -> None:
    """Its normal turns within a pixel, so that what it shows is not torn."""
    ball = BALL | {"shape": {"type": "sphere", "radius": 0.4}, "translate": [0, 0, 0.5]}
    mirror = {"base_color": [0.9, 0.9, 0.9], "metallic": 1, "roughness": 0}
    camera = {"origin": [0.1, -1.6, 0.9], "target": [0, 0, 0.4], "fov": 18, "resolution": [24, 18]}
    scene = plate(
        [family(DITCH, step=0.45, count=6)], materials={"stone": MATT, "ball": mirror}, lights=[SKY], camera=camera,
        render={"bounces": 2},
    )  # fmt: skip
    scene["objects"].append(ball)
    agree(scene, radiance, "auto")


@pytest.mark.parametrize("method", ["auto", "csg", "geometry"])
def test_the_same_for_any_tiling(method: str, plate: Plate, radiance: Radiance) -> None:
    scene = plate(CUT, materials={"stone": MATERIALS["plastic"], "ball": MATT}, render={"bounces": 2})
    for others in ([], [BALL]):
        scene["objects"] += others
        first = radiance(scene, method=method, samples=9, resolution=(40, 30), threads=1, tile=64)
        assert (radiance(scene, method=method, samples=9, resolution=(40, 30), threads=2, tile=17) == first).all()
