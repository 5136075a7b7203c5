"""Planes that cut the scene of a session open."""

import base64
import json
import os
import shutil
import subprocess
import tempfile

from harness.images import decode_png, difference
from harness.server import Server, ServerTestCase
from harness.viewer import Viewer

SIZE = {"width": 96, "height": 54}
MIDDLE = {"x": 0.5, "y": 0.5}


class Section(ServerTestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        for name in ("mirror.glb", "furnace.glb"):
            shutil.copy(os.path.join(os.environ["HELIOGRAPH_SCENES"], name), cls.folder.name)
        cls.server = Server("--scene", "mirror", scenes=cls.folder.name)

    def reset(self):
        super().reset()
        self.server.call("scene.load", {"name": "mirror"})
        self.server.call("camera.fit")
        self.server.call("settings.patch", {"patch": {
            "antialiasing": {"jitter": False}, "accumulation": {"max_samples": 16}}})
        self.server.call("stream.configure", SIZE)

    def image(self):
        return decode_png(base64.b64decode(self.server.call("frame.capture")["data"]))

    def facing(self):
        """The plane through the middle of the scene that faces the camera."""
        camera = self.server.call("camera.get")
        normal = [eye - target for eye, target in zip(camera["eye"], camera["target"])]
        length = sum(one * one for one in normal) ** 0.5
        offset = sum(n * t for n, t in zip(normal, camera["target"])) / length
        return {"normal": normal, "offset": offset}

    def test_a_plane_cuts_what_is_seen_and_picked(self):
        whole, near = self.image(), self.server.call("scene.pick", MIDDLE)
        state = self.server.call("section.set", {"planes": [self.facing()]})
        self.assertAlmostEqual(sum(n * n for n in state["planes"][0]["normal"]), 1.0, places=5)
        self.assertEqual(state, self.server.call("section.get"))
        cut, far = self.image(), self.server.call("scene.pick", MIDDLE)
        self.assertGreater(difference(cut, whole), 1)
        self.assertTrue(near["hit"])
        self.assertGreater(far["distance"] or float("inf"), near["distance"] + 0.1)
        off = [{**state["planes"][0], "enabled": False}]
        self.server.call("section.set", {"planes": off})
        self.assertLess(difference(self.image(), whole), 0.5)
        self.server.call("section.set", {"planes": state["planes"]})
        self.assertLess(difference(self.image(), cut), 0.5)
        self.server.call("section.set", {"planes": []})
        self.assertLess(difference(self.image(), whole), 0.5)

    def test_wrong_planes_change_nothing(self):
        plane = self.facing()
        self.server.call("section.set", {"planes": [plane]})
        before = self.server.call("section.get")
        for params, path in (
                ({"planes": [plane] * 7}, "planes"),
                ({"planes": [plane, {"normal": [0, 0, 0], "offset": 0}]}, "planes[1].normal"),
                ({"planes": [{"normal": [1, 0, 0]}]}, "planes[0].offset"),
                ({"planes": [{"normal": [1, 0], "offset": 0}]}, "planes[0].normal"),
                ({"planes": [plane], "cap_color": [2, 0, 0]}, "cap_color[0]"),
                ({"plains": []}, "plains")):
            with self.subTest(path):
                self.assert_error(self.server.ask("section.set", params), -32602, path=path)
        self.assertEqual(self.server.call("section.get"), before)

    def test_another_scene_is_whole(self):
        self.server.call("section.set", {"planes": [self.facing()]})
        self.server.call("scene.load", {"name": "furnace"})
        self.assertEqual(self.server.call("section.get")["planes"], [])

    async def test_other_viewers_are_told(self):
        async with Viewer(self.server) as causer, Viewer(self.server) as other:
            state = await causer.call("section.set", {"planes": [self.facing()]})
            heard = await other.notification("section.changed")
            self.assertEqual((heard["planes"], heard["by"]),
                             (state["planes"], causer.hello["viewer"]))

    def test_an_edit_document_and_the_command_line_have_the_planes(self):
        self.server.call("section.set", {"planes": [self.facing()], "cap_color": [0, 0, 1]})
        document = self.server.call("edits.get")["edits"]
        self.assertEqual(document["section"]["cap_color"], [0, 0, 1])
        self.server.call("section.set", {"planes": []})
        self.assertNotIn("section", self.server.call("edits.get")["edits"])
        self.server.call("edits.apply", {"edits": document})
        self.assertEqual(self.server.call("section.get")["planes"], document["section"]["planes"])
        wrong = {**document, "section": {"planes": [{"normal": [0, 0, 0], "offset": 1}]}}
        self.assert_error(self.server.ask("edits.apply", {"edits": wrong}), -32602,
                          path="edits.section.planes[0].normal")
        images = {}
        path = os.path.join(self.folder.name, "edits.json")
        with open(path, "w", encoding="utf-8") as file:
            json.dump(document, file)
        for name, more in (("whole", []), ("cut", ["--edits", path])):
            output = os.path.join(self.folder.name, name + ".png")
            subprocess.run(
                [os.environ["HELIOGRAPH_BINARY"], "render",
                 os.path.join(self.folder.name, "mirror.glb"), "-o", output, "--width", "96",
                 "--height", "54", "--samples", "8", *more], check=True, timeout=300)
            with open(output, "rb") as file:
                images[name] = decode_png(file.read())
        self.assertGreater(difference(images["cut"], images["whole"]), 1)
