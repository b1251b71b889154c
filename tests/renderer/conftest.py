"""Small scenes, and the kernels compiled once before the first of them is rendered."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

import schema
from renderer import pipeline

Json = dict[str, Any]
Floats = NDArray[np.float64]


def checked(data: Json) -> schema.Scene:
    """The scene, which must be valid."""
    report = schema.check(data)
    assert report.scene is not None, report
    return report.scene


def plate_scene(grooves: list[Json], tile: list[float] | None = None, **parts: Any) -> Json:
    """A matt plate of 2 x 2 world units, seen from an edge, with grooves in pattern units: p, q = x + 1, y + 1.

    `parts` replaces entries of the scene; `mapping`, `size` and `camera` those of the plate and the camera.
    """
    camera = {"origin": [0.1, -1.9, 1.7], "target": [0, 0.02, 0], "fov": 38, "resolution": [48, 36]}
    size = parts.pop("size", [2, 2])
    plate = {
        "shape": {"type": "rectangle", "size": size},
        "mapping": parts.pop("mapping", {"scale": size}),
        "material": "stone",
        "pattern": "cut" if grooves else None,
    }
    return {
        "intaglio": 1,
        "camera": camera | parts.pop("camera", {}),
        "lights": [
            {"type": "directional", "direction": [1, 0.45, -0.9], "irradiance": [2.0, 1.8, 1.6]},
            {"type": "point", "position": [-0.7, 0.4, 0.9], "intensity": [0.5, 0.6, 0.8]},
        ],
        "materials": {"stone": {"base_color": [0.7, 0.65, 0.6], "specular": 0}},
        "patterns": {"cut": {"tile": tile, "grooves": grooves}} if grooves else {},
        "objects": [plate],
    } | parts


@pytest.fixture(scope="session")
def plate() -> Callable[..., Json]:
    return plate_scene


@pytest.fixture(scope="session")
def check() -> Callable[[Json], schema.Scene]:
    return checked


@pytest.fixture(scope="session")
def picture() -> Callable[..., pipeline.Picture]:
    """Render scene data: `pipeline.render` with its options."""
    pipeline.warm_up()

    def render(data: Json, *, seed: int = 0, **options: Any) -> pipeline.Picture:
        scene = checked(data | {"render": {"seed": seed} | data.get("render", {})})
        return pipeline.render(scene, **({"threads": 2} | options))

    return render


@pytest.fixture(scope="session")
def radiance(picture: Callable[..., pipeline.Picture]) -> Callable[..., Floats]:
    """Render scene data: the radiance (H, W, 3) alone, in double precision."""

    def render(data: Json, **options: Any) -> Floats:
        return picture(data, **options).radiance.astype(np.float64)

    return render
