"""Sends and deletes files as a client of the server's uploads does."""

import json
import os
import struct

from harness.images import encode_png

CONTROL, VIEW = "steering-0123456789", "watching-0123456789"
KINDS = ("scenes", "environments", "images")
SKY = b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 4 +X 8\n" + bytes([80, 120, 200, 128]) * 32
RED = encode_png((255, 0, 0))


def mirror():
    with open(os.path.join(os.environ["HELIOGRAPH_SCENES"], "mirror.glb"), "rb") as file:
        return file.read()


def one_node(material):
    """A binary glTF file with one triangle of this material."""
    corners = struct.pack("<9f", 0, 0, 0, 1, 0, 0, 0, 1, 0)
    document = {"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}],
                "nodes": [{"mesh": 0}], "materials": [{"name": material}],
                "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "material": 0}]}],
                "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3",
                               "min": [0, 0, 0], "max": [1, 1, 0]}],
                "bufferViews": [{"buffer": 0, "byteLength": len(corners)}],
                "buffers": [{"byteLength": len(corners)}]}
    text = json.dumps(document).encode()
    text += b" " * (-len(text) % 4)
    return (struct.pack("<4sII", b"glTF", 2, 28 + len(text) + len(corners))
            + struct.pack("<I4s", len(text), b"JSON") + text
            + struct.pack("<I4s", len(corners), b"BIN\0") + corners)


class UploadClient:
    """Sends and deletes files of a server."""

    def __init__(self, server):
        self.server = server

    def put(self, kind, name, token=CONTROL):
        body = {"scenes": mirror(), "environments": SKY, "images": RED}[kind]
        return self.request("PUT", kind, name, body, token)

    def delete(self, kind, name, token=CONTROL, **headers):
        return self.request("DELETE", kind, name, None, token, **headers)

    def request(self, method, kind, name, body, token, **headers):
        status, _, answer = self.server.request(
            method, f"/api/v1/{kind}/{name}", body, {"Authorization": "Bearer " + token, **headers})
        return status, answer.decode()

    def entries(self, kind):
        """What is listed of a kind, by name."""
        method = {"scenes": "scene.list", "environments": "environment.list",
                  "images": "images.list"}[kind]
        return {entry["name"]: entry for entry in self.server.call(method)[kind]}
