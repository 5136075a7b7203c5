"""Writes small glTF files."""

import array
import base64
import json
import struct


def document(positions, indices):
    """A document of one node that shows one mesh, without its buffer's bytes, and these."""
    vertex_bytes = array.array("f", positions).tobytes()
    index_bytes = array.array("I", indices).tobytes()
    columns = [positions[axis::3] for axis in range(3)]
    return {
        "asset": {"version": "2.0"},
        "buffers": [{"byteLength": len(vertex_bytes) + len(index_bytes)}],
        "bufferViews": [
            {"buffer": 0, "byteLength": len(vertex_bytes)},
            {"buffer": 0, "byteOffset": len(vertex_bytes), "byteLength": len(index_bytes)},
        ],
        "accessors": [
            {"bufferView": 0, "componentType": 5126, "type": "VEC3", "count": len(positions) // 3,
             "min": [min(column) for column in columns], "max": [max(column) for column in columns]},
            {"bufferView": 1, "componentType": 5125, "type": "SCALAR", "count": len(indices)},
        ],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}],
        "nodes": [{"name": "first", "mesh": 0}],
        "scenes": [{"name": "one", "nodes": [0]}],
    }, vertex_bytes + index_bytes


def write_gltf(path, content, binary):
    content["buffers"][0]["uri"] = ("data:application/octet-stream;base64," +
                                    base64.b64encode(binary).decode())
    with open(path, "w", encoding="ascii") as file:
        json.dump(content, file)


def write_glb(path, content, binary):
    text = json.dumps(content).encode()
    text += b" " * (-len(text) % 4)
    with open(path, "wb") as file:
        file.write(struct.pack("<4sII", b"glTF", 2, 28 + len(text) + len(binary)))
        file.write(struct.pack("<II", len(text), 0x4E4F534A) + text)
        file.write(struct.pack("<II", len(binary), 0x004E4942) + binary)


def grid(side):
    """Positions and indices of a bumpy square of side x side quads."""
    positions = [value for y in range(side + 1) for x in range(side + 1)
                 for value in (x / side, (x * y % 7) / side, y / side)]
    indices = [corner for y in range(side) for x in range(side)
               for first in (y * (side + 1) + x,)
               for corner in (first, first + side + 1, first + 1,
                              first + 1, first + side + 1, first + side + 2)]
    return positions, indices
