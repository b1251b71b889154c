"""A pixel depends on its place alone: the same bytes for any number of threads and any size of tile."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import pytest

from renderer import pipeline

Json = dict[str, Any]
SIZE = (75, 50)
GROOVES: list[Json] = [
    {
        "path": {"type": "polyline", "points": [[0.2, -1], [0.3, 3]]},
        "profile": {"type": "v", "width": 0.2, "depth": 0.1},
        "repeat": {"type": "linear", "count": 6, "step": [0.35, 0]},
    },
    {
        "path": {"type": "circle", "center": [1, 1], "radius": 0.6},
        "profile": {"type": "v", "width": 0.1, "depth": -0.1},
    },
]


@pytest.mark.parametrize("method", pipeline.METHODS)
def test_same_bytes(method: str, plate: Callable[..., Json], picture: Callable[..., pipeline.Picture]) -> None:
    scene = plate(GROOVES, [1.9, 1.8], render={"tolerance": 0.05})  # few samples tell as much as many
    if method != "geometry":
        ball = {
            "shape": {"type": "sphere", "radius": 0.4},
            "translate": [0.3, 0.2, 0.4],
            "material": "stone",
            "pattern": "cut",
        }
        scene["objects"].append(ball)

    def bytes_of(**options: int) -> tuple[bytes, bytes]:
        made = picture(scene, method=method, samples=16, resolution=SIZE, **options)
        assert made.radiance.shape == (SIZE[1], SIZE[0], 3)
        return made.radiance.tobytes(), made.aovs["method"].tobytes()

    first = bytes_of(threads=1, tile=64)
    for threads, tile in ((2, 16), (3, 37)):
        assert bytes_of(threads=threads, tile=tile) == first


def test_seed(plate: Callable[..., Json], picture: Callable[..., pipeline.Picture]) -> None:
    """Another seed draws other samples."""
    scene = plate(GROOVES)
    a, b, c = (picture(scene, method="csg", samples=4, seed=seed).radiance for seed in (0, 0, 1))
    assert (a == b).all()
    assert (a != c).any()
