"""Modified glTF models: lights, clips and cameras added to a .glb file."""

import json
import math
import struct

FLOAT = 5126


class Model:
    def __init__(self, path):
        with open(path, "rb") as file:
            data = file.read()
        length, = struct.unpack_from("<I", data, 12)
        self.json = json.loads(data[20:20 + length])
        start = 20 + length
        size, = struct.unpack_from("<I", data, start)
        self.bytes = bytearray(data[start + 8:start + 8 + size])

    def save(self, path):
        self.json["buffers"][0]["byteLength"] = len(self.bytes)
        text = json.dumps(self.json).encode()
        text += b" " * (-len(text) % 4)
        body = bytes(self.bytes) + b"\0" * (-len(self.bytes) % 4)
        with open(path, "wb") as file:
            file.write(struct.pack("<4sII", b"glTF", 2, 28 + len(text) + len(body)))
            file.write(struct.pack("<I4s", len(text), b"JSON") + text)
            file.write(struct.pack("<I4s", len(body), b"BIN\0") + body)

    def node(self, name):
        return next(i for i, node in enumerate(self.json["nodes"]) if node.get("name") == name)

    def add_node(self, **node):
        self.json["nodes"].append(node)
        index = len(self.json["nodes"]) - 1
        self.json["scenes"][0]["nodes"].append(index)
        return index

    def add_light(self, name, *, kind="directional", intensity=3.0, color=(1.0, 1.0, 1.0),
                  **place):
        """A directional light shines straight down unless it is turned."""
        if "KHR_lights_punctual" not in self.json.setdefault("extensionsUsed", []):
            self.json["extensionsUsed"].append("KHR_lights_punctual")
        lights = self.json.setdefault("extensions", {}).setdefault(
            "KHR_lights_punctual", {"lights": []})["lights"]
        lights.append({"type": kind, "intensity": intensity, "color": list(color)})
        half = math.sin(math.pi / 4)
        place = place or {"rotation": [-half, 0, 0, half]}
        return self.add_node(name=name, **place, extensions={
            "KHR_lights_punctual": {"light": len(lights) - 1}})

    def add_clip(self, name, node, times, translations):
        """A clip that moves a node along a line."""
        sampler = {"input": self._floats("SCALAR", [[time] for time in times]),
                   "output": self._floats("VEC3", translations)}
        self.json.setdefault("animations", []).append({
            "name": name, "samplers": [sampler],
            "channels": [{"sampler": 0, "target": {"node": node, "path": "translation"}}]})

    def _floats(self, kind, rows):
        self.bytes += b"\0" * (-len(self.bytes) % 4)
        values = [value for row in rows for value in row]
        self.json["bufferViews"].append({"buffer": 0, "byteOffset": len(self.bytes),
                                         "byteLength": 4 * len(values)})
        self.bytes += struct.pack(f"<{len(values)}f", *values)
        self.json["accessors"].append({
            "bufferView": len(self.json["bufferViews"]) - 1, "componentType": FLOAT,
            "count": len(rows), "type": kind,
            "min": [min(column) for column in zip(*rows)],
            "max": [max(column) for column in zip(*rows)]})
        return len(self.json["accessors"]) - 1
