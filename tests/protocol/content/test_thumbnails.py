"""Thumbnails of scenes: rendered while the server is idle, kept on disk."""

import asyncio
import os
import shutil
import tempfile
import time
import unittest
from pathlib import Path

from harness.images import decode_jpeg
from harness.models import Model
from harness.server import TIME_FACTOR, Server
from harness.viewer import Viewer


class Thumbnails(unittest.IsolatedAsyncioTestCase):
    def setUp(self):
        self.folder = Path(tempfile.mkdtemp())
        self.addCleanup(shutil.rmtree, self.folder)
        self.scenes = self.folder / "scenes"
        (self.scenes / "more").mkdir(parents=True)
        source = Path(os.environ["HELIOGRAPH_SCENES"])
        shutil.copy(source / "mirror.glb", self.scenes / "first.glb")
        shutil.copy(source / "mirror.glb", self.scenes / "more" / "second.glb")
        (self.scenes / "broken.glb").write_bytes(b"glTF, but not more")

    def start(self):
        server = Server("--scene", "first", scenes=str(self.scenes),
                        environment={"XDG_CACHE_HOME": str(self.folder)})
        self.addCleanup(server.stop)
        return server

    def get(self, server, scene):
        status, _, body = server.request("GET", f"/api/v1/scenes/{scene}/thumbnail.jpg")
        return status, body

    def wait_for(self, server, scene):
        deadline = time.monotonic() + 60 * TIME_FACTOR
        while time.monotonic() < deadline:
            status, body = self.get(server, scene)
            if status != 202:
                return status, body
            time.sleep(0.1)
        self.fail("the thumbnail did not come")

    def test_they_are_rendered_once_and_outlive_the_server(self):
        server = self.start()
        self.assertEqual(self.get(server, "more/second")[0], 202)
        status, file = self.wait_for(server, "more/second")
        self.assertEqual(status, 200)
        image = decode_jpeg(file)
        self.assertEqual((image.width, image.height), (240, 135))
        self.assertGreater(image.deviation(), 5)
        self.assertEqual([one["name"] for one in server.call("session.list")["sessions"]], ["main"])
        self.assertEqual(server.call("scene.list")["current"], "first")
        server.stop()
        server = self.start()
        self.assertEqual(self.get(server, "more/second"), (200, file))
        # A file that has changed is another scene.
        os.utime(self.scenes / "more" / "second.glb", (1, 1))
        self.assertEqual(self.get(server, "more/second")[0], 202)
        self.assertEqual(self.wait_for(server, "more/second")[0], 200)

    def test_scenes_without_one_say_why(self):
        server = self.start()
        self.assertEqual(self.get(server, "missing")[0], 404)
        self.assertEqual(self.wait_for(server, "broken")[0], 400)
        self.assertEqual(self.wait_for(server, "first")[0], 200)

    async def test_they_wait_for_the_end_of_a_clip_whose_viewer_is_slow(self):
        model = Model(os.path.join(os.environ["HELIOGRAPH_SCENES"], "furnace.glb"))
        model.add_clip("hop", model.node("diffuse"), [0.0, 1.0], [[0, 0.6, 0], [0.5, 1.0, 0]])
        model.save(os.path.join(self.scenes, "first.glb"))
        server = self.start()
        async with Viewer(server, acknowledge=False) as viewer:
            await viewer.next_frame()
            await viewer.call("animation.play", {"clip": "hop"})
            await viewer.frame_where(lambda frame: not frame.final)
            deadline = time.monotonic() + 4
            while time.monotonic() < deadline:
                status, _ = await asyncio.to_thread(self.get, server, "more/second")
                self.assertEqual(status, 202, "rendered while a clip played")
                await asyncio.sleep(0.2)
            await viewer.call("animation.pause")
            status, _ = await asyncio.to_thread(self.wait_for, server, "more/second")
            self.assertEqual(status, 200)


if __name__ == "__main__":
    unittest.main()
