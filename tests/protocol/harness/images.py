"""Decodes images: PNG in Python, JPEG with the library that the server needs. Encodes plain ones."""

import ctypes
import struct
import zlib
from dataclasses import dataclass


@dataclass
class Image:
    width: int
    height: int
    rgb: bytes

    def mean(self):
        return sum(self.rgb) / len(self.rgb)

    def deviation(self):
        mean = self.mean()
        return (sum((value - mean) ** 2 for value in self.rgb) / len(self.rgb)) ** 0.5


def difference(a, b):
    """Mean absolute difference, 0 to 255."""
    assert (a.width, a.height) == (b.width, b.height)
    return sum(abs(x - y) for x, y in zip(a.rgb, b.rgb)) / len(a.rgb)


def _paeth(left, above, corner):
    guess = left + above - corner
    by_left, by_above, by_corner = abs(guess - left), abs(guess - above), abs(guess - corner)
    if by_left <= by_above and by_left <= by_corner:
        return left
    return above if by_above <= by_corner else corner


def _unfilter(kind, line, above):
    for i, value in enumerate(line):
        left = line[i - 3] if i >= 3 else 0
        corner = above[i - 3] if i >= 3 else 0
        guess = (0, left, above[i], (left + above[i]) // 2, _paeth(left, above[i], corner))[kind]
        line[i] = (value + guess) & 255
    return line


def encode_png(color, width=4, height=4):
    """A PNG file of one color, 8 bit RGB."""
    def chunk(kind, body):
        return (struct.pack(">I", len(body)) + kind + body
                + struct.pack(">I", zlib.crc32(kind + body)))
    rows = (b"\0" + bytes(color) * width) * height
    header = struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0)
    return (b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header)
            + chunk(b"IDAT", zlib.compress(rows)) + chunk(b"IEND", b""))


def decode_png(file):
    """8 bit RGB, not interlaced, checksums verified."""
    assert file[:8] == b"\x89PNG\r\n\x1a\n", "not a PNG"
    position, packed, size = 8, b"", None
    while True:
        length, kind = struct.unpack_from(">I4s", file, position)
        body = file[position + 8:position + 8 + length]
        checksum, = struct.unpack_from(">I", file, position + 8 + length)
        assert checksum == zlib.crc32(kind + body), f"damaged {kind}"
        position += 12 + length
        if kind == b"IHDR":
            size = struct.unpack(">IIBBBBB", body)
        elif kind == b"IDAT":
            packed += body
        elif kind == b"IEND":
            break
    width, height, *form = size
    assert form == [8, 2, 0, 0, 0], f"not plain RGB: {form}"
    data, lines, above = zlib.decompress(packed), [], bytes(3 * width)
    for row in range(height):
        start = row * (3 * width + 1)
        line = bytearray(data[start + 1:start + 1 + 3 * width])
        above = _unfilter(data[start], line, above)
        lines.append(bytes(above))
    return Image(width, height, b"".join(lines))


_turbo = None


def decode_jpeg(file):
    """Decodes strictly: any warning of the library is an error. Also tells the chroma sampling."""
    global _turbo
    if _turbo is None:
        _turbo = ctypes.CDLL("libturbojpeg.so.0")
        _turbo.tjInitDecompress.restype = ctypes.c_void_p
        _turbo.tjDestroy.argtypes = [ctypes.c_void_p]
        _turbo.tjDecompressHeader3.argtypes = [
            ctypes.c_void_p, ctypes.c_char_p, ctypes.c_ulong, *[ctypes.POINTER(ctypes.c_int)] * 4]
        _turbo.tjDecompress2.argtypes = [ctypes.c_void_p, ctypes.c_char_p, ctypes.c_ulong,
                                         ctypes.c_void_p, *[ctypes.c_int] * 5]
    stop_on_warning, rgb = 8192, 0
    width, height, sampling, colours = (ctypes.c_int() for _ in range(4))
    handle = _turbo.tjInitDecompress()
    try:
        failed = _turbo.tjDecompressHeader3(handle, file, len(file), width, height, sampling,
                                            colours)
        assert not failed, "not a JPEG"
        pixels = ctypes.create_string_buffer(width.value * height.value * 3)
        failed = _turbo.tjDecompress2(handle, file, len(file), pixels, width.value, 0, height.value,
                                      rgb, stop_on_warning)
        assert not failed, "damaged JPEG"
    finally:
        _turbo.tjDestroy(handle)
    image = Image(width.value, height.value, pixels.raw)
    image.full_chroma = sampling.value == 0
    return image
