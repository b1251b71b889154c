"""Whatever is done to a scene, the outcome is a report: a scene, or else problems."""

import json
from typing import Any

from hypothesis import given, settings
from hypothesis import strategies as st

from schema import check, check_text

JSON = st.recursive(
    st.none()
    | st.booleans()
    | st.integers()
    | st.floats()
    | st.text()
    | st.sampled_from(["type", "v", "svg", "stone"]),
    lambda inner: st.lists(inner, max_size=4) | st.dictionaries(st.text() | st.just("type"), inner, max_size=4),
    max_leaves=8,
)


def containers(value: Any) -> list[Any]:
    found = []
    if isinstance(value, dict | list):
        found.append(value)
        for item in value.values() if isinstance(value, dict) else value:
            found += containers(item)
    return found


@st.composite
def mutants(draw: st.DrawFn, text: str) -> Any:
    scene = json.loads(text)
    for _ in range(draw(st.integers(1, 4))):
        target = draw(st.sampled_from([c for c in containers(scene) if c] or [scene]))
        keys = list(target) if isinstance(target, dict) else list(range(len(target)))
        if not keys:
            continue
        key = draw(st.sampled_from(keys))
        match draw(st.sampled_from(["replace", "delete", "add", "number"])):
            case "replace":
                target[key] = draw(JSON)
            case "delete":
                del target[key]
            case "add" if isinstance(target, dict):
                target[draw(st.text(max_size=8))] = draw(JSON)
            case "add":
                target.append(draw(JSON))
            case _:
                target[key] = draw(st.floats(-1e7, 1e7) | st.integers(-3, 3))
    return scene


@given(st.data())
@settings(max_examples=300, deadline=None)
def test_mutants_end_in_a_report(example_text: str, data: st.DataObject) -> None:
    report = check(data.draw(mutants(example_text)))
    assert (report.scene is None) == bool(report.problems)
    for problem in report.problems + report.warnings:
        assert len(problem.line().encode().splitlines()) == 1
        assert problem.expected
        assert problem.found


@given(JSON)
def test_any_json_ends_in_a_report(data: Any) -> None:
    report = check_text(json.dumps(data))
    assert (report.scene is None) == bool(report.problems)


@given(st.binary() | st.text())
def test_any_text_ends_in_a_report(text: str | bytes) -> None:
    assert check_text(text).problems


def test_surrogates_and_odd_keys(example_text: str) -> None:
    text = example_text.replace('"fov": 40', '"fov": "\\ud800"').replace('"ends"', '"\\udfff~/[key]"')
    for problem in check_text(text).problems:
        problem.line().encode()
