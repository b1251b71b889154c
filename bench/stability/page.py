"""`python -m bench stability`: the sweep, its maps in docs/pictures, and the tables in docs/STABILITY.md."""

from __future__ import annotations

import math
import re
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from bench.report import Line, at_most
from bench.stability import draw
from bench.stability.sweep import FACTORS, ITSELF, METHODS, Result, outlies, pairs, save, singles, sweep

ROOT = Path(__file__).resolve().parents[2]
OUT = ROOT / "bench" / "out" / "stability.json"
PICTURES = ROOT / "docs" / "pictures"
PAGE = ROOT / "docs" / "STABILITY.md"
NAMES = (*METHODS, *ITSELF)


def measure() -> tuple[list[Line], dict[str, Any]]:
    """Sweep, draw and write."""
    begin = time.perf_counter()
    alone, paired = sweep()
    seconds = time.perf_counter() - begin
    OUT.parent.mkdir(parents=True, exist_ok=True)
    OUT.write_text(save(alone + paired))
    write(alone, paired)
    scores = {name: [r.scores[name] for r in alone + paired if name in r.scores] for name in NAMES}
    failed = {name: sum(bool(one.failed) for one in scores[name]) for name in NAMES}
    outliers = {name: sum(outlies(one) for one in scores[name]) for name in NAMES}
    return [
        Line("stability: the sweep", seconds, "s"),
        Line("stability: scenes with a truth", sum(not math.isnan(r.floor) for r in alone + paired)),
        *(Line(f"stability: worst RMS of {name}", worst(alone + paired, name)[0]) for name in NAMES),
        *(at_most(f"stability: failures and holes of {name}", count, 0) for name, count in failed.items()),
        *(_outliers(name, count) for name, count in outliers.items()),
    ], {"seconds": seconds}


def _outliers(name: str, count: int) -> Line:
    """`base`, `segment`, `line` and `relief` are wrong by nature in places, see the page."""
    what = f"stability: scenes with a pixel of {name} beyond the truth's range"
    return at_most(what, count, 0) if name in ("auto", "area", "csg", ITSELF[0]) else Line(what, count)


def write(alone: list[Result], paired: list[Result]) -> None:
    """The pictures, and the page's tables."""
    draw.alone(alone, PICTURES / "stability.png")
    for name in NAMES:
        draw.paired(paired, name, PICTURES / f"stability-{name.replace(', same samples', '-itself')}.png")
    text = PAGE.read_text()
    for key, lines in (("alone", _alone(alone)), ("pairs", _pairs(paired))):
        begin, end = f"<!-- {key} -->\n", f"<!-- end of {key} -->"
        table = "\n".join(lines)
        text = re.sub(f"{begin}.*?{end}", lambda _, t=f"{begin}{table}\n{end}": t, text, flags=re.S)  # type: ignore[misc]
    PAGE.write_text(text)


def worst(results: list[Result], name: str) -> tuple[float, Result | None]:
    """The largest error of a method, and where; what failed is infinitely wrong."""
    found: tuple[float, Result | None] = (0.0, None)
    for result in results:
        score = result.scores.get(name)
        if score is not None:
            error = math.inf if score.failed else score.rms
            if error > found[0]:
                found = error, result
    return found


def _alone(results: list[Result]) -> Iterator[str]:
    """Each factor's worst error, and the value where it is."""
    yield f"| factor | {' | '.join(NAMES)} |"
    yield "| --- |" + " --- |" * len(NAMES)
    rows = list(zip(singles(), results, strict=True))
    for factor in FACTORS:
        mine = [result for (of, *_), result in rows if of is factor]
        cells = []
        for name in NAMES:
            error, result = worst(mine, name)
            cells.append(f"{_error(error)} at {_value(result, factor.field)}" if result else "0")
        yield f"| {factor.label} | {' | '.join(cells)} |"


def _pairs(results: list[Result]) -> Iterator[str]:
    """For each method how many of the pairs' scenes are how wrong, and the worst."""
    yield "| method | scenes | above 0.002 | above 0.01 | above 0.1 | failed | outliers | worst | where |"
    yield "| --- | --- | --- | --- | --- | --- | --- | --- | --- |"
    rows = list(zip(pairs(), results, strict=True))
    for name in NAMES:
        scores = [result.scores[name] for result in results if name in result.scores]
        share = [f"{100 * sum(s.rms > limit for s in scores) / len(scores):.0f} %" for limit in (0.002, 0.01, 0.1)]
        failed = sum(bool(s.failed) for s in scores)
        outliers = sum(outlies(s) for s in scores)
        error, result = worst(results, name)
        where = next(
            (
                f"{first.label} {draw.text(a)}; {second.label} {draw.text(b)}"
                for (first, second, a, b, _), r in rows
                if r is result
            ),
            "",
        )
        told = (name, len(scores), *share, failed, outliers, _error(error), where)
        yield f"| {' | '.join(map(str, told))} |"


def _error(error: float) -> str:
    return f"{error:.1e}".replace("e-0", "e-").replace("e+00", "") if math.isfinite(error) else "failed"


def _value(result: Result, field: str) -> str:
    return draw.text(getattr(result.case, field))
