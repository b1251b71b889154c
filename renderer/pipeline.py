"""The driver: a frame is a pipeline of stages over the footprints of a tile (DESIGN, section 2).

Tiles run on a pool of threads. A pixel depends on its place alone, so that pictures are the same for any number of
threads and any size of tile.
"""

from __future__ import annotations

import functools
import math
import os
import subprocess
import sys
import time
from collections.abc import Callable
from concurrent.futures import FIRST_COMPLETED, Future, ThreadPoolExecutor, wait
from dataclasses import dataclass, field, replace
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

import schema
from renderer import CACHE, body, bounce, film, mirror, relief, shading
from renderer.area import ALL, REFLECTED, area_sampling, in_blocks
from renderer.compile import CompiledScene, PatternCache, compile_scene, table_bytes
from renderer.csg import MOST, csg
from renderer.errors import Cancelled, Fault, RenderError
from renderer.footprint import Footprints, Tile, flat_frames, footprints, footprints_within
from renderer.geometry.random import EIGHTHS
from renderer.geometry.strips import STRIPS
from renderer.line import LOOSE, PAPER, STRICT, line
from renderer.lines import line_sampling
from renderer.raycast import Caster, Mirrored
from renderer.relief import Textures
from renderer.sampling import EDGE, EVEN, FIRST, sampled, whiteness
from renderer.shading import DIFFUSE, GLOSSY, MIRROR, answers
from renderer.tables import AREA, BARE, BASE, CROWDED, CSG, MESH, NOT_MINE, RAY, Floats, Lighting, Pattern
from renderer.trace import Truth

TILE = 64  # pixels
RAYS = 1 << 14  # from one object to others, at a time
ROUGH = 0.03  # the error that may be left on meshes' curved bases: next to the terminator light is wrong all over
FEW_STRIPS = 512  # `auto` samples where more are near: then that is faster,
FEWER_STRIPS = 64  # ... and where mirrors show them
MIRRORS = 4  # in one another are looked into, so many at most: what is deeper is left to rays
WEAK = 0.1  # the tolerance, at most, of what a weak mirror shows
MODES = {"auto": STRICT, "line": LOOSE, "segment": PAPER}  # of the kernel `line`; bare surfaces take it as it comes
METHODS = ("auto", "base", "segment", "line", "lines", "area", "csg", "geometry", "relief")

_READY = CACHE / "ready"  # written once all kernels have been compiled


@dataclass(frozen=True)
class Picture:
    """What a render gives."""

    radiance: NDArray[np.float32]  # (H, W, 3) linear
    # (H, W) method: indices of tables.METHODS; error: predicted, relative to a white surface in the same light, 0 where
    # nothing is known; cost: steps taken, in a unit of the method's own
    aovs: dict[str, film.Aov]
    # By stage, those of threads added up. By the clock: kernels (loading them), compile, solids (making what the method
    # traces in place of the patterns), total.
    seconds: dict[str, float]
    pattern_bytes: int  # memory of the compiled patterns
    shares: dict[str, float]  # by method, of the pixels that see an object
    solid_bytes: int = 0  # memory of the meshes or textures that the method renders in place of the patterns


class Settings(NamedTuple):
    """How to render."""

    method: str
    samples: int
    bounces: int
    seed: int
    texels: int
    tolerance: float
    mirrors: int = 0  # that are seen in one another before what is to be rendered


class Part(NamedTuple):
    """The footprints of one object in a tile."""

    row: int  # of OBJECT
    pattern: Pattern
    seen: Footprints
    lighting: Lighting
    radiance: Floats  # (n, 5) of all footprints: RGB, predicted error, cost
    method: NDArray[np.uint8]  # (n,)
    spent: dict[str, float]

    def took(self, name: str, start: float) -> None:
        """Add up the seconds since `start`."""
        self.spent[name] = self.spent.get(name, 0.0) + time.perf_counter() - start


@dataclass
class Frame:
    """A picture in the making."""

    scene: CompiledScene
    settings: Settings
    caster: Caster
    flat: dict[int, NDArray[np.void]]
    heights: Floats  # as `footprint.footprints` wants them: of methods that see what another object shades of a groove
    model: Truth | Textures | None  # what methods geometry and relief trace
    albedo: Floats
    radiance: NDArray[np.float32]
    method: NDArray[np.uint8]
    error: NDArray[np.float32]
    cost: NDArray[np.float32]
    seconds: dict[str, float] = field(default_factory=dict)

    def tile(self, tile: Tile) -> dict[str, float]:
        """Render one tile: the seconds of its stages."""
        scene, settings = self.scene, self.settings
        clock = time.perf_counter
        begin = clock()
        image = np.zeros((tile.width * tile.height, 5))
        methods = np.empty(tile.width * tile.height, np.uint8)
        if isinstance(self.model, Truth):
            self.model.render(
                settings.samples, settings.bounces, settings.seed, *tile, scene.camera, scene.lighting, scene.materials,
                scene.slots, self.albedo, image, methods,
            )  # fmt: skip
            self._put(tile, image, methods)
            return {"geometry": clock() - begin}
        seen = footprints(
            self.caster, scene.camera, scene.lighting.lights, tile, self.flat, self.heights, settings.tolerance,
            settings.seed,
        )  # fmt: skip
        spent = {"cast": clock() - begin}
        radiance, method = self._look(seen, spent)
        start = clock()
        film.develop(
            seen.footprints, radiance, method, tile.x, tile.y, tile.width, scene.camera, scene.lighting, image, methods
        )  # fmt: skip
        self._put(tile, image, methods)
        return spent | {"film": clock() - start}

    def _look(self, seen: Footprints, spent: dict[str, float]) -> tuple[Floats, NDArray[np.uint8]]:
        """What the camera sees in footprints: radiance, predicted error and cost (n, 5), and method (n,); add up the
        seconds of each stage."""
        scene, settings = self.scene, self.settings
        radiance = np.zeros((len(seen.footprints), 5))
        method = np.full(len(seen.footprints), BASE, np.uint8)
        of = seen.frames["object"][seen.footprints["frame"]]
        grooved = seen.frames["grooved"][seen.footprints["frame"]] != 0
        within = seen.frames["within"][seen.footprints["frame"]] != 0
        if within.any():
            self._look_out(seen, np.flatnonzero(within), radiance, method, spent)
        for row in np.unique(of[~within]):
            index = scene.objects["pattern"][row]
            carries = grooved & (index >= 0) & (settings.method != "base")
            for pattern, chosen in (
                (BARE, np.flatnonzero((of == row) & ~carries & ~within)),
                (scene.patterns[index] if index >= 0 else BARE, np.flatnonzero((of == row) & carries & ~within)),
            ):
                if len(chosen):
                    self._shade(row, pattern, seen, chosen, radiance, method, spent)
        return radiance, method

    @property
    def rays_go_on(self) -> bool:
        """Whether rays that have left a surface may meet one."""
        return self.caster.shadows or bool(self.scene.objects["clear"].any())

    def _rough(self, row: int) -> float:
        """The error that analytic methods may leave on an object's curved base. Of meshes rays do not know more."""
        return max(self.settings.tolerance, ROUGH if self.scene.objects["shape"][row] == MESH else 0.0)

    def _put(self, tile: Tile, image: Floats, methods: NDArray[np.uint8]) -> None:
        rows, columns = slice(tile.y, tile.y + tile.height), slice(tile.x, tile.x + tile.width)
        picture = image.reshape(tile.height, tile.width, 5)
        self.radiance[rows, columns] = picture[..., :3]
        self.error[rows, columns], self.cost[rows, columns] = picture[..., 3], picture[..., 4]
        self.method[rows, columns] = methods.reshape(tile.height, tile.width)

    def _shade(
        self, row: int, pattern: Pattern, seen: Footprints, chosen: NDArray[np.int64], radiance: Floats,
        method: NDArray[np.uint8], spent: dict[str, float],
    ) -> None:  # fmt: skip
        """Shade the footprints `chosen` of one object by the method asked for; add up the seconds of each kernel.

        Direct light is found as without bounces, and what comes from facet to facet and from other objects by samples;
        but for `csg`, which samples both at once, and what `line` knows in closed form.
        """
        scene, settings = self.scene, self.settings
        part = Part(row, pattern, seen, scene.lighting, radiance, method, spent)
        sampled = (seen.footprints["torn"][chosen] != 0) | (seen.footprints["open"][chosen] != 0)
        if sampled.any():
            self._sample(part, chosen[sampled], settings.bounces)
            chosen = chosen[~sampled]
        if settings.bounces == 0 or settings.method == "relief":
            self._direct(part, chosen)
            return
        if settings.method == "csg":
            self._sample(part, chosen, settings.bounces)
            return
        if not self.rays_go_on:
            start = time.perf_counter()
            exact = settings.method in ("lines", "area") and pattern is not BARE
            mode = STRICT if exact else MODES.get(settings.method, LOOSE)
            line(mode, self._rough(row), settings.bounces, pattern, seen.footprints, chosen, *self._of(part))
            part.took("line", start)
            chosen = chosen[method[chosen] == NOT_MINE]
        if len(chosen):
            lights, sky, around, _ = scene.lighting
            alone = Lighting(lights, np.zeros(3), left=float(sky.mean()) + around.white)
            shown = self._mirrors(part._replace(lighting=alone), chosen)
            left = chosen[method[chosen] != AREA]
            self._direct(part._replace(lighting=alone), left)
            shown = np.maximum(shown, self._others(part, chosen))
            self._sample(part, chosen[shown == REFLECTED], settings.bounces, indirect=True, shown=True)
            self._sample(part, chosen[shown == 0], settings.bounces, indirect=True)

    def _of(self, part: Part) -> tuple[Any, ...]:
        """What all kernels take after the footprints."""
        scene = self.scene
        return (
            part.seen.frames, scene.camera, part.lighting, scene.materials, scene.slots[part.row], self.albedo,
            part.radiance, part.method,
        )  # fmt: skip

    def _look_out(
        self, seen: Footprints, chosen: NDArray[np.int64], radiance: Floats, method: NDArray[np.uint8],
        spent: dict[str, float],
    ) -> None:  # fmt: skip
        """Shade the footprints `chosen` of clear bodies that the camera sees from within."""
        scene, settings = self.scene, self.settings
        start = time.perf_counter()
        method[chosen] = CSG

        def look(numbers: NDArray[np.int64], copies: Footprints, found: Floats) -> None:
            rays = np.zeros(np.diff(numbers).sum(), RAY)
            which = np.arange(len(numbers))
            bounce.look(numbers, settings.bounces, settings.seed, copies.footprints, which, scene.camera, rays)
            self._meet(rays, copies.footprints, found)

        self._converge(seen, chosen, 1, settings.bounces, look, radiance)
        spent["bounce"] = spent.get("bounce", 0.0) + time.perf_counter() - start

    def _most(self, bounces: int) -> int:
        """Samples of a pixel, at most, where rays go on: of `auto` with no bounces as many as bring an edge of a
        quarter of white within its tolerance at two deviations."""
        settings = self.settings
        if settings.method != "auto" or bounces > 0:
            return settings.samples
        return min(max(math.ceil(math.pow(EDGE / settings.tolerance, 1.0 / EVEN)), FIRST), MOST**2)

    def _converge(
        self, seen: Footprints, chosen: NDArray[np.int64], rays: int, bounces: int,
        sample: Callable[[NDArray[np.int64], Footprints, Floats], None], radiance: Floats,
    ) -> None:  # fmt: skip
        """Add to footprints' radiance, error and cost what samples find; `auto` takes as many as the tolerance asks.

        sample: adds to (EIGHTHS n, 5) the radiance of the samples `numbers` (n, 2) of the n footprints of a table, what
        is known of their error otherwise, and their cost; it needs room for so many `rays` a sample.
        """
        settings, footprints = self.settings, seen.footprints[chosen]
        adaptive = settings.method == "auto"
        otherwise, cost = np.zeros(len(chosen)), np.zeros(len(chosen))

        def draw(which: NDArray[np.int64], numbers: NDArray[np.int64]) -> Floats:
            found = np.zeros((len(which), EIGHTHS, 5))
            ends = np.flatnonzero(np.diff(np.cumsum(np.diff(numbers)[:, 0] * rays) // RAYS)) + 1
            for some in np.split(np.arange(len(which)), ends):
                copies = seen._replace(footprints=footprints[which[some]])
                sample(numbers[some], copies, found[some[0] : some[-1] + 1].reshape(-1, 5))
            otherwise[which] = np.maximum(otherwise[which], found[..., 3].max(axis=1))
            cost[which] += found[..., 4].sum(axis=1)
            return found[..., :3]

        made = sampled(
            footprints["pixel"], footprints["weight"],
            whiteness(seen.footprints, chosen, seen.frames, self.scene.camera, self.scene.lighting),
            settings.tolerance if adaptive else 0.0, self._most(bounces), draw,
        )  # fmt: skip
        radiance[chosen, :3] += made.mean
        radiance[chosen, 3] += made.error + otherwise
        radiance[chosen, 4] += cost

    def _meet(self, rays: NDArray[np.void], footprints: NDArray[np.void], radiance: Floats) -> None:
        """Add what RAYs see to their footprints' radiance."""
        scene = self.scene
        bounce.meet(
            rays, self.caster, scene.patterns, scene.slots, self.settings.seed, footprints, scene.lighting,
            scene.materials, self.albedo, radiance,
        )  # fmt: skip

    def _direct(self, part: Part, chosen: NDArray[np.int64]) -> None:
        """Shade footprints by the lights alone, and by all of the sky."""
        settings, pattern, footprints, method = self.settings, part.pattern, part.seen.footprints, part.method
        rest = self._of(part)
        rough = self._rough(part.row)
        if settings.method == "csg" and pattern is not BARE:
            self._sample(part, chosen)
            return
        start = time.perf_counter()
        if isinstance(self.model, Textures) and pattern is not BARE:
            relief.relief(settings.samples, settings.seed, self.model.of[part.row], footprints, chosen, *rest)
            part.took("relief", start)
            return
        if settings.method in ("lines", "area") and pattern is not BARE:
            left = chosen
        else:
            line(MODES.get(settings.method, LOOSE), rough, 0, pattern, footprints, chosen, *rest)
            part.took("line", start)
            left = chosen[method[chosen] == NOT_MINE]
        none = 0, part.lighting, np.zeros(0, np.uint8)  # of what `_mirrors` does
        most = FEW_STRIPS if settings.method == "auto" else STRIPS
        if len(left) and settings.method in ("lines", "area", "auto"):
            start = time.perf_counter()
            flat, ordered = int(part.row) in self.flat, in_blocks(footprints, left)
            if settings.method == "lines":
                line_sampling(
                    settings.samples, settings.seed, settings.tolerance, most, flat, pattern, footprints, ordered, *rest
                )
            else:
                area_sampling(settings.tolerance, rough, most, flat, *none, pattern, footprints, ordered, *rest)
            part.took("lines" if settings.method == "lines" else "area", start)
            left = left[method[left] >= CROWDED]
        crowded = left[method[left] == CROWDED]
        if len(crowded) and most < STRIPS:
            left = left[method[left] == NOT_MINE]
            self._sample(part, crowded, sparing=True)
            crowded = in_blocks(footprints, crowded[method[crowded] == NOT_MINE])
            start = time.perf_counter()  # with as many strips as there is room for, where samples do not do
            area_sampling(
                settings.tolerance, rough, STRIPS, int(part.row) in self.flat, *none, pattern, footprints, crowded,
                *rest,
            )  # fmt: skip
            part.took("area", start)
            left = np.concatenate([left, crowded[method[crowded] >= CROWDED]])
        if len(left):
            self._sample(part, left)

    def _mirrors(self, part: Part, chosen: NDArray[np.int64]) -> NDArray[np.uint8]:
        """Shade footprints by exact areas, direct light and what mirrors show: what of the latter is done (n,), none,
        REFLECTED or ALL."""
        scene, settings = self.scene, self.settings
        shown = np.zeros(len(part.seen.footprints), np.uint8)
        flat = int(part.row) in self.flat and part.pattern is not BARE
        follows = settings.method in ("auto", "area") and not self.rays_go_on
        part.method[chosen] = NOT_MINE
        if flat and follows and answers(scene.materials, scene.slots[part.row]) & MIRROR:
            start = time.perf_counter()
            area_sampling(
                settings.tolerance, self._rough(part.row), FEWER_STRIPS, True, settings.bounces, scene.lighting, shown,
                part.pattern, part.seen.footprints, in_blocks(part.seen.footprints, chosen), *self._of(part),
            )  # fmt: skip
            part.took("area", start)
        return shown[chosen]

    def _others(self, part: Part, chosen: NDArray[np.int64]) -> NDArray[np.uint8]:
        """Add what flat mirrors show of other objects to footprints: of which that is done (n,), none, REFLECTED or
        ALL."""
        scene, settings = self.scene, self.settings
        done = np.zeros(len(chosen), np.uint8)
        lights_on = answers(scene.materials, scene.slots[part.row][:1])
        if (
            not lights_on & MIRROR or settings.method not in ("auto", "area") or int(part.row) not in self.flat
            or not self.rays_go_on or scene.objects["clear"].any() or settings.mirrors == MIRRORS
        ):  # fmt: skip
            return done
        plain = mirror.shows_others(part.pattern, part.seen.footprints, chosen, part.seen.frames, scene.camera)
        obj, material = scene.objects[part.row], scene.materials[scene.slots[part.row][0]]
        camera, normal = mirror.camera_behind(scene.camera, obj), np.ascontiguousarray(obj["rotation"][:, 2])
        shapes = Mirrored(self.caster, int(part.row))
        flat = flat_frames(shapes, camera.origin)
        weak = mirror.weakness(part.seen.footprints, chosen, camera, normal, material)
        for power in np.unique(weak[plain]):
            tolerance = min(settings.tolerance * 2.0**power, WEAK)
            inner = replace(
                self,
                scene=scene._replace(camera=camera),
                settings=settings._replace(
                    bounces=settings.bounces - 1, tolerance=tolerance, mirrors=settings.mirrors + 1,
                    seed=settings.seed + int(part.row) + 1,
                ),
                flat=flat,
            )  # fmt: skip
            some = np.flatnonzero(plain & (weak == power))
            squares = part.seen.footprints[chosen[some]]
            start = time.perf_counter()
            seen = footprints_within(
                shapes, camera, scene.lighting.lights, squares, flat, self.heights, tolerance, inner.settings.seed
            )
            passes = np.zeros(len(some), np.bool_)  # outlines that rays may pass by are left to those
            passes[seen.footprints["pixel"][seen.footprints["open"] != 0]] = True
            plain[some[passes]] = False
            seen = seen._replace(footprints=seen.footprints[~passes[seen.footprints["pixel"]]])
            part.took("cast", start)
            found, _ = inner._look(seen, part.spent)
            mirror.reflect_shown(
                seen.footprints, found, camera, scene.lighting, normal, material, part.seen.footprints, chosen[some],
                passes, part.radiance,
            )  # fmt: skip
        done[plain] = REFLECTED if lights_on & (DIFFUSE | GLOSSY) else ALL
        return done

    def _sample(
        self, part: Part, chosen: NDArray[np.int64], bounces: int = 0, *, indirect: bool = False, shown: bool = False,
        sparing: bool = False,
    ) -> None:  # fmt: skip
        """Shade footprints by `csg`; rays go from facet to facet, and on to other objects if there are any.

        indirect: add what these bring to what is there; shown: but for what mirrors show. Of what is torn
        or open, all of `chosen` or nothing.
        """
        settings, footprints = self.settings, part.seen.footprints
        goes = self.rays_go_on and (bounces > 0 or bool(footprints["open"][chosen].any()))
        asks = len(part.lighting.lights) if not indirect and footprints["torn"][chosen].any() else 0
        if settings.method != "csg" and not goes and not asks and bounces == 0:
            start = time.perf_counter()
            none = np.zeros(0, RAY), np.zeros(1, np.int64)
            csg(
                np.zeros((0, 2), np.int64), 0, False, False, settings.tolerance, sparing, settings.seed, *none, *none,
                part.pattern, footprints, chosen, self.scene.objects, *self._of(part),
            )  # fmt: skip
            part.took("csg", start)
            return
        fine = settings.tolerance if settings.method == "auto" else EDGE * math.pow(settings.samples, -EVEN)

        def sample(numbers: NDArray[np.int64], copies: Footprints, found: Floats) -> None:
            start = time.perf_counter()
            which = np.arange(len(numbers))
            room = int(np.diff(numbers).sum())
            leaving, gone = np.empty(room * goes, RAY), np.zeros(1, np.int64)
            asking, asked = np.empty(room * asks, RAY), np.zeros(1, np.int64)
            mine = part._replace(seen=copies, radiance=found, method=np.empty(len(which), np.uint8))
            csg(
                numbers, bounces, indirect, shown, fine, False, settings.seed, leaving, gone, asking, asked,
                part.pattern, copies.footprints, which, self.scene.objects, *self._of(mine),
            )  # fmt: skip
            part.took("csg", start)
            start = time.perf_counter()
            bounce.ask(asking[: asked[0]], self.caster, found)
            self._meet(leaving[: gone[0]], copies.footprints, found)
            part.took("bounce", start)

        if not indirect:
            part.radiance[chosen] = 0.0
        self._converge(part.seen, chosen, goes + asks, bounces, sample, part.radiance)
        part.method[chosen] = CSG


def render(
    scene: schema.Scene,
    *,
    method: str | None = None,
    samples: int | None = None,
    texels: int | None = None,
    tolerance: float | None = None,
    threads: int | None = None,
    resolution: tuple[int, int] | None = None,
    progress: Callable[[float], None] | None = None,
    cancelled: Callable[[], bool] | None = None,
    meshes: Callable[[str], bytes] | None = None,
    patterns: PatternCache | None = None,
    solids: dict[str, Truth | Textures] | None = None,
    tile: int = TILE,
) -> Picture:
    """Render a scene. What is not given is the scene's own; threads: one a processor.

    progress: called with the part done, 0 to 1. cancelled: asked between tiles. meshes: a mesh's or envmap's bytes, by
    name. solids: what other renders have made of the patterns, by what it depends on; more may come to it.
    Raises RenderError where the scene cannot be rendered, Cancelled where `cancelled` says so.
    """
    begin = time.perf_counter()
    method = method or scene.render.method
    settings = Settings(
        method,
        samples or scene.render.samples_of(method),
        scene.render.bounces,
        scene.render.seed,
        texels or scene.render.texels,
        tolerance or scene.render.tolerance,
    )
    if settings.method not in METHODS:
        raise RenderError(Fault("/render/method", f"one of {', '.join(METHODS)}", repr(settings.method)))
    has_mesh = any(isinstance(item.shape, schema.Mesh) for item in scene.objects)
    seconds = {
        "kernels": warm_up(
            lines=method == "lines",
            geometry=method == "geometry",
            textures=settings.method == "relief",
            meshes=has_mesh,
        )
    }
    start = time.perf_counter()
    compiled = compile_scene(
        scene, resolution or scene.camera.resolution, patterns if patterns is not None else PatternCache(), meshes
    )
    seconds["compile"] = time.perf_counter() - start
    model: Truth | Textures | None = None
    if settings.method in ("geometry", "relief"):
        start = time.perf_counter()
        solids = {} if solids is None else solids
        of = scene.model_dump_json(include={"objects", "patterns", "lights"})
        key = f"{settings.method} {settings.texels} {settings.bounces} {scene.camera.origin} {of}"
        if key not in solids and settings.method == "geometry":
            solids[key] = _truth(compiled, settings.bounces)
        elif key not in solids:
            solids[key] = _textures(compiled, settings.texels, threads, cancelled)
        model = solids[key]
        seconds["solids"] = time.perf_counter() - start
    frame = _frame(compiled, settings, model)
    _tiles(frame, tile, threads or os.cpu_count() or 1, progress, cancelled)
    seconds |= frame.seconds
    seconds["total"] = time.perf_counter() - begin
    return Picture(
        radiance=frame.radiance,
        aovs={"method": frame.method, "error": frame.error, "cost": frame.cost},
        seconds=seconds,
        pattern_bytes=sum(table_bytes(pattern) for pattern in compiled.patterns),
        shares=film.shares(frame.method),
        solid_bytes=model.bytes if model else 0,
    )


@functools.cache
def _albedo() -> Floats:
    """The table that lights gloss from the sky, within 1/128; a tenth of a second, once a process."""
    return shading.gloss_albedo(16, 128)


def _frame(compiled: CompiledScene, settings: Settings, model: Truth | Textures | None = None) -> Frame:
    width, height = compiled.resolution
    heights = np.zeros((len(compiled.objects), 2))
    for row, index in enumerate(compiled.objects["pattern"]):
        if index >= 0 and settings.method in ("auto", "lines", "area", "csg"):
            heights[row] = compiled.patterns[index].height, compiled.patterns[index].depth
    caster = Caster(compiled.objects, compiled.triangles, bent=settings.bounces > 0, heights=heights)
    lit = settings.bounces > 0 or bool(compiled.lighting.sky.any()) or len(compiled.lighting.surroundings.tables) > 0
    return Frame(
        scene=compiled,
        settings=settings,
        caster=caster,
        flat=flat_frames(caster, compiled.camera.origin),
        heights=heights,
        model=model,
        albedo=_albedo() if lit else np.zeros((2, 2, 4)),
        radiance=np.zeros((height, width, 3), np.float32),
        method=np.zeros((height, width), np.uint8),
        error=np.zeros((height, width), np.float32),
        cost=np.zeros((height, width), np.float32),
    )


def _truth(compiled: CompiledScene, bounces: int) -> Truth:
    """The scene as real geometry."""
    bodies = []
    for row, obj in enumerate(compiled.objects):
        pattern = compiled.patterns[obj["pattern"]] if obj["pattern"] >= 0 else BARE
        try:
            bodies.append(
                body.build(
                    row, obj, pattern, compiled.triangles, compiled.camera.origin, compiled.lighting.lights, bounces
                )
            )
        except ValueError as error:
            raise RenderError(Fault(f"/objects/{row}/pattern", "a pattern that can be meshed", str(error))) from None
    return Truth(bodies)


def _textures(
    compiled: CompiledScene, texels: int, threads: int | None, cancelled: Callable[[], bool] | None
) -> Textures:
    """The textures of method relief."""
    uv = compiled.triangles.uv, compiled.triangles.object
    try:
        return relief.textures(compiled.objects, compiled.patterns, *uv, texels, threads=threads, cancelled=cancelled)
    except ValueError as error:
        raise RenderError(Fault("/render/texels", "fewer texels for these patterns", str(error))) from None


def _tiles(
    frame: Frame,
    size: int,
    threads: int,
    progress: Callable[[float], None] | None,
    cancelled: Callable[[], bool] | None,
) -> None:
    """Render all tiles, as many at a time as there are threads."""
    height, width = frame.method.shape
    todo = [
        Tile(x, y, min(size, width - x), min(size, height - y))
        for y in range(0, height, size)
        for x in range(0, width, size)
    ]
    total, done = len(todo), 0
    todo.reverse()
    with ThreadPoolExecutor(threads, "tile") as pool:
        running: set[Future[dict[str, float]]] = set()
        try:
            while todo or running:
                if cancelled is not None and cancelled():
                    raise Cancelled
                while todo and len(running) < 2 * threads:
                    running.add(pool.submit(frame.tile, todo.pop()))
                finished, running = wait(running, timeout=0.1, return_when=FIRST_COMPLETED)
                for future in finished:
                    for stage, spent in future.result().items():
                        frame.seconds[stage] = frame.seconds.get(stage, 0.0) + spent
                    done += 1
                    if progress is not None:
                        progress(done / total)
        finally:
            for future in running:
                future.cancel()


def kernels_compiled() -> bool:
    """Whether the kernels of this version have been compiled on this machine."""
    return _READY.exists()


_warm: set[str] = set()


def warm_up(*, lines: bool = False, geometry: bool = False, textures: bool = False, meshes: bool = False) -> float:
    """Compile the kernels, or load them from their cache: the seconds that took, next to none from the second call.

    The kernels of methods `lines`, `geometry` and `relief`, and those of mesh files, are left until they are asked for.
    """
    begin = time.perf_counter()
    beside = None
    if (
        "analytic" not in _warm and not kernels_compiled() and (os.cpu_count() or 1) > 1
    ):  # half of the work in another process
        program = "from renderer import pipeline; pipeline.compile_analytic('line', 'csg')"
        if geometry:
            program += "; pipeline.compile_geometry()"
        beside = subprocess.Popen([sys.executable, "-c", program], stdin=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    if "analytic" not in _warm:
        compile_analytic("area")
    if lines and "lines" not in _warm:
        compile_analytic("lines")
        _warm.add("lines")
    if textures and "relief" not in _warm:
        _try("relief", {"type": "rectangle", "size": [2, 2]})
        _warm.add("relief")
    if beside is not None:
        beside.wait()
    if "analytic" not in _warm:
        compile_analytic("line", "csg")
        _READY.touch()
        _warm.add("analytic")
    if geometry and "geometry" not in _warm:
        compile_geometry()
        _warm.add("geometry")
    if meshes and "meshes" not in _warm:
        _try("line", _MESH)
        _warm.add("meshes")
    return time.perf_counter() - begin


def compile_analytic(*methods: str) -> None:
    """Compile the kernels of these methods, or load them."""
    for method in methods:
        plane = method in ("area", "lines")  # of which they leave nothing to `csg`
        shape: dict[str, object] = {"type": "rectangle", "size": [9, 9]} if plane else {"type": "sphere", "radius": 1}
        _try(method, shape, bounces=int(method == "csg"))


def compile_geometry() -> None:
    """Compile the kernels of method `geometry`, or load them."""
    _try("geometry", {"type": "rectangle", "size": [2, 2]})
    _try("geometry", {"type": "sphere", "radius": 1})
    _try("geometry", _MESH)


_MESH: dict[str, object] = {"type": "mesh", "file": "triangle.obj"}
_TRIANGLE = b"""v -2 -2 0\nv 2 -2 0\nv 0 2 0\nvt 0 0\nvt 1 0\nvt 0 1\nf 1/1 2/2 3/3\n"""


def _try(method: str, shape: dict[str, object], bounces: int = 0) -> None:
    """Render a picture that nobody sees, with lights of both kinds and grooves; in glass where rays go on."""
    scene = schema.check(
        {
            "intaglio": 1,
            "camera": {"origin": [0, 0, 3], "target": [0, 0.1, 0], "resolution": [2, 2]},
            "lights": [{"type": "constant", "radiance": [1, 1, 1]},
                       {"type": "point", "position": [0, 0, 2], "intensity": [1, 1, 1]}],
            "materials": {"m": {"transmission": min(bounces, 1)}},
            "patterns": {"p": {"grooves": [{"path": {"type": "circle", "center": [0.5, 0.5], "radius": 0.2},
                                            "profile": {"type": "v", "width": 0.1, "depth": 0.1}}]}},
            "objects": [{"shape": shape, "material": "m", "pattern": "p"}],
        }
    ).scene  # fmt: skip
    assert scene is not None
    compiled = compile_scene(scene, (2, 2), PatternCache(), lambda _: _TRIANGLE)
    model: Truth | Textures | None = None
    if method == "geometry":
        model = _truth(compiled, 0)
    elif method == "relief":
        model = _textures(compiled, 16, 1, None)
    _frame(compiled, Settings(method, 1, bounces, 0, 16, 0.01), model).tile(Tile(0, 0, 2, 2))
