"""A measured number beside its goal."""

from __future__ import annotations

from typing import NamedTuple


class Line(NamedTuple):
    """One row of the table. met: None where there is no goal."""

    what: str
    value: float
    unit: str = ""
    goal: str = ""
    met: bool | None = None


def at_most(what: str, value: float, goal: float, unit: str = "") -> Line:
    return Line(what, value, unit, f"<= {goal:g}", value <= goal)


def at_least(what: str, value: float, goal: float, unit: str = "") -> Line:
    return Line(what, value, unit, f">= {goal:g}", value >= goal)


def table(lines: list[Line]) -> str:
    """The lines as text, columns aligned."""
    wide = max(len(line.what) for line in lines)
    verdict = {True: "met", False: "MISSED", None: ""}
    return "\n".join(
        f"{line.what:<{wide}}  {line.value:>11.4g} {line.unit:<6} {line.goal:<10} {verdict[line.met]}".rstrip()
        for line in lines
    )
