"""chart.png and contact.png."""

from __future__ import annotations

import io
import math
import os
import textwrap
import threading
from collections.abc import Callable
from typing import Any

import numpy as np
from matplotlib import colormaps
from matplotlib.axes import Axes
from matplotlib.colors import LogNorm
from matplotlib.figure import Figure
from matplotlib.ticker import FuncFormatter, LogLocator, NullFormatter

from renderer import film
from service.chart import measure
from service.chart.measure import Measured
from service.chart.report import Results, Row, words

# Okabe and Ito's colours, which the colour-blind tell apart, and a marker each.
STYLES = {
    "base": ("#000000", "X"), "segment": ("#CC79A7", "D"), "line": ("#0072B2", "*"), "auto": ("#009E73", "s"),
    "csg": ("#E69F00", "^"), "geometry": ("#D55E00", "o"), "relief": ("#56B4E9", "P"),
    "area": ("#8B6B1F", "h"), "lines": ("#6A3D9A", "d"),
}  # fmt: skip
OTHER = ("#666666", "v")
DPI = 110
SHOWN = 9  # comparisons in words

_lock = threading.Lock()  # matplotlib keeps fonts for all threads


def chart(found: Results, title: str) -> bytes:
    """Error, bias and HDR-FLIP against time, as PNG."""
    figure = Figure(figsize=(13.5, 8.6), dpi=DPI, layout="constrained")
    grid = figure.add_gridspec(3, 3, height_ratios=(1, 1, 0.36))
    reference = found.state.reference
    main = figure.add_subplot(grid[:2, :2])
    _curves(main, found, lambda row: row.errors.rmse if row.errors else None, labels=True)
    _axes(main, "root mean square error, linear radiance", "seconds a frame (median)")
    if 0.0 < found.noise < math.inf:
        main.axhline(found.noise, color="0.35", linestyle="--", linewidth=1)
        _beside(main, found.noise, "noise of the reference itself")
        limit = measure.FIFTH * found.floor
        main.axhspan(1e-12, limit, color="0.5", alpha=0.16, linewidth=0, zorder=0)
        _beside(main, limit, f"below {limit:.1e}: not resolved (5 x floor {found.floor:.1e})", above=False)
    handles, names = main.get_legend_handles_labels()
    if handles:
        main.legend(handles, names, loc="upper right", fontsize=9, framealpha=0.9)
    side = figure.add_subplot(grid[0, 2])
    _curves(side, found, lambda row: row.errors.bias if row.errors else None)
    _axes(side, "bias alone (▽: at most)", "")
    if 0.0 < found.floor < math.inf:
        side.axhspan(1e-12, measure.FIFTH * found.floor, color="0.5", alpha=0.16, linewidth=0, zorder=0)
    low = figure.add_subplot(grid[1, 2])
    _curves(low, found, lambda row: row.flip)
    _axes(low, "HDR-FLIP, mean", "seconds a frame")
    if 0.0 < found.flip_floor < math.inf:
        low.axhspan(1e-12, measure.FIFTH * found.flip_floor, color="0.5", alpha=0.16, linewidth=0, zorder=0)
    for axes in (main, side, low):
        _limits(axes)
    text = figure.add_subplot(grid[2, :])
    text.axis("off")
    told = [words(one) for one in found.comparisons]
    left = [*dict.fromkeys(told)][:SHOWN] or ["nothing to compare yet"]
    text.text(0, 1, "\n".join(left), va="top", fontsize=8.5, transform=text.transAxes)
    text.text(0.56, 1, "\n".join(_left_out(found)), va="top", fontsize=8.5, transform=text.transAxes)
    width, height = found.plan.resolution
    state = "" if found.state.finished else "   (stopped: the same command goes on)"
    if found.state.load > (os.cpu_count() or 1):
        state += f"\nthe machine was busy (load {found.state.load:.1f}): the seconds are too many, all methods' alike"
    figure.suptitle(
        f"{title}, {width} x {height}; reference: {found.state.method or 'none'}, {reference.count} passes of "
        f"{reference.samples} samples{state}", fontsize=12,
    )  # fmt: skip
    return _png(figure)


def contact(found: Results) -> bytes:
    """The reference, then each method at its smallest error: the picture, where it errs, and HDR-FLIP; as PNG."""
    best = _best(found)
    width, height = found.plan.resolution
    exposure = found.plan.scene.render.exposure
    reference = found.state.reference
    tall = 2.6 * height / width + 0.42
    figure = Figure(figsize=(9.6, tall * (len(best) + 1) + 0.3), dpi=DPI, layout="constrained")
    grid = figure.subplots(len(best) + 1, 3, squeeze=False)
    grain = np.sqrt((reference.variance / max(reference.count, 1)).mean(axis=2))
    errors = [np.abs(found.state.records[row.setting.name].first - reference.mean).mean(axis=2) for row in best]
    top = max([float(np.quantile(error, 0.999)) for error in errors] + [1e-6])
    low = min(max(float(grain.mean()) / 3.0, 1e-4 * top), 0.1 * top)
    norm = LogNorm(vmin=low, vmax=top, clip=True)
    colours = colormaps["magma"]

    def line(axes: Any, picture: Any, error: Any, map_: Any, name: str, note: str) -> Any:
        axes[0].imshow(film.srgb(picture * np.float32(exposure)), interpolation="nearest")
        axes[0].set_title(name, fontsize=9, loc="left")
        shown = axes[1].imshow(np.maximum(error, low), norm=norm, cmap=colours, interpolation="nearest")
        axes[1].set_title(note, fontsize=9, loc="left")
        for one in axes:
            one.set_axis_off()
        if map_ is None:
            return shown, None
        return shown, axes[2].imshow(map_, vmin=0, vmax=_flip_top(best), cmap=colours, interpolation="nearest")

    shown, mapped = line(
        grid[0], reference.mean.astype(np.float32), grain, None, f"reference: {found.state.method}",
        f"its own noise, RMSE {found.noise:.1e}",
    )  # fmt: skip
    for axes, row, error in zip(grid[1:], best, errors, strict=True):
        name = f"{row.setting.method}{' ' + row.setting.label if row.setting.label else ''}, {row.seconds:.3g} s"
        note = f"RMSE {_said(row.errors.rmse)}" if row.errors else ""
        if row.errors and row.errors.bias:
            note += f", bias {_said(row.errors.bias)}"
        first = found.state.records[row.setting.name].first
        shown, here = line(axes, first, error, row.flip_map, name, note)
        if row.flip:
            axes[2].set_title(f"HDR-FLIP {_said(row.flip)}", fontsize=9, loc="left")
        mapped = here or mapped
    figure.colorbar(shown, ax=grid[:, 1], location="bottom", shrink=0.9, pad=0.01, aspect=40).set_label(
        "|difference from the reference|, mean of channels", fontsize=8
    )
    if mapped is not None:
        figure.colorbar(mapped, ax=grid[:, 2], location="bottom", shrink=0.9, pad=0.01, aspect=40).set_label(
            "HDR-FLIP", fontsize=8
        )
    return _png(figure)


def _curves(axes: Axes, found: Results, value: Callable[[Row], Measured | None], labels: bool = False) -> None:
    """A curve a method: points where it was resolved, open triangles where there is but a bound."""
    for method in dict.fromkeys(row.setting.method for row in found.rows):
        colour, marker = STYLES.get(method, OTHER)
        got = [
            (row.seconds, error, row.setting)
            for row in found.rows
            if row.setting.method == method and (error := value(row)) is not None and math.isfinite(error.least)
        ]
        known = [(x, e.value, s) for x, e, s in got if e.value is not None and e.value > 0.0]
        bounds = [(x, e.at_most, s) for x, e, s in got if e.value is None and e.at_most > 0.0]
        front = _front([(x, y) for x, y, _ in known])
        if len(front) > 1:
            axes.plot(*zip(*front, strict=True), color=colour, linewidth=1.3, alpha=0.85)
        size = 11 if marker == "*" else 6.5
        name = method
        if known:
            axes.plot(
                [x for x, _, _ in known], [y for _, y, _ in known], marker, color=colour, markersize=size, label=name
            )
            name = "_"
        if bounds:
            axes.plot(
                [x for x, _, _ in bounds], [y for _, y, _ in bounds], "v", color=colour, markersize=8,
                markerfacecolor="white", markeredgewidth=1.6, label=f"{method} (at most)" if name == method else "_",
            )  # fmt: skip
        if labels:
            for x, y, setting in [*known, *bounds]:
                # The names of methods that are as good do not lie on one another.
                below = list(STYLES).index(method) % 2 == 1 if method in STYLES else True
                axes.annotate(setting.label or setting.method, (x, y), xytext=(5, -12 if below else 5),
                              textcoords="offset points",
                              fontsize=8, color=colour)  # fmt: skip


def _front(points: list[tuple[float, float]]) -> list[tuple[float, float]]:
    """Those points than which none is both faster and nearer to the truth."""
    front: list[tuple[float, float]] = []
    for x, y in sorted(points):
        if not front or y < front[-1][1]:
            front.append((x, y))
    return front


def _axes(axes: Axes, vertical: str, horizontal: str) -> None:
    axes.set_xscale("log")
    axes.set_yscale("log")
    axes.set_title(vertical, fontsize=10, loc="left")
    axes.set_xlabel(horizontal, fontsize=9)
    axes.grid(True, which="major", color="0.85", linewidth=0.8)
    axes.grid(True, which="minor", color="0.93", linewidth=0.5)
    axes.set_axisbelow(True)
    axes.tick_params(labelsize=8)
    for axis in (axes.xaxis, axes.yaxis):
        axis.set_major_locator(LogLocator(numticks=12))
        axis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
        axis.set_minor_formatter(NullFormatter())


def _limits(axes: Axes) -> None:
    """Around the points, with room for their names; not around the bands."""
    data = np.array([point for line in axes.get_lines() for point in line.get_xydata() if line.get_marker() != "None"])  # type: ignore[union-attr]
    if not len(data):
        axes.text(0.5, 0.5, "nothing measured yet", ha="center", transform=axes.transAxes, color="0.4")
        return
    (left, low), (right, high) = data.min(axis=0), data.max(axis=0)
    axes.set_xlim(left / 1.6, right * 2.2)
    axes.set_ylim(low / 2.5, high * 2.5)
    for axis, (first, last) in ((axes.xaxis, axes.get_xlim()), (axes.yaxis, axes.get_ylim())):
        if last < 100.0 * first:  # a power of ten alone would tell little
            axis.set_minor_locator(LogLocator(subs=(2, 5)))
            axis.set_minor_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
            axis.set_tick_params(which="minor", labelsize=7)


def _beside(axes: Axes, y: float, text: str, above: bool = True) -> None:
    axes.annotate(
        text, (0.01, y), xycoords=("axes fraction", "data"), xytext=(0, 3 if above else -3), textcoords="offset points",
        va="bottom" if above else "top", fontsize=8, color="0.3", annotation_clip=True,
    )  # fmt: skip


def _left_out(found: Results) -> list[str]:
    """What is not in the chart, and why."""
    reasons: dict[str, list[str]] = {}
    for row in found.rows:
        if row.why_not:
            method = row.setting.method
            whole = found.state.cannot.get(method)
            reasons.setdefault(f"{method}: {row.why_not}" if whole else row.why_not, []).append(row.setting.name)
    lines = []
    for reason, names in reasons.items():
        text = reason if reason.split(":")[0] in found.state.cannot else f"{', '.join(names)}: {reason}"
        lines += textwrap.wrap(text, 96, subsequent_indent="    ")
    return lines[:SHOWN]


def _best(found: Results) -> list[Row]:
    """The row of each method with its smallest error."""
    best: dict[str, Row] = {}
    for row in found.rows:
        if row.errors is None:
            continue
        held = best.get(row.setting.method)
        if held is None or held.errors is None or row.errors.rmse.least < held.errors.rmse.least:
            best[row.setting.method] = row
    return list(best.values())


def _flip_top(rows: list[Row]) -> float:
    """The top of HDR-FLIP's scale: what all but a hundredth of the worst map's pixels keep below."""
    return max([float(np.quantile(row.flip_map, 0.99)) for row in rows if row.flip_map is not None] + [0.05])


def _said(error: Measured) -> str:
    return f"{error.value:.2g}" if error.value is not None else f"≤ {error.at_most:.1g}"


def _png(figure: Figure) -> bytes:
    out = io.BytesIO()
    with _lock:
        figure.savefig(out, format="png")
    return out.getvalue()
