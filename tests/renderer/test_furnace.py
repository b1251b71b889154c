"""Light is neither made nor lost: white under a white sky is white, the shares of a footprint sum to one, and lights
add."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from .scenes import (
    BOX,
    DITCH,
    MIXED,
    OUTLINES,
    PALETTE,
    SINGLE,
    SKEW,
    SKY,
    WHITE,
    Floats,
    Json,
    family,
    line,
)

Plate = Callable[..., Json]
Radiance = Callable[..., Floats]

BLACK = {"base_color": [0, 0, 0], "specular": 0}
LAMPS = {
    "stone": BLACK | {"emissive": [1, 0, 0]},
    "brick": BLACK | {"emissive": [0, 1, 0]},
    "moss": BLACK | {"emissive": [0, 0, 1]},
}
"""Each part of a footprint shines in a colour of its own: its share is what the pixel shows of it."""


@pytest.mark.parametrize("method", ["base", "segment", "line", "lines", "area", "csg", "auto", "geometry", "relief"])
def test_furnace(method: str, plate: Plate, radiance: Radiance) -> None:
    """White facets reflect all of a white sky, and no sky is taken away yet: every pixel is exactly 1.

    With `segment` too: its parts sum to one by construction, as do the shares of `line`. And with `relief`, whose rays
    always end in the texture or where it goes on.
    """
    grooves = [family()] if method in ("line", "segment") else [family(), line([-1, 0.9], [3, 1.2])]
    scene = plate(grooves, materials={"stone": WHITE}, lights=[SKY])
    assert np.abs(radiance(scene, method=method, samples=9, texels=128) - 1.0).max() < SINGLE


def test_emission_adds(plate: Plate, radiance: Radiance) -> None:
    materials = {"stone": WHITE | {"emissive": [0.5, 0.25, 0]}, "lamp": WHITE | {"emissive": [2, 0, 0]}}
    dark = plate([family()], materials=materials, lights=[])
    lit = plate([family()], materials=materials, lights=[SKY])
    for method in ("line", "csg"):
        inside = radiance(lit, method=method, samples=9)[20:30, 10:38]
        assert np.abs(inside - [1.5, 1.25, 1.0]).max() < SINGLE
        assert np.abs(radiance(dark, method=method, samples=9)[20:30, 10:38] - [0.5, 0.25, 0]).max() < SINGLE
    glowing = radiance(plate([family(material="lamp")], materials=materials, lights=[]), method="line")
    assert glowing[..., 0].max() > 1.5


@pytest.mark.parametrize("method", ["line", "lines", "area", "csg", "auto", "segment"])
def test_grooves_of_no_depth_are_the_bare_plate(method: str, plate: Plate, radiance: Radiance) -> None:
    flat = [[b, w * 1e-9] for b, w in SKEW]
    sun = {"type": "directional", "direction": [1, 0.45, -0.9], "irradiance": [3, 3, 3]}
    scene = plate([family(flat)], lights=[sun])
    assert np.abs(radiance(scene, method=method, samples=16) - radiance(scene, method="base")).max() < SINGLE


def shares(radiance: Radiance, scene: Json, method: str, samples: int = 9, *, cut: bool = False) -> Floats:
    """The shares (H, W, 3) of the stone, brick and moss facets, which must sum to what the bare plate covers.

    cut: but at its outline, which grooves cut and ridges stand over.
    """
    found = radiance(scene | {"lights": [], "materials": LAMPS}, method=method, samples=samples)
    cover = radiance(scene | {"lights": [], "materials": LAMPS}, method="base")[..., 0]
    assert (found >= 0.0).all()
    off = np.abs(found.sum(axis=2) - cover)
    if method == "geometry":  # whose rays find the plate's rim by themselves
        assert (found.sum(axis=2) < 1.0 + SINGLE).all()
        off = off[cover == 1.0]
    if cut:
        assert (found.sum(axis=2) < 1.0 + SINGLE).all()
        inner = np.lib.stride_tricks.sliding_window_view(cover, (5, 5)).min(axis=(2, 3)) == 1.0
        off = off[2:-2, 2:-2][inner]
        assert off.size > 100
    assert off.max() < SINGLE
    return found


@pytest.mark.parametrize("method", ["lines", "area", "csg", "auto", "geometry"])
@pytest.mark.parametrize("origin", [[0.1, -1.9, 1.7], [0, -1.4, 0.2]])
def test_shares_sum_to_one(method: str, origin: list[float], plate: Plate, radiance: Radiance) -> None:
    found = shares(radiance, plate(MIXED, camera={"origin": origin}, materials=PALETTE), method)
    assert (found.max(axis=(0, 1)) > 0.5).all()


@pytest.mark.parametrize("method", ["lines", "area", "csg", "auto"])
@pytest.mark.parametrize(
    "shape", [{"type": "sphere", "radius": 1}, {"type": "cylinder", "radius": 0.8, "height": 1.5}], ids=["ball", "can"]
)
def test_shares_sum_to_one_on_curved_objects(method: str, shape: Json, plate: Plate, radiance: Radiance) -> None:
    scene = plate(MIXED, materials=PALETTE, mapping={"scale": [6, 3], "offset": [-3.5, -0.5]})
    scene["objects"][0] |= {"shape": shape, "rotate": [-40, 0, 0]}
    found = shares(radiance, scene, method, cut=True)
    assert (found.max(axis=(0, 1)) > 0.4).all()


@settings(max_examples=150, deadline=None, derandomize=True, print_blob=True)
@given(
    outline=OUTLINES, other=OUTLINES, step=st.floats(0.01, 0.6), angle=st.floats(-1, 1),
    reach=st.sampled_from([0.03, 0.3, 2.0, 30.0]), low=st.sampled_from([0.05, 0.4, 1.5]),
    method=st.sampled_from(["line", "lines", "area", "segment", "auto"]),
)  # fmt: skip
def test_shares_of_parallel_grooves(
    plate: Plate, radiance: Radiance, outline: list[list[float]], other: list[list[float]], step: float, angle: float,
    reach: float, low: float, method: str,
) -> None:  # fmt: skip
    """Any two families of any profiles, apart, touching or overlapping, from any distance."""
    tilt = [[1.0 - 4 * angle, -3.0], [1.0 + 4 * angle, 5.0]]
    grooves = [
        line(*tilt, profile=profile, material=name, repeat={"type": "linear", "count": 9, "step": [move, 0]})
        for profile, name, move in ((outline, "brick", step), (other, "moss", -step))
    ]
    camera = {"origin": [0.1, -reach, low * reach], "fov": 38 / (1 + reach), "resolution": [12, 9]}
    shares(radiance, plate(grooves, camera=camera, materials=PALETTE), method)


@pytest.mark.parametrize("method", ["segment", "line", "csg", "geometry"])
@pytest.mark.parametrize("profile", [SKEW, BOX, DITCH], ids=["skew", "box", "ditch"])
def test_lights_add(method: str, profile: list[list[float]], plate: Plate, radiance: Radiance) -> None:
    """The picture under many lights is the sum of the pictures under each, and grows with their power.

    Samples are the same for one seed, so sampled methods add up as exactly as the others. What varies within a piece is
    taken at its middle, and which pieces a plane falls into hangs on the other lights: with the analytic methods, a
    point light's pictures add up but for that, and are left out.
    """
    lights: list[Json] = [
        {"type": "directional", "direction": [1, 0.45, -0.9], "irradiance": [2.0, 1.8, 1.6]},
        {"type": "directional", "direction": [-1, 0.2, -0.2], "irradiance": [0.5, 0.8, 1.0]},
        {"type": "point", "position": [-0.7, 0.4, 0.9], "intensity": [0.5, 0.6, 0.8]},
        {"type": "constant", "radiance": [0.2, 0.1, 0.3]},
    ]
    grooves = [family(profile), *MIXED[1:]]
    if method in ("segment", "line"):
        grooves, lights = grooves[:1], [light for light in lights if light["type"] != "point"]

    def under(*some: Json) -> Floats:
        return radiance(plate(grooves, lights=list(some), materials=PALETTE), method=method, samples=9)

    together = under(*lights)
    assert np.abs(sum(under(light) for light in lights) - together).max() < 4 * SINGLE
    strong = [light | {k: [4 * c for c in v] for k, v in light.items() if k not in ("type", "direction", "position")}
              for light in lights]  # fmt: skip
    assert np.abs(under(*strong) - 4 * together).max() < 4 * SINGLE
