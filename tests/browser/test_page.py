"""The page in a browser, against the real service and renderer."""

from __future__ import annotations

import json

import pytest
from playwright.sync_api import Dialog, Route, expect

from .conftest import SCENE, Editor

pytestmark = pytest.mark.browser


def test_starts_with_an_example_rendered_and_all_in_view(fresh: Editor) -> None:
    assert fresh.picture().startswith(b"\x89PNG")
    name = fresh.page.locator(".file-name").inner_text()
    assert name in [f"{option}.json" for option in fresh.page.get_by_label("Open an example").inner_text().split()]
    height = fresh.page.evaluate("document.documentElement.scrollHeight")
    assert height == 800
    expect(fresh.page.get_by_text("No problems")).to_be_visible()


def test_drawing_a_polyline_changes_the_picture(editor: Editor) -> None:
    before = editor.picture()
    editor.page.keyboard.press("p")
    for p, q in ((0.5, 2), (1.5, 3), (2.5, 2)):
        editor.click(p, q)
    editor.page.keyboard.press("Enter")
    assert editor.picture() != before
    grooves = editor.grooves()
    assert len(grooves) == 3
    assert grooves[:2] == SCENE["patterns"]["plate"]["grooves"]
    assert grooves[2]["path"]["type"] == "polyline"
    for found, wanted in zip(grooves[2]["path"]["points"], ((0.5, 2), (1.5, 3), (2.5, 2)), strict=True):
        assert found == pytest.approx(wanted, abs=0.02)


def test_drawing_a_curve_and_a_circle(editor: Editor) -> None:
    before = editor.picture()
    editor.page.get_by_role("button", name="Draw a curve").click()
    for p, q in ((0.5, 2), (1.5, 3), (2.5, 2)):
        editor.click(p, q)
    editor.page.mouse.dblclick(*editor.at(3.2, 2.5))
    curved = editor.picture()
    assert curved != before
    editor.page.keyboard.press("o")
    editor.drag(editor.at(2, 2), editor.at(2.6, 2))
    assert editor.picture() != curved
    curve, circle = (groove["path"] for groove in editor.grooves()[2:])
    assert curve["type"] == "svg"
    assert curve["d"].count("C") == 3
    assert circle["type"] == "circle"
    assert circle["radius"] == pytest.approx(0.6, abs=0.02)


def test_escape_gives_up_a_path(editor: Editor) -> None:
    editor.page.keyboard.press("p")
    editor.click(1, 1)
    editor.click(2, 2)
    editor.page.keyboard.press("Escape")
    editor.page.keyboard.press("Enter")
    assert editor.document() == SCENE


def test_moving_a_point_and_undoing_it(editor: Editor) -> None:
    before = editor.picture()
    editor.click(1, 2)
    editor.drag(editor.at(1, 3.5), editor.at(2, 3))
    moved = editor.picture()
    assert moved != before
    assert editor.grooves()[0]["path"]["points"] == [[1, 0.5], pytest.approx([2, 3], abs=0.02)]
    editor.page.keyboard.press("Control+z")
    assert editor.picture() == before
    assert editor.document() == SCENE
    editor.page.keyboard.press("Control+Shift+z")
    assert editor.picture() == moved


def test_moving_a_groove_with_the_arrow_keys(editor: Editor) -> None:
    editor.click(1, 2)
    editor.page.keyboard.press("ArrowRight")
    (p0, q0), (p1, q1) = editor.grooves()[0]["path"]["points"]
    assert p0 == p1 > 1
    assert (q0, q1) == (0.5, 3.5)


def test_deleting_a_point_and_a_groove(editor: Editor) -> None:
    before = editor.picture()
    editor.row(1).click()
    editor.click(3.5, 1)
    editor.page.keyboard.press("Delete")
    assert editor.grooves()[1]["path"]["points"] == [[2, 1], [3.5, 3]]
    editor.page.keyboard.press("Delete")
    assert editor.picture() != before
    assert editor.grooves() == SCENE["patterns"]["plate"]["grooves"][:1]
    editor.page.get_by_role("button", name="Undo").click()
    editor.page.get_by_role("button", name="Undo").click()
    assert editor.picture() == before


def test_without_its_last_groove_the_plate_is_bare_and_can_be_drawn_on(editor: Editor) -> None:
    before = editor.picture()
    for _ in range(2):
        editor.row(0).click()
        editor.page.keyboard.press("Delete")
    document = editor.document()
    assert (document["patterns"], document["objects"][0]["pattern"]) == ({}, None)
    editor.page.keyboard.press("p")
    editor.click(1, 1)
    editor.click(3, 3)
    editor.page.keyboard.press("Enter")
    assert editor.picture() != before
    document = editor.document()
    assert document["objects"][0]["pattern"] in document["patterns"]


def test_a_new_scene_is_rendered(editor: Editor) -> None:
    editor.page.get_by_role("button", name="New").click()
    expect(editor.page.locator(".file-name")).to_have_text("untitled.json")
    assert editor.picture(timeout=8000).startswith(b"\x89PNG")


def test_the_profile(editor: Editor) -> None:
    before = editor.picture()
    editor.row(0).click()
    editor.field("Depth").fill("0.6")
    deeper = editor.picture()
    assert deeper != before
    editor.field("Profile").select_option("Round")
    assert editor.picture() != deeper
    assert editor.grooves()[0]["profile"] == {"type": "round", "width": 0.4, "depth": 0.6, "facets": 16}


def test_material_and_priority(editor: Editor) -> None:
    editor.page.get_by_role("button", name="Add material").click()
    editor.row(0).click()
    before = editor.picture()
    editor.page.get_by_label("Groove", exact=True).get_by_label("Material").select_option("material")
    assert editor.picture() != before
    editor.field("Priority").fill("3")
    groove = editor.grooves()[0]
    assert (groove["material"], groove["priority"]) == ("material", 3)


def test_turning_the_camera_and_the_light(editor: Editor) -> None:
    before = editor.picture()
    box = editor.page.locator(".preview-stage").bounding_box()
    assert box is not None
    editor.drag((box["x"] + 100, box["y"] + 100), (box["x"] + 180, box["y"] + 120))
    turned = editor.picture()
    assert turned != before
    sphere = editor.page.locator(".light-sphere").bounding_box()
    assert sphere is not None
    editor.page.mouse.click(sphere["x"] + 20, sphere["y"] + 30)
    assert editor.picture() != turned
    document = editor.document()
    x, y, z = document["lights"][0]["direction"]
    assert x > 0 > y
    assert z < 0
    assert {**document, "camera": None, "lights": None} == {**SCENE, "camera": None, "lights": None}


def test_open_and_save_keep_what_the_page_does_not_edit(editor: Editor) -> None:
    scatter = {"type": "scatter", "count": 40, "seed": 4_294_967_295, "bounds": [0, 0, 4, 4], "scale": [0.5, 1]}
    profile = {"type": "v", "width": 0.02, "depth": 0.01}
    more = [
        {"path": {"type": "svg", "d": "m1,1c.5 0 1,1 1 1a1 1 0 01.5.5", "flip_y": False}, "profile": profile},
        {"path": {"type": "polyline", "points": [[-0.1, 0], [0.1, 0.02]]}, "profile": profile, "repeat": scatter},
        {"path": {"type": "polyline", "space": "world", "points": [[0, 0, 1], [1, 0, 1]]}, "profile": profile},
    ]
    plate = SCENE["patterns"]["plate"]
    scene = {**SCENE, "patterns": {"plate": {**plate, "grooves": plate["grooves"] + more}}}
    editor.open(scene, "more.json")
    expect(editor.page.locator(".file-name")).to_have_text("more.json")
    name, text = editor.save()
    assert name == "more.json"
    assert json.loads(text) == scene
    assert max(map(len, text.splitlines())) <= 120
    editor.row(0).click()
    editor.field("Depth").fill("0.3")
    assert editor.grooves()[2:] == more


def test_a_problem_is_shown_where_it_is(editor: Editor) -> None:
    before = editor.picture()
    editor.row(0).click()
    editor.field("Width").fill("-1")
    finding = editor.page.get_by_role("button", name="grooves › 1 › profile › width")
    expect(finding).to_contain_text("found -1")
    expect(editor.page.get_by_role("heading", name="1 problem")).to_be_visible()
    expect(editor.field("Width")).to_have_attribute("aria-invalid", "true")
    editor.row(1).click()
    expect(editor.field("Width")).not_to_have_attribute("aria-invalid", "true")
    finding.click()
    expect(editor.field("Width")).to_be_focused()
    expect(editor.row(0)).to_have_attribute("aria-pressed", "true")
    assert editor.grooves()[0]["profile"]["width"] == -1
    editor.field("Width").fill("0.4")
    expect(editor.page.get_by_role("heading", name="No problems")).to_be_visible()
    assert editor.picture() == before


def test_what_is_no_scene_is_not_opened_and_a_broken_one_stays_editable(editor: Editor) -> None:
    editor.open("{oops", "broken.json")
    expect(editor.page.get_by_role("status")).to_contain_text("broken.json was not opened")
    expect(editor.page.locator(".file-name")).to_have_text("scene.json")
    odd = {"intaglio": 1, "camera": 7, "patterns": {"plate": {"grooves": [3, {"path": []}]}}, "objects": "none"}
    editor.open(odd, "odd.json")
    expect(editor.page.get_by_role("heading", name="problems")).to_be_visible()
    editor.row(0).click()
    editor.page.keyboard.press("Delete")
    assert editor.document() == {**odd, "patterns": {"plate": {"grooves": [{"path": []}]}}}


def test_a_reload_loses_nothing(editor: Editor) -> None:
    editor.row(0).click()
    editor.field("Depth").fill("0.6")
    changed = editor.picture()
    asked: list[str] = []

    def answer(dialog: Dialog) -> None:
        asked.append(dialog.type)
        dialog.accept()

    editor.page.on("dialog", answer)
    editor.page.reload()
    assert asked == ["beforeunload"]
    assert editor.picture() == changed
    assert editor.grooves()[0]["profile"]["depth"] == 0.6


def test_a_service_that_goes_and_comes_back(editor: Editor) -> None:
    before = editor.picture()

    def refuse(route: Route) -> None:
        route.abort()

    editor.page.route("**/api/**", refuse)
    editor.row(0).click()
    editor.field("Depth").fill("0.6")
    expect(editor.page.get_by_text("The service does not answer")).to_be_visible()
    editor.page.unroute("**/api/**", refuse)
    assert editor.picture() != before
