"""A picture of the sky: read, looked up, and shining as a constant sky does, as integrals say, and as in Mitsuba."""

from __future__ import annotations

import io
import math
from collections.abc import Callable
from typing import Any

import numba
import numpy as np
import pytest
from numpy.typing import NDArray
from PIL import Image

import schema
from renderer import film, scattering, shading, skyfile
from renderer.errors import RenderError
from renderer.shading import Vector
from renderer.surroundings import prepared, surroundings
from renderer.tables import IRRADIANCE, LIGHT, Lighting, Surroundings

from . import foreign
from .parts import alone
from .scenes import RIDGE, SINGLE, SKEW, Floats, Json, family, line, only_noise, rms
from .test_foreign import RUNS, compared, student
from .test_material import material

Plate = Callable[..., Json]
Radiance = Callable[..., Floats]

EVEN = (1.0, 0.5, 0.25)
ENVMAP = {"type": "envmap", "file": "sky.exr"}
MATERIALS = {
    "matt": {"base_color": [0.7, 0.5, 0.3], "specular": 0},
    "plastic": {"base_color": [0.7, 0.5, 0.3], "roughness": 0.3},
    "metal": {"base_color": [0.9, 0.7, 0.4], "metallic": 1, "roughness": 0.4},
    "mirror": {"base_color": [0.9, 0.7, 0.4], "metallic": 0.5, "roughness": 0},
}
SHAPES = {"plate": {"type": "rectangle", "size": [2, 2]}, "ball": {"type": "sphere", "radius": 0.8}}


def directions(height: int) -> Floats:
    """(h, 2 h, 3) of the middles of texels, as the schema has them: from the zenith down, from +y over +x."""
    tilt, turn = (np.arange(height) + 0.5) * math.pi / height, (np.arange(2 * height) + 0.5) * math.pi / height
    across = np.sin(tilt)[:, None]
    return np.stack(
        [across * np.sin(turn), across * np.cos(turn), np.repeat(np.cos(tilt)[:, None], 2 * height, axis=1)], axis=2
    )


def grey(values: NDArray[Any]) -> NDArray[np.float32]:
    return np.repeat(values[..., None], 3, axis=2).astype(np.float32)


def files(picture: NDArray[Any]) -> Callable[[str], bytes]:
    data = film.exr({"RGB": np.ascontiguousarray(picture, np.float32)})
    return lambda name: data


def under(picture: NDArray[np.float32]) -> Lighting:
    """The light of a picture without suns."""
    made, suns = prepared(picture)
    assert len(suns) == 0
    return Lighting(np.zeros(0, LIGHT), np.zeros(3), made)


@pytest.mark.parametrize("name", MATERIALS)
@pytest.mark.parametrize("method", ["line", "area", "lines", "csg", "auto", "geometry", "relief"])
def test_an_even_picture_is_a_constant_sky(method: str, name: str, plate: Plate, radiance: Radiance) -> None:
    """With the same samples. A mirror or gloss that `line` would follow in closed form, or find bare, is sampled under
    a picture, as are mirrors that are matt in part: there the two differ by noise, each by 0.0006 of the mean with so
    many samples."""
    even = files(np.tile(np.array(EVEN, np.float32), (4, 8, 1)))
    for shape in SHAPES.values():
        for bounces in (0, 2):
            scene = plate([family()], materials={"stone": MATERIALS[name]}, render={"bounces": bounces})
            scene["objects"][0]["shape"] = shape
            constant = scene | {"lights": [{"type": "constant", "radiance": EVEN}]}
            noisy = bounces > 0 and name != "matt" and method in ("line", "area", "lines", "auto")
            samples = 256 if noisy and name == "mirror" else 16
            options: dict[str, Any] = {"method": method, "samples": samples, "texels": 64, "resolution": (24, 18)}
            found = radiance(scene | {"lights": [ENVMAP]}, meshes=even, **options)
            expected = radiance(constant, **options)
            if noisy:
                assert abs(found.mean() - expected.mean()) < 0.002 * expected.mean()
            else:
                assert np.abs(found - expected).max() < SINGLE


def test_the_furnace(plate: Plate, radiance: Radiance) -> None:
    white = {"base_color": [1, 1, 1], "specular": 0}
    scene = plate([family()], materials={"stone": white}, lights=[ENVMAP])
    for method in ("line", "csg", "geometry"):
        found = radiance(scene, method=method, samples=16, meshes=files(np.ones((16, 32, 3), np.float32)))
        assert np.abs(found - 1.0).max() < SINGLE


COMPASS = {
    (0, 0, 1): (1.0, 0.0, 0.0),
    (0, 0, -1): (0.0, 1.0, 0.0),
    (0, 1, 0): (0.0, 0.0, 1.0),
    (1, 0, 0): (1.0, 1.0, 0.0),
    (0, -1, 0): (0.0, 1.0, 1.0),
    (-1, 0, 0): (1.0, 0.0, 1.0),
}


def compass() -> NDArray[np.float32]:
    """A colour a direction: rows at the top and the bottom, and patches half way down, from the left edge on."""
    made = np.zeros((32, 64, 3), np.float32)
    made[:6], made[-6:] = COMPASS[0, 0, 1], COMPASS[0, 0, -1]
    for column, towards in ((0, (0, 1, 0)), (16, (1, 0, 0)), (32, (0, -1, 0)), (48, (-1, 0, 0))):
        made[12:20, np.arange(column - 4, column + 4)] = COMPASS[towards]
    return made


@pytest.mark.parametrize("method", ["line", "geometry"])
def test_directions(method: str, plate: Plate, radiance: Radiance) -> None:
    """What the background shows where one looks along each axis, and in a mirror; turned, and scaled."""
    chart = files(compass())
    for towards, colour in COMPASS.items():
        up = [0, 1, 0] if towards[2] else [0, 0, 1]
        camera = {"origin": [0, 0, 9], "target": [9 * towards[0], 9 * towards[1], 9 + 9 * towards[2]], "up": up,
                  "fov": 5, "resolution": [3, 3]}  # fmt: skip
        scene = plate([], camera=camera, lights=[ENVMAP], size=[0.01, 0.01])
        scene["objects"][0]["translate"] = [30, 30, 30]
        assert np.abs(radiance(scene, method=method, samples=4, meshes=chart) - colour).max() < SINGLE
        turned = scene | {"lights": [ENVMAP | {"rotate": 90, "scale": 3}]}
        x, y, z = towards  # what is seen there was at the place a quarter back
        assert np.abs(
            radiance(turned, method=method, samples=4, meshes=chart) - 3.0 * np.array(COMPASS[y, -x, z])
        ).max() < 3 * SINGLE  # fmt: skip
    camera = {"origin": [2, 0, 0.2], "target": [0, 0, 0.0], "fov": 2, "resolution": [3, 3]}
    chrome = {"base_color": [1, 1, 1], "metallic": 1, "roughness": 0}
    scene = plate([], camera=camera, lights=[ENVMAP], materials={"stone": chrome}, render={"bounces": 1})
    assert np.abs(radiance(scene, method=method, samples=4, meshes=chart) - COMPASS[-1, 0, 0]).max() < SINGLE


def test_the_background_is_the_mean_over_a_pixel(plate: Plate, radiance: Radiance) -> None:
    """A picture finer than pixels, by `line` and by samples."""
    fine = grey(np.random.default_rng(3).random((256, 512)) * np.ones((256, 512)))
    scene = plate([], lights=[ENVMAP], camera={"fov": 100, "resolution": [24, 18]}, size=[0.5, 0.5])
    options: dict[str, Any] = {"meshes": files(fine)}
    found = radiance(scene, method="line", **options)
    one, two = (radiance(scene, method="geometry", samples=1024, seed=seed, **options) for seed in (1, 2))
    assert rms(found - 0.5 * (one + two)) < 0.01
    assert rms(found - 0.5 * (one + two)) < 3.0 * rms(one - two)


@pytest.mark.parametrize("axis", [0, 1, 2])
def test_irradiance_of_half_a_sky(axis: int) -> None:
    """Of a matt surface under a white hemisphere: (1 + n.a) / 2, the part of its cosine that falls on that."""
    made = under(grey((directions(512)[..., axis] > 0.0) * 1.0)).surroundings
    normals = np.random.default_rng(1).normal(size=(500, 3))
    normals = np.concatenate([normals / np.linalg.norm(normals, axis=1, keepdims=True), np.eye(3), -np.eye(3)])
    looked_up = alone(shading.looked_up)
    for n in normals:
        assert looked_up(made, IRRADIANCE, tuple(n))[0] == pytest.approx(0.5 + 0.5 * n[axis], abs=2e-4)
    assert made.white == pytest.approx(1.0, abs=2e-4)


@pytest.mark.parametrize("method", ["line", "geometry"])
@pytest.mark.parametrize("tilt", [0.0, 35.0, 80.0])
def test_a_plate_under_half_a_sky(method: str, tilt: float, plate: Plate, radiance: Radiance) -> None:
    """Turned about y, so that its normal leans to +x; and with the picture turned the other way."""
    half = files(grey((directions(256)[..., 0] > 0.0) * 1.0))
    sine = math.sin(math.radians(tilt))
    scene = plate([], camera={"origin": [4 * sine, 0, 4 * math.cos(math.radians(tilt))], "up": [0, 1, 0], "fov": 5,
                              "target": [0, 0, 0]}, lights=[ENVMAP])  # fmt: skip
    scene["objects"][0]["rotate"] = [0, tilt, 0]
    base = np.array([0.7, 0.65, 0.6])
    found = radiance(scene, method=method, samples=4, meshes=half)
    assert np.abs(found - base * (0.5 + 0.5 * sine)).max() < 3e-4
    turned = radiance(scene | {"lights": [ENVMAP | {"rotate": 180}]}, method=method, samples=4, meshes=half)
    assert np.abs(turned - base * (0.5 - 0.5 * sine)).max() < 3e-4
    across = radiance(scene | {"lights": [ENVMAP | {"rotate": -90}]}, method=method, samples=4, meshes=half)
    assert np.abs(across - base * 0.5).max() < 3e-4


@numba.njit(error_model="numpy")  # type: ignore[untyped-decorator]
def gloss(
    row: NDArray[np.void], lighting: Lighting, albedo: Floats, n: Vector, e: Vector, count: int
) -> tuple[float, float]:
    """Radiance under a sky in closed form, and by so many rays squared."""
    total = 0.0
    for i in range(count):
        for j in range(count):
            l, weight = scattering.scatter(row[0], albedo, n, e, 0.0, (i + 0.5) / count, (j + 0.5) / count, False)
            total += weight[0] * shading.sky_from(lighting, l)[0] / count**2
    return shading.ambient(row[0], lighting, albedo, n, e)[0], total


@pytest.mark.parametrize(("kind", "most"), [("linear", 0.02), ("half", 0.15)])
def test_gloss(kind: str, most: float) -> None:
    """The split sum against rays: a picture linear in the direction is found from all sides, and an edge, the worst
    there is, within 0.15 of its height where E grazes, 0.025 on root mean square."""
    towards = directions(256)[..., 0]
    lighting = under(grey(1.0 + 0.5 * towards if kind == "linear" else (towards > 0.0) * 1.0))
    albedo = shading.gloss_albedo(16, 128)
    random = np.random.default_rng(5)
    off = []
    for roughness in (0.1, 0.2, 0.4, 0.6, 0.8, 1.0):
        row = material(metallic=1.0, alpha=roughness**2, base_color=1.0)
        for cosine in (0.95, 0.7, 0.4, 0.2):
            for _ in range(8):
                n, t = random.normal(size=(2, 3))
                n /= np.linalg.norm(n)
                t -= (t @ n) * n
                e = cosine * n + math.sqrt(1.0 - cosine**2) * t / np.linalg.norm(t)
                found, expected = gloss(row, lighting, albedo, tuple(n), tuple(e), 100)
                off.append(found - expected)
    assert np.abs(off).max() < most
    assert rms(np.array(off)) < (0.005 if kind == "linear" else 0.025)


def smooth(towards: Floats) -> Floats:
    """A sky (h, w, 3) of low frequencies, brighter above."""
    x, y, z = towards[..., 0], towards[..., 1], towards[..., 2]
    return np.stack([1.0 + 0.5 * x + 0.3 * z, 0.8 + 0.6 * z, 0.7 + 0.4 * y * z + 0.3 * x * y], axis=2)


@pytest.mark.parametrize("name", MATERIALS)
def test_methods_agree(name: str, plate: Plate, radiance: Radiance) -> None:
    """`auto` and `csg` against `geometry`, without bounces exactly so far as edges go, and with some but for noise."""
    sky = files(smooth(directions(64)))
    grooves = [family(), line([-1, 0.9], [3, 1.2], profile=RIDGE)]
    camera = {"fov": 20, "resolution": [24, 18]}
    scene = plate(grooves, lights=[ENVMAP], materials={"stone": MATERIALS[name]}, camera=camera)
    truth = radiance(scene, method="geometry", samples=400, meshes=sky)
    for method in ("auto", "csg", "area"):
        found = radiance(scene, method=method, samples=400, meshes=sky)
        assert rms(found - truth) < 0.01
        assert abs(found.mean() - truth.mean()) < 0.001
    followed = scene | {"render": {"bounces": 2}}
    one, again, other = (
        radiance(followed, method=method, samples=64, seed=seed, meshes=sky)
        for method, seed in (("geometry", 1), ("geometry", 2), ("csg", 3))
    )
    only_noise(one, other, again)


@pytest.mark.parametrize("shape", ["plate", "grooved", "ball"])
def test_as_mitsuba_has_it(shape: str, plate: Plate, radiance: Radiance) -> None:
    """`geometry` against Mitsuba's path tracer under the same smooth sky; 8 bounces leave less than (0.7 / 2)^8 of it.

    Mitsuba's picture is the same function of the direction at its own texels, the first and last of which are poles.
    """
    mitsuba = foreign.load()
    grooves = [family(step=0.4, count=5)] if shape != "plate" else [family([[b, 1e-9 * w] for b, w in SKEW])]
    camera = {"origin": [0.1, -1.2, 1.1], "target": [0, 0, 0], "fov": 25, "resolution": [32, 24]}
    scene = plate(grooves, lights=[], camera=camera, render={"bounces": 8})
    if shape == "ball":
        scene["objects"][0] |= {"shape": {"type": "sphere", "radius": 0.4}, "mapping": {"scale": [2.5, 1.25]}}
        scene["camera"]["fov"] = 40
    height = 512
    tilt, turn = np.arange(height) * math.pi / (height - 1), (np.arange(2 * height) + 0.5) * math.pi / height
    across = np.sin(tilt)[:, None]
    nodes = np.stack([across * np.sin(turn), across * np.cos(turn), np.cos(tilt)[:, None] + 0.0 * turn], axis=2)
    report = schema.check(scene)
    assert report.scene is not None
    theirs_scene = foreign.foreign_scene(mitsuba, report.scene, around=smooth(nodes))
    theirs = np.array([foreign.picture(mitsuba, theirs_scene, 64, seed) for seed in range(RUNS)])
    scene["lights"] = [ENVMAP]
    sky, solids = files(smooth(directions(256))), {}  # type: ignore[var-annotated]
    ours = np.array(
        [radiance(scene, method="geometry", samples=64, seed=k, meshes=sky, solids=solids) for k in range(RUNS)]
    )
    z, (difference, error) = compared(ours, theirs)
    least, most = student(2 * RUNS - 2, len(z)), student(RUNS - 1, len(z))
    found = f"z^2 {np.mean(z**2):.3f} of {len(z)} pixels, means differ by {difference:.2e}, error {error:.2e}"
    assert len(z) > 300
    assert abs(difference) < 4.0 * error + 2e-4, found
    assert least[0] - 4.0 * least[1] < np.mean(z**2) < most[0] + 4.0 * most[1], found


def sunny(height: int, row: int, column: int, power: float) -> tuple[NDArray[np.float32], Floats]:
    """A dim sky with a texel of that much irradiance, and the direction to it."""
    made = np.full((height, 2 * height, 3), 0.1, np.float32)
    solid = math.pi / height * (math.cos(math.pi * row / height) - math.cos(math.pi * (row + 1) / height))
    made[row, column] = power / solid
    return made, directions(height)[row, column]


def test_a_sun_becomes_a_directional_light(plate: Plate, radiance: Radiance) -> None:
    """Its power and its place are kept, it casts shadows, and no samples are needed to find it."""
    picture, towards = sunny(256, 60, 100, 2.0)
    data = film.exr({"RGB": picture})
    made, suns = surroundings("sky.exr", data, 2.0, 90.0)
    assert suns.shape == (1, 6)
    assert suns[0, :3] == pytest.approx([-towards[1], towards[0], towards[2]], abs=1e-6)
    looked_up = alone(shading.looked_up)
    kept = looked_up(made, 0, (-towards[1], towards[0], towards[2]))[0]
    assert kept < 1e-2 * 2.0 * picture.max()
    n = (0.0, 0.0, 1.0)
    assert suns[0, 3] * towards[2] / math.pi + looked_up(made, IRRADIANCE, n)[0] == pytest.approx(
        2.0 * (0.1 + 2.0 * towards[2] / math.pi), rel=2e-3
    )
    white = {"base_color": [1, 1, 1], "specular": 0}
    scene = plate([], lights=[ENVMAP], materials={"stone": white}, camera={"fov": 20, "resolution": [16, 12]})
    for method, bounces in (("line", 0), ("csg", 0), ("geometry", 2)):
        found = radiance(scene | {"render": {"bounces": bounces}}, method=method, samples=256, meshes=lambda name: data)
        assert np.abs(found - (0.1 + 2.0 * towards[2] / math.pi)).max() < (0.01 if bounces == 0 else 0.5)
        assert found.mean() == pytest.approx(0.1 + 2.0 * towards[2] / math.pi, rel=0.01)


# --- files ---


def rgbe(picture: NDArray[np.float32]) -> NDArray[np.uint8]:
    largest = picture.max(axis=2)
    _, power = np.frexp(largest)
    scaled = picture * np.ldexp(256.0, -power)[..., None]
    made = np.concatenate([scaled, power[..., None] + 128.0], axis=2).astype(np.uint8)
    made[largest < 1e-32] = 0
    return made


def hdr(
    picture: NDArray[np.float32], coded: bool, header: bytes = b"#?RADIANCE\n# a\nFORMAT=32-bit_rle_rgbe\n"
) -> bytes:
    height, width, _ = picture.shape
    out = header + b"\n-Y %d +X %d\n" % (height, width)
    for row in rgbe(picture):
        if not coded:
            out += row.tobytes()
            continue
        out += bytes([2, 2, width >> 8, width & 255])
        for values in row.T:
            at = 0
            while at < width:
                run = 1
                while at + run < width and run < 127 and values[at + run] == values[at]:
                    run += 1
                if run > 2:
                    out += bytes([128 + run, values[at]])
                else:
                    run = min(2, width - at)
                    out += bytes([run, *values[at : at + run]])
                at += run
    return out


def dyadic() -> NDArray[np.float32]:
    """A picture that RGBE holds exactly."""
    random = np.random.default_rng(2)
    made = np.ldexp(random.integers(128, 256, (9, 40, 3)) / 256.0, random.integers(-9, 12, (9, 40, 1)))
    made[2:4, 5:30], made[5, 3] = made[1, 1], 0.0
    return made.astype(np.float32)


def png(pixels: NDArray[Any]) -> bytes:
    out = io.BytesIO()
    Image.fromarray(pixels).save(out, "PNG")
    return out.getvalue()


def test_files_are_read() -> None:
    picture = dyadic()
    for data in (hdr(picture, False), hdr(picture, True)):
        assert (skyfile.read("A.HDR", data) == picture).all()
    exposed = hdr(picture, True, b"#?RGBE\nEXPOSURE=2\nEXPOSURE= 4\n")
    assert (skyfile.read("a.hdr", exposed) == picture / 8).all()
    assert (skyfile.read("a.exr", film.exr({"RGB": picture})) == picture).all()
    parts = {name: np.ascontiguousarray(picture[..., i]) for i, name in enumerate("RGB")}
    assert (skyfile.read("a.exr", film.exr(parts | {"A": parts["R"]})) == picture).all()
    assert (skyfile.read("a.exr", film.exr({"Y": parts["G"]})) == picture[..., [1, 1, 1]]).all()
    linear = np.linspace(0.0, 1.0, 96, dtype=np.float32).reshape(4, 8, 3)
    read = skyfile.read("a.png", png(film.srgb(linear)))
    assert np.abs(read - linear).max() < 0.5 / 255 * 2.3  # half a step, times the steepest slope
    grey16 = skyfile.read("a.png", png(np.array([[0, 65535, 32768]], np.uint16)))
    assert grey16[0, :, 0] == pytest.approx([0.0, 1.0, 0.21404], abs=1e-4)


ONE = np.ones((2, 4, 3), np.float32)


def spoilt(value: float) -> bytes:
    made = ONE.copy()
    made[1, 2, 0] = value
    return film.exr({"RGB": made})


BAD = [
    ("a.jpg", b"", "expected an EXR, HDR or PNG file, found 'a.jpg'"),
    ("a.exr", b"nonsense", "expected a readable EXR file"),
    ("a.png", b"nonsense", "expected a readable PNG file"),
    ("a.png", png(np.zeros((2, 2, 3), np.uint8))[:40], "expected a readable PNG file"),
    ("a.hdr", b"nonsense", "expected a Radiance picture, which begins with #?, found b'nonsense'"),
    ("a.hdr", b"#?RADIANCE\n\n+Y 1 -X 1\n", "expected a header that ends with -Y HEIGHT +X WIDTH, found none"),
    ("a.hdr", hdr(ONE, False, b"#?RADIANCE\nFORMAT=32-bit_rle_xyze\n"), "expected FORMAT=32-bit_rle_rgbe"),
    ("a.hdr", hdr(ONE, False, b"#?RADIANCE\nEXPOSURE=0\n"), "expected an EXPOSURE above 0, found 0"),
    ("a.hdr", hdr(ONE, False)[:-1], "expected 2 rows of texels, flat or run-length encoded, found 1"),
    ("a.hdr", hdr(dyadic(), True)[:-1], "expected 9 rows of texels, flat or run-length encoded, found 8"),
    ("a.hdr", b"#?RADIANCE\n\n-Y 1 +X 2\n" + bytes([9, 9, 9, 9, 1, 1, 1, 1]), "expected 1 rows of texels"),
    ("a.hdr", b"#?RADIANCE\n\n-Y 99999 +X 99999\n", "expected 1 to 33554432 texels, 65536 a side at most"),
    ("a.exr", spoilt(math.nan), "expected texels that are finite and not negative, found nan in row 1, column 2"),
    ("a.exr", spoilt(math.inf), "expected texels that are finite and not negative, found inf in row 1, column 2"),
    ("a.exr", spoilt(-1.0), "expected texels that are finite and not negative, found -1 in row 1, column 2"),
    ("a.exr", film.exr({"Z": ONE[..., 0].copy()}), "expected channels R, G and B, or Y, found Z"),
]


@pytest.mark.parametrize(("name", "data", "message"), BAD, ids=[message[:40] for _, _, message in BAD])
def test_bad_files(name: str, data: bytes, message: str, plate: Plate, radiance: Radiance) -> None:
    with pytest.raises(skyfile.SkyFileError) as error:
        skyfile.read(name, data)
    assert str(error.value).startswith(message)
    scene = plate([], lights=[{"type": "constant", "radiance": [1, 1, 1]}, ENVMAP | {"file": name}])
    with pytest.raises(RenderError) as refused:
        radiance(scene, meshes=lambda name: data)
    (fault,) = refused.value.faults
    assert fault.pointer == "/lights/1/file"
    assert f"expected {fault.expected}, found {fault.found}" == str(error.value)


def test_files_that_are_not_there(plate: Plate, radiance: Radiance) -> None:
    scene = plate([], lights=[ENVMAP])
    with pytest.raises(RenderError, match="/lights/0/file: expected no envmap, as no file can be read here"):
        radiance(scene)

    def gone(name: str) -> bytes:
        raise FileNotFoundError(2, "No such file or directory", name)

    with pytest.raises(RenderError, match=r"file: expected a file that can be read, found 'sky\.exr': No such"):
        radiance(scene, meshes=gone)


def test_any_size() -> None:
    for shape in ((1, 1), (1, 7), (5, 3)):
        made, suns = prepared(np.full((*shape, 3), 0.5, np.float32))
        assert len(suns) == 0
        assert isinstance(made, Surroundings)
        assert (made.texels == 0.5).all()
