"""Directions drawn as materials answer: by the law of large numbers against the integral over the hemisphere."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

from renderer.kernel import kernel
from renderer.scattering import scatter
from renderer.shading import between, dot, gloss_albedo, reflect, unit
from renderer.tables import MATERIAL, Floats

GRID = 128  # draws each way, and steps of the quadrature over GRID * 4 by GRID * 4


def material(**fields: float | tuple[float, float, float]) -> np.void:
    made: Any = np.zeros(1, MATERIAL)
    made["base_color"] = (0.8, 0.5, 0.3)
    for name, value in fields.items():
        made[name] = value
    row: np.void = made[0]
    return row


@kernel
def drawn(material: Any, albedo: Floats, n: Floats, e: Floats, grid: int) -> Floats:
    """Means of the weight, and of the weight times the squares of L's components: (4, 3)."""
    found = np.zeros((4, 3))
    normal, eye = (n[0], n[1], n[2]), (e[0], e[1], e[2])
    for i in range(grid):
        for j in range(grid):
            lobe = (0.5 + i * grid + j) * 0.6180339887498949 % 1.0
            l, weight = scatter(material, albedo, normal, eye, lobe, (i + 0.5) / grid, (j + 0.5) / grid, False)
            for c in range(3):
                found[0, c] += weight[c]
                for k in range(3):
                    found[1 + k, c] += weight[c] * l[k] * l[k]
    return found / (grid * grid)


@kernel
def integrated(material: Any, albedo: Floats, n: Floats, e: Floats, grid: int) -> Floats:
    """The same, of BRDF times cosine over all directions; the coat takes its mean from the body's light."""
    found = np.zeros((4, 3))
    normal, eye = (n[0], n[1], n[2]), (e[0], e[1], e[2])
    f0, more = material.f0, material.f90 - material.f0
    ne, roughness = dot(normal, eye), math.sqrt(material.alpha)
    taken = f0 * between(albedo, ne, roughness, 0) + more * between(albedo, ne, roughness, 1)
    for i in range(grid):
        z = -1.0 + 2.0 * (i + 0.5) / grid
        for j in range(2 * grid):
            turn = math.pi * (j + 0.5) / grid
            l = (math.sqrt(1.0 - z * z) * math.cos(turn), math.sqrt(1.0 - z * z) * math.sin(turn), z)
            if dot(normal, l) <= 0.0:
                continue
            value = reflect(material, normal, eye, l)
            h = unit((l[0] + eye[0], l[1] + eye[1], l[2] + eye[2]))
            body = (1.0 - material.metallic) * (f0 + more * (1.0 - dot(eye, h)) ** 5 - taken) * dot(normal, l) / math.pi
            for c in range(3):
                total = value[c] + body * material.base_color[c]
                found[0, c] += total
                for k in range(3):
                    found[1 + k, c] += total * l[k] * l[k]
    return found * (2.0 * math.pi / (grid * grid))


ALBEDO = gloss_albedo(16, 128)
MATERIALS = {
    "matt": material(alpha=1.0),
    "plastic": material(alpha=0.16, f0=0.04, f90=1.0),
    "satin": material(alpha=0.64, f0=0.04, f90=1.0, metallic=0.3),
    "brass": material(alpha=0.3, metallic=1.0, f0=0.04, f90=1.0),
}


@pytest.mark.parametrize("name", MATERIALS)
@pytest.mark.parametrize("elevation", [90.0, 40.0, 8.0])
@pytest.mark.parametrize("n", [(0.0, 0.0, 1.0), (0.6, -0.48, 0.64), (0.0, 0.6, -0.8)])
def test_the_mean_is_the_integral(name: str, elevation: float, n: tuple[float, float, float]) -> None:
    """Of the weight, which is the albedo, and of the weight where L points: a wrong density shows in one of them."""
    normal = np.array(n)
    across = np.cross(normal, (0.3, 0.8, 0.1))
    across /= np.linalg.norm(across)
    eye = math.sin(math.radians(elevation)) * normal + math.cos(math.radians(elevation)) * across
    found = drawn(MATERIALS[name], ALBEDO, normal, eye, GRID)
    expected = integrated(MATERIALS[name], ALBEDO, normal, eye, 8 * GRID)
    assert found == pytest.approx(expected, abs=0.004)
    assert (found[0] <= 1.0).all()


@pytest.mark.parametrize("alpha", [0.0, 0.04, 0.3, 1.0])
def test_a_coat_on_white_gives_back_what_it_gets(alpha: float) -> None:
    white = material(alpha=alpha, f0=0.04, f90=1.0, base_color=(1.0, 1.0, 1.0))
    for elevation in (90.0, 30.0, 10.0):
        e = np.array([math.cos(math.radians(elevation)), 0.0, math.sin(math.radians(elevation))])
        assert drawn(white, ALBEDO, np.array([0.0, 0.0, 1.0]), e, GRID)[0] == pytest.approx(1.0, abs=0.01)


def test_a_mirror_sends_all_one_way() -> None:
    chrome = material(metallic=1.0, base_color=(0.9, 0.8, 0.7))
    n, e = np.array([0.0, 0.0, 1.0]), np.array([0.6, 0.0, 0.8])
    found = drawn(chrome, ALBEDO, n, e, 8)
    fresnel = np.array([0.9, 0.8, 0.7]) + (1.0 - np.array([0.9, 0.8, 0.7])) * (1.0 - 0.8) ** 5
    assert found[0] == pytest.approx(fresnel)
    assert found[1] == pytest.approx(0.36 * fresnel)
    assert found[3] == pytest.approx(0.64 * fresnel)


def test_nothing_from_below() -> None:
    """The eye behind the surface, or in its plane."""
    for e in ((0.6, 0.0, -0.8), (1.0, 0.0, 0.0)):
        assert not drawn(MATERIALS["plastic"], ALBEDO, np.array([0.0, 0.0, 1.0]), np.array(e), 8).any()
