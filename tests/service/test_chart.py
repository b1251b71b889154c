"""A chart from end to end: the loop, its results, and the service's small one."""

from __future__ import annotations

import dataclasses
import io
import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from fastapi.testclient import TestClient
from PIL import Image

import schema
from renderer import pipeline
from renderer.errors import Cancelled, Fault, RenderError
from service.chart import make
from service.chart.report import document, results
from service.chart.run import Plan, opened

from .conftest import SETTINGS, FakeRenderer, assert_problem, open_client

NAMES = ("line", "csg", "geometry")


def planned(scene: dict[str, Any], *names: str) -> Plan:
    """A chart of 32x24 whose reference has a fixed number of passes."""
    checked = schema.check(scene).scene
    assert checked is not None
    plan = make.plan(checked, budget=1000, resolution=(32, 24), names=names or NAMES, threads=2, most=4)
    return dataclasses.replace(plan, passes=4, samples=64)


def never() -> bool:
    return False


@pytest.fixture
def after(monkeypatch: pytest.MonkeyPatch) -> Callable[[int], Callable[[], bool]]:
    """Makes what says stop after so many renders of the chart's own size."""
    render, done = pipeline.render, 0

    def counted(scene: schema.Scene, **options: Any) -> pipeline.Picture:
        nonlocal done
        picture = render(scene, **options)
        done += options["resolution"] == (32, 24)
        return picture

    monkeypatch.setattr(pipeline, "render", counted)

    def limit(renders: int) -> Callable[[], bool]:
        last = done + renders
        return lambda: done >= last

    return limit


def measures(told: dict[str, Any]) -> dict[str, Any]:
    """All of chart.json that does not hang on the clock."""
    timeless = json.loads(json.dumps(told))
    for key in ("machine", "seconds", "load", "equal"):
        del timeless[key]
    del timeless["reference"]["seconds"]
    for row in timeless["rows"]:
        for key in ("seconds", "runs", "prepare"):
            row.pop(key, None)
    return dict(timeless)


def test_a_chart_that_is_stopped_again_and_again_comes_to_the_same(
    scene: dict[str, Any], tmp_path: Path, after: Callable[[int], Callable[[], bool]]
) -> None:
    plan = planned(scene)
    whole = document(results(plan, make.measure(plan, tmp_path / "whole", never)))
    stops = 0
    while True:
        try:
            state = make.measure(plan, tmp_path / "parts", after(8))
            break
        except Cancelled:
            stops += 1
            assert stops < 20
            left = make.left(plan, tmp_path / "parts")
            if left is not None:
                assert document(results(plan, left))["state"] == "stopped"
    assert stops > 2
    parts = document(results(plan, state))
    assert parts["state"] == "complete"
    assert parts["reference"]["passes"] == 4
    assert measures(parts) == measures(whole)
    assert [len(row["runs"]) for row in parts["rows"]] == [len(row["runs"]) for row in whole["rows"]]


def test_methods_and_reference_share_no_seed(scene: dict[str, Any], tmp_path: Path, monkeypatch: Any) -> None:
    seeds: dict[int, set[int]] = {}
    render = pipeline.render

    def spy(scene: schema.Scene, **options: Any) -> pipeline.Picture:
        seeds.setdefault(options["samples"] or 0, set()).add(scene.render.seed)
        return render(scene, **options)

    monkeypatch.setattr(pipeline, "render", spy)
    plan = dataclasses.replace(planned(scene, "geometry"), samples=9)
    make.measure(plan, tmp_path, never)
    assert len(seeds[9]) == 4
    assert len(seeds[4]) > 1
    assert not seeds[9] & seeds[4]


def test_another_scene_begins_anew(
    scene: dict[str, Any], tmp_path: Path, after: Callable[[int], Callable[[], bool]]
) -> None:
    plan = planned(scene, "base")
    with pytest.raises(Cancelled):
        make.measure(plan, tmp_path, after(3))
    assert not opened(plan, tmp_path / "state")[1]
    assert make.left(plan, tmp_path) is not None
    scene["camera"]["fov"] = 41
    said: list[str] = []
    with pytest.raises(Cancelled):
        make.measure(planned(scene, "base"), tmp_path, after(0), say=said.append)
    assert len(said) == 1
    assert "beginning anew" in said[0]
    assert make.left(planned(scene, "base"), tmp_path) is None


def test_files(scene: dict[str, Any], tmp_path: Path) -> None:
    """Pictures can be opened; line is right where grooves run parallel, base is not, and the reference says so."""
    plan = planned(scene, "base", *NAMES)
    make.write(plan, make.measure(plan, tmp_path, never), tmp_path, "a scene")
    for name in ("chart.png", "contact.png"):
        with Image.open(tmp_path / name) as image:
            assert image.width > 500
    told = json.loads((tmp_path / "chart.json").read_text())
    rows = {row["name"]: row for row in told["rows"]}
    assert list(rows) == ["base", "line", "csg-1", "csg-4", "geometry-4"]
    assert rows["base"]["rmse"]["value"] > 5 * told["reference"]["floor"]
    assert rows["line"]["rmse"]["at_most"] < rows["base"]["rmse"]["value"]
    assert rows["line"]["sigma"] == 0
    assert rows["csg-1"]["rmse"]["value"] > rows["csg-4"]["rmse"]["value"]
    assert rows["geometry-4"]["bytes"] != rows["line"]["bytes"] > 0
    assert {one["setting"] for one in told["equal"]} == {"line", "csg-4"}


def test_a_method_that_cannot_is_listed_with_its_reason(
    scene: dict[str, Any], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """geometry refuses a solid: its row says so, and the reference is csg."""
    render = pipeline.render

    def refusing(scene: schema.Scene, **options: Any) -> pipeline.Picture:
        if options["method"] == "geometry":
            raise RenderError(Fault("/objects/0/pattern", "a pattern that can be meshed", "too many triangles"))
        return render(scene, **options)

    monkeypatch.setattr(pipeline, "render", refusing)
    plan = planned(scene, "line", "geometry")
    told = document(results(plan, make.measure(plan, tmp_path, never)))
    assert told["reference"]["method"] == "csg"
    rows = {row["method"]: row for row in told["rows"]}
    assert rows["geometry"]["cannot"].endswith("found too many triangles")
    assert rows["line"]["rmse"] is not None


def test_service_gives_picture_and_numbers(scene: dict[str, Any]) -> None:
    pipeline.warm_up(geometry=True)  # may compile for longer than the service gives a request
    with open_client(dataclasses.replace(SETTINGS, chart_seconds=1.0)) as client:
        picture = client.post("/api/chart?methods=line,csg", json=scene)
        assert picture.status_code == 200, picture.text
        assert picture.headers["content-type"] == "image/png"
        assert Image.open(io.BytesIO(picture.content)).width > 500
        told = client.post(
            "/api/chart?methods=line,csg&resolution=24x18", json=scene, headers={"Accept": "application/json"}
        )
        assert told.json()["resolution"] == [24, 18]
        assert {row["method"] for row in told.json()["rows"]} == {"line", "csg"}
        assert max(row["samples"] or 0 for row in told.json()["rows"]) == 64


def test_service_bounds_charts(client: TestClient, scene: dict[str, Any], fake: FakeRenderer) -> None:
    assert_problem(client.post("/api/chart?resolution=97x72", json=scene), 422, "/camera/resolution")
    assert_problem(client.post("/api/chart?methods=best", json=scene), 422)
    assert_problem(client.post("/api/chart?seconds=601", json=scene), 422)
    assert_problem(client.post("/api/chart", json=scene, headers={"Accept": "image/x-exr"}), 406)
    assert not fake.calls


def test_service_draws_what_it_has_when_the_seconds_are_over(scene: dict[str, Any], fake: FakeRenderer) -> None:
    """A render that does not end: the chart's time is over, and nothing was measured."""
    fake.block = True
    with open_client(dataclasses.replace(SETTINGS, chart_seconds=0.2)) as client:
        document = assert_problem(client.post("/api/chart", json=scene), 503)
        assert document["type"] == "urn:intaglio:too-long"
