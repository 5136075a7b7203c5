"""Captured files and frames of the stream. Notebooks show both as images."""

import base64
import io
import struct
from dataclasses import dataclass

_HEADER = struct.Struct("<4sBBBBHHIIIIHHHHHHQIIII")
_FIELDS = ("magic version type codec flags header_bytes quality frame_seq render_id input_seq_echo "
           "state_rev width height x y full_width full_height render_start_us render_us encode_us "
           "queue_us sample_count").split()

FLAG_FINAL = 2
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


@dataclass(repr=False)
class Frame(_Shown):
    """One frame of the stream; `header` holds the fields listed in protocol/README.md."""

    header: dict
    data: bytes

    @classmethod
    def parse(cls, message):
        header = dict(zip(_FIELDS, _HEADER.unpack_from(message)))
        if header["magic"] != b"HVRF":
            raise ValueError("not a frame of heliograph.v1")
        return cls(header, bytes(message[header["header_bytes"]:]))

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
