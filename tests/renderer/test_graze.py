"""Light over one face to another on round shapes: straight from where to where the ray in space goes.

Two points of pattern space, one on either face, tell by the map of the ground truth the way that light takes between
them. `graze` knows that way, and has to find what it is in pattern space.
"""

from __future__ import annotations

import math

import numpy as np
import pytest
from numpy.typing import NDArray

from renderer import body
from renderer.geometry.faces import faces_of
from renderer.geometry.graze import graze
from renderer.tables import CYLINDER, SPHERE

from .parts import alone
from .test_curved import MOVED, frame_at, some_turn

Floats = NDArray[np.float64]
MAPPING = np.array([5.0, 3.0, -1.0, 0.25])


@pytest.mark.parametrize("near", [False, True], ids=["sun", "lamp"])
@pytest.mark.parametrize("shape", [SPHERE, CYLINDER])
def test_light_lands_where_the_ray_in_space_does(shape: int, near: bool) -> None:
    """What the way is wrong by is of second order in the size of grooves; without `graze`, of first."""
    size = np.array([0.7, 0.0]) if shape == SPHERE else np.array([0.7, 1.9])
    frame = frame_at(shape, size, MAPPING, 0.3, 0.62)
    base = body._NO_BASE._replace(shape=shape, size=size, mapping=MAPPING)
    faces, found = alone(faces_of)(), alone(graze)

    def tangent(point: Floats) -> Floats:
        """Where in the tangent frame a point of pattern space lies, by the map."""
        at = some_turn() @ body.carry(base, point[None, None], np.zeros(1, np.int32))[0, 0] + MOVED
        place: Floats = frame["dual"] @ (at - frame["origin"]) + [*frame["pq"], 0.0]
        return place

    rng = np.random.default_rng(6)
    for _ in range(40):
        azimuth, rise, tilt, turn = rng.uniform(0.0, 2.0 * math.pi), rng.uniform(0.3, 1.5), *rng.uniform(-0.4, 0.4, 2)
        normal = np.array([*rng.normal(size=2) * 0.3, 1.0])
        left = []
        for h in (0.02, 0.01):
            way = np.array([math.cos(azimuth), math.sin(azimuth), rise])
            low = np.array([*frame["pq"], 0.0]) + h * np.array([0.4 * tilt, 0.4, -0.8])
            over = low + h * way
            light = np.array([*(tangent(over) - tangent(low)), 0.0])
            if near:  # thirty times as far
                light = np.array([*(tangent(low) + 30.0 * light[:3]), 1.0])
            edge = np.array([-math.sin(azimuth + turn), math.cos(azimuth + turn), 0.0])
            down = np.array([0.0, 0.0, 3.0 * h])
            faces.corner[1, :4] = [over + h * edge, over - h * edge, over - h * edge - down, over + h * edge - down]
            faces.corners[1] = 4
            faces.plane[0] = [*normal, -normal @ low]
            out = np.empty(4)
            found(frame, light, low, 0, 1, faces, out)

            def off(source: Floats, way: Floats = way, over: Floats = over) -> float:
                to = source[:3] - source[3] * over
                return float(np.linalg.norm(np.cross(to / np.linalg.norm(to), way / np.linalg.norm(way))))

            left.append(off(out))
            assert left[-1] < 0.1 * off(light) + 3.0 * h * h
        assert near or left[1] < 0.35 * left[0] + 1e-5
