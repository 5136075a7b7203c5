"""Thumbnails of scenes: rendered while the server is idle, kept on disk."""

import os
import shutil
import tempfile
import time
import unittest
from pathlib import Path

from harness.images import decode_jpeg
from harness.server import TIME_FACTOR, Server


class Thumbnails(unittest.TestCase):
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


if __name__ == "__main__":
    unittest.main()
