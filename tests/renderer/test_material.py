"""How a material answers to light: reciprocal, never more than it gets, and under a sky as under the sum of lights."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numba
import numpy as np
import pytest
from numpy.typing import NDArray

from renderer import pipeline, shading
from renderer.tables import MATERIAL

from .scenes import SKY, Floats, Json

Plate = Callable[..., Json]
SUN = {"type": "directional", "direction": [0, 0, -1], "irradiance": [1, 1, 1]}  # straight above, as one eye is


def material(**more: Any) -> NDArray[np.void]:
    row = np.zeros(1, MATERIAL)
    row["base_color"], row["alpha"], row["f0"], row["f90"] = (0.8, 0.5, 0.2), 0.25, 0.04, 1.0
    for name, value in more.items():
        row[name] = value
    return row


@numba.njit(error_model="numpy")  # type: ignore[untyped-decorator]
def answers(materials: NDArray[np.void], to_eye: Floats, to_light: Floats) -> Floats:
    """`reflect` at a normal of +z for pairs (n, 3) of directions, as it is: cosine included."""
    out = np.empty((len(to_eye), 3))
    for i in range(len(to_eye)):
        e, l = to_eye[i], to_light[i]
        out[i, 0], out[i, 1], out[i, 2] = shading.reflect(
            materials[0], (0.0, 0.0, 1.0), (e[0], e[1], e[2]), (l[0], l[1], l[2])
        )
    return out


def hemisphere(count: int) -> tuple[Floats, float]:
    """Directions (n, 3) at the middles of cells of equal solid angle, and that angle."""
    z, turn = np.meshgrid((np.arange(count) + 0.5) / count, (np.arange(count) + 0.5) * 2.0 * math.pi / count)
    side = np.sqrt(1.0 - z**2)
    return np.stack([side * np.cos(turn), side * np.sin(turn), z], axis=2).reshape(-1, 3), 2.0 * math.pi / count**2


def eyes(cosine: float, count: int) -> Floats:
    return np.tile([math.sqrt(1.0 - cosine**2), 0.0, cosine], (count, 1))


MIXES = [
    material(),
    material(metallic=1.0),
    material(metallic=0.4, alpha=0.09),
    material(alpha=1.0),
    material(f90=0.0, f0=0.0),
]


@pytest.mark.parametrize("row", MIXES, ids=lambda row: f"{row['metallic'][0]}-{row['alpha'][0]}")
def test_reciprocity(row: NDArray[np.void]) -> None:
    """Without the cosine to the light the BRDF is the same both ways."""
    rng = np.random.default_rng(3)
    a, b = (rng.normal(size=(200, 3)) for _ in range(2))
    for v in (a, b):
        v[:, 2] = np.abs(v[:, 2]) + 1e-3
        v /= np.linalg.norm(v, axis=1, keepdims=True)
    there, back = answers(row, a, b) / b[:, 2:], answers(row, b, a) / a[:, 2:]
    assert np.allclose(there, back, rtol=1e-9)


@pytest.mark.parametrize("cosine", [0.1, 0.3, 0.7, 1.0])
def test_no_material_gives_more_light_than_it_gets(cosine: float) -> None:
    """The share of a white sky sent to E, by summing over the lights' directions: at most 1 for a metal and for a coat
    alone. (A white body under a coat is glTF's mix by Schlick's term, which may exceed 1 where E grazes.)

    A Lambert surface's is its colour. At alpha 1 the distribution of GGX is even, 1 / pi, and Smith's term
    1 / (2 (NL + NE)): the integral over z = NL from 0 to 1 of z / (z + NE) is 1 - NE log((1 + NE) / NE). Sums of
    midpoints: exact to 1e-5.
    """
    directions, angle = hemisphere(400)
    eye = eyes(cosine, len(directions))
    for alpha in (0.09, 0.25, 1.0):
        for row in (material(metallic=1.0, alpha=alpha, base_color=1.0), material(alpha=alpha, base_color=0.0, f0=1.0)):
            total = answers(row, eye, directions).sum(axis=0) * angle
            assert (total < 1.0 + 1e-3).all()
    even = 1.0 - cosine * math.log((1.0 + cosine) / cosine)
    assert np.allclose(total, even, atol=1e-5)
    lambert = answers(MIXES[-1], eye, directions).sum(axis=0) * angle
    assert np.allclose(lambert, MIXES[-1]["base_color"][0], atol=1e-5)


@pytest.mark.parametrize("samples", [48, 192])
def test_gloss_albedo(samples: int) -> None:
    """The table against the sum over the whole hemisphere of lights of a metal with base colour 1 (Fresnel 1: the first
    number) and 0 (Schlick's (1 - E.H)^5 alone: the second); and the sums of the first one's directions.

    Where E grazes, half the lobe lies below the plane: the midpoints know the place of that edge to one of `samples`.
    """
    table = shading.gloss_albedo(16, samples)
    directions, angle = hemisphere(600)
    for i in (1, 4, 9, 15):
        for j in (7, 11, 15):  # roughness 0.47 and more: sharper lobes fall between the directions
            e = eyes(i / 15, len(directions))
            row = material(metallic=1.0, alpha=(j / 15) ** 2, base_color=(1.0, 0.0, 0.0))
            each = answers(row, e, directions) * angle
            assert table[i, j, :2] == pytest.approx(each.sum(axis=0)[:2], abs=1.0 / samples)
            across, along = each[:, 0] @ directions[:, 0], each[:, 0] @ directions[:, 2]
            side = np.sqrt(1.0 - (i / 15) ** 2)
            assert table[i, j, 2] * side == pytest.approx(across, abs=1.0 / samples)
            assert table[i, j, 3] == pytest.approx(along, abs=1.0 / samples)


def test_the_sky_is_the_sum_of_all_lights(plate: Plate, picture: Callable[..., pipeline.Picture]) -> None:
    """The closed form for a constant sky against the sum over directional lights all around.

    The dielectric's body takes what the coat leaves on average, an approximation: within 0.02.
    """
    stone = {"base_color": [0.8, 0.5, 0.2], "roughness": 0.6, "metallic": 0.3}
    camera = {"origin": [0, -0.6, 0.8], "target": [0, 0, 0], "fov": 1, "resolution": [1, 1]}
    seen = picture(plate([], materials={"stone": stone}, lights=[SKY], camera=camera)).radiance[0, 0]
    directions, angle = hemisphere(300)
    row = material(base_color=(0.8, 0.5, 0.2), alpha=0.36, metallic=0.3, f0=0.04, f90=1.0)
    total = answers(row, eyes(0.8, len(directions)), directions).sum(axis=0) * angle
    assert seen == pytest.approx(total, abs=0.02)


@pytest.mark.parametrize("kind", [{"metallic": 1}, {"transmission": 1}, {}], ids=["metal", "glass", "coat"])
@pytest.mark.parametrize("roughness", [1e-300, 1e-12, 1e-5])
def test_roughness_next_to_nought(kind: Json, roughness: float, plate: Plate, radiance: Callable[..., Floats]) -> None:
    """It counts as a thousandth, and highlights of a millionth of a radian, which pixels hardly meet, break nothing."""
    groove = {"path": {"type": "polyline", "points": [[0.5, -1], [0.9, 3]]},
              "profile": {"type": "v", "width": 0.3, "depth": 0.1}}  # fmt: skip
    pictures = [
        radiance(
            plate([groove], materials={"stone": kind | {"roughness": value}}, render={"bounces": 2}, lights=[SKY, SUN],
                  camera={"origin": [0, 0, 2], "resolution": [17, 13]}),
            method="auto", samples=16,
        )
        for value in (roughness, 0.001)
    ]  # fmt: skip
    assert np.isfinite(pictures[0]).all()
    np.testing.assert_array_equal(pictures[0], pictures[1])
