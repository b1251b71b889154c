"""What the renderer only approximates."""

from typing import Any

import pytest

from schema import check

G = "/patterns/tiles/grooves/0"


def warnings(scene: dict[str, Any]) -> list[str]:
    report = check(scene)
    assert report.problems == []
    assert all(warning.severity == "warning" for warning in report.warnings)
    return [warning.pointer for warning in report.warnings]


# The groove is 0.16 wide: its half is 0.08.
TIGHT: list[tuple[dict[str, Any], list[str]]] = [
    ({"type": "circle", "center": [0, 0], "radius": 0.079}, [f"{G}/path/radius"]),
    ({"type": "circle", "center": [0, 0], "radius": 0.081}, []),
    # From r = 0 the radius of curvature is half the growth a radian: 2 / (2 pi 2) / 2 = 0.0796, and twice that.
    ({"type": "spiral", "center": [0, 0], "inner_radius": 0, "outer_radius": 2, "turns": 2},
     [f"{G}/path/inner_radius"]),
    ({"type": "spiral", "center": [0, 0], "inner_radius": 0, "outer_radius": 2, "turns": 1}, []),
    # An ellipse's least radius of curvature is b^2 / a: 0.04 and 0.25.
    ({"type": "svg", "d": "M-1 0 A 1 .2 0 0 1 1 0"}, [f"{G}/path/d"]),
    ({"type": "svg", "d": "M-1 0 A 1 .5 0 0 1 1 0"}, []),
    # A parabola with its control point at height h: at the vertex |v|^3 / |v x a| = 2^3 / (2 * 4h) = 1 / h.
    ({"type": "svg", "d": "M-1 0 Q 0 13 1 0"}, [f"{G}/path/d"]),
    ({"type": "svg", "d": "M-1 0 Q 0 12 1 0"}, []),
    # A turn by 180 - atan(0.1 / 1) = 174.3 degrees, and by 180 - atan(0.3) = 163.3.
    ({"type": "polyline", "points": [[0, 0], [1, 0], [0, 0.1]]}, [f"{G}/path/points/1"]),
    ({"type": "polyline", "points": [[0, 0], [1, 0], [0, 0.3]]}, []),
]  # fmt: skip


@pytest.mark.parametrize(("path", "expected"), TIGHT)
def test_bent_tighter_than_wide(
    scene: dict[str, Any], groove: dict[str, Any], path: dict[str, Any], expected: list[str]
) -> None:
    groove["path"] = path
    assert warnings(scene) == expected


def test_scale_widens_the_groove(scene: dict[str, Any], groove: dict[str, Any]) -> None:
    groove["path"] = {"type": "circle", "center": [0, 0], "radius": 0.1}
    assert warnings(scene) == []
    groove["scale"] = {"type": "sine", "amplitude": 0.5, "periods": 1}
    assert warnings(scene) == [f"{G}/path/radius"]


def test_closed_path_has_corners_at_its_ends(scene: dict[str, Any], groove: dict[str, Any]) -> None:
    groove["path"] = {"type": "polyline", "points": [[0, 0], [1, 0.05], [1, -0.05]], "closed": True}
    assert warnings(scene) == [f"{G}/path/points/0"]


def test_envmap_is_rendered(scene: dict[str, Any]) -> None:
    scene["lights"] = [{"type": "envmap", "file": "sky.exr"}]
    assert warnings(scene) == []


def test_refraction_wants_bounces(scene: dict[str, Any]) -> None:
    scene["objects"][0]["material"] = "glass"
    scene["materials"]["glass"]["roughness"] = 0.5
    assert warnings(scene) == ["/materials/glass/transmission"]
    scene["render"]["bounces"] = 2
    assert warnings(scene) == []


def test_mirrors_and_glass_want_bounces(scene: dict[str, Any]) -> None:
    assert warnings(scene) == []  # no object is of glass
    scene["objects"][0]["material"] = "glass"
    assert warnings(scene) == ["/materials/glass/transmission", "/materials/glass/roughness"]
