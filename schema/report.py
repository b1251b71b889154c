"""Pydantic's errors as problems of the scene file."""

from collections.abc import Iterator
from typing import Any

from pydantic import ValidationError

from .errors import Problem, pointer, shown
from .words import described, keys, locate, resolved, tags

NOTHING = "nothing"


def problems_of(error: ValidationError) -> Iterator[Problem]:
    """Every problem that an error of validation tells of."""
    for detail in error.errors(include_url=False):
        yield from _problems(detail["type"], detail["loc"], detail["input"], detail.get("ctx", {}))


def _problems(kind: str, loc: tuple[str | int, ...], value: Any, context: dict[str, Any]) -> Iterator[Problem]:
    if loc[-1:] == ("[key]",) and kind != "extra_forbidden":
        yield Problem(pointer(*loc[:-1]), "a name of 1 to 64 characters", shown(loc[-2]))
        return
    place, node = locate(loc)
    if kind == "meaning":
        for fault in context["faults"]:
            yield Problem(pointer(*place, *fault.at), fault.expected, fault.found)
    elif kind == "extra_forbidden":
        yield Problem(
            pointer(*place), f"one of the keys {keys(locate(loc[:-1])[1])}", f"the unknown key {shown(loc[-1])}"
        )
    elif kind in ("union_tag_invalid", "union_tag_not_found") and "discriminator" in resolved(node):
        found = shown(value["type"]) if "type" in value else NOTHING
        yield Problem(pointer(*place, "type"), f"one of {tags(node)}", found)
    elif kind == "missing" and isinstance(loc[-1], int):
        yield Problem(pointer(*place[:-1]), described(locate(loc[:-1])[1]), shown(value))
    elif kind == "missing":
        yield Problem(pointer(*place), described(node), NOTHING)
    elif kind == "too_short" and len(value) >= context["min_length"]:
        return  # Pydantic counts the items that are right; those that are not have been reported themselves.
    elif kind == "string_unicode" and not loc:
        yield Problem("", "keys that are Unicode text", "a key with half a surrogate pair")
    else:
        yield Problem(pointer(*place), described(node), shown(value))
