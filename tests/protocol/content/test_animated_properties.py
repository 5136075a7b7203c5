"""Clips that animate a material's colour and a node's visibility (KHR_animation_pointer)."""

import array
import asyncio
import base64
import os
import shutil
import tempfile

import numpy

from harness.gltf import document, write_glb
from harness.images import decode_jpeg, decode_png
from harness.server import Server, ServerTestCase
from harness.viewer import Viewer

# A square around the origin that looks toward +Z.
SQUARE = [-1, -1, 0, 1, -1, 0, 1, 1, 0, -1, 1, 0], [0, 1, 2, 0, 2, 3]
LEFT, RIGHT = 0.25, 0.75  # of the image's width, where the two squares are
COLOR = "pbrMetallicRoughness/baseColorFactor"
# Of 255: what a still surface may differ by from frame to frame, on average. In a soft shadow it is
# about 0.7 with the histories of earlier frames and 3 without.
STILL = 1.5


class SceneFile:
    """A file of two squares, mesh 0 and 1, with the materials "paint" and "chalk": both white."""

    def __init__(self):
        self.content, self.binary = document(*SQUARE)
        self.content["materials"] = [
            {"name": name, "pbrMetallicRoughness": {"baseColorFactor": [1, 1, 1, 1],
                                                    "metallicFactor": 0}}
            for name in ("paint", "chalk")]
        primitive = self.content["meshes"][0]["primitives"][0]
        self.content["meshes"] = [{"primitives": [{**primitive, "material": material}]}
                                  for material in (0, 1)]
        self.content["extensionsUsed"] = ["KHR_animation_pointer"]
        self.content["extensionsRequired"] = ["KHR_animation_pointer"]

    def set_nodes(self, *nodes):
        self.content["nodes"] = nodes
        self.content["scenes"][0]["nodes"] = list(range(len(nodes)))

    def add(self, component, kind, count, data):
        self.binary += b"\0" * (-len(self.binary) % 4)
        self.content["bufferViews"].append(
            {"buffer": 0, "byteOffset": len(self.binary), "byteLength": len(data)})
        self.binary += data
        self.content["accessors"].append({
            "bufferView": len(self.content["bufferViews"]) - 1, "componentType": component,
            "type": kind, "count": count})
        return len(self.content["accessors"]) - 1

    def floats(self, kind, count, *values):
        return self.add(5126, kind, count, array.array("f", values).tobytes())

    def red_to_blue(self):
        """A sampler from 0 to 2 seconds."""
        return {"input": self.floats("SCALAR", 2, 0, 2),
                "output": self.floats("VEC4", 2, 1, 0, 0, 1, 0, 0, 1, 1)}

    @staticmethod
    def channel(sampler, pointer):
        return {"sampler": sampler, "target": {
            "path": "pointer", "extensions": {"KHR_animation_pointer": {"pointer": pointer}}}}

    def write(self, path):
        self.binary += b"\0" * (-len(self.binary) % 4)
        self.content["buffers"][0]["byteLength"] = len(self.binary)
        write_glb(path, self.content, self.binary)


def pixels(frame):
    image = decode_jpeg(frame.payload)
    shape = (image.height, image.width, 3)
    return numpy.frombuffer(image.rgb, numpy.uint8).reshape(shape).astype(float)


def part(image, x):
    """The middle of a square: a tenth of the image's width, a fifth of its height."""
    height, width, _ = image.shape
    left, top = int((x - 0.05) * width), int(0.4 * height)
    return image[top:top + height // 5, left:left + width // 10]


class AnimatedProperties(ServerTestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.write_squares(os.path.join(cls.folder.name, "squares.glb"))
        cls.write_painted(os.path.join(cls.folder.name, "painted.glb"))
        shutil.copy(os.path.join(os.environ["HELIOGRAPH_SCENES"], "mirror.glb"), cls.folder.name)
        cls.server = Server("--scene", "squares", "--set", "antialiasing.jitter=false",
                            scenes=cls.folder.name)

    @staticmethod
    def write_squares(path):
        """From 0 to 2 seconds the left square goes from red to blue, and the right one, which the
        file hides, is visible from second 1 on."""
        file = SceneFile()
        file.content["extensionsUsed"].append("KHR_node_visibility")
        file.set_nodes(
            {"name": "left", "mesh": 0, "translation": [-1.5, 0, 0]},
            {"name": "right", "mesh": 1, "translation": [1.5, 0, 0],
             "extensions": {"KHR_node_visibility": {"visible": False}}})
        file.content["animations"] = [{"name": "change", "samplers": [
            file.red_to_blue(),
            {"input": file.floats("SCALAR", 2, 0, 1),
             "output": file.add(5121, "SCALAR", 2, b"\0\1"), "interpolation": "STEP"},
        ], "channels": [
            file.channel(0, f"/materials/0/{COLOR}"),
            file.channel(1, "/nodes/1/extensions/KHR_node_visibility/visible")]}]
        file.write(path)

    @staticmethod
    def write_painted(path):
        """The left square goes from red to blue. The right one lies in the soft shadow of a third,
        which needs many samples."""
        file = SceneFile()
        file.content["extensionsUsed"].append("KHR_lights_punctual")
        file.content["extensions"] = {"KHR_lights_punctual": {
            "lights": [{"type": "point", "intensity": 20}]}}
        file.set_nodes(
            {"name": "left", "mesh": 0, "translation": [-1.5, 0, 0]},
            {"name": "right", "mesh": 1, "translation": [1.5, 0, 0]},
            {"name": "shade", "mesh": 1, "translation": [1.5, 1, 1], "scale": [0.4, 0.4, 1]},
            {"name": "bulb", "translation": [1.5, 2, 2], "extras": {"radius": 0.4},
             "extensions": {"KHR_lights_punctual": {"light": 0}}})
        file.content["animations"] = [{"name": "change", "samplers": [file.red_to_blue()],
                                       "channels": [file.channel(0, f"/materials/0/{COLOR}")]}]
        file.write(path)

    def reset(self):
        super().reset()
        self.load("squares")

    def load(self, scene):
        self.server.call("scene.load", {"name": scene})
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

    async def played(self, viewer, count):
        """So many frames of the clip as it plays, over more than one turn of it."""
        await viewer.call("animation.play", {"clip": "change"})
        loop = asyncio.get_running_loop()
        images, began = [], loop.time()
        while len(images) < count or loop.time() - began < 2.5:
            images.append(pixels(await viewer.frame_where(lambda frame: not frame.final)))
        return images

    async def test_a_playing_clip_sends_frames_that_differ_until_it_pauses(self):
        self.load("painted")
        async with Viewer(self.server) as viewer:
            await viewer.rest()
            means = [part(image, LEFT).mean(axis=(0, 1)) for image in await self.played(viewer, 12)]
            redness = [red - blue for red, _, blue in means]
            self.assertGreater(max(redness), 60)
            self.assertLess(min(redness), -60)
            self.assertGreater(len({round(value / 10) for value in redness}), 5, "goes over slowly")
            await viewer.call("animation.pause")
            final = part(pixels(await viewer.rest()), LEFT).mean(axis=(0, 1))
            received = viewer.frames_received
            await asyncio.sleep(1)
            self.assertEqual(viewer.frames_received, received, "frames of a static view")
            capture = self.color(LEFT)
            self.assertLess(max(abs(a - b) for a, b in zip(final, capture)), 15, "the final state")

    async def test_a_still_object_beside_an_animated_material_stays_still(self):
        self.load("painted")
        async with Viewer(self.server) as viewer:
            await viewer.rest()
            still = [part(image, RIGHT) for image in await self.played(viewer, 12)]
            await viewer.call("animation.pause")
            apart = [abs(a - b).mean() for a, b in zip(still, still[1:]) if a.shape == b.shape]
            self.assertGreater(len(apart), 5)
            self.assertLess(numpy.mean(apart), STILL)
