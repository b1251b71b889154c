"""The shadow of one object on another one's grooves falls where it does, not as on the bare surface."""

from __future__ import annotations

from collections.abc import Callable

import pytest

from renderer import footprint

from .scenes import RIDGE, Floats, Json, family, line, rms

Plate = Callable[..., Json]
Radiance = Callable[..., Floats]

DEEP = [[-0.15, 0.0], [0.0, -0.2], [0.15, 0.0]]
SUN = {"type": "directional", "direction": [1, 0.5, -1], "irradiance": [3, 3, 3]}
LAMP = {"type": "point", "position": [0.7, 0.6, 0.8], "intensity": [0.7, 0.7, 1]}
CAMERA = {"origin": [0.1, -1.6, 1.4], "target": [0, 0, 0], "fov": 30, "resolution": [48, 36]}
OTHERS = {
    "ball": {"shape": {"type": "sphere", "radius": 0.22}, "translate": [-0.2, 0.05, 0.4], "material": "stone"},
    "board": {"shape": {"type": "rectangle", "size": [0.5, 0.3]}, "translate": [-0.3, 0, 0.3], "material": "stone"},
    "mesh": {"shape": {"type": "mesh", "file": "board.obj"}, "translate": [-0.3, 0, 0.3], "material": "stone"},
}
BOARD = b"v -.3 -.15 0\nv .2 -.15 .1\nv .2 .15 .1\nv -.3 .15 0\nf 1 2 3\nf 1 3 4\n"


@pytest.mark.parametrize("method", ["auto", "area", "csg"])
@pytest.mark.parametrize("other", OTHERS)
@pytest.mark.parametrize("bounces", [0, 1])
def test_into_grooves_and_onto_ridges(
    method: str, other: str, bounces: int, plate: Plate, radiance: Radiance, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Four times as near to the truth, at least, as with the bare surface's shadow. What is left are single pixels, of
    which a shadow meets the middle heights alone, and noise."""
    scene = plate(
        [family(DEEP, 0.4, 6), line([-1, 0.7], [3, 1.1], profile=RIDGE)], lights=[SUN, LAMP], camera=CAMERA,
        render={"bounces": bounces},
    )  # fmt: skip
    scene["objects"].append(OTHERS[other])

    def shot(method: str) -> Floats:
        return radiance(scene, method=method, samples=256, meshes=lambda _: BOARD)

    truth, ours = shot("geometry"), shot(method)
    monkeypatch.setattr(footprint, "mark_torn", lambda *_: None)
    bare = shot(method)
    assert rms(ours - truth) < 0.25 * rms(bare - truth)
    if bounces == 0:  # light that has come by other facets is still that of the bare surface's shadow
        assert (abs(ours - truth).max(axis=2) > 0.1).mean() < 0.003
