"""Scenes whose files have the light around them (EXT_lights_image_based)."""

import base64
import os
import shutil
import subprocess
import tempfile

from harness.gltf import document, grid, write_glb
from harness.images import decode_png, difference, encode_png
from harness.server import Server, ServerTestCase

EXTENSION = "EXT_lights_image_based"


def write_scene(path, color=None):
    """A bumpy square, alone or within a cube of that color."""
    content, binary = document(*grid(8))
    content["materials"] = [{"pbrMetallicRoughness": {"metallicFactor": 0}}]
    content["meshes"][0]["primitives"][0]["material"] = 0
    if color:
        content["images"] = [{"uri": "data:image/png;base64," +
                                     base64.b64encode(encode_png(color)).decode()}]
        content["extensionsUsed"] = content["extensionsRequired"] = [EXTENSION]
        content["extensions"] = {EXTENSION: {"lights": [{
            "irradianceCoefficients": [[0.5, 0.5, 0.5]] * 9, "specularImages": [[0] * 6],
            "specularImageSize": 4}]}}
        content["scenes"][0]["extensions"] = {EXTENSION: {"light": 0}}
    write_glb(path, content, binary)


def channels(image):
    """The means of red, green and blue."""
    return [sum(image.rgb[channel::3]) / (image.width * image.height) for channel in range(3)]


class ImageLights(ServerTestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        given = os.environ["HELIOGRAPH_SCENES"]
        for name in ("mirror.glb", "white.hdr"):
            shutil.copy(os.path.join(given, name), cls.folder.name)
        # A file beside the scene gives way to the light within.
        shutil.copy(os.path.join(given, "white.hdr"), os.path.join(cls.folder.name, "red.hdr"))
        write_scene(cls.path("plain.glb"))
        write_scene(cls.path("red.glb"), (255, 0, 0))
        write_scene(cls.path("blue.glb"), (0, 0, 255))
        cls.server = Server("--scene", "mirror", "--set", "antialiasing.jitter=false",
                            scenes=cls.folder.name)

    @classmethod
    def path(cls, name):
        return os.path.join(cls.folder.name, name)

    def image(self, server=None):
        capture = (server or self.server).call("frame.capture")
        return decode_png(base64.b64decode(capture["data"]))

    def assert_red(self, image):
        red, green, blue = channels(image)
        self.assertGreater(red, 10)
        self.assertGreater(red, 1.5 * max(green, blue))

    def assert_grey(self, image):
        shares = channels(image)
        self.assertGreater(min(shares), 0.8 * max(shares))

    def test_the_light_of_its_file_is_the_scenes_own_environment(self):
        self.assertIsNone(self.server.call("scene.load", {"name": "plain"})["environment"])
        self.assert_grey(self.image())
        info = self.server.call("scene.load", {"name": "red"})
        self.assertEqual(info["environment"], "red.glb")
        self.assertEqual(info["warnings"], [])
        self.assertEqual((info["images"], info["textures"]), (0, 0))
        self.assertIsNone(self.server.call("environment.list")["current"])
        own = self.image()
        self.assert_red(own)
        self.server.call("settings.patch", {"patch": {"environment": {"visible": False}}})
        self.assert_red(self.image())
        self.server.call("settings.patch", {"patch": {"environment": None}})
        self.server.call("environment.set", {"name": "studio"})
        self.assert_grey(self.image())
        self.server.call("environment.set", {"name": None})
        self.assertLess(difference(self.image(), own), 4)
        self.server.call("scene.load", {"name": "blue"})
        red, _, blue = channels(self.image())
        self.assertGreater(blue, 1.5 * red)

    def test_the_environment_of_the_command_line_comes_first(self):
        with Server("--scene", "red", "--environment", self.path("white.hdr"),
                    scenes=self.folder.name) as server:
            self.assertEqual(server.call("scene.info")["environment"], "white.hdr")
            self.assert_grey(self.image(server))

    def test_it_lights_rendered_images(self):
        for more, check in (((), self.assert_red),
                            (("--environment", self.path("white.hdr")), self.assert_grey)):
            output = self.path("image.png")
            subprocess.run(
                [os.environ["HELIOGRAPH_BINARY"], "render", self.path("red.glb"), "-o", output,
                 "--width", "96", "--height", "54", "--set", "accumulation.max_samples=16", *more],
                check=True, capture_output=True, text=True, timeout=300)
            with open(output, "rb") as file:
                check(decode_png(file.read()))
