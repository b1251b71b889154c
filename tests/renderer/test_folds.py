"""Very many grooves: repeats folded into one period show what all the copies together would.

What does not fold is summed copy by copy, so the same grooves with folding switched off are the exact reference where
they are few enough; beyond, the fully sampled solid is, and closed forms. KINK, ONE and EVEN of geometry/folds.py bound
what a fold is wrong by, as a part of what is seen: 0.0008 and 0.0004 together at the most.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from itertools import pairwise
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

import schema
from renderer import pipeline
from renderer.compile import PatternCache, compile_scene, families, patterns
from renderer.footprint import Tile, flat_frames, footprints
from renderer.geometry import layout, query
from renderer.geometry.view import view_of
from renderer.raycast import Caster
from renderer.tables import LINE, Pattern

from .parts import alone
from .scenes import PALETTE, Floats, Json, rms

Plate = Callable[..., Json]
Check = Callable[[Json], schema.Scene]

BOUND = 0.0012 * 0.7 * 3.0 / math.pi  # of Lambert under an irradiance of 3
V = [[-0.35, 0.0], [0.05, -0.3], [0.35, 0.0]]
RIDGED = [[-0.3, 0.0], [-0.1, 0.2], [0.1, -0.25], [0.3, 0.0]]
FULL = [[-0.5, 0.0], [0.1, -0.4], [0.5, 0.0]]
SUN = {"type": "directional", "direction": [-1, 0.3, -0.6], "irradiance": [3, 3, 3]}
LOW = {"type": "directional", "direction": [1, 0.3, -0.2], "irradiance": [3, 3, 3]}
LAMP = {"type": "point", "position": [-0.9, 0.1, 0.8], "intensity": [3, 3, 3]}
FRONT = {"origin": [0, -1.5, 0.6], "target": [0, 0, 0], "fov": 25}
SIDE = {"origin": [-2.4, 0.3, 0.7], "target": [0, 0, 0], "fov": 25}


def scaled(profile: list[list[float]], d: float) -> Json:
    return {"type": "polyline", "points": [[b * d, w * d] for b, w in profile]}


def linear(count: int, profile: list[list[float]]) -> list[Json]:
    """So many grooves along q in two units of p."""
    d = 2.0 / count
    path = {"type": "polyline", "points": [[0.5 * d, -3], [0.5 * d, 5]]}
    return [{"path": path, "profile": scaled(profile, d), "repeat": {"type": "linear", "count": count, "step": [d, 0]}}]


def rings(count: int, profile: list[list[float]]) -> list[Json]:
    """So many rings about a place beside the plate, 4 to 6.9 units away; 2,500 at most: more compile for minutes."""
    count = min(count, 2500)
    d = 2.9 / count
    path = {"type": "circle", "center": [-4, 1], "radius": 4.0}
    repeat = {"type": "concentric", "count": count, "step": d}
    return [{"path": path, "profile": scaled(profile, d), "repeat": repeat}]


def tiled(count: int, profile: list[list[float]]) -> list[Json]:
    """A tile of five grooves, of which so many lie in two units of p."""
    d = 2.0 / count
    path = {"type": "polyline", "points": [[0.3 * d, 0], [0.3 * d, 5 * d]]}
    repeat = {"type": "linear", "count": 5, "step": [d, 0]}
    return [{"path": path, "profile": scaled(profile, d), "repeat": repeat, "ends": "flat"}]


KINDS = {"linear": linear, "concentric": rings, "tiled": tiled}


def scene_of(plate: Plate, kind: str, count: int, profile: list[list[float]], **parts: Any) -> Json:
    tile = [10.0 / count, 10.0 / count] if kind == "tiled" else None
    parts = {"lights": [SUN], "camera": FRONT} | parts
    return plate(KINDS[kind](count, profile), tile=tile, **parts)


def radiance_of(scene: schema.Scene, **options: Any) -> Floats:
    return pipeline.render(scene, threads=1, **options).radiance.astype(np.float64)


def without_folds(monkeypatch: pytest.MonkeyPatch) -> None:
    def never(*args: Any) -> tuple[NDArray[np.void], NDArray[np.void]]:
        found, members = families.dressed(*args)
        found["folds"] = 0
        return found, members

    monkeypatch.setattr(patterns, "dressed", never)


@pytest.mark.parametrize("kind", ["linear"])
@pytest.mark.parametrize("profile", [V, RIDGED, FULL], ids=["v", "ridged", "full"])
@pytest.mark.parametrize("camera", [FRONT, SIDE], ids=["front", "side"])
@pytest.mark.parametrize("light", [SUN, LOW, LAMP], ids=["sun", "low", "lamp"])
def test_a_fold_is_the_sum_of_its_copies(
    kind: str, profile: list[list[float]], camera: Json, light: Json, plate: Plate, check: Check,
    monkeypatch: pytest.MonkeyPatch,
) -> None:  # fmt: skip
    """Where the copies can be summed one by one, at 20 to 150 of them a pixel. The rims are in the picture."""
    scene = check(scene_of(plate, kind, 2500, profile, camera=camera | {"resolution": [40, 30]}, lights=[light]))
    folded = pipeline.render(scene, method="auto", threads=1)
    without_folds(monkeypatch)
    summed = pipeline.render(scene, method="auto", threads=1)
    both = (folded.aovs["method"] == LINE) & (summed.aovs["method"] == LINE)
    assert both.mean() > 0.15
    off = np.abs(folded.radiance - summed.radiance)[both]
    assert off.max() > 0.0
    assert off.max() < BOUND


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("profile", [V, RIDGED], ids=["v", "ridged"])
@pytest.mark.parametrize("count", [25000])
def test_many_grooves_against_samples(
    kind: str, profile: list[list[float]], count: int, plate: Plate, check: Check
) -> None:
    """Of two seeds the samples' noise s is measured: the picture is off by no more, its mean by s / sqrt(pixels)."""
    data = scene_of(plate, kind, count, profile, camera=FRONT | {"resolution": [16, 12]})
    one, other = (radiance_of(check(data | {"render": {"seed": k}}), method="csg", samples=64) for k in (1, 2))
    picture = pipeline.render(check(data), method="auto", threads=1)
    assert picture.shares["line"] > 0.8
    mine = picture.aovs["method"] == LINE
    noise = rms((one - other)[mine]) / math.sqrt(2.0)
    off = (picture.radiance - one)[mine]
    assert rms(off) < 1.1 * noise
    assert abs(off.mean()) < 4.0 * noise / math.sqrt(mine.sum()) + 0.0002


@pytest.mark.parametrize("method", ["auto", "line"])
@pytest.mark.parametrize("count", [250, 2500, 25000])
def test_whole_periods_from_straight_above(count: int, method: str, plate: Plate, check: Check) -> None:
    """A plate seen from afar shows the mean over a period: of each facet as much as it is wide."""
    d = 2.0 / count
    sun = {"type": "directional", "direction": [0, 0, -1], "irradiance": [math.pi, math.pi, math.pi]}
    materials = {"stone": {"base_color": [1, 1, 1], "specular": 0}}
    high = 20.0  # the plate's middle, 1/20 of it to a side: 12.5 periods of 250, 1250 of 25,000
    fov = 2.0 * math.degrees(math.atan(0.05 / high))
    camera = {"origin": [0, 0, high], "target": [0, 0, 0], "up": [0, 1, 0], "fov": fov, "resolution": [1, 1]}
    data = scene_of(plate, "linear", count, V, camera=camera, lights=[sun], materials=materials)
    if count == 250:  # 13 periods exactly
        data["camera"]["fov"] = 2.0 * math.degrees(math.atan(0.5 * 13 * d / high))
    found = radiance_of(check(data), method=method)[0, 0]
    mean = 1.0 - 0.7  # the plane's share, then the facets', each with the cosine of its slope
    for (b0, w0), (b1, w1) in pairwise(V):
        mean += (b1 - b0) ** 2 / math.hypot(b1 - b0, w1 - w0)
    assert np.abs(found - mean).max() < 1e-5  # half the angle of view, squared


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("profile", [V, RIDGED, FULL], ids=["v", "ridged", "full"])
@pytest.mark.parametrize("count", [25000])
def test_shares_sum_to_one(kind: str, profile: list[list[float]], count: int, plate: Plate, check: Check) -> None:
    """Plane and facets shine, each in a colour of its own."""
    dark = {"base_color": [0, 0, 0], "specular": 0}
    materials = {"stone": dark | {"emissive": [1, 0, 0]}, "brick": dark | {"emissive": [0, 1, 0]}}
    data = scene_of(plate, kind, count, profile, lights=[], materials=PALETTE | materials)
    data["patterns"]["cut"]["grooves"][0]["material"] = "brick"
    data["camera"] |= {"resolution": [24, 18]}
    for camera in (FRONT, SIDE):
        data["camera"] |= camera
        cover = radiance_of(check(data), method="base")[..., 0]
        found = radiance_of(check(data), method="auto", samples=4)
        assert (found >= -2e-6).all()
        assert np.abs(found.sum(axis=2) - cover).max() < 2e-6


@pytest.mark.parametrize("kind", ["linear", "concentric"])
def test_no_jump_where_folding_begins(kind: str, plate: Plate, check: Check, monkeypatch: pytest.MonkeyPatch) -> None:
    """As the camera backs away the periods under a pixel grow from 3 to 60: folded or not, it shows the same."""
    data = scene_of(plate, kind, 2500, RIDGED, lights=[SUN, LAMP])
    cache, exact = PatternCache(), PatternCache()
    for distance in np.geomspace(0.5, 8.0, 25):
        origin = [-0.3 * distance, -0.6 * distance, 0.5 * distance]
        data["camera"] |= {"origin": origin, "target": [0.02, 0, 0], "fov": 1.0, "resolution": [3, 3]}
        scene = check(data)
        folded = radiance_of(scene, method="auto", patterns=cache)
        with monkeypatch.context() as patched:
            without_folds(patched)
            summed = radiance_of(scene, method="auto", patterns=exact)
        assert np.abs(folded - summed).max() < BOUND


def looked_at(plate: Plate, check: Check, kind: str, count: int, profile: list[list[float]]) -> list[int]:
    """How many grooves are laid out for each footprint of a picture, -1 where they are not folded."""
    scene = check(scene_of(plate, kind, count, profile, camera=FRONT | {"resolution": [16, 12]}))
    compiled = compile_scene(scene, (16, 12), PatternCache(), None)
    pattern, camera, lights = compiled.patterns[0], compiled.camera, compiled.lighting.lights
    caster = Caster(compiled.objects, compiled.triangles)
    seen = footprints(
        caster, camera, lights, Tile(0, 0, 16, 12), flat_frames(caster, camera.origin), np.zeros((1, 2)), 1.0, 0
    )
    work = alone(layout.work_for)(pattern, len(lights))
    towards, meet, fold = alone(view_of), alone(layout.meet_lights), alone(layout.fold_within)
    found = []
    for footprint in seen.footprints:
        frame = seen.frames[footprint["frame"]]
        view = towards(footprint, frame, camera)
        meet(False, pattern, frame, view, footprint["blocked"], lights, work)
        rows, entries, _, _ = fold(False, 0.0, pattern, frame, view, lights, work)
        found.append(rows + entries if rows else -1)
    return found


@pytest.mark.parametrize("kind", ["linear", "tiled"])
@pytest.mark.parametrize("profile", [V, RIDGED], ids=["v", "ridged"])
def test_what_is_looked_at_does_not_grow(kind: str, profile: list[list[float]], plate: Plate, check: Check) -> None:
    """Ten times as many grooves, and ten times more, and no more of them are laid out for a footprint."""
    few, many, more = (looked_at(plate, check, kind, n, profile) for n in (5000, 50000, 200000))
    assert np.mean(np.array(few) > 0) > 0.9
    assert max(more) <= max(few)
    assert max(many) <= max(few)
    assert max(few) < 100


# --- which grooves are families ---


def compiled(grooves: list[Json], tile: list[float] | None = None) -> Pattern:
    return PatternCache().pattern(schema.Pattern.model_validate({"tile": tile, "grooves": grooves})).tables


def test_families_of_repeats() -> None:
    row = compiled(linear(250, V)).families
    assert row["period"] == pytest.approx([0.008])
    assert row["count"] == [250]
    assert row["folds"] == [1]
    ring = compiled(rings(100, V)).families
    assert ring["radius"] == pytest.approx([4.0 + 99 * 0.029])
    assert ring["period"] == pytest.approx([0.029])
    tile = compiled(tiled(100, V), [0.1, 0.1]).families
    assert tile["period"] == pytest.approx([0.02])  # a fifth of the tile
    assert np.isinf(tile["count"]).all()


def test_two_repeats_that_take_turns_are_one_family() -> None:
    grooves = [linear(100, [[0.4 * b, w] for b, w in V])[0], linear(100, [[0.4 * b, -w] for b, w in V])[0]]
    grooves[1]["path"] = {"type": "polyline", "points": [[0.02, -3], [0.02, 5]]}
    pattern = compiled(grooves)
    assert len(pattern.families) == 1
    assert len(pattern.members) == 2
    assert pattern.families["folds"] == [1]
    assert len(pattern.rest.items) == 0


@pytest.mark.parametrize(
    "change",
    [
        {"profile": scaled([[-0.6, 0.0], [0.0, -0.3], [0.6, 0.0]], 0.008)},
        {"scale": {"type": "sine", "amplitude": 0.5, "periods": 3}},
        {"profile": scaled([[-0.2, 0.0], [-0.3, -0.3], [0.3, -0.3], [0.2, 0.0]], 0.008)},
        {"profile": scaled([[-0.5, 0.0], [-0.5, -0.3], [0.5, -0.3], [0.5, 0.0]], 0.008)},
    ],
    ids=["overlap", "scale", "overhang", "no wall between"],
)
def test_what_does_not_fold(change: Json) -> None:
    assert compiled([linear(250, V)[0] | change]).families["folds"].tolist() == [0]


def test_other_grooves_are_the_rest() -> None:
    other = {"path": {"type": "polyline", "points": [[0, 0], [1, 1], [1, 0]]}, "profile": scaled(V, 0.1)}
    pattern = compiled([other, linear(250, V)[0]])
    assert set(pattern.rest.items) == {0, 1}


def test_a_scratch_across_a_family_is_not_folded_away(plate: Plate, check: Check) -> None:
    data = scene_of(plate, "linear", 2500, V, camera=FRONT | {"resolution": [32, 24]})
    plain = pipeline.render(check(data), method="auto", threads=1)
    data["patterns"]["cut"]["grooves"].append(
        {"path": {"type": "polyline", "points": [[0.5, 1.0], [1.5, 1.05]]}, "profile": scaled(V, 0.05)}
    )
    picture = pipeline.render(check(data), method="auto", threads=1)
    scratched = np.abs(picture.radiance - plain.radiance).max(axis=2) > 0.0
    assert 0.01 < scratched.mean() < 0.3
    rows = np.pad(scratched.any(axis=1), 1)
    apart = ~(rows[:-2] | rows[1:-1] | rows[2:])  # what is next to it may come to `area`, which sees the same
    assert apart.sum() > 10
    assert (picture.aovs["method"] == plain.aovs["method"])[apart].all()


# --- the query ---


@pytest.mark.parametrize("tile", [None, [0.5, 0.4]])
def test_a_query_gives_each_piece_once_and_scans_what_it_reaches(tile: list[float] | None) -> None:
    """Each piece once a repetition, all of those in reach, and nothing for a rectangle beside the paths."""
    grooves = [
        {"path": {"type": "svg", "d": "M0.1,0.1 C0.2,0.6 0.3,-0.2 0.4,0.3"}, "profile": scaled(V, 0.02),
         "repeat": {"type": "scatter", "count": 20, "seed": 1, "bounds": [0, 0, 1, 1]}},
        linear(40, V)[0],
    ]  # fmt: skip
    pattern = compiled(grooves, tile)
    find = alone(query.find)
    found = alone(query.nearby)(pattern, 1 << 20)
    random = np.random.default_rng(3)
    for _ in range(200):
        x, y = random.uniform(-1, 2, 2)
        w, h = random.uniform(0, 0.3, 2)
        count = find(pattern, found, x, y, x + w, y + h, 1 << 20)
        keys = {(int(found.piece[k]), *found.shift[k].tolist()) for k in range(count)}
        assert len(keys) == count
        grid = pattern.grid
        for piece, dx, dy in keys:  # each is listed in a cell that the rectangle meets
            low = np.clip(((x - dx, y - dy) - grid.origin) // grid.cell, 0, grid.shape - 1).astype(int)
            high = np.clip(((x + w - dx, y + h - dy) - grid.origin) // grid.cell, 0, grid.shape - 1).astype(int)
            cells = [iy * grid.shape[0] + ix for iy in range(low[1], high[1] + 1) for ix in range(low[0], high[0] + 1)]
            assert any(piece in grid.items[grid.first[c] : grid.first[c + 1]] for c in cells)
    if tile is None:
        assert find(pattern, found, 50.0, 50.0, 51.0, 51.0, 1 << 20) == 0
        assert found.query[0] < 201  # rectangles beside the paths' bounds look at no cell at all
