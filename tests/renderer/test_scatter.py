"""Directions drawn as materials answer: by the law of large numbers against the integral over the hemisphere."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

from renderer.kernel import kernel
from renderer.shading import dot, reflect, scatter
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
def drawn(material: np.void, n: Floats, e: Floats, grid: int) -> Floats:
    """Means of the weight, and of the weight times the squares of L's components: (4, 3)."""
    found = np.zeros((4, 3))
    normal, eye = (n[0], n[1], n[2]), (e[0], e[1], e[2])
    for i in range(grid):
        for j in range(grid):
            lobe = (0.5 + i * grid + j) * 0.6180339887498949 % 1.0
            l, weight = scatter(material, normal, eye, lobe, (i + 0.5) / grid, (j + 0.5) / grid)
            for c in range(3):
                found[0, c] += weight[c]
                for k in range(3):
                    found[1 + k, c] += weight[c] * l[k] * l[k]
    return found / (grid * grid)


@kernel
def integrated(material: np.void, n: Floats, e: Floats, grid: int) -> Floats:
    """The same, of BRDF times cosine over all directions."""
    found = np.zeros((4, 3))
    normal, eye = (n[0], n[1], n[2]), (e[0], e[1], e[2])
    for i in range(grid):
        z = -1.0 + 2.0 * (i + 0.5) / grid
        for j in range(2 * grid):
            turn = math.pi * (j + 0.5) / grid
            l = (math.sqrt(1.0 - z * z) * math.cos(turn), math.sqrt(1.0 - z * z) * math.sin(turn), z)
            if dot(normal, l) <= 0.0:
                continue
            value = reflect(material, normal, eye, l)
            for c in range(3):
                found[0, c] += value[c]
                for k in range(3):
                    found[1 + k, c] += value[c] * l[k] * l[k]
    return found * (2.0 * math.pi / (grid * grid))


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
    found = drawn(MATERIALS[name], normal, eye, GRID)
    expected = integrated(MATERIALS[name], normal, eye, 8 * GRID)
    assert found == pytest.approx(expected, abs=0.004)
    assert (found[0] <= 1.0).all()


def test_a_mirror_sends_all_one_way() -> None:
    chrome = material(metallic=1.0, base_color=(0.9, 0.8, 0.7))
    n, e = np.array([0.0, 0.0, 1.0]), np.array([0.6, 0.0, 0.8])
    found = drawn(chrome, n, e, 8)
    fresnel = np.array([0.9, 0.8, 0.7]) + (1.0 - np.array([0.9, 0.8, 0.7])) * (1.0 - 0.8) ** 5
    assert found[0] == pytest.approx(fresnel)
    assert found[1] == pytest.approx(0.36 * fresnel)
    assert found[3] == pytest.approx(0.64 * fresnel)


def test_nothing_from_below() -> None:
    """The eye behind the surface, or in its plane."""
    for e in ((0.6, 0.0, -0.8), (1.0, 0.0, 0.0)):
        assert not drawn(MATERIALS["plastic"], np.array([0.0, 0.0, 1.0]), np.array(e), 8).any()
