"""Scenes with large images: viewers see their geometry first, programs the whole."""

import asyncio
import base64
import os
import random
import shutil
import struct
import tempfile
import unittest
import zlib

from harness.gltf import document, grid, write_glb
from harness.images import encode_png
from harness.server import Server, ServerTestCase
from harness.viewer import Viewer

SIDE = 4096
NOISE_SIDE = 2048  # incompressible: more bytes than the least for which geometry comes first


def chunk(kind, data):
    return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))


def png(side, rows, level):
    header = struct.pack(">IIBBBBB", side, side, 8, 2, 0, 0, 0)
    return (b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) +
            chunk(b"IDAT", zlib.compress(rows, level)) + chunk(b"IEND", b""))


def large_images():
    noise = random.Random(7)
    yield png(NOISE_SIDE, b"".join(b"\0" + noise.randbytes(3 * NOISE_SIDE)
                                   for _ in range(NOISE_SIDE)), 0)
    for color in (b"\x20\x90\x40", b"\x90\x20\x40", b"\x40\x20\x90"):
        yield png(SIDE, (b"\0" + color * SIDE) * SIDE, 1)


def textured(images):
    """A bumpy square for each image, side by side."""
    content, binary = document(*grid(8))
    content.update(images=[], textures=[], materials=[], nodes=[], meshes=[])
    for i, image in enumerate(images):
        binary += b"\0" * (-len(binary) % 4)
        content["bufferViews"].append(
            {"buffer": 0, "byteOffset": len(binary), "byteLength": len(image)})
        binary += image
        content["images"].append(
            {"mimeType": "image/png", "bufferView": len(content["bufferViews"]) - 1})
        content["textures"].append({"source": i})
        content["materials"].append({"pbrMetallicRoughness": {"baseColorTexture": {"index": i}}})
        content["meshes"].append(
            {"primitives": [{"attributes": {"POSITION": 0}, "indices": 1, "material": i}]})
        content["nodes"].append({"mesh": i, "translation": [1.1 * i, 0, 0]})
    content["scenes"] = [{"nodes": list(range(len(content["nodes"])))}]
    content["buffers"] = [{"byteLength": len(binary)}]
    return content, binary


class FirstViews(ServerTestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        root = cls.folder.name
        given = os.path.join(os.environ["HELIOGRAPH_SCENES"], "mirror.glb")
        for name in ("mirror.glb", "small.glb"):
            shutil.copy(given, os.path.join(root, name))
        images = list(large_images())
        content, binary = textured(images)
        # Each name is loaded once: what is in the cache has no first view.
        for name in ("watched", "unwatched", "cancelled", "dragged", "stepped", "traced",
                     "retextured"):
            write_glb(os.path.join(root, name + ".glb"), content, binary)
        damaged = images[:-1] + [images[-1][:-40] + b"\0" * 40]
        content, binary = textured(damaged)
        write_glb(os.path.join(root, "damaged.glb"), content, binary)
        cls.uploads = tempfile.TemporaryDirectory()
        cls.server = Server("--scene", "mirror", "--strict-assets", "--uploads", cls.uploads.name,
                            scenes=root)

    async def load_until_seen(self, viewer, name):
        """Starts a load and waits until the camera is the scene's; returns the load and what was
        told of the camera. Frames take much of the time that the load has left."""
        load = asyncio.create_task(viewer.ask("scene.load", {"name": name}))
        return load, await viewer.notification("camera.changed")

    async def first_view(self, viewer, name):
        """Starts a load and waits for its first frame; returns the load and the frame."""
        load, told = await self.load_until_seen(viewer, name)
        rev = told["camera"]["rev"]
        frame = await viewer.frame_where(lambda it: it.header["state_rev"] >= rev)
        return load, frame

    def stepped_image(self, session=None):
        """Four frames in lockstep, which depend on nothing that was rendered before."""
        self.server.call("frame.step", {"frames": 4, "dt": 1 / 30}, session)
        answer = self.server.call("frame.capture", {}, session)
        self.server.call("frame.run", session=session)
        return base64.b64decode(answer["data"])

    async def test_the_first_frame_comes_before_textures_and_the_last_is_that_of_one_step(self):
        async with Viewer(self.server) as viewer:
            await viewer.rest()
            load, frame = await self.first_view(viewer, "watched")
            self.assertFalse(load.done(), "it was shown before it was complete")
            info = (await load)["result"]
            self.assertEqual(info["name"], "watched")
            stages = [message["params"] for message in viewer.notifications
                      if message["method"] == "scene.progress"]
            seen = [stage["first_view"] for stage in stages]
            self.assertTrue(any(seen))
            self.assertFalse(seen[0] or seen[-1])
            self.assertEqual(stages[-1]["stage"], "ready")
            self.assertIn("textures", [stage["stage"] for stage in stages if stage["first_view"]])
            last = await viewer.rest()
            self.assertGreater(last.header["state_rev"], frame.header["state_rev"])
            camera = await viewer.call("camera.get")
        watched = await asyncio.to_thread(self.stepped_image)
        self.server.call("session.create", {"name": "alone"})
        try:
            self.server.call("scene.load", {"name": "unwatched"}, "alone")
            size = {key: self.server.call("session.info")[key] for key in ("width", "height")}
            self.server.call("stream.configure", size, "alone")
            pose = {key: camera[key] for key in ("eye", "target", "up", "vertical_fov")}
            self.server.call("camera.set", pose, "alone")
            self.assertEqual(await asyncio.to_thread(self.stepped_image, "alone"), watched)
        finally:
            self.server.call("session.close", {"session": "alone"})

    async def test_a_load_is_cancelled_while_its_geometry_is_seen(self):
        async with Viewer(self.server) as viewer:
            await viewer.call("scene.load", {"name": "mirror"})
            before = await viewer.call("camera.get")
            viewer.notifications.clear()
            load, _ = await self.first_view(viewer, "cancelled")
            self.assertEqual((await viewer.call("scene.info"))["name"], "mirror")
            self.assertNotEqual((await viewer.call("camera.get"))["eye"], before["eye"])
            self.assertEqual(await viewer.call("scene.cancel"), {"cancelled": True})
            self.assert_error(await load, -32009, path="name")
            self.assertEqual((await viewer.call("camera.get"))["eye"], before["eye"])
            self.assertEqual((await viewer.call("scene.info"))["name"], "mirror")
            self.assertFalse((await viewer.progress_with("cancelled"))["first_view"])
            await viewer.rest()

    async def test_a_drag_of_the_scene_before_does_not_move_the_new_camera(self):
        async with Viewer(self.server) as viewer:
            await viewer.call("scene.load", {"name": "mirror"})
            since = (await viewer.call("camera.get"))["scene_rev"]
            drag = {"eye": [0, 1, 4], "target": [0, 0, 0], "scene_rev": since}
            self.assertEqual((await viewer.call("camera.set", drag))["scene_rev"], since)
            viewer.notifications.clear()
            load, _ = await self.load_until_seen(viewer, "dragged")
            camera = await viewer.call("camera.get")
            self.assertNotEqual(camera["scene_rev"], since)
            self.assert_error(await viewer.ask("camera.set", drag), -32009, path="scene_rev")
            orbit = {"yaw": 10, "scene_rev": since}
            self.assert_error(await viewer.ask("camera.orbit", orbit), -32009, path="scene_rev")
            self.assertEqual((await viewer.call("camera.get"))["eye"], camera["eye"])
            moved = await viewer.call("camera.set", {**drag, "scene_rev": camera["scene_rev"]})
            await load
            after = await viewer.call("camera.get")
            self.assertEqual(after["eye"], moved["eye"])
            self.assertEqual(after["scene_rev"], camera["scene_rev"], "the scene is the same")
            await viewer.rest()

    async def test_programs_that_hide_the_first_view_bring_the_camera_of_before(self):
        async with Viewer(self.server) as viewer:
            for name, begin, end in (("stepped", ("frame.step", {"frames": 0, "dt": 0}), "frame.run"),
                                     ("traced", ("reference.start", {}), "reference.stop")):
                await viewer.call("scene.load", {"name": "mirror"})
                before = await viewer.call("camera.get")
                viewer.notifications.clear()
                load, told = await self.load_until_seen(viewer, name)
                first = told["camera"]
                self.assertNotEqual(first["scene_rev"], before["scene_rev"])
                viewer.notifications.clear()
                await viewer.call(*begin)
                told = await viewer.notification("camera.changed")
                self.assertFalse(load.done(), "it was loaded before the camera was told")
                self.assertEqual(told["camera"]["scene_rev"], before["scene_rev"])
                self.assertEqual(told["camera"]["eye"], before["eye"])
                self.assertGreater(told["camera"]["rev"], first["rev"])
                viewer.notifications.clear()
                await viewer.call(end)
                told = await viewer.notification("camera.changed")
                self.assertFalse(load.done(), "it was loaded before the camera was told")
                self.assertEqual(told["camera"]["scene_rev"], first["scene_rev"])
                self.assertEqual(told["camera"]["eye"], first["eye"])
                await load
                after = await viewer.call("camera.get")
                self.assertEqual(after["scene_rev"], first["scene_rev"])
                await viewer.rest()

    async def test_textures_wait_for_the_scene_that_is_being_loaded(self):
        status, _, answer = self.server.request("PUT", "/api/v1/images/red",
                                                encode_png((255, 0, 0)))
        self.assertEqual(status, 201, answer)
        async with Viewer(self.server) as viewer:
            await viewer.call("scene.load", {"name": "mirror"})
            material = (await viewer.call("materials.list"))["materials"][0]["name"]
            change = {"material": material, "slot": "base_color", "image": "red"}
            edits = {"version": 1, "textures": [change]}
            viewer.notifications.clear()
            load, _ = await self.load_until_seen(viewer, "retextured")
            for method, params in (("textures.set", change), ("edits.apply", {"edits": edits})):
                answer = await viewer.ask(method, params)
                self.assert_error(answer, -32050)
                self.assertIn("a scene is being loaded", answer["error"]["message"])
            self.assertEqual((await load)["result"]["name"], "retextured", "the load goes on")
            await viewer.rest()

    async def test_damage_in_a_texture_brings_the_scene_before_back(self):
        async with Viewer(self.server) as viewer:
            await viewer.call("scene.load", {"name": "mirror"})
            before = await viewer.call("camera.get")
            viewer.notifications.clear()
            load, _ = await self.first_view(viewer, "damaged")
            self.assert_error(await load, -32602, path="name")
            await viewer.progress_with("failed")
            self.assertEqual((await viewer.call("scene.info"))["name"], "mirror")
            self.assertEqual((await viewer.call("camera.get"))["eye"], before["eye"])
            await viewer.rest()

    async def test_small_scenes_have_none(self):
        async with Viewer(self.server) as viewer:
            await viewer.rest()
            viewer.notifications.clear()
            await viewer.call("scene.load", {"name": "small"})
            await viewer.progress_with("ready")
            methods = [message["method"] for message in viewer.notifications]
            self.assertNotIn("camera.changed", methods)
            self.assertFalse(any(message["params"]["first_view"]
                                 for message in viewer.notifications
                                 if message["method"] == "scene.progress"))


if __name__ == "__main__":
    unittest.main()
