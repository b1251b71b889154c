"""JSON text to data, with every way in which that can fail told as a problem."""

import json
from collections import Counter
from typing import Any

from .errors import Problem, pointer, shown

MAX_BYTES = 64 * 2**20
# No number of the format has more digits. Longer ones become floats, as reading them takes quadratic time.
MAX_DIGITS = 20


def data_of_text(text: str | bytes) -> tuple[Any, list[Problem]]:
    """The data, and the problems that the text itself has. The data count only where there are none.

    NaN and Infinity, which JSON does not have, are read here and refused with their place by the models.
    """
    if len(text) > MAX_BYTES:
        unit = "bytes" if isinstance(text, bytes) else "characters"
        return None, [Problem("", f"a scene of at most {MAX_BYTES} bytes", f"{len(text)} {unit}")]
    repeated: list[tuple[dict[str, Any], list[str]]] = []

    def collect(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
        entries = dict(pairs)
        if len(entries) < len(pairs):
            counts = Counter(key for key, _ in pairs)
            repeated.append((entries, [key for key, count in counts.items() if count > 1]))
        return entries

    try:
        if isinstance(text, bytes):
            text = text.decode("utf-8-sig")
        data = json.loads(text, object_pairs_hook=collect, parse_int=_whole)
    except UnicodeDecodeError as error:
        return None, [Problem("", "UTF-8 text", f"byte 0x{error.object[error.start]:02x} at offset {error.start}")]
    except json.JSONDecodeError as error:
        found = f"a fault at line {error.lineno}, column {error.colno}: {error.msg}"
        return None, [Problem("", "JSON", found)]
    except RecursionError:
        return None, [Problem("", "JSON nested a few levels deep", "JSON nested too deeply to read")]
    return data, _repeated_keys(data, repeated) if repeated else []


def _whole(digits: str) -> int | float:
    return int(digits) if len(digits) <= MAX_DIGITS else float(digits)


def _repeated_keys(data: Any, repeated: list[tuple[dict[str, Any], list[str]]]) -> list[Problem]:
    """Walks the data for the places of objects with repeated keys. `repeated` keeps them alive, so ids are safe."""
    keys_of = {id(entries): keys for entries, keys in repeated}
    problems: list[Problem] = []
    stack: list[tuple[tuple[str | int, ...], Any]] = [((), data)]
    while stack:
        place, value = stack.pop()
        if isinstance(value, dict):
            for key in keys_of.get(id(value), ()):
                problems.append(Problem(pointer(*place, key), "each key once", f"the key {shown(key)} more than once"))
            stack += [((*place, key), item) for key, item in value.items()]
        elif isinstance(value, list):
            stack += [((*place, index), item) for index, item in enumerate(value) if isinstance(item, dict | list)]
    return problems
