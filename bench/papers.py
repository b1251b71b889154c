"""The figures of paper 000 again, and its Table 1 beside what is measured here; writes docs/PAPERS.md.

The report compares its method with the solid as geometry at 8 samples a pixel (16 for figure 16), at equal samples: as
near to the truth as that is. Here the same is done, and the times are compared at equal error as well, each against a
converged reference. It is a chart a figure: see `service/chart`.
"""

from __future__ import annotations

import io
import math
import tempfile
from collections.abc import Callable
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from PIL import Image

import schema
from bench import figures
from bench.report import Line, at_least, at_most
from bench.scenes import EXAMPLES, Floats, load
from renderer import film
from service import outputs
from service.chart import make
from service.chart.compare import equal
from service.chart.machine import machine
from service.chart.report import Results, Row, document, points, results, words
from service.chart.run import Plan
from service.chart.settings import Setting

DOCS = EXAMPLES.parent / "docs"
PAGE = DOCS / "PAPERS.md"
SIZE = (320, 240)
QUALITY = 88  # of the JPEG pictures
KB = 1024
LADDER = (4, 16, 64, 256)  # samples of geometry's curve
# Where rays go from object to object.
AUTO = tuple(Setting("auto", 4096, tolerance=tolerance) for tolerance in (0.01, 0.05, 0.02))
GLASS = (Setting("csg", 64), *AUTO)

INTRODUCTION = """# The report's figures again

Written by `python -m bench papers` on {day}, commit {commit}: {processor}, {cores} cores, load {load}; pictures of
{width} x {height} pixels. The report is C. Bosch, X. Pueyo, S. Mérillou, D. Ghazanfarpour: *General rendering of
grooved surfaces*, 2006. Its scenes are not published: ours are made after its figures. It ran on a Pentium 4 at
1.6 GHz, at a resolution that it does not tell, and its geometry was traced by Maya where ours is by Embree on all
cores. So compare gains, not seconds.

## At equal samples, as the report has it

Its Table 1: the method's time and memory, those of the solid as geometry at 8 samples a pixel (16 for figure 16), and
the second over the first.
"""
EQUAL_ERROR = """## At equal error

Root mean square errors of linear radiance without the reference's noise; `≤` where the reference does not resolve it.
The report gives no errors.
"""


class Said(NamedTuple):
    """A row of the report's Table 1: seconds and KB of its method and of geometry; None: not given."""

    seconds: float
    kilobytes: float
    geometry_seconds: float | None = None
    geometry_kilobytes: float | None = None


class Case(NamedTuple):
    """A figure."""

    figure: str
    said: Said | None
    note: str
    scene: schema.Scene
    settings: tuple[Setting, ...]  # the first one is what stands in the table
    samples: int  # of geometry, as the report had it
    budget: float  # seconds
    meshes: Callable[[str], bytes] | None = None


def cases() -> list[Case]:
    """The figures of Table 1 that can be compared."""
    parallel, tiles, vinyl = load("parallel"), load("tiles"), load("vinyl")
    auto, rough = Setting("auto", tolerance=0.002), Setting("auto", tolerance=0.02)
    return [
        Case("14", Said(26, 16, 289, 656), "250 parallel grooves", parallel,
             (Setting("line"), Setting("segment"), *_geometry(8)), 8, 80.0),
        Case("15", Said(47, 14, 202, 4232), "crossing grooves", tiles,
             (auto, rough, Setting("area"), *_geometry(8)), 8, 110.0),
        Case("16 (a)", Said(20, 14, 71, 4232), "figure 15's floor from farther away, two near point lights",
             figures.farther(), (auto, rough, Setting("area"), *_geometry(16)), 16, 110.0),
        Case("16 (b)", Said(13, 14, 71, 4232), "the same, by two line samples",
             figures.farther(), (Setting("lines", 2), Setting("lines", 8), Setting("area"), *_geometry(16)), 16, 110.0),
        Case("17", Said(46, 16, 387, 656), "figure 14 with one mirror bounce inside the grooves", figures.polished(),
             (Setting("line"), Setting("segment"), *_geometry(8)), 8, 110.0),
        Case("15, mirrored", None, "figure 15's tiles as mirrors, one bounce: no figure of the report",
             figures.mirrors(), (auto, rough, Setting("csg", 64), *_geometry(8)), 8, 110.0),
        Case("19", Said(31, 486), "records of 500 circles; the report's top left", vinyl,
             (rough, auto, Setting("line"), Setting("csg", 1), Setting("csg", 4),
              Setting("csg", 16), Setting("geometry", 8)), 8, 90.0),
        Case("20 (b)", Said(164, 149), "a grooved glass, what it reflects", figures.glass(2, transmits=False),
             (*GLASS, *_geometry(8)), 8, 150.0),
        Case("20 (c)", Said(290, 149), "what shows through it", figures.glass(6, reflects=False),
             (*GLASS, *_geometry(8)), 8, 150.0),
        Case("20 (d)", Said(382, 149), "both", figures.glass(6), (*GLASS, *_geometry(8)), 8, 150.0),
        Case("11 (2008)", None, "a grooved ball of glass, of the paper of 2008", figures.ball(),
             (*GLASS, *_geometry(8)), 8, 150.0),
        Case("20, polished", None, "the floor of figure 20 as a mirror, one bounce: no figure of the report",
             figures.polished_floor(), (*AUTO, Setting("csg", 64), *_geometry(8)), 8, 110.0),
        Case("21", Said(81, 863), "a house: nine grooved objects, in a pool and in windows", load("house"),
             (*AUTO, *_geometry(8)), 8, 90.0, lambda name: (EXAMPLES / name).read_bytes()),
    ]  # fmt: skip


def measure() -> tuple[list[Line], dict[str, Any]]:
    """All figures; writes the page and its pictures."""
    lines: list[Line] = []
    details: dict[str, Any] = {}
    done: list[tuple[Case, Results]] = []
    about = machine()
    for case in cases():
        print(f"  figure {case.figure} ...", flush=True)
        plan = Plan(case.scene, SIZE, case.settings, case.budget, _threads(), case.meshes)
        with tempfile.TemporaryDirectory() as folder:
            found = results(plan, make.measure(plan, Path(folder), lambda: False))
        details[case.figure] = document(found)
        lines += _lines(case, found)
        outputs.write(DOCS / "pictures" / _file(case), _picture(case, found))
        done.append((case, found))
    outputs.write(PAGE, page(done, about).encode())
    return lines, details


def _lines(case: Case, found: Results) -> list[Line]:
    """What is measured, beside the goals that there are."""
    row = found.rows[0]
    if row.errors is None:
        return []
    name = f"figure {case.figure}: {row.setting.name}"
    error = row.errors.rmse
    goal = {"14": 0.0008, "15": 0.004, "17": 0.0015}.get(case.figure)
    bound = "" if error.value is not None else " at most"
    what = f"{name}, RMSE{bound}"
    lines = [at_most(what, error.least, goal) if goal else Line(what, error.least), Line(name, row.seconds, "s")]
    rival, needed = _rival(found)
    if needed is not None:
        times = needed / row.seconds
        label = f"{name} is so many times faster than {rival} at equal error"
        least = {"14": 200, "17": 50}.get(case.figure)
        lines.append(at_least(label, times, least) if least else Line(label, times))
    return [*lines, Line(f"figure {case.figure}: the reference's floor", found.floor)]


def _rival(found: Results) -> tuple[str, float | None]:
    """What is compared with at equal error, and the seconds that it takes; None: never, or not known."""
    row = found.rows[0]
    for rival in ("geometry", "csg"):
        curve = points(found.rows, rival)
        if curve and row.errors is not None:
            return rival, equal(curve, row.errors.rmse.least).seconds
    return "geometry", None


def page(done: list[tuple[Case, Results]], about: dict[str, object]) -> str:
    """docs/PAPERS.md. about: the machine, before it all began."""
    parts = [
        INTRODUCTION.format(width=SIZE[0], height=SIZE[1], day=str(about["date"])[:10], **about),
        "| figure | | report: s | here: s | report: KB | here: KB |",
        "| --- | --- | --- | --- | --- | --- |",
        *(_samples_row(case, case.said, found) for case, found in done if case.said),
        "",
        EQUAL_ERROR,
        "| figure | method | RMSE | s | geometry at the report's samples: RMSE | at equal error |",
        "| --- | --- | --- | --- | --- | --- |",
        *(_error_row(case, found) for case, found in done),
        "",
        "## Pictures",
        "",
        *(line for case, found in done for line in _shown(case, found)),
    ]
    return "\n".join(parts).rstrip() + "\n"


def _samples_row(case: Case, said: Said, found: Results) -> str:
    start = f"| {case.figure} | {case.note} "
    time_said, memory_said = _gain(said.seconds, said.geometry_seconds), _gain(said.kilobytes, said.geometry_kilobytes)
    ours, theirs = found.rows[0], _geometry_row(case, found)
    records = found.state.records
    ours_kb = records[ours.setting.name].bytes / KB if ours.setting.name in records else None
    theirs_kb = records[theirs.setting.name].bytes / KB if theirs and theirs.setting.name in records else None
    time = _gain(ours.seconds, theirs.seconds if theirs else None)
    return f"{start}| {time_said} | {time} | {memory_said} | {_gain(ours_kb, theirs_kb)} |"


def _error_row(case: Case, found: Results) -> str:
    row, other = found.rows[0], _geometry_row(case, found)
    start = f"| {case.figure} | `{row.setting.name}` "
    if row.errors is None:
        return f"{start}| – | – | – | no reference |"
    theirs = _error(other) if other is not None else "–"
    told = [words(one) for one in found.comparisons if one.row is row]
    rival, needed = _rival(found)
    if not told and needed is not None:  # another setting of the method comes nearer still
        told = [f"{needed / row.seconds:,.0f} times faster than {rival}"]
    cannot = found.state.cannot.get("geometry")
    why = f"; geometry cannot: {cannot}" if cannot else ""
    return f"{start}| {_error(row)} | {row.seconds:.3g} | {theirs} | {(told or ['–'])[0]}{why} |"


def _shown(case: Case, found: Results) -> list[str]:
    other = _geometry_row(case, found)
    right = f"right: geometry, {case.samples} samples, {other.seconds:.2g} s" if other else "right: the reference"
    row = found.rows[0]
    return [
        f"**Figure {case.figure}.** {case.note[0].upper()}{case.note[1:]}. Left: `{row.setting.name}`, "
        f"{row.seconds:.2g} s; {right}.",
        "",
        f"![Figure {case.figure}](pictures/{_file(case)})",
        "",
    ]


def _picture(case: Case, found: Results) -> bytes:
    """Ours and geometry's, or the reference's, side by side."""
    other = _geometry_row(case, found)
    records = found.state.records
    left: Floats = records[found.rows[0].setting.name].first.astype(np.float64)
    right = records[other.setting.name].first if other is not None else found.state.reference.mean
    both = np.concatenate([left, right], axis=1).astype(np.float32)
    exposure = np.float32(found.plan.scene.render.exposure)
    out = io.BytesIO()
    Image.fromarray(film.srgb(both * exposure), "RGB").save(out, "JPEG", quality=QUALITY)
    return out.getvalue()


def _geometry_row(case: Case, found: Results) -> Row | None:
    """Geometry at the report's samples; None where it could not."""
    wanted = Setting("geometry", case.samples).name
    return next((r for r in found.rows if r.setting.name == wanted and not math.isnan(r.seconds)), None)


def _geometry(samples: int) -> tuple[Setting, ...]:
    return tuple(Setting("geometry", count) for count in sorted({*LADDER, samples}))


def _error(row: Row) -> str:
    if row.errors is None:
        return "–"
    error = row.errors.rmse
    return f"{error.value:.2g}" if error.value is not None else f"≤ {error.at_most:.1g}"


def _gain(ours: float | None, theirs: float | None) -> str:
    """Ours, theirs, and how many times that is."""
    if ours is None:
        return "–"
    if theirs is None:
        return f"{ours:.3g}"
    return f"{ours:.3g}, {_number(theirs)}: x {_number(theirs / ours)}"


def _number(value: float) -> str:
    return f"{value:,.0f}" if value >= 100 else f"{value:.3g}"


def _file(case: Case) -> str:
    return "figure-" + "".join(c for c in case.figure if c.isalnum()) + ".jpg"


def _threads() -> int:
    cores = machine()["cores"]
    return cores if isinstance(cores, int) else 1
