"""Several devices in one server: sessions on each, and a loss that is that of one device."""

import asyncio
import os
import subprocess
import tempfile
import time
import unittest

from harness.exposition import parse
from harness.images import decode_jpeg, decode_png, difference
from harness.server import TIME_FACTOR, Server, ServerTestCase
from harness.viewer import Viewer

DEVICE = os.environ.get("HELIOGRAPH_TEST_DEVICE", "llvmpipe")


def of_devices(server, name):
    """The samples of a metric by device."""
    family = parse(server.get("/metrics")[2].decode())[name]
    return {dict(labels)["device"]: value for (_, labels), value in family.samples.items()}


class TwoDevices(ServerTestCase):
    arguments = ("--device", f"{DEVICE},{DEVICE}")

    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.fault = os.path.join(cls.folder.name, "lose")
        cls.server = Server(*cls.arguments,
                            environment={"HELIOGRAPH_TEST_DEVICE_LOSS": cls.fault})

    def own(self, name, **how):
        """A session on the second device, as soon as what a test before this one has rendered there
        does not count any more. It ends with the test."""
        for _ in range(60):
            made = self.server.call("session.create", {"name": name, **how})
            if made["device"] == 1:
                break
            self.server.call("session.close", {"session": name})
            time.sleep(0.5)
        self.addCleanup(self.server.call, "session.close", {"session": name})
        self.assertEqual(made["device"], 1)
        return made

    def losses(self):
        return of_devices(self.server, "heliograph_device_losses_total")

    async def test_sessions_spread_and_show_the_same(self):
        self.own("second", copy_of="main")
        frames = of_devices(self.server, "heliograph_device_frames_total")
        async with Viewer(self.server) as here, Viewer(self.server, session="second") as there:
            self.assertEqual([viewer.hello["device"]["index"] for viewer in (here, there)], [0, 1])
            self.assertIn(DEVICE.lower(), there.hello["device"]["name"].lower())
            for viewer in (here, there):
                await viewer.call("camera.set", {"eye": [3, 2, 3]})
            images = [decode_jpeg((await viewer.rest()).payload) for viewer in (here, there)]
        self.assertGreater(images[0].deviation(), 5)
        self.assertLess(difference(*images), 4, "few samples, after different motion")
        rendered = of_devices(self.server, "heliograph_device_frames_total")
        for device in ("0", "1"):
            self.assertGreater(rendered[device], frames[device])
        self.assertEqual(of_devices(self.server, "heliograph_device_sessions"), {"0": 1, "1": 1})
        self.assertEqual(set(of_devices(self.server, "heliograph_device_info")), {"0", "1"})

    def test_the_same_steps_give_the_same_bytes(self):
        self.own("second", copy_of="main")
        images = []
        for session in ("main", "second"):
            self.server.call("frame.step", {"frames": 3, "dt": 0.1}, session=session)
            status, _, image = self.server.get(f"/api/v1/sessions/{session}/frame.png")
            self.server.call("frame.run", session=session)
            self.assertEqual(status, 200)
            images.append(image)
        self.assertGreater(decode_png(images[0]).deviation(), 5)
        self.assertEqual(images[0], images[1])

    def test_a_scene_that_is_loaded_goes_to_the_device_of_its_session(self):
        self.own("second", scene="mirror")
        shown = {session["name"]: (session["device"], session["scene"])
                 for session in self.server.call("session.list")["sessions"]}
        self.assertEqual(shown, {"main": (0, "mirror"), "second": (1, "mirror")})
        self.server.call("frame.capture", {"samples": 1}, session="second")

    async def test_a_camera_of_ones_own_and_a_snapshot_stay_on_the_device(self):
        self.own("second", copy_of="main")
        async with Viewer(self.server, session="second") as viewer:
            joined = await viewer.call("session.detach")
            self.assertEqual(joined["info"]["device"], 1)
            await viewer.rest()
        frames = of_devices(self.server, "heliograph_device_frames_total")["0"]
        status, _, _ = self.server.get("/api/v1/sessions/second/frame.png?width=80&samples=1")
        self.assertEqual(status, 200)
        self.assertEqual(of_devices(self.server, "heliograph_device_frames_total")["0"], frames)

    def test_an_environment_and_edits_reach_the_second_device(self):
        self.server.call("environment.set", {"name": "white"})
        self.addCleanup(self.server.call, "environment.set", {"name": None})
        self.own("second", copy_of="main")
        self.assertEqual(self.server.call("environment.list", session="second")["current"], "white")
        self.server.call("frame.capture", {"samples": 1}, session="second")
        self.server.call("environment.set", {"name": "studio"}, session="second")
        self.server.call("frame.capture", {"samples": 1}, session="second")

    async def test_both_deliver_frames_at_once_in_order(self):
        self.own("second", copy_of="main")
        async with Viewer(self.server) as here, Viewer(self.server, session="second") as there:
            async with here.moving(), there.moving():
                received = await asyncio.gather(self.orders(here), self.orders(there))
        for orders in received:
            self.assertEqual(orders, sorted(orders))

    @staticmethod
    async def orders(viewer, count=20):
        found = []
        for _ in range(count):
            header = (await viewer.next_frame()).header
            found.append((header["frame_seq"], header["render_id"], header["render_start_us"]))
        return found

    async def test_a_loss_costs_the_sessions_of_one_device_their_histories(self):
        self.own("second", copy_of="main")
        async with Viewer(self.server) as here, Viewer(self.server, session="second") as there:
            for viewer in (here, there):
                await viewer.call("camera.set", {"eye": [3, 2, 3]})
            shown = decode_jpeg((await there.rest()).payload)
            await here.rest()
            losses = self.losses()
            with open(self.fault, "w", encoding="ascii"):
                pass
            # Of the two, only this one submits anything.
            await there.call("camera.set", {"eye": [3, 2, 3.1]})
            self.assertFalse((await there.notification("device.changed", 60))["ready"])
            self.assertEqual(self.server.get("/health/ready")[0], 200)
            async with here.moving():
                received = [await here.next_frame() for _ in range(3)]
                await self.recovered(there)
                while not here.frames.empty():
                    received.append(await here.next_frame())
            gaps = [after.received_at - before.received_at
                    for before, after in zip(received, received[1:])]
            self.assertLess(max(gaps), 2 * TIME_FACTOR)
            await there.call("camera.set", {"eye": [3, 2, 3]})
            apart = difference(shown, decode_jpeg((await there.rest()).payload))
            self.assertLess(apart, 4, "few samples, after different motion")
            self.assertFalse([message for message in here.notifications
                              if message["method"] == "device.changed"])
        self.assertEqual(self.losses(), {"0": losses["0"], "1": losses["1"] + 1})
        self.assertEqual(of_devices(self.server, "heliograph_device_ready"), {"0": 1, "1": 1})

    async def recovered(self, viewer):
        for _ in range(1200):
            if any(message["method"] == "device.changed" and message["params"]["ready"]
                   for message in viewer.notifications):
                return
            await asyncio.sleep(0.05)
        self.fail("the device did not recover:\n" + self.server.log_text())


class Options(unittest.TestCase):
    def test_an_unknown_device_of_several_is_named_with_those_that_exist(self):
        ended = subprocess.run(
            [os.environ["HELIOGRAPH_BINARY"], "serve", "--port", "0", "--scene-root",
             os.environ["HELIOGRAPH_SCENES"], "--device", f"{DEVICE},no such device"],
            capture_output=True, text=True, timeout=120)
        self.assertEqual(ended.returncode, 1, ended.stderr)
        told = [line for line in ended.stderr.splitlines() if line.startswith("heliograph: ")]
        self.assertEqual(len(told), 1, ended.stderr)
        self.assertIn('"no such device"', told[0])
        self.assertIn(DEVICE.lower(), told[0].lower())

    def test_devices_marks_all_that_are_meant(self):
        listed = subprocess.run([os.environ["HELIOGRAPH_BINARY"], "devices", "--device", "all"],
                                capture_output=True, text=True, timeout=60, check=True).stdout
        self.assertRegex(listed, r"\n\* ")

    def test_all_is_one_device_where_there_is_one(self):
        with Server("--device", "all", environment={"HELIOGRAPH_DEVICE": "no such device"}
                    ) as server:
            infos = of_devices(server, "heliograph_device_info")
            devices = int(server.call("hello", {"client": "protocol tests", "codecs": ["jpeg"]})
                          ["device"]["index"])
            self.assertEqual(devices, 0)
            self.assertGreaterEqual(len(infos), 1)
