"""Environments of the set as files that `heliograph render --environment` takes."""

import numpy
from PIL import Image


def linear(codes):
    value = codes / 255.0
    return numpy.where(value <= 0.04045, value / 12.92, ((value + 0.055) / 1.055) ** 2.4)


def shared_exponent(radiance):
    """[h, w, 4] bytes: mantissas of 8 bits and their exponent (Ward 1991)."""
    _, exponent = numpy.frexp(radiance.max(-1, keepdims=True))
    mantissas = numpy.floor(numpy.ldexp(radiance, 8 - exponent))
    pixels = numpy.concatenate((mantissas, exponent + 128), -1)
    return numpy.where(radiance.max(-1, keepdims=True) < 1e-32, 0, pixels).astype(numpy.uint8)


def write_hdr(path, radiance):
    """Radiance's format without run lengths. `radiance`: [h, w, 3], linear."""
    height, width, _ = radiance.shape
    header = f"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y {height} +X {width}\n"
    path.write_bytes(header.encode() + shared_exponent(radiance).tobytes())


def environment_file(path, folder):
    """The file itself, or, of an image of code values, a copy of linear radiance in `folder`."""
    if path.suffix.lower() in (".hdr", ".exr"):
        return path
    copy = folder / f"{path.stem}.hdr"
    if not copy.exists():
        write_hdr(copy, linear(numpy.asarray(Image.open(path).convert("RGB"), float)))
    return copy
