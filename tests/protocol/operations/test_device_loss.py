"""The device is lost: everything but histories survives."""

import asyncio
import os
import shutil
import subprocess
import tempfile
import time
import unittest

from harness.gltf import document, grid, write_glb
from harness.images import decode_jpeg, difference
from harness.server import Server, ServerTestCase
from harness.viewer import Viewer


class DeviceLoss(ServerTestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.fault = os.path.join(cls.folder.name, "lose")
        cls.scenes = os.path.join(cls.folder.name, "scenes")
        shutil.copytree(os.environ["HELIOGRAPH_SCENES"], cls.scenes)
        cls.server = Server(scenes=cls.scenes,
                            environment={"HELIOGRAPH_TEST_DEVICE_LOSS": cls.fault})

    def lose(self):
        with open(self.fault, "w", encoding="ascii"):
            pass

    def ready(self):
        return self.server.get("/health/ready")[0] == 200

    def losses(self):
        page = self.server.get("/metrics")[2].decode()
        lines = [line for line in page.splitlines()
                 if line.startswith("heliograph_device_losses_total")]
        return float(lines[0].split()[1])

    async def received(self, viewer, ready):
        for _ in range(600):
            if any(message["method"] == "device.changed" and message["params"]["ready"] == ready
                   for message in viewer.notifications):
                return
            await asyncio.sleep(0.05)
        self.fail(f"device.changed with ready {ready} did not come:\n" + self.server.log_text())

    async def test_sessions_keep_their_state(self):
        # Few samples differ by more than noise: the light that surfaces pass on is still uncertain.
        samples = {"patch": {"accumulation": {"max_samples": 16}}}
        self.server.call("settings.patch", samples)
        self.addCleanup(self.server.call, "settings.patch",
                        {"patch": {"accumulation": {"max_samples": 4}}})
        self.server.call("session.create", {"name": "other", "copy_of": "main"})
        self.server.call("settings.patch", {"patch": {"exposure": {"compensation": 1}}},
                         session="other")
        async with Viewer(self.server) as here, Viewer(self.server, session="other") as there:
            await here.call("camera.set", {"eye": [3, 2, 3]})
            await there.call("camera.set", {"eye": [2, 2, 4]})
            before = [decode_jpeg((await viewer.rest()).payload) for viewer in (here, there)]
            state = [await viewer.call(method) for viewer in (here, there)
                     for method in ("camera.get", "settings.get", "scene.info")]
            count = self.losses()
            self.lose()
            await here.call("camera.set", {"eye": [4, 4, 4]})
            await self.received(here, False)
            await self.received(there, True)
            await here.call("camera.set", {"eye": [3, 2, 3]})
            await there.call("camera.set", {"eye": [2, 2, 4]})
            after = [decode_jpeg((await viewer.rest()).payload) for viewer in (here, there)]
            for one, other in zip(before, after):
                self.assertLess(difference(one, other), 2)
            again = [await viewer.call(method) for viewer in (here, there)
                     for method in ("camera.get", "settings.get", "scene.info")]
            for one, other in zip(state, again):
                one.pop("rev", None), other.pop("rev", None)
                self.assertEqual(one, other)
        self.assertTrue(self.ready())
        self.assertEqual(self.losses(), count + 1)
        self.server.call("session.close", {"session": "other"})

    async def test_a_loss_while_loading_is_reported_and_recovered(self):
        shutil.copy(os.path.join(self.scenes, "mirror.glb"), os.path.join(self.scenes, "new.glb"))
        self.lose()
        # The caller gets the result of the second attempt.
        self.assertEqual(self.server.call("scene.load", {"name": "new"})["name"], "new")
        self.assertFalse(os.path.exists(self.fault))
        self.server.wait_for(self.ready, "the recovery", timeout=60)
        self.assertGreaterEqual(self.server.call("frame.capture", {"samples": 1})["samples"], 1)

    async def test_repeated_losses_back_off_while_commands_work(self):
        async with Viewer(self.server) as viewer:
            await viewer.rest()
            begin = self.losses()
            step = 0
            while self.losses() < begin + 3:
                self.lose()
                step += 1
                await viewer.call("camera.set", {"eye": [3 + 0.01 * step, 2, 3]})
                await asyncio.sleep(0.1)
                self.assertLess(step, 300, self.server.log_text())
            status, _, body = self.server.get("/health/ready")
            self.assertEqual((status, b"lost" in body), (503, True))
            if os.path.exists(self.fault):
                os.remove(self.fault)
            self.server.wait_for(self.ready, "the recovery", timeout=60)
            await viewer.rest()
        self.assertIn("recovery in ", self.server.log_text())


class LossAtTheStart(unittest.TestCase):
    """The device is lost while its programs and tables are made."""

    def test_it_is_set_up_again(self):
        with tempfile.TemporaryDirectory() as folder:
            fault = os.path.join(folder, "lose")
            with open(fault, "w", encoding="ascii"):
                pass
            with Server(environment={"HELIOGRAPH_TEST_DEVICE_LOSS": fault}) as server:
                self.assertFalse(os.path.exists(fault), "the device was not lost")
                self.assertIn("lost while it was set up; trying again", server.log_text())
                self.assertEqual(server.get("/health/ready")[0], 200)

    def test_repeated_losses_end_with_one_sentence(self):
        with tempfile.TemporaryDirectory() as folder:
            fault = os.path.join(folder, "lose")
            process = subprocess.Popen(
                [os.environ["HELIOGRAPH_BINARY"], "serve", "--port", "0", "--scene-root",
                 os.environ["HELIOGRAPH_SCENES"]], stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                text=True, env={**os.environ, "HELIOGRAPH_TEST_DEVICE_LOSS": fault})
            deadline = time.monotonic() + 60
            while process.poll() is None and time.monotonic() < deadline:
                with open(fault, "a", encoding="ascii"):
                    pass
                time.sleep(0.001)
            out, err = process.communicate(timeout=10)
            self.assertEqual((process.returncode, out), (1, ""), err)
            told = [line for line in err.splitlines() if line.startswith("heliograph: ")]
            self.assertEqual(len(told), 1, err)
            self.assertIn("the graphics device was lost 3 times while it was set up", told[0])


class LossBeforeTheFirstFrame(unittest.TestCase):
    def test_the_first_scene_is_loaded_again(self):
        # The renderer of the session may meet every loss while the scene loads: then once more.
        for attempt in range(5):
            if self.loses_the_first_load(attempt):
                return
        self.fail("every load ended without a loss")

    def loses_the_first_load(self, attempt):
        with tempfile.TemporaryDirectory() as folder:
            content, binary = document(*grid(500 + 100 * attempt))
            write_glb(os.path.join(folder, "first.glb"), content, binary)
            fault = os.path.join(folder, "lose")
            with Server("--scene", "first", scenes=folder, early=True,
                        environment={"HELIOGRAPH_TEST_DEVICE_LOSS": fault}) as server:
                def loaded_or_lost():
                    log = server.log_text()
                    if "loading first: " in log or "first loaded in" in log:
                        return True
                    with open(fault, "w", encoding="ascii"):
                        return False
                server.wait_for(loaded_or_lost, "the loss", timeout=60, pause=0.005)
                if os.path.exists(fault):
                    os.remove(fault)
                if "loading first: " not in server.log_text():
                    return False
                server.wait_for(lambda: server.get("/health/ready")[0] == 200, "the first frame",
                                timeout=60)
                self.assertEqual(server.call("scene.list")["current"], "first")
                self.assertEqual(server.stop(), 0)
        return True
