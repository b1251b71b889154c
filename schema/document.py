"""The scene file's JSON Schema."""

from functools import lru_cache
from typing import Any

from .scene import Scene

DIALECT = "https://json-schema.org/draft/2020-12/schema"


def json_schema() -> dict[str, Any]:
    """The JSON Schema (draft 2020-12) of a scene file, the caller's to change."""
    return {"$schema": DIALECT, **Scene.model_json_schema(), "title": "intaglio scene"}


@lru_cache(maxsize=1)
def shared_schema() -> dict[str, Any]:
    """The same, made once and not to be changed."""
    return json_schema()
