#!/usr/bin/env python3
"""Writes .glb files that are large in one respect or several: triangles, textures, instances.

    python3 tests/bench/large_scenes.py OUT.glb --triangles 10000000 --meshes 100
    python3 tests/bench/large_scenes.py OUT.glb --textures 2000 --texture-size 256
    python3 tests/bench/large_scenes.py OUT.glb --instances 100000 --meshes 50 --triangles 10000

Every mesh is a bumpy square, every texture a smooth image with noise of its own. The same
arguments give the same bytes. Needs the standard library only.
"""

import argparse
import array
import json
import math
import random
import struct
import zlib


def chunk(kind, data):
    return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))


def png(side, seed):
    """RGB, `side` x `side`: rows of a ramp whose lowest bits are noise."""
    noise = random.Random(seed)
    keep = int.from_bytes(b"\x07" * (3 * side), "little")
    rows = []
    for y in range(side):
        ramp = bytes((8 * ((x * 31 // side + y * 31 // side + c * seed) % 31))
                     for x in range(side) for c in range(3)) if y % 8 == 0 else ramp
        bits = int.from_bytes(noise.randbytes(3 * side), "little") & keep
        rows.append(b"\0" + (int.from_bytes(ramp, "little") | bits).to_bytes(3 * side, "little"))
    header = struct.pack(">IIBBBBB", side, side, 8, 2, 0, 0, 0)
    return (b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) +
            chunk(b"IDAT", zlib.compress(b"".join(rows), 1)) + chunk(b"IEND", b""))


def grid(side):
    """Attributes and triangles of a square of `side` x `side` quads, 1 m wide."""
    positions, uvs = array.array("f"), array.array("f")
    corners = bytearray()
    width = side + 1
    across = [x / side for x in range(width)]
    row = array.array("f", [value for u in across for value in (u, 0.05 * math.sin(20 * u), 0.0)])
    uv_row = array.array("f", [value for u in across for value in (u, 0.0)])
    quads = array.array("I", [corner for x in range(side) for corner in
                              (x, x + width, x + 1, x + 1, x + width, x + width + 1)]).tobytes()
    # All corners of a row as one number, to which the row's first vertex is added at once.
    first_row = int.from_bytes(quads, "little")
    each = int.from_bytes(b"\1\0\0\0" * (6 * side), "little")
    for z in range(width):
        row[2::3] = array.array("f", [z / side]) * width
        uv_row[1::2] = array.array("f", [z / side]) * width
        positions.extend(row)
        uvs.extend(uv_row)
        if z < side:
            corners += (first_row + each * (z * width)).to_bytes(len(quads), "little")
    normals = array.array("f", (0.0, 1.0, 0.0)) * (width * width)
    return {"POSITION": ("VEC3", positions), "NORMAL": ("VEC3", normals),
            "TEXCOORD_0": ("VEC2", uvs)}, bytes(corners)


class Binary:
    """The binary chunk, in pieces: equal ones are listed many times and stored once."""

    def __init__(self):
        self.pieces = []
        self.views = []
        self.size = 0

    def add(self, data):
        self.views.append({"buffer": 0, "byteOffset": self.size, "byteLength": len(data)})
        self.pieces += [data, b"\0" * (-len(data) % 4)]
        self.size += len(data) + -len(data) % 4
        return len(self.views) - 1


def add_meshes(document, binary, meshes, triangles):
    side = max(1, round(math.sqrt(triangles / meshes / 2)))
    attributes, corners = grid(side)
    stored = {name: (kind, values.tobytes()) for name, (kind, values) in attributes.items()}
    count = (side + 1) ** 2
    extent = {"min": [0, -0.05, 0], "max": [1, 0.05, 1]}
    accessors = document["accessors"]
    for mesh in range(meshes):
        primitive = {"attributes": {}, "indices": len(accessors)}
        accessors.append({"bufferView": binary.add(corners), "componentType": 5125,
                          "type": "SCALAR", "count": len(corners) // 4})
        for name, (kind, data) in stored.items():
            primitive["attributes"][name] = len(accessors)
            accessors.append({"bufferView": binary.add(data), "componentType": 5126, "type": kind,
                              "count": count, **(extent if name == "POSITION" else {})})
        if document["materials"]:
            primitive["material"] = mesh % len(document["materials"])
        document["meshes"].append({"primitives": [primitive]})
    return 2 * side * side * meshes


def add_textures(document, binary, textures, side, normal_maps):
    for i in range(textures):
        document["images"].append({"mimeType": "image/png", "bufferView": binary.add(png(side, i))})
        document["textures"].append({"source": i})
        material = {"pbrMetallicRoughness": {"baseColorTexture": {"index": i}}}
        if normal_maps:
            material["normalTexture"] = {"index": i}
        document["materials"].append(material)


def add_instances(document, instances, meshes):
    width = math.ceil(math.sqrt(instances))
    document["nodes"] = [{"name": f"node {i}", "mesh": i % meshes,
                          "translation": [1.1 * (i % width), 0, 1.1 * (i // width)]}
                         for i in range(instances)]
    document["scenes"] = [{"nodes": list(range(instances))}]


def write(path, document, binary):
    text = json.dumps(document).encode()
    text += b" " * (-len(text) % 4)
    with open(path, "wb") as file:
        file.write(struct.pack("<4sII", b"glTF", 2, 28 + len(text) + binary.size))
        file.write(struct.pack("<II", len(text), 0x4E4F534A) + text)
        file.write(struct.pack("<II", binary.size, 0x004E4942))
        for piece in binary.pieces:
            file.write(piece)


def write_scene(path, triangles=200, meshes=1, textures=0, texture_size=256, instances=None,
                normal_maps=False):
    """Returns the number of triangles, before instancing."""
    document = {"asset": {"version": "2.0"}, "accessors": [], "meshes": [], "images": [],
                "textures": [], "materials": []}
    binary = Binary()
    add_textures(document, binary, textures, texture_size, normal_maps)
    made = add_meshes(document, binary, meshes, triangles)
    add_instances(document, instances or meshes, meshes)
    document["bufferViews"] = binary.views
    document["buffers"] = [{"byteLength": binary.size}]
    write(path, {name: value for name, value in document.items() if value}, binary)
    return made


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("path")
    parser.add_argument("--triangles", type=int, default=200, help="of all meshes together")
    parser.add_argument("--meshes", type=int, default=1)
    parser.add_argument("--textures", type=int, default=0)
    parser.add_argument("--texture-size", type=int, default=256)
    parser.add_argument("--instances", type=int, help="default: one for each mesh")
    parser.add_argument("--normal-maps", action="store_true", help="so that tangents are generated")
    write_scene(**vars(parser.parse_args()))


if __name__ == "__main__":
    main()
