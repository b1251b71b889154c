"""Problems: where, what was expected and what was found. Their text is part of the contract."""

import json
from dataclasses import dataclass
from typing import Any, Literal

MAX_FOUND = 80


@dataclass(frozen=True, slots=True)
class Problem:
    """One thing that is wrong (an error), or that the renderer only approximates (a warning).

    `pointer` is an RFC 6901 JSON pointer; the empty string is the whole scene.
    """

    pointer: str
    expected: str
    found: str
    severity: Literal["error", "warning"] = "error"

    def line(self) -> str:
        """`POINTER: expected …, found …` on one line, printable anywhere UTF-8 is."""
        text = f"{self.pointer or '(root)'}: expected {self.expected}, found {self.found}"
        return "".join(char if char.isprintable() else char.encode("unicode_escape").decode() for char in text)

    def __str__(self) -> str:
        return self.line()


def pointer(*parts: str | int) -> str:
    """The JSON pointer of a place. Lone surrogates, which no encoder takes, are written as escapes."""
    text = "".join("/" + str(part).replace("~", "~0").replace("/", "~1") for part in parts)
    return text.encode("utf-8", "backslashreplace").decode("utf-8")


def shown(value: Any) -> str:
    """A value as JSON in at most 80 characters; big arrays and objects by their size alone."""
    if isinstance(value, dict):
        return "an empty object" if not value else f"an object with {_counted(len(value), 'key')}"
    if isinstance(value, list | tuple):
        if len(value) > 4 or any(isinstance(item, list | tuple | dict) for item in value):
            return f"an array of {_counted(len(value), 'item')}"
        text = "[" + ", ".join(shown(item) for item in value) + "]"
    elif isinstance(value, str):
        text = json.dumps(value[: MAX_FOUND + 1], ensure_ascii=False)
        text = text.encode("utf-8", "backslashreplace").decode("utf-8")
    elif isinstance(value, int) and value.bit_length() > 64:
        return f"a whole number of {value.bit_length()} bits"
    elif value is None or isinstance(value, bool | int | float):
        text = json.dumps(value)
    else:
        return f"a Python {type(value).__name__}"
    return text if len(text) <= MAX_FOUND else text[: MAX_FOUND - 1] + "…"


def _counted(count: int, noun: str) -> str:
    return f"{count} {noun}" if count == 1 else f"{count} {noun}s"
