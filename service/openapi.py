"""The OpenAPI document, complete with the scene's models. `python -m service.openapi` prints it; the page's types are
generated from that."""

from __future__ import annotations

import json
import sys
from typing import Any

from fastapi import FastAPI
from fastapi.openapi.utils import get_openapi

import schema
from service.documents import ProblemDocument

_COMPONENTS = "#/components/schemas/"


def document(app: FastAPI) -> dict[str, Any]:
    """FastAPI's document, with the scene's JSON Schema taken apart into components."""
    made = get_openapi(title=app.title, version=app.version, description=app.description, routes=app.routes)
    schemas = made.setdefault("components", {}).setdefault("schemas", {})
    scene = schema.json_schema()
    models = scene.pop("$defs", {})
    if "Scene" not in models:
        models["Scene"] = {key: value for key, value in scene.items() if not key.startswith("$")}
    problem = ProblemDocument.model_json_schema(ref_template=_COMPONENTS + "{model}")
    schemas.update(problem.pop("$defs", {}))
    schemas["ProblemDocument"] = problem
    clash = schemas.keys() & models.keys()
    if clash:
        raise RuntimeError(f"both the scene and the service have models named {sorted(clash)}")
    schemas.update(models)
    names = {"#/scene": f"{_COMPONENTS}Scene", "#/pattern": f"{_COMPONENTS}Pattern"}
    complete = _renamed(made, names)
    assert isinstance(complete, dict)
    return complete


def _renamed(node: Any, names: dict[str, str]) -> Any:
    """`node` with all references turned into the document's own."""
    if isinstance(node, dict):
        result = {key: _renamed(value, names) for key, value in node.items()}
        if isinstance(result.get("$ref"), str):
            result["$ref"] = _reference(result["$ref"], names)
        mapping = result.get("mapping")
        if isinstance(mapping, dict) and "propertyName" in result:  # of a discriminator
            result["mapping"] = {kind: _reference(target, names) for kind, target in mapping.items()}
        return result
    if isinstance(node, list):
        return [_renamed(item, names) for item in node]
    return node


def _reference(target: str, names: dict[str, str]) -> str:
    return names.get(target, target.replace("#/$defs/", _COMPONENTS))


def main() -> None:
    """Print the document."""
    from service.app import create
    from service.settings import Settings

    json.dump(create(Settings()).openapi(), sys.stdout, indent=1, sort_keys=True)
    sys.stdout.write("\n")


if __name__ == "__main__":
    main()
