"""The text of problems is contract: pointer, expected, found."""

from typing import Any

import pytest

from schema import MAX_BYTES, check, check_text, json_schema
from schema.errors import Problem, pointer

G = "/patterns/tiles/grooves/0"
LONG = "x" * 200
VALID_NAMES = '("brass", "glass", "stone")'

CASES: list[tuple[str, Any, str]] = [
    ("/intaglio", True, "/intaglio: expected 1, found true"),
    ("/intaglio", 2, "/intaglio: expected 1, found 2"),
    ("/camera/fov", "wide", '/camera/fov: expected a number between 0.1 and 179, found "wide"'),
    ("/camera/fov", True, "/camera/fov: expected a number between 0.1 and 179, found true"),
    ("/camera/fov", float("nan"), "/camera/fov: expected a number between 0.1 and 179, found NaN"),
    ("/camera/fov", float("inf"), "/camera/fov: expected a number between 0.1 and 179, found Infinity"),
    ("/camera/fov", 10**400, "/camera/fov: expected a number between 0.1 and 179, found a whole number of 1329 bits"),
    ("/camera/fob", 3, '/camera/fob: expected one of the keys "origin", "target", "up", "fov", "resolution", '
     'found the unknown key "fob"'),
    ("/camera/up", [0, 3, -2], "/camera/up: expected a direction across the view, "
     "found one along the view from origin to target"),
    ("/camera/target", [0, -3, 2], "/camera/target: expected a target apart from the origin, found the origin"),
    ("/camera/resolution", [8192, 8192], "/camera/resolution: expected at most 33554432 pixels in all, found 67108864"),
    ("/camera/resolution", [640.5, 480], "/camera/resolution/0: expected a whole number between 1 and 8192, "
     "found 640.5"),
    ("/camera/origin", [1], "/camera/origin: expected an array of 3, each a number between -1000000 and 1000000, "
     "found [1]"),
    ("/lights/0/type", "spot", '/lights/0/type: expected one of "constant", "directional", "envmap", "point", '
     'found "spot"'),
    ("/lights/0/direction", [0, 0, 0], "/lights/0/direction: expected a direction, found a vector of no length"),
    ("/lights/1/intensity/2", -1, "/lights/1/intensity/2: expected a number between 0 and 1000000, found -1"),
    ("/materials/stone/ior", 1, "/materials/stone/ior: expected a number above 1 and up to 4, found 1"),
    ("/objects", [], "/objects: expected an array of 1 to 1000, each an object, found []"),
    ("/objects/0/material", "gold",
     f'/objects/0/material: expected the name of a material {VALID_NAMES}, found "gold"'),
    ("/objects/0/pattern", "nope", '/objects/0/pattern: expected the name of a pattern ("tiles"), found "nope"'),
    ("/render/method", LONG, '/render/method: expected one of "auto", "base", "segment", "line", "lines", "area", '
     '"csg", "geometry", "relief", found "' + "x" * 78 + "…"),
    (G + "/material", "gold", f'{G}/material: expected the name of a material {VALID_NAMES}, found "gold"'),
    (G + "/material", ["stone"], f"{G}/material: expected 2 materials, one a facet, found 1"),
    (G + "/path/points", [[0, 0]], f"{G}/path/points: expected an array of 2 to 100000, each an array of 2 to 3, "
     "each a number between -1000000 and 1000000, found an array of 1 item"),
    (G + "/path/points", [[0, 1], [0, 1]], f"{G}/path/points: expected a path of some length, "
     "found points that all coincide"),
    (G + "/path/points/1", [0, 1, 2], f"{G}/path/points/1: expected a point [p, q], as space is pattern, "
     "found an array of 3 numbers"),
    (G + "/path", {"type": "svg", "d": "M0 0 L 1 x"}, f"{G}/path/d: expected a number as argument 2 of L, "
     "found 'x' at character 10"),
    (G + "/path", {"type": "svg", "d": "L 1 1"}, f"{G}/path/d: expected path data that begin with M or m, found 'L'"),
    (G + "/path", {"type": "svg", "d": "M 1 1 z"}, f"{G}/path/d: expected a path of some length, "
     "found path data that draw nothing"),
    (G + "/path", {"type": "svg", "d": "M0 0" + "l9e5 0" * 3}, f"{G}/path/d: expected coordinates within 1e+06 of "
     "zero, found a path that reaches 2.7e+06"),
    (G + "/path", {"type": "spiral", "center": [0, 0], "inner_radius": 2, "outer_radius": 2, "turns": 1},
     f"{G}/path/outer_radius: expected a radius above the inner radius, 2, found 2"),
    (G + "/profile", {"type": "polyline", "points": [[0, 0], [1, -1], [2, 0.5]]},
     f"{G}/profile/points/2/1: expected 0, as a profile ends on the surface, found 0.5"),
    (G + "/profile/depth", 0, f"{G}/profile/depth: expected a depth of at least 1e-09 either way, found 0"),
    (G + "/profile", {"type": "trapezoid", "width": 1, "floor": 2, "depth": 1},
     f"{G}/profile/floor: expected a floor of at most the width, 1, found 2"),
    (G + "/scale", {"type": "table", "t": [0, 1], "values": [1, 1, 1]},
     f"{G}/scale/values: expected 2 values, one for each t, found 3"),
    (G + "/scale", {"type": "table", "t": [0, 0.5, 0.5, 0.9], "values": [1, 1, 1, 1]},
     f"{G}/scale/t/3: expected 1, as the table spans the path, found 0.9"),
    (G + "/repeat/count", 0, f"{G}/repeat/count: expected a whole number between 1 and 1000000, found 0"),
    (G + "/repeat/step", [0, 0], f"{G}/repeat/step: expected a step that is not zero, as there is more than one copy, "
     "found a step of zero"),
    (G + "/repeat", {"type": "grid", "counts": [1000, 1001], "steps": [[1, 0], [0, 1]]},
     "/patterns/tiles/grooves: expected at most 1000000 grooves with all repeats, found 1001000"),
    (G + "/repeat", {"type": "concentric", "count": 2, "step": 1},
     f'{G}/repeat/type: expected a repeat other than concentric, as the path is no circle, found "concentric"'),
    ("/patterns/tiles/grooves", [], "/patterns/tiles/grooves: expected an array of 1 to 10000, each an object, "
     "found []"),
    ("/patterns/a~0b~1c", {"grooves": 3}, "/patterns/a~0b~1c/grooves: expected an array of 1 to 10000, each an object, "
     "found 3"),
]  # fmt: skip


def put(data: Any, place: str, value: Any) -> None:
    """Writes a value where a pointer points."""
    *parents, last = (part.replace("~1", "/").replace("~0", "~") for part in place.removeprefix("/").split("/"))
    for part in parents:
        data = data[int(part)] if isinstance(data, list) else data[part]
    data[int(last) if isinstance(data, list) else last] = value


@pytest.mark.parametrize(("place", "value", "line"), CASES, ids=[f"{c[0]}={c[1]!r:.40}" for c in CASES])
def test_problem_says_where_what_was_expected_and_what_was_found(
    scene: dict[str, Any], place: str, value: Any, line: str
) -> None:
    put(scene, place, value)
    report = check(scene)
    assert line in [str(problem) for problem in report.problems]
    assert report.scene is None


def test_the_example_is_valid(scene: dict[str, Any]) -> None:
    report = check(scene)
    assert (report.problems, report.warnings) == ([], [])
    assert report.scene is not None


def test_everything_is_valid(everything: dict[str, Any]) -> None:
    everything["objects"][1]["translate"] = [0, 0, 9]
    assert check(everything).problems == []


def test_all_problems_at_once(scene: dict[str, Any], groove: dict[str, Any]) -> None:
    scene["camera"]["fov"] = 0
    scene["objects"][0]["material"] = "gold"
    groove["profile"]["depth"] = 0
    groove["material"] = "silver"
    scene["objects"].append({"shape": {"type": "sphere", "radius": 9}})
    del scene["materials"]["glass"]["ior"]
    pointers = {problem.pointer for problem in check(scene).problems}
    assert pointers == {
        "/camera/fov",
        "/objects/0/material",
        "/objects/1/material",
        f"{G}/material",
        f"{G}/profile/depth",
    }


def test_concentric_circles_keep_their_radius(scene: dict[str, Any], groove: dict[str, Any]) -> None:
    groove["path"] = {"type": "circle", "center": [0, 0], "radius": 1}
    groove["repeat"] = {"type": "concentric", "count": 5, "step": -0.25}  # the last one: 1 - 4 / 4 = 0
    assert [str(p) for p in check(scene).problems] == [
        f"{G}/repeat/step: expected circles with radii above 0, found a last radius of 0"
    ]


@pytest.mark.parametrize(("y", "inside"), [(-4.01, False), (-3.99, True)])
def test_camera_inside_a_turned_cylinder(scene: dict[str, Any], y: float, inside: bool) -> None:
    """A cylinder of height 4 turned by 90 degrees about x lies along y; moved to y = -2 it begins at y = -4."""
    shape = {"type": "cylinder", "radius": 1, "height": 4}
    scene["objects"].append({"shape": shape, "rotate": [90, 0, 0], "translate": [0, -2, 2], "material": "stone"})
    scene["camera"]["origin"] = [0, y, 2]
    assert [p.pointer for p in check(scene).problems] == (["/camera/origin"] if inside else [])


def test_turns_come_in_the_order_x_y_z(scene: dict[str, Any]) -> None:
    """The z axis turned about x by 90 degrees is -y; about z by 90 degrees that is +x."""
    shape = {"type": "cylinder", "radius": 1, "height": 20}
    scene["objects"].append({"shape": shape, "rotate": [90, 0, 90], "material": "stone"})
    scene["camera"] |= {"origin": [9, 0, 0], "target": [0, 0, 5]}
    assert [p.pointer for p in check(scene).problems] == ["/camera/origin"]
    scene["camera"]["origin"] = [0, 9, 0]
    assert check(scene).problems == []


TEXTS: list[tuple[str | bytes, str]] = [
    ("{", "(root): expected JSON, found a fault at line 1, column 2: "
     "Expecting property name enclosed in double quotes"),
    ('{"a": 1,\n "b": x}', "(root): expected JSON, found a fault at line 2, column 7: Expecting value"),
    (b'{"a\xff"}', "(root): expected UTF-8 text, found byte 0xff at offset 3"),
    ('{"b": [{"c": 1, "c": 2}]}', '/b/0/c: expected each key once, found the key "c" more than once'),
    ("[" * 200_000, "(root): expected JSON nested a few levels deep, found JSON nested too deeply to read"),
    (" " * (MAX_BYTES + 1), f"(root): expected a scene of at most {MAX_BYTES} bytes, found {MAX_BYTES + 1} characters"),
    ('{"intaglio": NaN}', "/intaglio: expected 1, found NaN"),
    ('{"intaglio": 1e999}', "/intaglio: expected 1, found Infinity"),
    ('{"intaglio": ' + "9" * 10_000 + "}", "/intaglio: expected 1, found Infinity"),
    ("[]", "(root): expected an object, found []"),
    ("", "(root): expected JSON, found a fault at line 1, column 1: Expecting value"),
]  # fmt: skip


@pytest.mark.parametrize(("text", "line"), TEXTS, ids=[f"{t[0]!r:.30}" for t in TEXTS])
def test_text_that_is_no_scene(text: str | bytes, line: str) -> None:
    report = check_text(text)
    assert str(report.problems[0]) == line
    assert report.scene is None


def test_rubbish_costs_little() -> None:
    """Two million faults end in one problem, without their details."""
    text = '{"patterns": {' + ",".join(f'"{i}": {{"grooves": [{"{},".join([""] * 2001)}3]}}' for i in range(999)) + "}}"
    (problem,) = check_text(text).problems
    assert str(problem) == "(root): expected a scene with at most 20000 problems, found more"


def test_a_line_stays_one_line() -> None:
    assert Problem("/a\nb", "x", "y").line() == "/a\\nb: expected x, found y"


def test_pointer_escapes() -> None:
    assert pointer("a/b", 0, "m~n", "") == "/a~1b/0/m~0n/"


def test_schema_is_the_callers_to_change() -> None:
    json_schema()["properties"].clear()
    assert json_schema()["properties"]
