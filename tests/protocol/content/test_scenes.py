"""Loading scenes: only from the catalogue, atomically."""

import asyncio
import json
import os
import re
import shutil
import struct
import tempfile
import time
import unittest

from harness.gltf import document, grid, write_glb, write_gltf
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
        cls.root = root
        cls.write_choices(os.path.join(root, "choices.gltf"))
        content, binary = document(*grid(500))
        for name in ("slow", "other_slow"):
            write_glb(os.path.join(root, name + ".glb"), content, binary)
        os.mkdir(os.path.join(root, "broken"))
        for name, data in cls.broken.items():
            with open(os.path.join(root, "broken", name + ".glb"), "wb") as file:
                file.write(data)
        escape, positions = document([0, 0, 0, 1, 0, 0, 0, 1, 0], [0, 1, 2])
        escape["buffers"] = [{"uri": "../../secret.bin", "byteLength": len(positions)}]
        with open(os.path.join(root, "broken", "escape.gltf"), "w", encoding="ascii") as file:
            json.dump(escape, file)
        shutil.copy(os.path.join(given, "mirror.glb"), os.path.join(cls.folder.name, "secret.glb"))
        cls.server = Server("--scene", "mirror", scenes=root)

    @staticmethod
    def write_choices(path):
        """Two scenes, the second of two triangles, and two variants of the first one's material."""
        content, binary = document([0, 0, 0, 1, 0, 0, 0, 1, 0], [0, 1, 2])
        content["extensionsUsed"] = ["KHR_materials_variants", "EXT_unheard_of"]
        content["extensions"] = {"KHR_materials_variants":
                                 {"variants": [{"name": "day"}, {"name": "night"}]}}
        content["materials"] = [{"name": name} for name in ("plain", "bright", "dark")]
        content["meshes"][0]["primitives"][0].update(material=0, extensions={
            "KHR_materials_variants": {"mappings": [{"material": 1, "variants": [0]},
                                                    {"material": 2, "variants": [1]}]}})
        content["nodes"] += [{"mesh": 0}, {"mesh": 0, "translation": [1, 0, 0]}]
        content["scenes"].append({"name": "two", "nodes": [1, 2]})
        write_gltf(path, content, binary)

    def cache(self):
        text = self.server.get("/metrics")[2].decode()
        return {key: float(value) for key, value in
                re.findall(r"^heliograph_scene_cache_(\w+) (\S+)$", text, re.MULTILINE)}

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
        self.assertEqual(info["environment"], "sky.hdr")
        self.assertEqual(len(info["material_names"]), info["materials"])
        self.assertEqual(len(info["light_names"]), info["lights"])
        self.assertGreater(info["nodes"], 0)
        self.assertGreater(info["vertices"], 50)
        for part in ("file", "host", "device"):
            self.assertGreater(info["memory"][part], 1000, part)
        self.assertEqual(self.server.call("scene.info"), info)
        self.assertEqual(self.server.call("scene.list")["current"], "furnace")

    def test_failed_loads_leave_the_session_unchanged(self):
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

    def test_scenes_too_large_for_the_device_are_refused(self):
        content, binary = document(*grid(700))
        write_glb(os.path.join(self.root, "vast.glb"), content, binary)
        answer = self.server.ask("scene.load", {"name": "vast"})
        if "result" in answer:
            self.skipTest("this device holds a million triangles without shared normals")
        self.assert_error(answer, -32602, path="name")
        self.assertIn("MiB; this device", answer["error"]["message"])

    async def test_progress_and_change_are_notified(self):
        async with Viewer(self.server) as loader, Viewer(self.server) as other:
            info = await loader.call("scene.load", {"name": "furnace"})
            progress = await other.notification("scene.progress")
            self.assertEqual(progress["name"], "furnace")
            self.assertTrue(0 <= progress["fraction"] <= 1)
            author = loader.hello["viewer"]
            self.assertEqual(progress["by"], author)
            self.assertEqual(await other.notification("scene.changed"),
                             {"scene": info, "by": author})
            self.assertNotIn("scene.changed", [m["method"] for m in loader.notifications])

    async def test_a_later_load_replaces_an_earlier_one(self):
        async with Viewer(self.server) as viewer:
            names = ["furnace", "mirror"] * 3
            answers = await asyncio.gather(
                *[viewer.ask("scene.load", {"name": name}) for name in names])
            self.assertEqual(answers[-1]["result"]["name"], "mirror")
            for answer in answers[:-1]:
                if "error" in answer:
                    self.assert_error(answer, -32009, path="name")
            self.assertEqual((await viewer.call("scene.info"))["name"], "mirror")

    def test_scene_and_variant_of_a_file_can_be_chosen(self):
        info = self.server.call("scene.load", {"name": "choices"})
        self.assertEqual((info["scenes"], info["scene"], info["triangles"]), (["one", "two"], 0, 1))
        self.assertEqual((info["variants"], info["variant"]), (["day", "night"], None))
        self.assertIn("EXT_unheard_of", " ".join(info["warnings"]))
        for scene in ("two", "1"):
            info = self.server.call("scene.load", {"name": "choices", "scene": scene})
            self.assertEqual((info["scene"], info["triangles"]), (1, 2))
        info = self.server.call("scene.load", {"name": "choices", "variant": "night"})
        self.assertEqual((info["scene"], info["variant"]), (0, "night"))
        for member, wrong in (("scene", "tvo"), ("scene", "2"), ("variant", "nigth")):
            answer = self.server.ask("scene.load", {"name": "choices", member: wrong})
            self.assert_error(answer, -32004, path=member)
        self.assertIn("night", answer["error"]["message"])
        self.assertEqual(self.server.call("scene.info"), info)

    async def test_a_load_is_cancelled(self):
        async with Viewer(self.server) as viewer:
            shown = await viewer.call("scene.info")
            self.assertEqual(await viewer.call("scene.cancel"), {"cancelled": False})
            load = asyncio.create_task(viewer.ask("scene.load", {"name": "slow"}))
            await viewer.notification("scene.progress")
            begun = time.monotonic()
            self.assertEqual(await viewer.call("scene.cancel"), {"cancelled": True})
            self.assert_error(await load, -32009, path="name")
            self.assertLess(time.monotonic() - begun, 5)
            self.assertEqual(await viewer.call("scene.info"), shown)
            await viewer.progress_with("cancelled")
            await viewer.call("scene.load", {"name": "furnace"})

    async def test_viewers_are_told_that_a_load_has_failed(self):
        async with Viewer(self.server) as loader, Viewer(self.server) as other:
            answer = await loader.ask("scene.load", {"name": "choices", "scene": "none"})
            self.assert_error(answer, -32004, path="scene")
            progress = await other.progress_with("failed")
            self.assertEqual(progress["name"], "choices")

    async def test_closing_a_session_cancels_its_load(self):
        ended = self.server.log_text().count("loading slow was cancelled")
        self.server.call("session.create", {"name": "passing"})
        async with Viewer(self.server, session="passing") as viewer:
            load = asyncio.create_task(asyncio.to_thread(
                self.server.ask, "scene.load", {"name": "slow"}, "passing"))
            await viewer.notification("scene.progress")
            begun = time.monotonic()
            self.server.call("session.close", {"session": "passing"})
            self.assert_error(await load, -32004, path="session")
            self.assertLess(time.monotonic() - begun, 5)
        self.server.wait_for(
            lambda: self.server.log_text().count("loading slow was cancelled") > ended, "its end")

    async def test_concurrent_loads_of_a_scene_are_shared(self):
        before = self.cache()
        async with Viewer(self.server) as viewer:
            answers = await asyncio.gather(
                *[viewer.ask("scene.load", {"name": "other_slow"}) for _ in range(3)])
            for answer in answers:
                self.assertEqual(answer["result"]["name"], "other_slow")
            await viewer.call("scene.load", {"name": "mirror"})
            await viewer.call("scene.load", {"name": "other_slow"})
        now = self.cache()
        self.assertEqual(now["misses_total"] - before["misses_total"], 1)
        self.assertEqual(now["hits_total"] - before["hits_total"], 4)
        self.assertGreater(now["bytes"], before["bytes"])

    def test_a_changed_file_is_reloaded(self):
        path = os.path.join(self.root, "changing.gltf")
        self.write_choices(path)
        self.assertEqual(self.server.call("scene.load", {"name": "changing"})["triangles"], 1)
        content, binary = document(*grid(3))
        write_gltf(path, content, binary)
        self.assertEqual(self.server.call("scene.load", {"name": "changing"})["triangles"], 18)

    async def test_frames_continue_after_a_failed_load(self):
        async with Viewer(self.server) as viewer:
            await viewer.ask("scene.load", {"name": "broken/truncated"})
            camera = await viewer.call("camera.set", {"eye": [3, 3, 3]})
            await viewer.frame_where(lambda frame: frame.header["state_rev"] >= camera["rev"])


class FirstScene(unittest.TestCase):
    """Clients that connect before the first scene is loaded."""

    def test_an_invalid_load_does_not_stop_the_server(self):
        with tempfile.TemporaryDirectory() as root:
            content, binary = document(*grid(700))
            write_glb(os.path.join(root, "first.glb"), content, binary)
            shutil.copy(os.path.join(os.environ["HELIOGRAPH_SCENES"], "mirror.glb"), root)
            with open(os.path.join(root, "broken.glb"), "wb") as file:
                file.write(b"this is not glTF")
            with Server("--scene", "first", scenes=root, early=True) as server:
                self.assertEqual(server.ask("scene.load", {"name": "nowhere"})["error"]["code"],
                                 -32004)
                self.assertEqual(server.ask("scene.load", {"name": "broken"})["error"]["code"],
                                 -32602)
                self.assertEqual(server.call("scene.load", {"name": "mirror"})["name"], "mirror")
                server.wait_for(lambda: server.get("/health/ready")[0] == 200, "the first frame")
                self.assertEqual(server.stop(), 0)

    def test_a_first_scene_that_fails_stops_the_server_with_the_reason(self):
        with tempfile.TemporaryDirectory() as root:
            with open(os.path.join(root, "broken.glb"), "wb") as file:
                file.write(b"this is not glTF")
            server = Server("--scene", "broken", scenes=root, early=True)
            self.assertNotEqual(server.wait(), 0)
            self.assertIn("not a glTF file", server.log_text())
