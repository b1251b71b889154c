"""chart.json: all that was measured, as one object.

| key | |
| --- | --- |
| state | complete, or stopped: the same command goes on |
| machine | date, commit, processor, cores, load, versions |
| resolution, pixels, threads, budget, seconds | of the run; errors are over the pixels `inside`, see `run.State` |
| load | processes that ran beside it: above the number of cores, the seconds are too many |
| seeds | the first of the methods' and of the reference's pictures: picture n has n more |
| reference | method, passes, samples a pass; `noise` (RMSE), `floor`, `smallest` as in `measure`; `bias`: `own_bias` |
| rows | a setting each, with `cannot` (why), or `dear` (left out: seconds it would take), or numbers |
| equal | what a rival needs for a method's smallest error: see `compare` |

In a row: `seconds` the median of `runs` frames, kernels warm, patterns compiled; `prepare` seconds of what is done once
(patterns, meshes, textures); `bytes` of the representation; `rmse`, `bias`, `mrse`, `flip` each as `value`, null where
the reference does not resolve it, and `at_most`; `sigma` the standard deviation from seed to seed (null: one picture);
`all_pixels` the RMSE with silhouettes and all.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from renderer import CACHE
from renderer.trace import OFFSET
from service.chart import measure
from service.chart.compare import Equal, Point, equal
from service.chart.flip import exposures, flip
from service.chart.machine import machine
from service.chart.measure import Errors, Measured
from service.chart.run import Plan, State, sampled
from service.chart.settings import MINE, REFERENCE, Setting

RIVALS = ("geometry", "csg", "relief")
GRAIN_SEED = 0  # of the noise that HDR-FLIP's floor is taken from


@dataclass
class Row:
    """One setting's results; errors, flip: None where there is no reference or no picture yet."""

    setting: Setting
    why_not: str = ""
    seconds: float = math.nan
    errors: Errors | None = None
    everywhere: Measured | None = None  # the RMSE of all pixels
    flip: Measured | None = None
    flip_map: NDArray[np.float32] | None = None


@dataclass
class Comparison:
    """A method at its smallest error against a rival."""

    row: Row
    rival: str
    equal: Equal

    @property
    def times(self) -> float | None:
        """How many times faster; None: the rival never gets there."""
        return None if self.equal.seconds is None else self.equal.seconds / self.row.seconds


@dataclass
class Results:
    """All that the chart shows."""

    plan: Plan
    state: State
    rows: list[Row]
    noise: float
    floor: float
    flip_floor: float
    comparisons: list[Comparison]


def results(plan: Plan, state: State) -> Results:
    """Errors of all that was rendered, against the reference as it is now."""
    reference, mask = state.reference, state.inside
    ready = reference.count > 1 and mask is not None and bool(mask.any())
    stops = exposures(reference.mean) if ready else None
    flip_floor = math.inf
    if ready and mask is not None and stops is not None:
        # As much noise again as the reference has.
        grain = np.random.Generator(np.random.PCG64(GRAIN_SEED)).standard_normal((*mask.shape, 1))
        noisy = reference.mean + grain * np.sqrt(reference.variance / reference.count)
        flip_floor = float(flip(reference.mean, noisy, stops)[mask].mean())
    rows = []
    for setting in plan.settings:
        row = Row(setting)
        rows.append(row)
        record = state.records.get(setting.name)
        if record is None:
            reason = state.cannot.get(setting.method) or state.cannot.get(setting.name)
            if reason:
                row.why_not = f"cannot: {reason}"
            elif setting.name in state.dear:
                row.why_not = f"left out: would take {state.dear[setting.name]:.0f} s of the budget"
            else:
                row.why_not = "not yet"
            continue
        row.seconds = record.median
        if not ready or mask is None:
            continue
        row.errors = measure.errors(record, reference, mask, sampled(setting))
        row.everywhere = measure.errors(record, reference, np.ones_like(mask), sampled(setting)).rmse
        if stops is not None:
            row.flip_map = flip(reference.mean, record.first.astype(np.float64), stops)
            value = float(row.flip_map[mask].mean())
            row.flip = Measured(value if value >= measure.FIFTH * flip_floor else None, value + flip_floor)
    noise = measure.noise(reference, mask) if ready and mask is not None else math.inf
    floor = measure.floor(reference, mask) if ready and mask is not None else math.inf
    return Results(plan, state, rows, noise, floor, flip_floor, comparisons(rows))


def comparisons(rows: list[Row]) -> list[Comparison]:
    """Every method but `base` at its smallest error against every sampled rival."""
    found = []
    for method in dict.fromkeys(row.setting.method for row in rows):
        mine = [row for row in rows if row.setting.method == method and row.errors is not None]
        if method in ("base", "geometry") or not mine:
            continue
        best = min(mine, key=lambda row: (_error(row), row.seconds))
        for rival in RIVALS:
            curve = points(rows, rival)
            if rival != method and curve:
                found.append(Comparison(best, rival, equal(curve, _error(best))))
    return found


def points(rows: list[Row], method: str) -> list[Point]:
    """The curve of a sampled method: of its number of texels that comes nearest to the truth."""
    mine = [row for row in rows if row.setting.method == method and row.errors is not None and row.setting.samples]
    if not mine:
        return []
    best = min(mine, key=lambda row: _error(row))
    return [
        Point(
            row.setting.samples or 1, row.seconds, row.errors.rmse.value,
            row.errors.bias.value or 0.0 if row.errors.bias else 0.0,
        )
        for row in mine
        if row.errors is not None and row.errors.rmse.value is not None and row.setting.texels == best.setting.texels
    ]  # fmt: skip


def _error(row: Row) -> float:
    return row.errors.rmse.least if row.errors else math.inf


def document(found: Results) -> dict[str, Any]:
    """chart.json."""
    plan, state = found.plan, found.state
    reference = state.reference
    return {
        "chart": 1,
        "state": "complete" if state.finished else "stopped",
        "machine": machine() | {"kernels": CACHE.name},
        "resolution": plan.resolution,
        "pixels": {"inside": int(state.inside.sum()) if state.inside is not None else 0,
                   "all": plan.resolution[0] * plan.resolution[1]},
        "threads": plan.threads,
        "load": state.load,
        "budget": plan.budget,
        "seconds": state.spent,
        "seeds": {"methods": MINE, "reference": REFERENCE},
        "reference": {
            "method": state.method,
            "passes": reference.count,
            "samples": reference.samples,
            "seconds": reference.wall,
            "noise": _finite(found.noise),
            "floor": _finite(found.floor),
            "smallest": _finite(measure.FIFTH * found.floor),
            "flip_floor": _finite(found.flip_floor),
            "start_offset": OFFSET if state.method == "geometry" else None,
            "bias": own_bias(plan, state),
        },
        "mrse_epsilon": measure.EPSILON,
        "rows": [_row(row, state) for row in found.rows],
        "equal": [_comparison(one) for one in found.comparisons],
    }  # fmt: skip


def own_bias(plan: Plan, state: State) -> dict[str, float] | None:
    """The bias of the reference `geometry`, of single precision and of where its shadow rays start, free of noise:
    `csg` draws the very same samples for a seed and meets them in double precision, where grooved objects are flat.

    None where no setting of both with as many samples has been measured, or a grooved object is curved.
    """
    curved = any(item.pattern is not None and item.shape.type != "rectangle" for item in plan.scene.objects)
    if state.method != "geometry" or state.inside is None or curved:
        return None
    counts = [s.samples for s in plan.settings if s.method == "csg" and s.samples and s.name in state.records]
    for samples in sorted(counts, reverse=True):
        pair = [state.records.get(Setting(method, samples).name) for method in ("geometry", "csg")]
        if pair[0] is not None and pair[1] is not None:
            off = pair[0].first.astype(np.float64) - pair[1].first
            return {"samples": samples, "mean": float(off[state.inside].mean())}
    return None


def _row(row: Row, state: State) -> dict[str, Any]:
    setting = row.setting
    told: dict[str, Any] = {
        "name": setting.name, "method": setting.method, "samples": setting.samples, "texels": setting.texels,
        "tolerance": setting.tolerance,
    }  # fmt: skip
    record = state.records.get(setting.name)
    if record is None:
        key = "dear" if setting.name in state.dear else "cannot" if row.why_not.startswith("cannot") else "waits"
        return told | {key: row.why_not.removeprefix("cannot: ")}
    told |= {
        "seconds": row.seconds, "runs": record.seconds, "prepare": record.prepare,
        "bytes": record.bytes, "pictures": record.count,
    }  # fmt: skip
    if row.errors is None:
        return told
    errors = row.errors
    return told | {
        "rmse": errors.rmse._asdict(),
        "bias": errors.bias._asdict() if errors.bias else None,
        "sigma": errors.sigma,
        "mrse": errors.mrse._asdict(),
        "flip": row.flip._asdict() if row.flip else None,
        "all_pixels": {"rmse": row.everywhere._asdict() if row.everywhere else None},
    }


def _comparison(one: Comparison) -> dict[str, Any]:
    errors = one.row.errors
    return {
        "setting": one.row.setting.name,
        "rival": one.rival,
        "rmse": errors.rmse._asdict() if errors else None,
        "seconds": one.row.seconds,
        "how": one.equal.how,
        "rival_samples": one.equal.samples,
        "rival_seconds": one.equal.seconds,
        "slope": one.equal.slope,
        "times": one.times,
        "at_least": errors is not None and errors.rmse.value is None,
        "words": words(one),
    }


def words(one: Comparison) -> str:
    """A comparison as a sentence."""
    errors = one.row.errors
    assert errors is not None
    bound = errors.rmse.value is None
    error = f"{'≤ ' if bound else ''}{errors.rmse.least:.2g}"
    name = one.row.setting.name
    if one.times is None:
        return f"{one.rival} never gets to {name}'s error ({error})"
    if not bound and 0.95 < one.times < 1.05:
        return f"{name} is as fast as {one.rival} at equal error ({error})"
    faster = one.times if one.times >= 1.0 else 1.0 / one.times
    amount = f"{'at least ' if bound and one.times >= 1.0 else ''}{_round(faster)} times"
    how = {
        "measured": "",
        "extrapolated": f", extrapolated to {_round(one.equal.samples or 0.0)} samples",
        "already": ", whose cheapest setting is as good already",
    }[one.equal.how]
    compared = "faster" if one.times >= 1.0 else "slower"
    return f"{name} is {amount} {compared} than {one.rival} at equal error ({error}{how})"


def _round(number: float) -> str:
    """Two digits, thousands apart."""
    if number < 10.0:
        return f"{number:.1f}"
    digits = 10.0 ** (math.floor(math.log10(number)) - 1)
    return f"{round(number / digits) * digits:,.0f}"


def _finite(number: float) -> float | None:
    return number if math.isfinite(number) else None
