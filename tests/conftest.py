"""A tiny scene, for the command line and the service."""

from __future__ import annotations

from typing import Any

import pytest


@pytest.fixture
def scene() -> dict[str, Any]:
    return {
        "intaglio": 1,
        "camera": {"origin": [0, -3, 2], "target": [0, 0, 0], "fov": 40, "resolution": [16, 12]},
        "lights": [{"type": "directional", "direction": [-1, 0, -1], "irradiance": [3, 3, 3]}],
        "materials": {"stone": {"base_color": [0.7, 0.7, 0.7], "roughness": 1, "specular": 0}},
        "patterns": {
            "tiles": {
                "grooves": [
                    {
                        "path": {"type": "polyline", "points": [[0.25, -1], [0.25, 5]]},
                        "profile": {"type": "v", "width": 0.16, "depth": 0.08},
                    }
                ]
            }
        },
        "objects": [{"shape": {"type": "rectangle", "size": [4, 4]}, "material": "stone", "pattern": "tiles"}],
    }
