"""Pictures of the surroundings: EXR, Radiance HDR and PNG files as linear radiance."""

from __future__ import annotations

import io
import re
import tempfile
from pathlib import Path, PurePath

import numpy as np
from numpy.typing import NDArray

from renderer.kernel import kernel

SUFFIXES = (".exr", ".hdr", ".png")
MAX_TEXELS = 33_554_432  # 8192 x 4096
LONGEST = 65_536  # texels along a side

Picture = NDArray[np.float32]


class SkyFileError(ValueError):
    """A picture that cannot be used; `expected` and `found` say why."""

    def __init__(self, expected: str, found: str) -> None:
        super().__init__(f"expected {expected}, found {found}")
        self.expected, self.found = expected, found


def read(name: str, data: bytes) -> Picture:
    """Linear RGB (h, w, 3) of a picture file, its upper row first; `name` tells its kind. PNG is taken for sRGB.

    Raises SkyFileError where it cannot be read, is too large, or a texel is no radiance.
    """
    suffix = PurePath(name).suffix.lower()
    readers = {".exr": _exr, ".hdr": _hdr, ".png": _png}
    if suffix not in readers:
        raise SkyFileError("an EXR, HDR or PNG file", repr(name))
    try:
        picture = np.ascontiguousarray(readers[suffix](data), np.float32)
    except SkyFileError:
        raise
    except Exception as error:  # Pillow and OpenEXR raise whatever the file makes them meet
        raise SkyFileError(f"a readable {suffix[1:].upper()} file", f"{type(error).__name__}: {error}") from None
    bad = np.argwhere(~(np.isfinite(picture) & (picture >= 0.0)))
    if len(bad):
        row, column, channel = bad[0]
        found = f"{picture[row, column, channel]:g} in row {row}, column {column}"
        raise SkyFileError("texels that are finite and not negative", found)
    return picture


def _sized(width: int, height: int) -> None:
    if not (0 < width <= LONGEST and 0 < height <= LONGEST and width * height <= MAX_TEXELS):
        raise SkyFileError(f"1 to {MAX_TEXELS} texels, {LONGEST} a side at most", f"{width} x {height}")


def _exr(data: bytes) -> Picture:
    """Channels R, G and B, or Y for a grey picture."""
    import OpenEXR  # slow to load, and few scenes need it

    with tempfile.TemporaryDirectory() as folder:
        path = str(Path(folder) / "sky.exr")
        Path(path).write_bytes(data)
        try:
            low, high = OpenEXR.File(path, header_only=True).header()["dataWindow"]
            _sized(*(int(size) for size in high - low + 1))
            channels = OpenEXR.File(path, separate_channels=True).channels()
        except RuntimeError as error:
            raise SkyFileError("a readable EXR file", str(error).replace(path, PurePath(path).name)) from None
    names = ("R", "G", "B") if "R" in channels else ("Y", "Y", "Y")
    if any(name not in channels for name in names):
        raise SkyFileError("channels R, G and B, or Y", ", ".join(sorted(channels)))
    return np.stack([np.asarray(channels[name].pixels, np.float32) for name in names], axis=2)


def _png(data: bytes) -> Picture:
    from PIL import Image, UnidentifiedImageError

    try:
        Image.open(io.BytesIO(data), formats=("PNG",)).close()
    except UnidentifiedImageError:
        raise SkyFileError("a readable PNG file", "something else") from None
    with Image.open(io.BytesIO(data), formats=("PNG",)) as image:
        _sized(*image.size)
        if image.mode in ("I", "I;16"):
            encoded = np.repeat(np.asarray(image, np.float32)[..., None] / np.float32(65535.0), 3, axis=2)
        else:
            encoded = np.asarray(image.convert("RGB"), np.float32) / np.float32(255.0)
    return np.where(encoded <= 0.04045, encoded / 12.92, ((encoded + 0.055) / 1.055) ** 2.4)  # IEC 61966-2-1


def _hdr(data: bytes) -> Picture:
    """Radiance's RGBE (G. Ward, "Real pixels", Graphics Gems II, 1991): mantissas over 256, one exponent over 128."""
    if not data.startswith(b"#?"):
        raise SkyFileError("a Radiance picture, which begins with #?", repr(data[:10]))
    match = re.match(rb"#\?((?:.|\n)*?)\n\r?\n-Y (\d{1,9}) \+X (\d{1,9})\r?\n", data[:65536])
    if match is None:
        raise SkyFileError("a header that ends with -Y HEIGHT +X WIDTH", "none")
    header = match[1].decode("latin-1")
    kind = re.search(r"^FORMAT=\s*(\S+)", header, re.MULTILINE)
    if kind is not None and kind[1] != "32-bit_rle_rgbe":
        raise SkyFileError("FORMAT=32-bit_rle_rgbe", kind[1][:40])
    height, width = int(match[2]), int(match[3])
    _sized(width, height)
    rgbe = np.zeros((height, 4, width), np.uint8)
    row = unpack(np.frombuffer(data, np.uint8, offset=match.end()), rgbe)
    if row < height:
        raise SkyFileError(f"{height} rows of texels, flat or run-length encoded", f"{row}")
    exposure = float(np.prod([float(value) for value in re.findall(r"^EXPOSURE=\s*(\S+)", header, re.MULTILINE)]))
    if not (np.isfinite(exposure) and exposure > 0.0):
        raise SkyFileError("an EXPOSURE above 0", f"{exposure:g}")
    mantissa, power = rgbe[:, :3].astype(np.float32), rgbe[:, 3:].astype(np.int32) - 136
    values = np.where(power > -136, np.ldexp(mantissa, power), 0.0) / exposure
    return np.asarray(values.transpose(0, 2, 1), np.float32)


@kernel
def unpack(data: NDArray[np.uint8], rgbe: NDArray[np.uint8]) -> int:
    """Fill (h, 4, w) from the rows of a Radiance picture: how many rows are there and well-formed.

    A row begins with 2, 2 and its length where its components follow one another, each run-length encoded; else it is
    flat. The older encoding, which repeats whole texels, is not read.
    """
    height, width = len(rgbe), rgbe.shape[2]
    at, end = 0, len(data)
    for row in range(height):
        coded = 8 <= width < 32768 and at + 4 <= end and data[at] == 2 and data[at + 1] == 2
        if coded and data[at + 2] < 128:
            if (data[at + 2] << 8) + data[at + 3] != width:
                return row
            at += 4
            for component in range(4):
                column = 0
                while column < width:
                    if at + 2 > end:
                        return row
                    count = int(data[at])
                    same = count > 128
                    if same:
                        count -= 128
                    if count == 0 or column + count > width or (not same and at + 1 + count > end):
                        return row
                    for i in range(count):
                        rgbe[row, component, column + i] = data[at + 1 + (0 if same else i)]
                    column += count
                    at += 2 if same else 1 + count
            continue
        if at + 4 * width > end:
            return row
        for column in range(width):
            if data[at] == 1 and data[at + 1] == 1 and data[at + 2] == 1:
                return row  # a run of the older encoding: a texel's largest mantissa is 128 at least
            for component in range(4):
                rgbe[row, component, column] = data[at + component]
            at += 4
    return height
