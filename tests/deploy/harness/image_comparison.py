"""Compares images with the decoders of the protocol tests."""

import importlib.util
import os

from .commands import run
from .files import ROOT

_path = os.path.join(ROOT, "tests/protocol/harness/images.py")
_spec = importlib.util.spec_from_file_location("protocol_decoders", _path)
_decoders = importlib.util.module_from_spec(_spec)
_spec.loader.exec_module(_decoders)
decode_png, decode_jpeg, difference = (_decoders.decode_png, _decoders.decode_jpeg,
                                       _decoders.difference)

BLOCKS = 8
# Limit of `largest_difference_of_means`. Two releases of Debian have different compilers, Mesa and
# Embree, so that single rays may hit the other side of an edge. That does not change the mean of a
# block by more than half a code value of 255.
SAME_IMAGE = 0.5


def render(scene, output, *, size=(160, 90), samples=8):
    """Renders with the program of this build, on this machine."""
    run(os.environ["HELIOGRAPH_BINARY"], "render", scene, "-o", output, "--width", str(size[0]),
        "--height", str(size[1]), "--samples", str(samples), timeout=600)


def read(path):
    with open(path, "rb") as file:
        return decode_png(file.read())


def largest_difference_of_means(a, b):
    """The largest difference of the means of 8 x 8 blocks, 0 to 255: noise averages out."""
    a, b = (read(image) if isinstance(image, str) else image for image in (a, b))
    assert (a.width, a.height) == (b.width, b.height), (a.width, a.height, b.width, b.height)
    return max(abs(x - y) for x, y in zip(_means(a), _means(b)))


def _means(image):
    sums, counts = [0] * (3 * BLOCKS ** 2), [0] * (3 * BLOCKS ** 2)
    for index, value in enumerate(image.rgb):
        pixel, channel = divmod(index, 3)
        y, x = divmod(pixel, image.width)
        block = (y * BLOCKS // image.height) * BLOCKS + x * BLOCKS // image.width
        sums[3 * block + channel] += value
        counts[3 * block + channel] += 1
    return [total / count for total, count in zip(sums, counts)]
