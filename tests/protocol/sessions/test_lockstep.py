"""Lockstep: time advances frame by frame on request, and the same calls give the same bytes."""

import asyncio
import base64
import hashlib
import json
import os
import shutil
import tempfile
import time

from harness.models import Model
from harness.raw_socket import RawSocket
from harness.server import Server, ServerTestCase
from harness.viewer import Viewer

DT = 0.04


def make_scenes(folder):
    given = os.environ["HELIOGRAPH_SCENES"]
    model = Model(os.path.join(given, "furnace.glb"))
    model.add_light("sun", color=(1.0, 0.9, 0.8))
    ball = model.node("diffuse")
    model.add_clip("hop", ball, [0.0, 1.0, 2.0], [[0, 0.6, 0], [0.5, 1.0, 0], [0, 0.6, 0]])
    model.save(os.path.join(folder, "hopping.glb"))
    for name in ("mirror.glb", "sky.hdr"):
        shutil.copy(os.path.join(given, name), folder)


class Lockstep(ServerTestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        make_scenes(cls.folder.name)
        cls.server = Server("--scene", "hopping", scenes=cls.folder.name)

    def reset(self):
        self.server.call("frame.run")
        super().reset()
        self.server.call("scene.load", {"name": "hopping"})

    def step(self, frames, dt=DT):
        return self.server.call("frame.step", {"frames": frames, "dt": dt})

    def test_step_returns_when_all_frames_are_rendered(self):
        state = self.step(3)
        self.assertEqual((state["lockstep"], state["frames"], state["samples"]), (True, 3, 3))
        self.assertAlmostEqual(state["seconds"], 3 * DT)
        state = self.step(2, 0.5)
        self.assertEqual(state["frames"], 5)
        self.assertAlmostEqual(state["seconds"], 3 * DT + 1.0)

    def test_frames_of_an_earlier_lockstep_are_not_captured(self):
        self.step(2)
        # At once: the render thread does not see the session outside of lockstep.
        calls = [("frame.run", {}), ("frame.step", {"frames": 0, "dt": 0}), ("frame.capture", {})]
        _, answers = self.server.post_rpc([
            {"jsonrpc": "2.0", "id": number, "method": method, "params": params}
            for number, (method, params) in enumerate(calls)])
        self.assert_error({one["id"]: one for one in answers}[2], -32050)

    def test_a_clip_advances_by_steps_only(self):
        self.step(0)
        self.server.call("animation.play", {"clip": "hop", "rate": 2.0})
        self.assertEqual(self.server.call("animation.list")["seconds"], 0)
        time.sleep(0.2)
        self.assertEqual(self.server.call("animation.list")["seconds"], 0)
        self.step(10)
        self.assertAlmostEqual(self.server.call("animation.list")["seconds"], 2 * 10 * DT)
        self.server.call("animation.seek", {"seconds": 0.25})
        self.step(1)
        self.assertAlmostEqual(self.server.call("animation.list")["seconds"], 0.25 + 2 * DT)

    def received(self, viewer, method):
        return [message["params"] for message in viewer.notifications
                if message["method"] == method]

    async def test_clip_changes_are_notified_to_other_viewers(self):
        async with Viewer(self.server) as causer, Viewer(self.server) as other:
            by = causer.hello["viewer"]
            for method, params in (("animation.play", {"clip": "hop"}), ("animation.pause", {}),
                                   ("animation.seek", {"seconds": 0.5}),
                                   ("animation.rate", {"rate": 2.0})):
                other.notifications.clear()
                answer = await causer.call(method, params)
                changed = await other.notification("animation.changed")
                self.assertEqual(changed, {"animation": answer, "by": by}, method)
            other.notifications.clear()
            over_http = await asyncio.to_thread(self.server.call, "animation.play")
            changed = await other.notification("animation.changed")
            self.assertEqual((changed["animation"], changed["by"]), (over_http, ""))
            await causer.notification("animation.changed")
            self.assertEqual([one["by"] for one in self.received(causer, "animation.changed")],
                             [""],
                             "an echo")
            for _ in range(3):
                await other.next_frame()
            self.assertEqual(len(self.received(other, "animation.changed")), 1,
                             "the passing of time is not notified")

    async def test_lockstep_changes_are_notified_but_not_steps(self):
        async with Viewer(self.server) as causer, Viewer(self.server) as other:
            await causer.call("animation.play", {"clip": "hop"})
            await other.notification("animation.changed")
            other.notifications.clear()
            for _ in range(3):
                await causer.call("frame.step", {"frames": 2, "dt": DT})
            began = await other.notification("lockstep.changed")
            self.assertEqual(began["by"], causer.hello["viewer"])
            self.assertEqual((began["state"]["lockstep"], began["state"]["frames"]), (True, 0))
            clip = await other.notification("animation.changed")
            self.assertTrue(clip["animation"]["lockstep"] and clip["animation"]["playing"])
            async with Viewer(self.server) as newcomer:
                self.assertTrue((await newcomer.call("animation.list"))["lockstep"])
            answer = await causer.call("frame.run")
            await causer.call("frame.run")
            await other.call("camera.get")
            began, ended = self.received(other, "lockstep.changed")
            self.assertEqual(ended, {"state": answer, "by": causer.hello["viewer"]})
            clips = [one["animation"]["lockstep"]
                     for one in self.received(other, "animation.changed")]
            self.assertEqual(clips, [True, False])
            self.assertEqual(self.received(causer, "lockstep.changed"), [], "an echo")

    def test_run_continues_from_the_current_time(self):
        self.step(0)
        self.server.call("animation.play", {"clip": "hop"})
        self.step(10)
        self.assertFalse(self.server.call("frame.run")["lockstep"])
        time.sleep(0.3)
        seconds = self.server.call("animation.list")["seconds"]
        self.assertGreater(seconds, 10 * DT + 0.2)
        self.assertFalse(self.server.call("frame.run")["lockstep"], "running twice is no harm")

    def test_nothing_is_rendered_between_steps(self):
        self.step(2)
        first = self.capture("png")
        self.server.call("camera.orbit", {"yaw": 40})
        self.assertEqual(self.capture("png"), first)
        self.step(1)
        self.assertNotEqual(self.capture("png"), first)

    def test_captures_before_the_first_step_are_refused(self):
        self.step(0)
        self.assert_error(self.server.ask("frame.capture"), -32050)
        self.assert_error(self.server.ask("scene.pick", {"x": 0.5, "y": 0.5}), -32050)

    def test_invalid_steps_are_refused(self):
        for params, path in (({"frames": -1, "dt": 0.1}, "frames"), ({"frames": 1}, "dt"),
                             ({"frames": 1, "dt": 11}, "dt"), ({"frames": 1e9, "dt": 0}, "frames")):
            self.assert_error(self.server.ask("frame.step", params), -32602, path=path)

    async def test_viewers_receive_exactly_the_stepped_frames(self):
        async with Viewer(self.server) as viewer:
            await viewer.call("frame.step", {"frames": 0, "dt": DT})
            # Nothing before the step shows this; earlier frames may still be in flight.
            await viewer.call("camera.set", {"seq": 5})
            await viewer.call("frame.step", {"frames": 1, "dt": DT})
            await viewer.frame_where(lambda frame: frame.header["input_seq_echo"] == 5)
            await asyncio.sleep(0.5)
            self.assertTrue(viewer.frames.empty(), "a frame without request")
            await viewer.call("frame.step", {"frames": 3, "dt": DT})
            frame = await asyncio.wait_for(viewer.frames.get(), 5)
            self.assertEqual(frame.header["full_width"], 160)

    def begin(self):
        self.server.call("frame.run")
        self.server.call("camera.set", {"name": "main"})
        self.server.call("frame.step", {"frames": 0, "dt": DT})
        self.server.call("animation.play", {"clip": "hop", "rate": 1.0})
        self.server.call("animation.seek", {"seconds": 0})

    async def test_calls_run_in_order_of_arrival(self):
        point = {"x": 0.5, "y": 0.5, "buffers": ["gbuffer.motion"]}
        calls = [("frame.step", {"frames": 20, "dt": DT}), ("frame.capture", {}),
                 ("frame.inspect", point), ("camera.orbit", {"yaw": 30}),
                 ("animation.play", {"rate": 2.0}), ("frame.step", {"frames": 20, "dt": DT}),
                 ("frame.capture", {}), ("frame.step", {"frames": 3, "dt": 2 * DT}),
                 ("frame.inspect", point), ("frame.capture", {})]
        self.server.call("settings.patch", {"patch": {"accumulation": {"max_samples": 64}}})
        async with Viewer(self.server) as viewer:
            await asyncio.to_thread(self.begin)
            awaited = [await viewer.call(*call) for call in calls]
            await asyncio.to_thread(self.begin)
            sent = [asyncio.create_task(viewer.call(*call)) for call in calls]
            at_once = [await answer for answer in sent]
        await asyncio.to_thread(self.begin)
        batch = [{"jsonrpc": "2.0", "id": number, "method": method, "params": params}
                 for number, (method, params) in enumerate(calls)]
        _, answers = await asyncio.to_thread(self.server.post_rpc, batch)
        for others in (at_once, [answer["result"] for answer in answers]):
            for call, one, other in zip(calls, awaited, others):
                one, other = ({**answer, "rev": 0} for answer in (one, other))
                self.assertEqual(one, other, call)
        self.assertEqual(len({awaited[i]["data"] for i in (1, 6, 9)}), 3)

    async def test_steps_of_a_disconnected_viewer_are_dropped(self):
        async with Viewer(self.server) as viewer:
            await viewer.notify("frame.step", {"frames": 100000, "dt": DT})
            await viewer.frame_where(lambda frame: frame.header["render_id"] > 3)
        state = await asyncio.to_thread(self.step, 1)
        self.assertLess(state["frames"], 10000)
        # The time of frames that were not drawn has not passed.
        self.assertAlmostEqual(state["seconds"], state["frames"] * DT)

    def test_steps_of_a_caller_over_http_that_has_gone_are_dropped(self):
        call = json.dumps({"jsonrpc": "2.0", "id": 1, "method": "frame.step",
                           "params": {"frames": 100000, "dt": DT}}).encode()
        with RawSocket(self.server) as raw:
            raw.send(b"POST /rpc HTTP/1.1\r\nHost: 127.0.0.1\r\nContent-Length: %d\r\n\r\n%s"
                     % (len(call), call))
            time.sleep(1)
        begin = time.monotonic()
        state = self.step(1)
        self.assertLess(time.monotonic() - begin, 5)
        self.assertGreater(state["frames"], 1)
        self.assertLess(state["frames"], 10000)
        self.assertAlmostEqual(state["seconds"], state["frames"] * DT)

    async def test_leaving_lockstep_fails_pending_steps(self):
        async with Viewer(self.server) as viewer:
            stepping = asyncio.create_task(
                viewer.ask("frame.step", {"frames": 100000, "dt": 0.001}))
            await asyncio.sleep(0.5)
            await viewer.call("frame.run")
            self.assert_error(await stepping, -32009)

    def capture(self, kind, buffer="output", server=None):
        result = (server or self.server).call("frame.capture", {"format": kind, "buffer": buffer})
        return base64.b64decode(result["data"])

    def film(self, server):
        """What a server makes of a fixed list of calls: everything on, camera and clip moving."""
        server.call("settings.preset", {"name": "best"})
        server.call("settings.patch", {"patch": {
            "sampling": {"seed": 7}, "exposure": {"mode": "automatic"},
            "accumulation": {"max_samples": 64}}})
        server.call("camera.set", {"name": "main"})
        server.call("frame.step", {"frames": 0, "dt": DT})
        server.call("animation.play", {"clip": "hop", "rate": 1.0})
        marks = []
        for _ in range(4):
            server.call("camera.orbit", {"yaw": 3})
            server.call("frame.step", {"frames": 2, "dt": DT})
            marks += [hashlib.sha256(self.capture(kind, server=server)).hexdigest()
                      for kind in ("png", "exr", "npy")]
        for buffer in ("gbuffer.motion", "specular.denoised", "visibility.denoised"):
            marks.append(hashlib.sha256(self.capture("npy", buffer, server)).hexdigest())
        server.call("animation.pause")
        server.call("frame.step", {"frames": 4, "dt": DT})
        marks.append(hashlib.sha256(self.capture("exr", server=server)).hexdigest())
        return marks

    def test_two_servers_render_the_same_bytes(self):
        # This one has a past, and the clip stands anywhere when lockstep begins.
        self.server.call("animation.play", {"clip": "hop", "rate": 3.7})
        self.server.call("frame.capture", {"samples": 1})
        first = self.film(self.server)
        self.assertEqual(len(set(first)), len(first), "some frames are equal")
        self.server.call("frame.run")
        again = self.film(self.server)
        self.assertEqual(again, first)
        with Server("--scene", "hopping", scenes=self.folder.name) as other:
            other.call("stream.configure", {"width": 160, "height": 90})
            self.assertEqual(self.film(other), first)


class Reference(ServerTestCase):
    def test_it_accumulates_samples_without_viewers(self):
        before = self.server.call("settings.get")["settings"]
        self.assertFalse(self.server.call("reference.status")["shown"])
        state = self.server.call("reference.start", {"scope": "full", "samples": 12})
        self.assertEqual((state["shown"], state["scope"], state["target_samples"]),
                         (True, "full", 12))
        self.server.wait_for(lambda: self.server.call("reference.status")["finished"],
                             "the end of the reference")
        self.assertEqual(self.server.call("reference.status")["samples"], 12)
        self.server.call("camera.orbit", {"yaw": 5})
        self.server.wait_for(lambda: self.server.call("reference.status")["finished"],
                             "the end of the reference from elsewhere")
        state = self.server.call("reference.stop")
        self.assertEqual((state["shown"], state["samples"], state["finished"]), (False, 0, False))
        after = self.server.call("settings.get")["settings"]
        self.assertEqual(after["accumulation"], before["accumulation"])
        self.assertEqual(after["reference"], before["reference"])

    def test_stop_restores_the_settings_changed_by_start(self):
        def settings(session="main"):
            return self.server.call("settings.get", session=session)["settings"]
        self.server.call("settings.patch", {"patch": {"accumulation": {"enabled": False}}})
        before = settings()
        self.server.call("reference.start", {"scope": "full", "samples": 9})
        self.server.call("session.create", {"name": "copy", "copy_of": "main"})
        self.server.call("reference.stop", session="copy")
        self.assertEqual(settings("copy"), before)
        self.server.call("session.close", {"session": "copy"})
        self.server.call("settings.patch", {"patch": {"reference": {"use": "off"},
                                                      "accumulation": {"max_samples": 32}}})
        between = settings()
        self.server.call("reference.start", {"samples": 2})
        self.server.call("reference.stop")
        self.assertEqual(settings()["accumulation"], between["accumulation"])

    def test_settings_can_end_the_reference(self):
        with Server("--release-after", "1") as server:
            server.call("reference.start", {"samples": 2})
            server.wait_for(lambda: server.call("reference.status")["finished"], "the end")
            self.assertNotIn("images released", server.log_text())
            server.call("settings.patch", {"patch": {"reference": {"use": "off"}}})
            server.wait_for(lambda: "images released" in server.log_text(), "the release")

    def test_invalid_parameters_are_refused(self):
        self.assert_error(self.server.ask("reference.start", {"scope": "none"}), -32602,
                          path="scope")
        self.assert_error(self.server.ask("reference.start", {"samples": 0}), -32602,
                          path="samples")
