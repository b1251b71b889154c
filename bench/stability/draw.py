"""The maps: each factor alone, all methods in one picture; each pair of factors, a picture a method."""

from __future__ import annotations

import itertools
import math
from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
from matplotlib.axes import Axes
from matplotlib.colors import LogNorm

from bench.stability.sweep import FACTORS, ITSELF, METHODS, Factor, Result, Score, pairs, singles

LEAST, MOST = 1e-6, 1.0  # of the colours
SHORT = {
    "view": "view °",
    "light": "light °",
    "footprint": "footprint",
    "crossing": "crossing °",
    "run": "wall's run",
    "aspect": "aspect",
    "radius": "radius",
    "slope": "slope",
    "apart": "apart",
    "number": "number",
}
STYLES = {ITSELF[0]: ":", ITSELF[1]: "--"}
NORM = LogNorm(LEAST, MOST)


def text(value: float) -> str:
    """A number as short as it gets: 1e-4 and not 0.0001."""
    if value == 0 or 0.001 < value < 10000:
        return f"{value:g}"
    return f"{value:.0e}".replace("e-0", "e-").replace("e+0", "e")


def alone(results: list[Result], path: Path) -> None:
    """Draw every factor alone."""
    rows = list(zip(singles(), results, strict=True))
    figure, places = plt.subplots(2, 5, figsize=(19, 8), sharey=True, layout="constrained")
    for factor, place in zip(FACTORS, places.flat, strict=True):
        mine = [(value, result) for (of, value, _), result in rows if of is factor]
        at = np.arange(len(mine))
        floor = np.array([result.floor for _, result in mine])
        place.fill_between(at, LEAST / 100, floor, color="0.85", step="mid", label="below the truth's noise")
        for number, name in enumerate((*METHODS, *ITSELF)):
            errors = [_error(result.scores.get(name), result.floor, name) for _, result in mine]
            colour = f"C{number}"
            place.plot(at, errors, STYLES.get(name, "-"), color=colour, label=name, marker=".", linewidth=1.2)
            for x, (_, result) in enumerate(mine):
                if name in result.scores and result.scores[name].failed:
                    place.plot([x], [MOST], "x", color=colour, markersize=10)
        for x, (_, result) in enumerate(mine):
            if math.isnan(result.floor):
                place.text(x, 1e-3, "no truth", rotation=90, color="0.4", ha="center")
        place.set(yscale="log", ylim=(1e-8, 2), xlabel=factor.label)
        place.set_xticks(at, [text(value) for value, _ in mine], rotation=45, fontsize=8)
        place.grid(alpha=0.3)
    for place in places[:, 0]:
        place.set_ylabel("error (RMS), of a white surface's radiance")
    handles, labels = places.flat[0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside upper center", ncols=8)
    figure.savefig(path, dpi=75)
    plt.close(figure)


def _error(score: Score | None, floor: float, name: str) -> float:
    """What is drawn: no less than is known."""
    if score is None or score.failed:
        return math.nan
    return max(score.rms, 1e-9 if name in ITSELF else floor)


def paired(results: list[Result], name: str, path: Path) -> None:
    """Draw the map of one method: a square a pair of factors."""
    found: dict[tuple[str, str], list[Result]] = {}
    for (first, second, *_), result in zip(pairs(), results, strict=True):
        found.setdefault((first.field, second.field), []).append(result)
    side = len(FACTORS) - 1
    figure, places = plt.subplots(side, side, figsize=(15, 14), layout="constrained")
    for row, column in itertools.product(range(side), range(side)):
        place = places[row, column]
        first, second = FACTORS[column], FACTORS[row + 1]
        if (first.field, second.field) not in found:
            place.axis("off")
            continue
        _square(place, first, second, found[first.field, second.field], name)
        place.set_xticks(range(5), [text(v) for v in first.paired] if row == side - 1 else [], rotation=60, fontsize=8)
        place.set_yticks(range(5), [text(v) for v in second.paired] if column == 0 else [], fontsize=8)
        if row == side - 1:
            place.set_xlabel(SHORT[first.field], fontsize=11)
        if column == 0:
            place.set_ylabel(SHORT[second.field], fontsize=11)
    mappable = plt.cm.ScalarMappable(NORM, "turbo")
    bar = figure.colorbar(mappable, ax=places, shrink=0.5, location="right", anchor=(0, 0.9), extend="both")
    bar.set_label("error (RMS), of a white surface's radiance")
    figure.suptitle(name, fontsize=20)
    figure.text(
        0.55, 0.9, "·  no more than that: the truth's noise\n×  failed\n/  no truth, or no such scene\n"
        "o  judged by csg's own samples", fontsize=13, va="top",
    )  # fmt: skip
    figure.savefig(path, dpi=75)
    plt.close(figure)


def _square(place: Axes, first: Factor, second: Factor, results: list[Result], name: str) -> None:
    """One pair: the first factor to the right, the second upwards."""
    wide, high = len(first.paired), len(second.paired)
    colours = np.full((high, wide), np.nan)
    for index, result in enumerate(results):
        x, y = divmod(index, high)
        score = result.scores.get(name)
        if score is None:
            place.text(x, y, "/", ha="center", va="center", color="0.5")
        elif score.failed:
            place.text(x, y, "×", ha="center", va="center", color="black", fontsize=16, weight="bold")
        else:
            colours[y, x] = max(_error(score, result.floor, name), LEAST)
            if name not in ITSELF and score.rms <= result.floor:
                place.text(x, y, "·", ha="center", va="center", color="white", fontsize=14)
            elif result.truth == "csg":
                place.text(x, y, "o", ha="center", va="center", color="white", fontsize=7)
    place.imshow(colours, norm=NORM, cmap="turbo", origin="lower", aspect="auto")
    place.set_facecolor("0.9")
