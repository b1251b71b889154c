"""Light between the facets of one groove: form factors by crossed strings, and what `line` makes of them."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray

from renderer.geometry import strings
from renderer.tables import BASE, LINE

from .parts import alone
from .test_envmap import files

Json = dict[str, Any]
Floats = NDArray[np.float64]
Points = list[tuple[float, float]]

MATT = {"base_color": [0.8, 0.65, 0.5], "specular": 0}
WHITE = {"base_color": [1, 1, 1], "specular": 0}
SUN = {"type": "directional", "direction": [1, 0.45, -0.9], "irradiance": [2.0, 1.8, 1.6]}
MOON = {"type": "directional", "direction": [-0.8, 0.3, -0.6], "irradiance": [0.4, 0.6, 1.0]}
LAMP = {"type": "point", "position": [-0.9, 0.6, 1.4], "intensity": [1.5, 1.8, 2.4]}
SKY = {"type": "constant", "radiance": [0.3, 0.4, 0.5]}
INSIDE = {"fov": 14, "resolution": [32, 24]}  # no pixel on the plate's edge

FACTORS = alone(strings.factors)
VEE = {"type": "v", "width": 0.16, "depth": 0.12}
DITCH = {"type": "trapezoid", "width": 0.16, "floor": 0.08, "depth": 0.1}
BOX = {"type": "polyline", "points": [[-0.08, 0], [-0.08, -0.1], [0.08, -0.1], [0.08, 0]]}
BOWL = {"type": "round", "width": 0.16, "depth": 0.08, "facets": 9}
HUMP = {"type": "polyline", "points": [[-0.08, 0], [-0.06, -0.1], [0, -0.02], [0.05, -0.12], [0.08, 0]]}


def factors(points: Points, parts: int = 1) -> tuple[Floats, Floats, Floats]:
    """Form factors (n, n) between the elements of a polyline with so many a facet, those to the sky, and lengths."""
    u = np.arange(parts) / parts
    chain = [a + u[:, None] * (b - a) for a, b in zip(np.array(points), np.array(points[1:]), strict=False)]
    x, y = np.concatenate([*chain, np.array(points[-1:])]).T.astype(float)
    n = len(x) - 1
    factor, sky = np.empty((n, n)), np.empty(n)
    FACTORS(n, x.copy(), y.copy(), np.empty(n + 1, np.int64), np.empty(n + 1), np.empty((n + 1, n + 1)), factor, sky)
    return factor.T, sky, np.hypot(np.diff(x), np.diff(y))


def vee(angle: float, wall: float = 1.0) -> Points:
    """A V of two such walls, that open so many degrees."""
    half = math.radians(0.5 * angle)
    run, rise = wall * math.sin(half), wall * math.cos(half)
    return [(-run, 0.0), (0.0, -rise), (run, 0.0)]


@pytest.mark.parametrize("parts", [1, 7])
@pytest.mark.parametrize("angle", [1, 30, 60, 90, 120, 179])
def test_walls_of_a_v(angle: float, parts: int) -> None:
    """F12 = 1 - sin(a / 2) (DESIGN 2.5)."""
    factor, _, length = factors(vee(angle), parts)
    across = length[:parts] @ factor[:parts, parts:].sum(1) / length[:parts].sum()
    assert across == pytest.approx(1.0 - math.sin(math.radians(angle / 2)), abs=1e-9)


def test_walls_of_a_box() -> None:
    """Opposite strips of width d, w apart: sqrt(1 + (w / d)^2) - w / d; floor to sky likewise."""
    factor, sky, _ = factors([(0, 0), (0, -0.4), (1, -0.4), (1, 0)])
    assert factor[0, 2] == pytest.approx(math.hypot(1, 2.5) - 2.5, abs=1e-12)
    assert sky[1] == pytest.approx(math.hypot(1, 0.4) - 0.4, abs=1e-12)
    assert factor[0, 1] == pytest.approx(0.5 * (0.4 + 1 - math.hypot(1, 0.4)) / 0.4, abs=1e-12)


def test_nothing_passes_through_a_peak() -> None:
    """Two V side by side, whose peak reaches the plane, see nothing of each other; behind a lower one part is seen."""
    factor, _, _ = factors([(0, 0), (1, -1), (2, 0), (3, -1), (4, 0)])
    assert np.abs(factor[:2, 2:]).max() < 1e-14
    assert np.abs(factor[2:, :2]).max() < 1e-14
    lower, _, _ = factors([(0, 0), (1, -1), (2, -0.5), (3, -1), (4, 0)])
    assert abs(lower[1, 2]) < 1e-14
    assert lower[0, 3] > 0.04


def seen_by_rays(points: Points, i: int, samples: int) -> Floats:
    """What part of facet i's light arrives at each facet, and at the sky (last), by rays."""
    p = np.array(points)
    a, b = p[i], p[i + 1]
    along = (b - a) / np.hypot(*(b - a))
    normal = np.array([-along[1], along[0]])
    u, v = (np.arange(samples) + 0.5) / samples, (np.arange(samples) + 0.5) / samples
    place, sine = np.meshgrid(u, 2 * v - 1, indexing="ij")
    o = a + place[..., None] * (b - a)
    d = sine[..., None] * along + np.sqrt(1 - sine**2)[..., None] * normal
    nearest, hit = np.full(place.shape, np.inf), np.full(place.shape, len(points) - 1)
    for j in range(len(points) - 1):
        if j == i:
            continue
        c, e = p[j], p[j + 1] - p[j]
        over = d[..., 0] * e[1] - d[..., 1] * e[0]
        with np.errstate(divide="ignore", invalid="ignore"):
            t = ((c - o)[..., 0] * e[1] - (c - o)[..., 1] * e[0]) / over
            s = ((c - o)[..., 0] * d[..., 1] - (c - o)[..., 1] * d[..., 0]) / over
        met = (t > 1e-12) & (s >= 0) & (s <= 1) & (t < nearest)
        nearest, hit = np.where(met, t, nearest), np.where(met, j, hit)
    return np.bincount(hit.ravel(), minlength=len(points)) / samples**2


RANDOM = st.lists(
    st.tuples(st.sampled_from([0.0, 0.1, 0.3, 0.7]), st.sampled_from([-0.9, -0.5, -0.3, -0.1, 0.0])), min_size=1,
    max_size=6,
)  # fmt: skip


def polyline(steps: list[tuple[float, float]]) -> Points:
    points = [(0.0, 0.0)]
    for step, w in steps:
        upright = step == 0.0 and len(points) > 1 and points[-1][0] == points[-2][0]
        if not upright and (points[-1][0] + step, w) != points[-1]:  # no wall goes back over itself
            points.append((points[-1][0] + step, w))
    return [*points, (points[-1][0] + 0.2, 0.0)]


@settings(deadline=None, max_examples=60)
@given(RANDOM, st.sampled_from([1, 3]))
def test_laws_of_factors(steps: list[tuple[float, float]], parts: int) -> None:
    """None below 0; what leaves arrives; as much goes there as comes back; of any size the same."""
    points = polyline(steps)
    factor, sky, length = factors(points, parts)
    assert factor.min() > -1e-12
    assert sky.min() > -1e-12
    assert np.allclose(factor.sum(1) + sky, 1.0, atol=1e-12)
    assert np.allclose(length[:, None] * factor, (length[:, None] * factor).T, atol=1e-13)
    larger, to_sky, _ = factors([(7.0 * b, 7.0 * w) for b, w in points], parts)
    assert np.allclose(larger, factor, atol=1e-12)
    assert np.allclose(to_sky, sky, atol=1e-12)
    turned, _, _ = factors([(-b, w) for b, w in reversed(points)], parts)
    assert np.allclose(turned[::-1, ::-1], factor, atol=1e-12)


@settings(deadline=None, max_examples=15)
@given(RANDOM)
def test_factors_are_what_rays_meet(steps: list[tuple[float, float]]) -> None:
    points = polyline([(max(step, 0.1), w) for step, w in steps])  # rays along a wall are not told from those in it
    factor, sky, _ = factors(points)
    for i in range(len(points) - 1):
        met = seen_by_rays(points, i, 400)
        assert np.abs(met - [*factor[i], sky[i]]).max() < 4e-3


def plain(
    plate: Callable[..., Json], profile: Json, lights: list[Json], bounces: int, material: Json = MATT,
    step: float = 0.2, camera: Json = INSIDE, **more: Any,
) -> Json:  # fmt: skip
    """Grooves side by side, slightly askew."""
    groove = {
        "path": {"type": "polyline", "points": [[-1.0, -9], [-0.9, 9]]}, "profile": profile,
        "repeat": {"type": "linear", "count": 20, "step": [step, 0]},
    }  # fmt: skip
    parts = {"materials": {"stone": material} | more.pop("materials", {}), "render": {"bounces": bounces}}
    return plate([groove | more.pop("groove", {})], **parts, lights=lights, camera=camera, **more)


@pytest.mark.parametrize("profile", [VEE, BOX, BOWL, HUMP], ids=["v", "box", "bowl", "hump"])
def test_furnace(plate: Callable[..., Json], radiance: Callable[..., Floats], profile: Json) -> None:
    """White grooves under a white sky are as white as it, however often light bounces; darker ones never brighter."""
    sky = [{"type": "constant", "radiance": [1, 1, 1]}]
    for bounces in (0, 1, 2, 5, 16):
        assert np.allclose(radiance(plain(plate, profile, sky, bounces, WHITE), method="line"), 1.0, atol=1e-6)
    grey = radiance(plain(plate, profile, sky, 16, MATT), method="line")
    assert (grey <= np.array(MATT["base_color"]) + 1e-6).all()


def test_endless_bounces_in_a_v(plate: Callable[..., Json], radiance: Callable[..., Floats]) -> None:
    """From straight above at a distance each wall shows the mean of the radiosity that a dense system gives it."""
    camera = {"origin": [0, 0, 600], "target": [0, 0, 0], "up": [0, 1, 0], "fov": 1.0, "resolution": [12, 9]}
    sky = [{"type": "constant", "radiance": [1, 1, 1]}]
    rows = {
        "path": {"type": "polyline", "points": [[-9, -20], [-9, 40]]},
        "repeat": {"type": "linear", "count": 200, "step": [0.16, 0]},
    }
    shown = radiance(plain(plate, VEE, sky, 16, camera=camera, size=[20, 20], groove=rows), method="line")
    factor, to_sky, length = factors([(-0.08, 0), (0, -0.12), (0.08, 0)], 300)
    for c, albedo in enumerate(MATT["base_color"]):  # type: ignore[arg-type, var-annotated]
        whole = np.linalg.solve(np.eye(600) - albedo * factor, albedo * to_sky)
        seen = whole @ length / length.sum()
        lost = albedo**17
        assert shown[..., c].mean() == pytest.approx(seen, abs=4e-4 + lost * 0.02)
        # of one factor a facet the closed form: rho Fs / (1 - rho (1 - Fs)), which is no more than near
        rough = albedo * (1 - factor[:300, 300:].sum(1).mean()) / (1 - albedo * factor[:300, 300:].sum(1).mean())
        assert seen == pytest.approx(rough, abs=0.02)


def as_near_as_noise(one: Floats, other: Floats, ours: Floats, floor: float) -> None:
    """`ours` is as far from two pictures' mean as they let it be, and by no more than `floor` besides."""
    off = ours - 0.5 * (one + other)
    noise = 0.25 * ((one - other) ** 2).mean()
    assert (off**2).mean() < 1.5 * noise + floor**2
    assert abs(off.mean()) < 8.0 * np.sqrt(noise / off.size) + 0.3 * floor


LOW: Json = {"origin": [0.2, -1.9, 0.5], "fov": 10}
CASES: dict[str, tuple[Json, list[Json], int, Json]] = {
    "v, one bounce": (VEE, [SUN, LAMP, SKY], 1, {}),
    "v, from low": (VEE, [SUN, MOON], 2, LOW),
    "ditch": (DITCH, [SUN, MOON, SKY], 8, {}),
    "box, from low": (BOX, [LAMP, SKY], 8, LOW),
    "bowl": (BOWL, [SUN, LAMP], 2, {}),
    "hump": (HUMP, [MOON, SKY], 8, {}),
}


@pytest.mark.parametrize("case", CASES)
def test_truth(plate: Callable[..., Json], picture: Callable[..., Any], case: str) -> None:
    profile, lights, bounces, camera = CASES[case]
    data = plain(plate, profile, lights, bounces, camera=INSIDE | camera)
    one, other = (picture(data, method="geometry", samples=900, seed=s).radiance.astype(float) for s in (1, 2))
    for method in ("line", "auto"):
        ours = picture(data, method=method)
        assert set(np.unique(ours.aovs["method"])) <= {LINE, BASE}
        as_near_as_noise(one, other, ours.radiance.astype(float), 0.0015)


def test_along_the_pixels(plate: Callable[..., Json], radiance: Callable[..., Floats]) -> None:
    """Grooves along the pixels' sides, where a footprint weighs all alike, are seen as those turned a little."""
    shown = []
    for turn in (0.0, 1e-3):
        path = {"type": "polyline", "points": [[0.92 - turn, 0], [0.92 + turn, 2]]}
        camera = {"origin": [0, 0, 60], "target": [0, 0, 0], "up": [0, 1, 0], "fov": 0.4}
        shown.append(radiance(plain(plate, BOX, [SKY], 8, groove={"path": path}, camera=camera), method="line"))
    assert np.abs(shown[0] - shown[1]).max() < 2e-3


def test_two_materials_and_light_of_their_own(plate: Callable[..., Json], picture: Callable[..., Any]) -> None:
    glow = {"base_color": [0.2, 0.3, 0.8], "specular": 0, "emissive": [0.2, 0.05, 0]}
    half = {"base_color": [0.63, 0.21, 0.14], "specular": 0}
    data = plain(
        plate, DITCH, [SUN, SKY], 4, materials={"glow": glow, "half": half}, groove={"material": ["glow", None, "half"]}
    )
    one, other = (picture(data, method="geometry", samples=900, seed=s).radiance.astype(float) for s in (1, 2))
    ours = picture(data, method="auto")
    assert set(np.unique(ours.aovs["method"])) <= {LINE, BASE}
    as_near_as_noise(one, other, ours.radiance.astype(float), 0.0015)


def test_stretched_in_the_world(plate: Callable[..., Json], picture: Callable[..., Any]) -> None:
    """Where the mapping is not the same both ways, grooves are wider in the world for their depth."""
    data = plain(plate, VEE, [SUN, SKY], 3, mapping={"scale": [4.0, 2.0]}, step=0.25, groove={
        "path": {"type": "polyline", "points": [[-1.0, -9], [2.0, 9]]}})  # fmt: skip
    one, other = (picture(data, method="geometry", samples=900, seed=s).radiance.astype(float) for s in (1, 2))
    ours = picture(data, method="line")
    as_near_as_noise(one, other, ours.radiance.astype(float), 0.0015)


def window() -> Callable[[str], bytes]:
    """A dim blue sky with a bright window of 30 by 20 degrees, low in the south-east, and a red west."""
    made = np.tile(np.array([0.1, 0.15, 0.3], np.float32), (90, 180, 1))
    made[30:40, 60:75] = [9, 8, 6]
    made[20:60, 120:150, 0] += 0.6
    return files(made)


OBLIQUE: Json = {"path": {"type": "polyline", "points": [[-1.0, -9], [2.0, 9]]}}
UNDER: dict[str, tuple[Json, int, Json, Json]] = {
    "v": (VEE, 1, {}, {}),
    "box, turned": (BOX, 4, {"groove": OBLIQUE}, {"rotate": 70, "scale": 1.5}),
    "hump, a sun and a sky": (HUMP, 2, {}, {"rotate": 200}),
    "ditch, stretched": (DITCH, 3, {"groove": OBLIQUE, "mapping": {"scale": [4.0, 2.0]}, "step": 0.25}, {}),
}


@pytest.mark.parametrize("case", UNDER)
def test_truth_under_a_picture(plate: Callable[..., Json], picture: Callable[..., Any], case: str) -> None:
    """A picture of the sky lights facets through the groove's opening."""
    profile, bounces, more, placed = UNDER[case]
    lights: list[Json] = [{"type": "envmap", "file": "sky.exr"} | placed, *([SUN, SKY] if "sun" in case else [])]
    data = plain(plate, profile, lights, bounces, **more)
    one, other = (
        picture(data, method="geometry", samples=1600, seed=s, meshes=window()).radiance.astype(float) for s in (1, 2)
    )
    ours = picture(data, method="auto", meshes=window())
    assert set(np.unique(ours.aovs["method"])) <= {LINE, BASE}
    as_near_as_noise(one, other, ours.radiance.astype(float), 0.0015)


def test_many_in_a_pixel(plate: Callable[..., Json], picture: Callable[..., Any]) -> None:
    """Repeats that are folded, and rings."""
    rows = {"repeat": {"type": "linear", "count": 400, "step": [0.009, 0]}}
    fine = {"type": "v", "width": 0.008, "depth": 0.005}
    data = plain(plate, fine, [SUN, MOON, SKY], 3, groove=rows)
    rings = {"path": {"type": "circle", "center": [1, 1], "radius": 0.96},
             "repeat": {"type": "concentric", "count": 100, "step": -0.009}}  # fmt: skip
    for scene in (data, plain(plate, fine, [SUN, SKY], 2, groove=rings, camera={"resolution": [32, 24]})):
        ours = picture(scene, method="auto")
        closed = ours.aovs["method"] == LINE
        assert closed.mean() > 0.15
        one, other = (picture(scene, method="csg", samples=400, seed=s).radiance.astype(float) for s in (1, 2))
        as_near_as_noise(one[closed], other[closed], ours.radiance.astype(float)[closed], 0.001)


def test_what_is_left_to_samples(plate: Callable[..., Json], picture: Callable[..., Any]) -> None:
    """Ridges, gloss, coats, mirrors that are matt in part seen twice, ends near by, a lamp close by; rings, as T turns,
    under a picture of the sky."""
    ridge = {"type": "v", "width": 0.16, "depth": -0.1}
    ended = {"path": {"type": "polyline", "points": [[1.0, 0.9], [1.0, 1.2]]}, "repeat": None}
    ring = {"path": {"type": "circle", "center": [1, 2], "radius": 1.0}, "repeat": None}
    near = LAMP | {"position": [0.0, 0.0, 0.3]}
    others = [
        plain(plate, ridge, [SUN], 1),
        plain(plate, VEE, [SUN], 1, {"base_color": [0.8, 0.8, 0.8], "roughness": 0.4}),
        plain(plate, VEE, [SUN], 1, {"base_color": [0.8, 0.8, 0.8], "roughness": 0}),
        plain(plate, VEE, [SUN], 2, MATT | {"metallic": 0.5, "roughness": 0}),
        plain(plate, VEE, [near], 1),
        plain(plate, VEE, [SUN], 1, groove=ended),
        plain(plate, VEE, [{"type": "envmap", "file": "sky.exr"}], 1, groove=ring),
    ]
    for data in others:
        data["camera"]["resolution"] = [8, 6]
        data["camera"]["fov"] = 3
        assert LINE not in picture(data, method="auto", samples=4, meshes=window()).aovs["method"]


def test_any_tiles_any_threads(plate: Callable[..., Json], picture: Callable[..., Any]) -> None:
    """Light that is kept for like grooves is the same wherever it is first found."""
    data = plain(plate, HUMP, [SUN, SKY], 3)
    whole = picture(data, method="line", threads=1).radiance
    for tile, threads in ((7, 2), (16, 1)):
        assert np.array_equal(whole, picture(data, method="line", tile=tile, threads=threads).radiance)
