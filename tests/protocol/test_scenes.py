"""Loading scenes: only from the catalogue, whole or not at all."""

import asyncio
import os
import shutil
import struct
import tempfile

from harness.server import Server, ServerTestCase
from harness.viewer import Viewer


class Scenes(ServerTestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        given = os.environ["HELIOGRAPH_SCENES"]
        root = os.path.join(cls.folder.name, "root")
        os.mkdir(root)
        for name in ("furnace.glb", "mirror.glb", "sky.hdr"):
            shutil.copy(os.path.join(given, name), root)
        with open(os.path.join(given, "mirror.glb"), "rb") as file:
            good = file.read()
        cls.broken = {
            "empty": b"",
            "text": b"this is not glTF",
            "truncated": good[:len(good) // 2],
            "header_only": good[:12],
            "lying_length": good[:8] + struct.pack("<I", 0xFFFFFFF0) + good[12:],
            "lying_chunk": good[:12] + struct.pack("<I", 0xFFFFFFF0) + good[16:],
            "bad_json": good[:20] + b"}" * 40 + good[60:],
        }
        os.mkdir(os.path.join(root, "broken"))
        for name, data in cls.broken.items():
            with open(os.path.join(root, "broken", name + ".glb"), "wb") as file:
                file.write(data)
        with open(os.path.join(root, "broken", "escape.gltf"), "w", encoding="ascii") as file:
            file.write('{"asset": {"version": "2.0"}, "buffers": [{"uri": "../../secret.bin", '
                       '"byteLength": 4}]}')
        shutil.copy(os.path.join(given, "mirror.glb"), os.path.join(cls.folder.name, "secret.glb"))
        cls.server = Server("--scene", "mirror", scenes=root)

    @classmethod
    def tearDownClass(cls):
        super().tearDownClass()
        cls.folder.cleanup()

    def test_the_catalogue_lists_what_is_below_the_root(self):
        listed = self.server.call("scene.list")
        names = [scene["name"] for scene in listed["scenes"]]
        self.assertIn("furnace", names)
        self.assertIn("broken/empty", names)
        self.assertNotIn("secret", " ".join(names))
        self.assertEqual(listed["current"], "mirror")

    def test_a_scene_describes_itself(self):
        info = self.server.call("scene.load", {"name": "furnace"})
        self.assertEqual(info["name"], "furnace")
        self.assertGreater(info["triangles"], 100)
        self.assertEqual(self.server.call("scene.info"), info)
        self.assertEqual(self.server.call("scene.list")["current"], "furnace")

    def test_what_is_missing_or_broken_leaves_the_session_as_it_was(self):
        camera = self.server.call("camera.get")
        info = self.server.call("scene.info")
        for name in ("nowhere", "../secret", "/etc/passwd", "mirror.glb/..", "..", "."):
            self.assert_error(self.server.ask("scene.load", {"name": name}), -32004, path="name")
        for name in (*self.broken, "escape"):
            answer = self.server.ask("scene.load", {"name": "broken/" + name})
            self.assert_error(answer, -32602, path="name")
            self.assertNotIn(self.folder.name, str(answer), "the error tells a path")
        self.assertEqual(self.server.call("scene.info"), info)
        self.assertEqual(self.server.call("camera.get"), camera)
        self.assertEqual(self.server.call("frame.capture")["samples"], 4)

    async def test_progress_and_change_are_announced(self):
        async with Viewer(self.server) as loader, Viewer(self.server) as other:
            info = await loader.call("scene.load", {"name": "furnace"})
            progress = await other.notification("scene.progress")
            self.assertEqual(progress["name"], "furnace")
            self.assertTrue(0 <= progress["fraction"] <= 1)
            self.assertEqual((await other.notification("scene.changed"))["scene"], info)
            self.assertNotIn("scene.changed", [m["method"] for m in loader.notifications])

    async def test_the_newest_request_wins(self):
        async with Viewer(self.server) as viewer:
            names = ["furnace", "mirror"] * 3
            answers = await asyncio.gather(
                *[viewer.ask("scene.load", {"name": name}) for name in names])
            self.assertEqual(answers[-1]["result"]["name"], "mirror")
            for answer in answers[:-1]:
                if "error" in answer:
                    self.assert_error(answer, -32009, path="name")
            self.assertEqual((await viewer.call("scene.info"))["name"], "mirror")

    async def test_pictures_go_on_after_a_failed_load(self):
        async with Viewer(self.server) as viewer:
            await viewer.ask("scene.load", {"name": "broken/truncated"})
            camera = await viewer.call("camera.set", {"eye": [3, 3, 3]})
            await viewer.frame_where(lambda frame: frame.header["state_rev"] >= camera["rev"])
