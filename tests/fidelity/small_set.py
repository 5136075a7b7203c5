"""A set like glTF-Render-Fidelity's for tests, in a temporary folder: one model, two engines."""

import base64
import json
import tempfile
import unittest
from pathlib import Path

import numpy
from PIL import Image

import lighting
import scenarios

MODELS = "../../../glTF-Sample-Assets/Models/"
SIZE = 64


def rgba(color, box=None, size=48):
    """A plain image, or a box (left, top, right, bottom) of a color on nothing."""
    image = numpy.zeros((size, size, 4), numpy.uint8)
    left, top, right, bottom = box or (0, 0, size, size)
    image[top:bottom, left:right] = (*color, 255)
    return image


def triangle(color, metallic=0.0):
    """A glTF document: a large triangle in the plane z = 0, an unlit color from both sides."""
    corners = numpy.array([[-1, -1, 0], [1, -1, 0], [0, 1, 0]], "<f4")
    uri = "data:application/octet-stream;base64," + base64.b64encode(corners.tobytes()).decode()
    return {"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}],
            "nodes": [{"mesh": 0}], "meshes": [{"primitives": [
                {"attributes": {"POSITION": 0}, "material": 0}]}],
            "materials": [{"doubleSided": True, "emissiveFactor": color, "pbrMetallicRoughness": {
                "baseColorFactor": [0, 0, 0, 1], "metallicFactor": metallic}}],
            "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3",
                           "min": [-1, -1, 0], "max": [1, 1, 0]}],
            "bufferViews": [{"buffer": 0, "byteLength": 36}],
            "buffers": [{"byteLength": 36, "uri": uri}]}


class SmallSet(unittest.TestCase):
    """Makes a set in a temporary folder."""

    def setUp(self):
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.assets = Path(temporary.name)
        self.root = self.assets / scenarios.GENERATOR
        self.model = self.root / "glTF-Sample-Assets/Models/Triangle.gltf"
        self.model.parent.mkdir(parents=True)
        self.model.write_text(json.dumps(triangle([1, 0, 0], 1.0)))
        # Three quarters dark; bright around +X, in the middle of the image.
        sky = numpy.full((16, 32, 3), 0.01)
        sky[:, 12:20] = 1.0
        (self.root / "environments").mkdir()
        lighting.write_hdr(self.root / "environments/lightroom_14b.hdr", sky)

    def describe(self, *views, names=("babylon", "vray")):
        (self.root / "test").mkdir(exist_ok=True)
        (self.root / "test/config.json").write_text(json.dumps({
            "renderers": [{"name": name} for name in names],
            "scenarios": [{"model": MODELS + "Triangle.gltf", "verticalFoV": 90.0,
                           "orbit": {"radius": 2.0, **view.pop("orbit", {})},
                           "dimensions": {"width": SIZE, "height": SIZE}, **view}
                          for view in views]}))

    def add_image(self, view, engine, image):
        path = self.root / f"test/goldens/{view}/{engine}-golden.png"
        path.parent.mkdir(parents=True, exist_ok=True)
        Image.fromarray(image).save(path)
