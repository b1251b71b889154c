"""Whatever stands in a valid scene: numbers come out, and none below 0."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from renderer.errors import RenderError

from .scenes import GROOVES, LIGHTS, ORIGINS, WHITE, Floats, Json

Plate = Callable[..., Json]
Radiance = Callable[..., Floats]

MATERIALS = st.sampled_from(
    [WHITE, {"roughness": 0}, {"metallic": 1, "roughness": 0.1}, {"transmission": 1, "roughness": 0}, {}]
)
MAPPINGS = st.sampled_from([[2, 2], [2, 2], [2000, 0.01], [1e5, 1e5], [0.01, 0.01], [2, 3]])
TILES = st.sampled_from([None, None, [0.7, 0.9]])
CURVED = {
    "sphere": {"shape": {"type": "sphere", "radius": 1}, "translate": [0, 0, -1]},
    "cylinder": {
        "shape": {"type": "cylinder", "radius": 1, "height": 1}, "translate": [0, 0, -1], "rotate": [90, 0, 0],
    },
}  # fmt: skip


def rendered(radiance: Radiance, scene: Json, method: str) -> Floats:
    """The picture; black where grooves that are too many, at one place or for a mesh, are refused."""
    try:
        return radiance(scene, method=method, samples=4)
    except RenderError as error:
        pointers = [fault.pointer for fault in error.faults]
    assert pointers == ["/patterns/cut/tile"] or (pointers == ["/objects/0/pattern"] and method == "geometry")
    return np.zeros((1, 1, 3))


def placed(grooves: list[Json], tile: list[float] | None) -> list[Json]:
    """Without their repeats where a tile repeats them: a hundred overlapping grooves are slow, and no news."""
    return grooves if tile is None else [{k: v for k, v in groove.items() if k != "repeat"} for groove in grooves]


def looking(origin: list[float]) -> Json:
    return {"origin": origin, "target": [0.01, 0.02, 0], "up": [0, 1, 0.01], "resolution": [4, 3]}


@settings(max_examples=100, deadline=None, derandomize=True, print_blob=True)
@given(
    grooves=st.lists(GROOVES, min_size=1, max_size=3), twice=st.booleans(), lights=st.lists(LIGHTS, max_size=2),
    origin=ORIGINS, material=MATERIALS, other=MATERIALS, scale=MAPPINGS, tile=TILES,
    shape=st.sampled_from(["rectangle", "sphere", "cylinder"]),
    method=st.sampled_from(["auto", "line", "segment", "csg", "base"]),
)  # fmt: skip
def test_odd_scenes_are_pictures(
    radiance: Radiance, plate: Plate, grooves: list[Json], twice: bool, lights: list[Json], origin: list[float],
    material: Json, other: Json, scale: list[float], tile: list[float] | None, shape: str, method: str,
) -> None:  # fmt: skip
    scene = plate(
        placed(grooves * (2 if twice else 1), tile), tile, lights=lights, materials={"stone": material, "other": other},
        mapping={"scale": scale}, camera=looking(origin),
    )  # fmt: skip
    scene["objects"][0] |= CURVED.get(shape, {})
    values = rendered(radiance, scene, method)
    assert np.isfinite(values).all()
    assert (values >= 0.0).all()
