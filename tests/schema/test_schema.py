"""The JSON Schema, with a foreign validator; and the models' documentation."""

import copy
import json
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from jsonschema import Draft202012Validator  # type: ignore[import-untyped]

import schema
from schema import Model, check_text, json_schema

EXAMPLES = sorted((Path(__file__).parents[2] / "examples").rglob("*.json"))


VALIDATOR = Draft202012Validator(json_schema())


def foreign_errors(data: Any) -> list[str]:
    return [error.message for error in VALIDATOR.iter_errors(data)]


def test_schema_is_one() -> None:
    Draft202012Validator.check_schema(json_schema())
    assert json_schema()["$schema"] == "https://json-schema.org/draft/2020-12/schema"


def test_foreign_validator_takes_the_valid(everything: dict[str, Any]) -> None:
    assert foreign_errors(everything) == []


@pytest.mark.parametrize("file", EXAMPLES, ids=lambda file: str(file.name))
def test_foreign_validator_takes_the_examples(file: Path) -> None:
    data = json.loads(file.read_text("utf-8"))
    if "intaglio" not in data:
        pytest.skip("no scene")
    assert foreign_errors(data) == []
    assert check_text(file.read_bytes()).problems == []


def places(value: Any, place: tuple[str | int, ...] = ()) -> Iterator[tuple[str | int, ...]]:
    yield place
    inner = value.items() if isinstance(value, dict) else enumerate(value) if isinstance(value, list) else ()
    for key, item in inner:
        yield from places(item, (*place, key))


def test_both_refuse_a_wrong_type_anywhere(everything: dict[str, Any]) -> None:
    """An object with one unknown key is right nowhere, and each place is where the problem is said to be."""
    for place in places(everything):
        data: Any = copy.deepcopy(everything)
        if not place:
            continue
        parent: Any = data
        for key in place[:-1]:
            parent = parent[key]
        parent[place[-1]] = {"nonsense": 1}
        if place in [("materials",), ("patterns",)]:
            continue  # there any key is a name
        assert foreign_errors(data), place
        pointers = [problem.pointer for problem in schema.check(data).problems]
        assert any(found.startswith(schema.pointer(*place)) for found in pointers), (place, pointers)


def models() -> list[type[Model]]:
    found, todo = [], [Model]
    while todo:
        children = todo.pop().__subclasses__()
        found += children
        todo += children
    return found


@pytest.mark.parametrize("model", models(), ids=lambda model: model.__name__)
def test_every_model_and_field_is_described(model: type[Model]) -> None:
    assert model.__doc__
    for name, field in model.model_fields.items():
        assert field.description, name
        if not field.is_required():
            assert "Default: " in field.description or name in {"render"}, name


def numbers(node: Any) -> Iterator[dict[str, Any]]:
    if isinstance(node, dict):
        yield node
        for item in node.values():
            yield from numbers(item)
    elif isinstance(node, list):
        for item in node:
            yield from numbers(item)


def test_everything_is_bounded() -> None:
    for node in numbers(json_schema()):
        kind = node.get("type")
        if "const" in node or "enum" in node or not isinstance(kind, str):
            continue
        if kind in ("number", "integer"):
            assert "maximum" in node, node
            assert "minimum" in node or "exclusiveMinimum" in node, node
        if kind == "string":
            assert "maxLength" in node, node
        if kind == "array":
            assert "maxItems" in node, node
        if kind == "object" and "properties" not in node:
            assert "maxProperties" in node, node
        if kind == "object" and "properties" in node:
            assert node["additionalProperties"] is False
