"""What a place of the scene file should hold, in plain words.

Read off the JSON Schema, so that what an error says and what is checked cannot come apart.
"""

import json
from collections.abc import Callable
from typing import Any

from .document import shared_schema

Node = dict[str, Any]
UNKNOWN: Node = {}


def resolved(node: Node) -> Node:
    """The schema behind references and the choice of null."""
    while True:
        if "$ref" in node:
            node = shared_schema()["$defs"][node["$ref"].removeprefix("#/$defs/")]
        elif "anyOf" in node:
            node = next(option for option in node["anyOf"] if option != {"type": "null"})
        else:
            return node


def locate(loc: tuple[str | int, ...]) -> tuple[tuple[str | int, ...], Node]:
    """A place as pydantic names it: the place in the file (without the tags of unions), and its schema.

    The schema is empty where the place is none of the format's.
    """
    place: list[str | int] = []
    node: Node = shared_schema()
    for part in loc:
        inner = resolved(node)
        if "oneOf" in inner:
            node = _option(inner, str(part))
            continue
        place.append(part)
        node = _below(inner, part)
    return tuple(place), node


def _option(node: Node, tag: str) -> Node:
    if "discriminator" in node:
        return {"$ref": node["discriminator"]["mapping"][tag]}
    return next((option for option in node["oneOf"] if option.get("type") == tag), UNKNOWN)


def _below(node: Node, part: str | int) -> Node:
    if isinstance(part, int):
        fixed = node.get("prefixItems", [])
        below: Node = fixed[part] if part < len(fixed) else node.get("items", UNKNOWN)
        return below
    if part in node.get("properties", {}):
        known: Node = node["properties"][part]
        return known
    more = node.get("additionalProperties")
    return more if isinstance(more, dict) else UNKNOWN


def keys(node: Node) -> str:
    """The keys that an object may have."""
    return listed(list(resolved(node).get("properties", {})))


def tags(node: Node) -> str:
    """The types to choose from."""
    return listed(list(resolved(node)["discriminator"]["mapping"]))


def listed(names: list[str]) -> str:
    """Names in quotes, joined."""
    return ", ".join(json.dumps(name, ensure_ascii=False) for name in names)


def described(node: Node) -> str:
    """What the schema wants, in words."""
    if any(option == {"type": "null"} for option in node.get("anyOf", [])):
        return f"null or {described(resolved(node))}"
    node = resolved(node)
    if "oneOf" in node:
        if "discriminator" in node:
            return f'an object with a "type" of {tags(node)}'
        return " or ".join(described(option) for option in node["oneOf"])
    if "enum" in node:
        return f"one of {listed(node['enum'])}"
    if "const" in node:
        return json.dumps(node["const"])
    describe = _BY_TYPE.get(node.get("type", ""))
    return describe(node) if describe else "a value of the format"


def _number(node: Node) -> str:
    noun = "a whole number" if node["type"] == "integer" else "a number"
    high = _plain(node["maximum"])
    if "exclusiveMinimum" in node:
        return f"{noun} above {_plain(node['exclusiveMinimum'])} and up to {high}"
    low = _plain(node["minimum"])
    return high if low == high else f"{noun} between {low} and {high}"


def _plain(value: float) -> str:
    return str(int(value)) if value == int(value) else f"{value:g}"


def _string(node: Node) -> str:
    return f"a string of {node['minLength']} to {node['maxLength']} characters"


def _array(node: Node) -> str:
    if "prefixItems" in node:
        items = node["prefixItems"]
        return f"an array of {len(items)}, each {described(items[0])}"
    low, high = node.get("minItems", 0), node["maxItems"]
    return f"an array of {low} to {high}, each {described(node['items'])}"


_BY_TYPE: dict[str, Callable[[Node], str]] = {
    "number": _number,
    "integer": _number,
    "string": _string,
    "boolean": lambda _: "true or false",
    "array": _array,
    "object": lambda _: "an object",
}
