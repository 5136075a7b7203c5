"""Shaders saved while the server runs: the next frame shows them, errors are shown over it."""

import asyncio
import os
import pathlib
import shutil
import tempfile
import unittest

from harness.images import decode_jpeg, difference
from harness.server import Server, ServerTestCase
from harness.viewer import Viewer

SOURCES = pathlib.Path(__file__).resolve().parents[3] / "shaders"
OUTPUT = "vec4(encoded, 1.0)"


class ShaderReload(ServerTestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.shaders = pathlib.Path(cls.folder.name) / "shaders"
        shutil.copytree(SOURCES, cls.shaders)
        cls.server = Server("--shader-dir", str(cls.shaders))

    def save(self, before, after):
        file = self.shaders / "post" / "present.comp"
        text = file.read_text()
        self.assertIn(before, text)
        saved = file.with_suffix(".saved")
        saved.write_text(text.replace(before, after))
        os.replace(saved, file)

    async def frame_unlike(self, viewer, image):
        """The next frame that differs from `image`, which no call asked for."""
        frame = await viewer.frame_where(
            lambda frame: difference(decode_jpeg(frame.payload), image) > 2)
        return decode_jpeg(frame.payload)

    async def frame_like(self, viewer, image):
        await viewer.frame_where(lambda frame: difference(decode_jpeg(frame.payload), image) < 2)

    async def logged(self, text):
        for _ in range(200):
            if text in self.server.log_text():
                return
            await asyncio.sleep(0.05)
        self.fail(f"not logged: {text}\n" + self.server.log_text())

    async def test_saved_shader_changes_the_frame_of_a_static_view(self):
        async with Viewer(self.server) as viewer:
            before = decode_jpeg((await viewer.rest()).payload)
            self.save(OUTPUT, "vec4(1.0 - encoded, 1.0)")
            await self.frame_unlike(viewer, before)
            self.save("vec4(1.0 - encoded, 1.0)", OUTPUT)
            await self.frame_like(viewer, before)

    async def test_error_is_shown_and_logged_and_nothing_stops(self):
        async with Viewer(self.server) as viewer:
            # Large enough that the text covers little of it.
            await viewer.call("stream.configure", {"width": 640, "height": 360})
            await viewer.frame_where(lambda frame: frame.header["width"] == 640)
            before = decode_jpeg((await viewer.rest()).payload)
            self.save(OUTPUT, "vec5(encoded, 1.0)")
            with_text = await self.frame_unlike(viewer, before)
            self.assertLess(difference(with_text, before), 128, "the last good frame is below it")
            await self.logged("shaders/post/present.comp:")
            await viewer.call("camera.set", {"eye": [4, 4, 4]})
            await viewer.call("camera.set", {"eye": [3, 3, 3]})
            self.save("vec5(encoded, 1.0)", OUTPUT)
            await self.logged("shaders compiled, changed: none")
            self.assertTrue(self.server.alive)


if __name__ == "__main__":
    unittest.main()
