"""Whatever stands in a valid scene: numbers come out, none below 0, and none above what there is to reflect."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from renderer import body
from renderer.errors import RenderError

from .scenes import GROOVES, LARGE_GROOVES, LIGHTS, ORIGINS, SINGLE, SKY, SUNS, WHITE, Floats, Json

Plate = Callable[..., Json]
Radiance = Callable[..., Floats]

MATERIALS = st.sampled_from(
    [WHITE, {"roughness": 0}, {"metallic": 1, "roughness": 0.1}, {"transmission": 1, "roughness": 0}, {}]
)
MAPPINGS = st.sampled_from([[2, 2], [2, 2], [2000, 0.01], [1e5, 1e5], [0.01, 0.01], [2, 3]])
TILES = st.sampled_from([None, None, [2.3, 1.9]])  # paths that overlap themselves ten times are slow, and no news
CURVED = {
    "sphere": {"shape": {"type": "sphere", "radius": 1}, "translate": [0, 0, -1]},
    "cylinder": {
        "shape": {"type": "cylinder", "radius": 1, "height": 1}, "translate": [0, 0, -1], "rotate": [90, 0, 0],
    },
}  # fmt: skip


def rendered(radiance: Radiance, scene: Json, method: str) -> Floats:
    """The picture; black where grooves that are too many, at one place or for a mesh, are refused."""
    try:
        return radiance(scene, method=method, samples=4, texels=64)
    except RenderError as error:
        pointers = [fault.pointer for fault in error.faults]
    assert pointers == ["/patterns/cut/tile"] or (pointers == ["/objects/0/pattern"] and method == "geometry")
    return np.zeros((1, 1, 3))


def placed(grooves: list[Json]) -> list[Json]:
    """Without their repeats: a hundred overlapping grooves are slow, and no news."""
    return [{k: v for k, v in groove.items() if k != "repeat"} for groove in grooves]


def looking(origin: list[float]) -> Json:
    return {"origin": origin, "target": [0.01, 0.02, 0], "up": [0, 1, 0.01], "resolution": [4, 3]}


def white(plate: Plate, grooves: list[Json], suns: list[Json], tile: list[float] | None = None, **parts: Any) -> Json:
    return plate(grooves, tile, lights=[*suns, SKY], materials={"stone": WHITE, "other": WHITE}, **parts)


def bounded(values: Floats, suns: int) -> bool:
    """Whether a picture is of numbers, none below 0 and none above what so many suns and the sky may give.

    White Lambert facets that face every sun, unshadowed, send back E / pi of each and all of the sky.
    """
    most = 1.0 + suns * np.array([3.0, 2.0, 1.0]) / math.pi
    return bool(((values >= 0.0) & (values <= most * (1.0 + SINGLE))).all())


@settings(max_examples=40, deadline=None, derandomize=True, print_blob=True)
@given(
    grooves=st.lists(GROOVES, min_size=1, max_size=3), twice=st.booleans(), lights=st.lists(LIGHTS, max_size=2),
    origin=ORIGINS, material=MATERIALS, other=MATERIALS, scale=MAPPINGS, tile=TILES,
    shape=st.sampled_from(["rectangle", "sphere", "cylinder"]),
    method=st.sampled_from(["auto", "line", "segment", "area", "csg", "base"]),
)  # fmt: skip
def test_odd_scenes_are_pictures(
    radiance: Radiance, plate: Plate, grooves: list[Json], twice: bool, lights: list[Json], origin: list[float],
    material: Json, other: Json, scale: list[float], tile: list[float] | None, shape: str, method: str,
) -> None:  # fmt: skip
    scene = plate(
        placed(grooves * (2 if twice else 1)), tile, lights=lights, materials={"stone": material, "other": other},
        mapping={"scale": scale}, camera=looking(origin),
    )  # fmt: skip
    scene["objects"][0] |= CURVED.get(shape, {})
    values = rendered(radiance, scene, method)
    assert np.isfinite(values).all()
    assert (values >= 0.0).all()


@settings(max_examples=40, deadline=None, derandomize=True, print_blob=True)
@given(
    grooves=st.lists(GROOVES, min_size=1, max_size=3), suns=st.lists(SUNS, max_size=3), origin=ORIGINS,
    scale=MAPPINGS, tile=TILES, method=st.sampled_from(["auto", "line", "segment", "area", "csg", "base"]),
)  # fmt: skip
def test_no_more_light_than_there_is(
    radiance: Radiance, plate: Plate, grooves: list[Json], suns: list[Json], origin: list[float], scale: list[float],
    tile: list[float] | None, method: str,
) -> None:  # fmt: skip
    """The mean over a footprint whose shares sum to one is no more than the most that a facet may send back."""
    scene = white(plate, placed(grooves), suns, tile, camera=looking(origin), mapping={"scale": scale})
    assert bounded(rendered(radiance, scene, method), len(suns))


@settings(max_examples=8, deadline=None, derandomize=True, print_blob=True)
@given(
    grooves=st.lists(LARGE_GROOVES, min_size=1, max_size=2), suns=st.lists(SUNS, max_size=2), origin=ORIGINS,
    scale=st.sampled_from([[2, 2], [1, 3]]), shape=st.sampled_from(["rectangle", "rectangle", "sphere", "cylinder"]),
)  # fmt: skip
def test_meshes_of_odd_scenes(
    radiance: Radiance, plate: Plate, grooves: list[Json], suns: list[Json], origin: list[float], scale: list[float],
    shape: str,
) -> None:  # fmt: skip
    """`geometry` keeps to both as well; for the time without repeats, and on coarse spheres and cylinders."""
    scene = white(plate, placed(grooves), suns, camera=looking(origin), mapping={"scale": scale})
    scene["objects"][0] |= CURVED.get(shape, {})
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(body, "CELL", 0.1)
        assert bounded(rendered(radiance, scene, "geometry"), len(suns))


@settings(max_examples=20, deadline=None, derandomize=True, print_blob=True)
@given(
    grooves=st.lists(GROOVES, min_size=1, max_size=2), suns=st.lists(SUNS, max_size=2), origin=ORIGINS,
    scale=MAPPINGS, tile=TILES, shape=st.sampled_from(["rectangle", "sphere", "cylinder"]),
)  # fmt: skip
def test_textures_of_odd_scenes(
    radiance: Radiance, plate: Plate, grooves: list[Json], suns: list[Json], origin: list[float], scale: list[float],
    tile: list[float] | None, shape: str,
) -> None:  # fmt: skip
    """`relief` too."""
    scene = white(plate, placed(grooves), suns, tile, camera=looking(origin), mapping={"scale": scale})
    scene["objects"][0] |= CURVED.get(shape, {})
    assert bounded(rendered(radiance, scene, "relief"), len(suns))
