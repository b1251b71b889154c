"""What must hold for any scene, whatever its picture."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numba
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray

from renderer import pipeline, shading
from renderer.errors import RenderError
from renderer.tables import MATERIAL

Json = dict[str, Any]
Floats = NDArray[np.float64]
Plate = Callable[..., Json]
Radiance = Callable[..., Floats]

SINGLE = 2e-6
"""Pictures are single precision: sums of a few numbers of about 1."""

SKEW = [[-0.06, 0.0], [-0.03, 0.04], [0.03, -0.12], [0.12, 0.05], [0.15, 0.0]]
WHITE = {"base_color": [1, 1, 1], "specular": 0, "roughness": 1}
SKY = {"type": "constant", "radiance": [1, 1, 1]}


def line(*points: list[float], profile: Json | None = None, **more: Any) -> Json:
    profile = profile or {"type": "polyline", "points": SKEW}
    return {"path": {"type": "polyline", "points": list(points)}, "profile": profile, **more}


def family(**more: Any) -> Json:
    return line([0.26, -1], [0.26, 3], repeat={"type": "linear", "count": 6, "step": [0.33, 0]}, **more)


@pytest.mark.parametrize("method", ["base", "segment", "line", "csg", "auto"])
def test_furnace(method: str, plate: Plate, radiance: Radiance) -> None:
    """White facets reflect all of a white sky, and no sky is taken away yet: every pixel is exactly 1.

    With `segment` too: its parts sum to one by construction, as do the shares of `line`.
    """
    grooves = [family()] if method in ("line", "segment") else [family(), line([-1, 0.9], [3, 1.2])]
    scene = plate(grooves, materials={"stone": WHITE}, lights=[SKY])
    assert np.abs(radiance(scene, method=method, samples=9) - 1.0).max() < SINGLE


def test_emission_adds(plate: Plate, radiance: Radiance) -> None:
    materials = {"stone": WHITE | {"emissive": [0.5, 0.25, 0]}, "lamp": WHITE | {"emissive": [2, 0, 0]}}
    dark = plate([family()], materials=materials, lights=[])
    lit = plate([family()], materials=materials, lights=[SKY])
    for method in ("line", "csg"):
        inside = radiance(lit, method=method, samples=9)[20:30, 10:38]
        assert np.abs(inside - [1.5, 1.25, 1.0]).max() < SINGLE
        assert np.abs(radiance(dark, method=method, samples=9)[20:30, 10:38] - [0.5, 0.25, 0]).max() < SINGLE
    glowing = radiance(plate([family(material="lamp")], materials=materials, lights=[]), method="line")
    assert glowing[..., 0].max() > 1.5


@pytest.mark.parametrize("method", ["line", "csg", "auto", "segment"])
def test_grooves_of_no_depth_are_the_bare_plate(method: str, plate: Plate, radiance: Radiance) -> None:
    flat = [[b, w * 1e-9] for b, w in SKEW]
    sun = {"type": "directional", "direction": [1, 0.45, -0.9], "irradiance": [3, 3, 3]}
    scene = plate([family(profile={"type": "polyline", "points": flat})], lights=[sun])
    assert np.abs(radiance(scene, method=method, samples=16) - radiance(scene, method="base")).max() < SINGLE


def rms(values: Floats) -> float:
    return float(np.sqrt(np.mean(values**2)))


def mirrored(scene: Json) -> Json:
    """The scene seen in a mirror that is its plane x = 0: paths turn to the other side, profiles with them."""

    def flip(vector: list[float]) -> list[float]:
        return [-vector[0], *vector[1:]]

    camera = scene["camera"] | {"origin": flip(scene["camera"]["origin"]), "target": flip(scene["camera"]["target"])}
    lights = []
    for light in scene["lights"]:
        place = "direction" if "direction" in light else "position"
        lights.append(light | {place: flip(light[place])})
    grooves = []
    for groove in scene["patterns"]["cut"]["grooves"]:
        path = groove["path"] | {"points": [[2.0 - p, q] for p, q in groove["path"]["points"]]}
        profile = {"type": "polyline", "points": [[-b, w] for b, w in reversed(groove["profile"]["points"])]}
        more = {}
        if "repeat" in groove:
            more["repeat"] = groove["repeat"] | {"step": flip(groove["repeat"]["step"])}
        grooves.append(groove | {"path": path, "profile": profile} | more)
    return scene | {"camera": camera, "lights": lights, "patterns": {"cut": {"tile": None, "grooves": grooves}}}


def test_mirror(plate: Plate, radiance: Radiance) -> None:
    """A mirrored scene has the mirrored picture: of `line` to the last digit, of `csg` but for its noise.

    The noise s of one picture is measured from two seeds; two pictures differ by s sqrt(2).
    """
    # so large that no edge of it is seen, which is antialiased by samples; again p, q = x + 1, y + 1
    large: Json = {"size": [20, 20], "mapping": {"scale": [20, 20], "offset": [-9, -9]}}
    straight = plate([family()], **large)
    crossing = plate([family(), line([-1, 0.9], [3, 1.2], ends="flat")], **large)
    picture = radiance(straight, method="line")
    assert np.abs(picture[:, ::-1] - radiance(mirrored(straight), method="line")).max() < SINGLE
    picture = radiance(crossing, method="csg", samples=36)
    noise = rms(picture - radiance(crossing, method="csg", samples=36, seed=1))
    assert noise > 1e-4
    assert rms(picture[:, ::-1] - radiance(mirrored(crossing), method="csg", samples=36)) < 1.15 * noise


@pytest.mark.parametrize("method", ["line", "csg", "geometry"])
def test_tile_is_repeats_written_out(method: str, plate: Plate, radiance: Radiance) -> None:
    """The plate is 2 wide; nothing reaches farther than 0.3 + 2 x 0.15 past a tile of its own.

    The same samples meet the same surfaces: only rounding may differ, which may put a sample beyond an edge.
    """
    if method == "line":
        groove, tile, steps, counts = line([0.1, -9], [0.1, 9]), [0.4, 20.0], [[0.4, 0], [0, 20]], [13, 1]
        first = [-4, 0]
    else:
        groove, tile, steps, counts = line([0.1, 0.1], [0.4, 0.3]), [0.4, 0.5], [[0.4, 0], [0, 0.5]], [13, 11]
        first = [-4, -3]
    moved = groove["path"] | {
        "points": [[p + first[0] * tile[0], q + first[1] * tile[1]] for p, q in groove["path"]["points"]]
    }
    written = groove | {"path": moved, "repeat": {"type": "grid", "counts": counts, "steps": steps}}
    tiled = radiance(plate([groove], tile), method=method, samples=16)
    same = np.abs(tiled - radiance(plate([written]), method=method, samples=16)).max(axis=2)
    assert (same < 1e-5).mean() > 0.998
    assert same.max() < 2.5 / 16


NUMBER = st.floats(-3, 3, allow_nan=False)
POINT = st.tuples(NUMBER, NUMBER).map(list)
SMALL = st.sampled_from([1e-6, 1e-3, 0.05, 0.2, 1.0])
PROFILES = st.one_of(
    st.builds(lambda w, d, s: {"type": "v", "width": w, "depth": d * s}, SMALL, SMALL, st.sampled_from([-1, 1])),
    st.builds(lambda w, d: {"type": "trapezoid", "width": w, "floor": w, "depth": d}, SMALL, SMALL),
    st.builds(lambda w: {"type": "polyline", "points": [[w, 0], [w, 0.1], [2 * w, -0.1], [2 * w, 0]]}, SMALL),
    st.builds(lambda w: {"type": "polyline", "points": [[-2 * w, 0], [-w, -0.1], [-w, 0.1], [-0.5 * w, 0]]}, SMALL),
)  # fmt: skip
PATHS = st.one_of(
    st.lists(POINT, min_size=2, max_size=4, unique_by=tuple).map(lambda p: {"type": "polyline", "points": p}),
    st.builds(lambda c, r: {"type": "circle", "center": c, "radius": r}, POINT, SMALL),
    st.builds(
        lambda c, r: {"type": "spiral", "center": c, "inner_radius": 0, "outer_radius": r, "turns": 1.5}, POINT, SMALL
    ),
    st.just({"type": "svg", "d": "M0,0 C1,2 1,0 0,1 L0,0.5 A0.3,0.2 0 1 0 1,1"}),
)
SCALES = st.sampled_from(
    [
        {"type": "constant"},
        {"type": "constant", "value": 0},
        {"type": "linear", "start": 0, "end": 2},
        {"type": "sine", "amplitude": 1, "periods": 7},
        {"type": "table", "t": [0, 0.5, 1], "values": [0, 1, 0]},
    ]
)
GROOVES = st.builds(
    lambda path, profile, scale, ends, priority: {
        "path": path, "profile": profile, "scale": scale, "ends": ends, "priority": priority,
    },
    PATHS, PROFILES, SCALES, st.sampled_from(["flat", "profile"]), st.integers(0, 2),
)  # fmt: skip
LIGHTS = st.one_of(
    st.builds(lambda d: {"type": "directional", "direction": d, "irradiance": [3, 3, 3]},
              st.sampled_from([[1, 0, 0], [1, 0, -1], [0, 0, -1], [1, 0, -1e-3], [0.1, 0.2, 1], [-1, 0, -2]])),
    st.builds(lambda p: {"type": "point", "position": p, "intensity": [1, 1, 1]},
              st.sampled_from([[0, 0, 0.01], [0, 0, 0], [0.3, 0.1, -1], [5, 5, 1e-3], [0, 0, 2]])),
    st.just(SKY),
)  # fmt: skip
ORIGINS = st.sampled_from(
    [[0, 0, 3], [0.1, -2, 1], [0, -3, 3 * math.tan(math.radians(0.1))], [0, 0, 1e-3], [0.2, 0.1, 0.05], [0, 0, 500]]
)
MATERIALS = st.sampled_from(
    [WHITE, {"roughness": 0}, {"metallic": 1, "roughness": 0.1}, {"transmission": 1, "roughness": 0}, {}]
)


@settings(max_examples=40, deadline=None, derandomize=True)
@given(
    grooves=st.lists(GROOVES, min_size=1, max_size=3), twice=st.booleans(), lights=st.lists(LIGHTS, max_size=2),
    origin=ORIGINS, material=MATERIALS, scale=st.sampled_from([[2, 2], [2000, 0.01], [1e5, 1e5], [0.01, 0.01]]),
    tile=st.sampled_from([None, [0.7, 0.9]]), shape=st.sampled_from(["rectangle", "sphere", "cylinder"]),
    method=st.sampled_from(["auto", "line", "segment", "csg"]),
)  # fmt: skip
def test_odd_scenes_are_pictures(
    radiance: Radiance, plate: Plate, grooves: list[Json], twice: bool, lights: list[Json], origin: list[float],
    material: Json, scale: list[float], tile: list[float] | None, shape: str, method: str,
) -> None:  # fmt: skip
    """Whatever stands in a valid scene: numbers come out, and none below 0. Too many grooves at one place are refused,
    which says where they are."""
    scene = plate(
        grooves * (2 if twice else 1), tile, lights=lights, materials={"stone": material}, mapping={"scale": scale},
        camera={"origin": origin, "target": [0.01, 0.02, 0], "up": [0, 1, 0.01], "resolution": [4, 3]},
    )  # fmt: skip
    if shape == "sphere":
        scene["objects"][0] |= {"shape": {"type": "sphere", "radius": 1}, "translate": [0, 0, -1]}
    elif shape == "cylinder":
        scene["objects"][0] |= {
            "shape": {"type": "cylinder", "radius": 1, "height": 1}, "translate": [0, 0, -1], "rotate": [90, 0, 0],
        }  # fmt: skip
    pointers = []
    try:
        values = radiance(scene, method=method, samples=4)
    except RenderError as error:
        pointers = [fault.pointer for fault in error.faults]
        values = np.zeros(1)
    assert pointers in ([], ["/patterns/cut/tile"])
    assert np.isfinite(values).all()
    assert (values >= 0.0).all()


# --- the material ---


def material(**more: Any) -> NDArray[np.void]:
    row = np.zeros(1, MATERIAL)
    row["base_color"], row["alpha"], row["f0"], row["f90"] = (0.8, 0.5, 0.2), 0.25, 0.04, 1.0
    for name, value in more.items():
        row[name] = value
    return row


@numba.njit(error_model="numpy")  # type: ignore[untyped-decorator]
def answers(materials: NDArray[np.void], to_eye: Floats, to_light: Floats) -> Floats:
    """`reflect` at a normal of +z for pairs (n, 3) of directions, as it is: cosine included."""
    out = np.empty((len(to_eye), 3))
    for i in range(len(to_eye)):
        e, l = to_eye[i], to_light[i]
        out[i, 0], out[i, 1], out[i, 2] = shading.reflect(
            materials[0], (0.0, 0.0, 1.0), (e[0], e[1], e[2]), (l[0], l[1], l[2])
        )
    return out


def hemisphere(count: int) -> tuple[Floats, float]:
    """Directions (n, 3) at the middles of cells of equal solid angle, and that angle."""
    z, turn = np.meshgrid((np.arange(count) + 0.5) / count, (np.arange(count) + 0.5) * 2.0 * math.pi / count)
    side = np.sqrt(1.0 - z**2)
    return np.stack([side * np.cos(turn), side * np.sin(turn), z], axis=2).reshape(-1, 3), 2.0 * math.pi / count**2


def eyes(cosine: float, count: int) -> Floats:
    return np.tile([math.sqrt(1.0 - cosine**2), 0.0, cosine], (count, 1))


MIXES = [
    material(),
    material(metallic=1.0),
    material(metallic=0.4, alpha=0.09),
    material(alpha=1.0),
    material(f90=0.0, f0=0.0),
]


@pytest.mark.parametrize("row", MIXES, ids=lambda row: f"{row['metallic'][0]}-{row['alpha'][0]}")
def test_reciprocity(row: NDArray[np.void]) -> None:
    """Without the cosine to the light the BRDF is the same both ways."""
    rng = np.random.default_rng(3)
    a, b = (rng.normal(size=(200, 3)) for _ in range(2))
    for v in (a, b):
        v[:, 2] = np.abs(v[:, 2]) + 1e-3
        v /= np.linalg.norm(v, axis=1, keepdims=True)
    there, back = answers(row, a, b) / b[:, 2:], answers(row, b, a) / a[:, 2:]
    assert np.allclose(there, back, rtol=1e-9)


@pytest.mark.parametrize("cosine", [0.1, 0.3, 0.7, 1.0])
def test_no_material_gives_more_light_than_it_gets(cosine: float) -> None:
    """The share of a white sky sent to E, by summing over the lights' directions: at most 1 for a metal and for a coat
    alone. (A white body under a coat is glTF's mix by Schlick's term, which may exceed 1 where E grazes.)

    A Lambert surface's is its colour. At alpha 1 the distribution of GGX is even, 1 / pi, and Smith's term
    1 / (2 (NL + NE)): the integral over z = NL from 0 to 1 of z / (z + NE) is 1 - NE log((1 + NE) / NE). Sums of
    midpoints: exact to 1e-5.
    """
    directions, angle = hemisphere(400)
    eye = eyes(cosine, len(directions))
    for alpha in (0.09, 0.25, 1.0):
        for row in (material(metallic=1.0, alpha=alpha, base_color=1.0), material(alpha=alpha, base_color=0.0, f0=1.0)):
            total = answers(row, eye, directions).sum(axis=0) * angle
            assert (total < 1.0 + 1e-3).all()
    even = 1.0 - cosine * math.log((1.0 + cosine) / cosine)
    assert np.allclose(total, even, atol=1e-5)
    lambert = answers(MIXES[-1], eye, directions).sum(axis=0) * angle
    assert np.allclose(lambert, MIXES[-1]["base_color"][0], atol=1e-5)


@pytest.mark.parametrize("samples", [48, 192])
def test_gloss_albedo(samples: int) -> None:
    """The table against the sum over the whole hemisphere of lights of a metal with base colour 1 (Fresnel 1: the first
    number) and 0 (Schlick's (1 - E.H)^5 alone: the second).

    Where E grazes, half the lobe lies below the plane: the midpoints know the place of that edge to one of `samples`.
    """
    table = shading.gloss_albedo(16, samples)
    directions, angle = hemisphere(600)
    for i in (1, 4, 9, 15):
        for j in (7, 11, 15):  # roughness 0.47 and more: sharper lobes fall between the directions
            e = eyes(i / 15, len(directions))
            row = material(metallic=1.0, alpha=(j / 15) ** 2, base_color=(1.0, 0.0, 0.0))
            total = answers(row, e, directions).sum(axis=0) * angle
            assert table[i, j] == pytest.approx(total[:2], abs=1.0 / samples)


def test_the_sky_is_the_sum_of_all_lights(plate: Plate, picture: Callable[..., pipeline.Picture]) -> None:
    """The closed form for a constant sky against the sum over directional lights all around.

    The dielectric's body takes what the coat leaves on average, an approximation: within 0.02.
    """
    stone = {"base_color": [0.8, 0.5, 0.2], "roughness": 0.6, "metallic": 0.3}
    camera = {"origin": [0, -0.6, 0.8], "target": [0, 0, 0], "fov": 1, "resolution": [1, 1]}
    seen = picture(plate([], materials={"stone": stone}, lights=[SKY], camera=camera)).radiance[0, 0]
    directions, angle = hemisphere(300)
    row = material(base_color=(0.8, 0.5, 0.2), alpha=0.36, metallic=0.3, f0=0.04, f90=1.0)
    total = answers(row, eyes(0.8, len(directions)), directions).sum(axis=0) * angle
    assert seen == pytest.approx(total, abs=0.02)
