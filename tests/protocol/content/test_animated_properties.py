"""Clips that animate a material's colour and a node's visibility (KHR_animation_pointer)."""

import array
import base64
import os
import shutil
import tempfile

from harness.gltf import document, write_glb
from harness.images import decode_png
from harness.server import Server, ServerTestCase

# A square around the origin that looks toward +Z.
SQUARE = [-1, -1, 0, 1, -1, 0, 1, 1, 0, -1, 1, 0], [0, 1, 2, 0, 2, 3]
LEFT, RIGHT = 0.25, 0.75  # of the image's width, where the two squares are


class AnimatedProperties(ServerTestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.write_scene(os.path.join(cls.folder.name, "squares.glb"))
        shutil.copy(os.path.join(os.environ["HELIOGRAPH_SCENES"], "mirror.glb"), cls.folder.name)
        cls.server = Server("--scene", "squares", "--set", "antialiasing.jitter=false",
                            scenes=cls.folder.name)

    @staticmethod
    def write_scene(path):
        """From 0 to 2 seconds the left square goes from red to blue, and the right one, which the
        file hides, is visible from second 1 on."""
        content, binary = document(*SQUARE)

        def add(component, kind, count, data):
            nonlocal binary
            binary += b"\0" * (-len(binary) % 4)
            content["bufferViews"].append(
                {"buffer": 0, "byteOffset": len(binary), "byteLength": len(data)})
            binary += data
            content["accessors"].append({
                "bufferView": len(content["bufferViews"]) - 1, "componentType": component,
                "type": kind, "count": count})
            return len(content["accessors"]) - 1

        def floats(kind, count, *values):
            return add(5126, kind, count, array.array("f", values).tobytes())

        def channel(sampler, pointer):
            return {"sampler": sampler, "target": {
                "path": "pointer", "extensions": {"KHR_animation_pointer": {"pointer": pointer}}}}

        content["extensionsUsed"] = ["KHR_animation_pointer", "KHR_node_visibility"]
        content["extensionsRequired"] = ["KHR_animation_pointer"]
        content["materials"] = [
            {"name": name, "pbrMetallicRoughness": {"baseColorFactor": [1, 1, 1, 1],
                                                    "metallicFactor": 0}}
            for name in ("paint", "chalk")]
        content["meshes"][0]["primitives"][0]["material"] = 0
        primitive = content["meshes"][0]["primitives"][0]
        content["meshes"].append({"primitives": [{**primitive, "material": 1}]})
        content["nodes"] = [
            {"name": "left", "mesh": 0, "translation": [-1.5, 0, 0]},
            {"name": "right", "mesh": 1, "translation": [1.5, 0, 0],
             "extensions": {"KHR_node_visibility": {"visible": False}}}]
        content["scenes"][0]["nodes"] = [0, 1]
        content["animations"] = [{"name": "change", "samplers": [
            {"input": floats("SCALAR", 2, 0, 2),
             "output": floats("VEC4", 2, 1, 0, 0, 1, 0, 0, 1, 1)},
            {"input": floats("SCALAR", 2, 0, 1), "output": add(5121, "SCALAR", 2, b"\0\1"),
             "interpolation": "STEP"},
        ], "channels": [
            channel(0, "/materials/0/pbrMetallicRoughness/baseColorFactor"),
            channel(1, "/nodes/1/extensions/KHR_node_visibility/visible")]}]
        content["buffers"][0]["byteLength"] = len(binary) + -len(binary) % 4
        write_glb(path, content, binary + b"\0" * (-len(binary) % 4))

    def reset(self):
        super().reset()
        self.server.call("scene.load", {"name": "squares"})
        self.server.call("camera.set", {"eye": [0, 0, 4], "target": [0, 0, 0],
                                        "vertical_fov": 45})

    def seek(self, seconds):
        self.server.call("animation.play", {"clip": "change"})
        self.server.call("animation.pause")
        self.server.call("animation.seek", {"seconds": seconds})

    def color(self, x):
        capture = self.server.call("frame.capture")
        image = decode_png(base64.b64decode(capture["data"]))
        start = 3 * (image.height // 2 * image.width + int(x * image.width))
        return tuple(image.rgb[start:start + 3])

    def shows(self, x):
        return self.server.call("scene.pick", {"x": x, "y": 0.5})["hit"]

    def test_the_clip_has_a_duration_and_no_warnings(self):
        clips = self.server.call("animation.list")["clips"]
        self.assertEqual(clips, [{"name": "change", "duration": 2}])
        self.assertEqual(self.server.call("scene.info")["warnings"], [])

    def test_colour_and_visibility_follow_the_time(self):
        red, _, blue = self.color(LEFT)
        self.assertLess(abs(red - blue), 40, "white without the clip")
        self.assertFalse(self.shows(RIGHT), "as in the file")
        self.seek(0)
        red, green, blue = self.color(LEFT)
        self.assertGreater(red, max(green, blue) + 60)
        self.assertFalse(self.shows(RIGHT))
        self.seek(2)
        red, green, blue = self.color(LEFT)
        self.assertGreater(blue, max(red, green) + 60)
        self.assertTrue(self.shows(RIGHT))
        self.seek(1)
        red, green, blue = self.color(LEFT)
        self.assertLess(abs(red - blue), 40, "halfway")
        self.assertGreater(min(red, blue), green + 40)
        self.assertTrue(self.shows(RIGHT))

    def test_what_is_edited_does_not_follow(self):
        self.seek(2)
        self.server.call("materials.patch",
                         {"material": "paint", "patch": {"base_color": [0, 1, 0]}})
        for seconds in (0, 2):
            self.seek(seconds)
            red, green, blue = self.color(LEFT)
            self.assertGreater(green, max(red, blue) + 60, seconds)
        self.server.call("materials.patch", {"material": "paint", "patch": {"base_color": None}})
        red, green, blue = self.color(LEFT)
        self.assertGreater(blue, max(red, green) + 60)
        self.server.call("nodes.patch", {"nodes": [1], "patch": {"visible": False}})
        self.assertFalse(self.shows(RIGHT))

    def test_steps_in_lockstep_follow(self):
        self.addCleanup(self.server.call, "frame.run")
        self.server.call("frame.step", {"frames": 0, "dt": 0.5})
        self.server.call("animation.play", {"clip": "change"})
        self.server.call("frame.step", {"frames": 1, "dt": 0.5})
        self.assertFalse(self.shows(RIGHT))
        self.server.call("frame.step", {"frames": 2, "dt": 0.5})
        self.assertTrue(self.shows(RIGHT))
