"""Captured files and frames of the stream. Notebooks show both as images."""

import base64
import io
import struct
import zlib
from dataclasses import dataclass

_HEADER = struct.Struct("<4sBBBBHHIIIIHHHHHHQIIII")
_FIELDS = ("magic version type codec flags header_bytes quality frame_seq render_id input_seq_echo "
           "state_rev width height x y full_width full_height render_start_us render_us encode_us "
           "queue_us sample_count").split()

FLAG_FINAL = 2
FLAG_DEPTH = 16
CODEC_JPEG, CODEC_PNG = 1, 2


class _Shown:
    """Display in notebooks: the bytes of a format that they can show, else None."""

    def _repr_png_(self):
        return self.data if self.data[:4] == b"\x89PNG" else None

    def _repr_jpeg_(self):
        return self.data if self.data[:2] == b"\xff\xd8" else None

    def save(self, path):
        """Writes the file unchanged."""
        with open(path, "wb") as file:
            file.write(self.data)


@dataclass(repr=False)
class Capture(_Shown):
    """One buffer as a file of `format`: png, jpeg, npy or exr."""

    buffer: str
    format: str
    width: int
    height: int
    samples: int
    data: bytes

    @classmethod
    def from_result(cls, result):
        return cls(**{**{name: result[name] for name in cls.__dataclass_fields__},
                      "data": base64.b64decode(result["data"])})

    def numpy(self):
        """The array of an npy capture: (height, width) or (height, width, channels)."""
        import numpy
        if self.format != "npy":
            raise ValueError(f"a capture as {self.format} is not an array; capture it as npy")
        return numpy.load(io.BytesIO(self.data), allow_pickle=False)

    def __repr__(self):
        return (f"<{self.buffer} as {self.format}, {self.width} x {self.height}, "
                f"{self.samples} samples, {len(self.data)} bytes>")


# After the header: size of the plane, nearest, eye, target, up, vertical_fov, compressed bytes.
_DEPTH = struct.Struct("<HHf3f3f3ffI")


@dataclass
class Depth:
    """The camera of a frame and where its surfaces are, coarsely, as protocol/README.md describes."""

    width: int
    height: int
    nearest: float
    eye: tuple
    target: tuple
    up: tuple
    vertical_fov: float
    samples: list

    @classmethod
    def parse(cls, data):
        width, height, nearest, *camera, size = _DEPTH.unpack_from(data)
        differences = zlib.decompress(data[_DEPTH.size:_DEPTH.size + size])
        eye, target, up = (tuple(camera[i:i + 3]) for i in (0, 3, 6))
        return cls(width, height, nearest, eye, target, up, camera[9],
                   _samples(differences, width))

    def view_z(self, column, row):
        """Metres along the view; infinite in the background."""
        sample = self.samples[row * self.width + column]
        return 65535 * self.nearest / sample if sample else float("inf")


def _samples(differences, width):
    """Adds the differences from what a plane through the neighbours predicts."""
    count = len(differences) // 2
    samples = []
    for i in range(count):
        folded = differences[i] | differences[count + i] << 8
        left = samples[i - 1] if i % width else 0
        above = samples[i - width] if i >= width else 0
        corner = samples[i - width - 1] if i % width and i >= width else 0
        difference = folded >> 1 ^ -(folded & 1)
        samples.append(left + above - corner + difference & 0xFFFF)
    return samples


@dataclass(repr=False)
class Frame(_Shown):
    """One frame of the stream; `header` holds the fields listed in protocol/README.md."""

    header: dict
    data: bytes
    extension: bytes = b""

    @classmethod
    def parse(cls, message):
        header = dict(zip(_FIELDS, _HEADER.unpack_from(message)))
        if header["magic"] != b"HVRF":
            raise ValueError("not a frame of heliograph.v1")
        end = header["header_bytes"]
        return cls(header, bytes(message[end:]), bytes(message[_HEADER.size:end]))

    @property
    def depth(self):
        """Its camera and depth, if they were requested: `stream.configure(depth=True)`."""
        return Depth.parse(self.extension) if self.header["flags"] & FLAG_DEPTH else None

    @property
    def width(self):
        return self.header["width"]

    @property
    def height(self):
        return self.header["height"]

    @property
    def samples(self):
        return self.header["sample_count"]

    @property
    def final(self):
        """Whether it is the final frame of a static view, in full quality."""
        return bool(self.header["flags"] & FLAG_FINAL)

    def __repr__(self):
        return (f"<frame {self.header['frame_seq']}, {self.width} x {self.height}, "
                f"{self.samples} samples, {len(self.data)} bytes>")
