"""Sessions: create, join, shared and exclusive control, limits, close."""

import asyncio
import time
import unittest

from harness.images import decode_jpeg, difference
from harness.memory import assert_less_memory
from harness.server import TIME_FACTOR, ServerTestCase
from harness.viewer import FLAG_DISCONTINUITY, Viewer

FORBIDDEN, NOT_FOUND, CONFLICT, FULL = -32001, -32004, -32009, -32029


class Sessions(ServerTestCase):
    arguments = ("--max-sessions", "4", "--max-viewers", "3",
                 "--max-pixels", str(160 * 90 * 4))

    def setUp(self):
        super().setUp()
        for session in self.server.call("session.list")["sessions"]:
            if session["name"] != "main":
                self.server.call("session.close", {"session": session["name"]})

    def create(self, name, **more):
        return self.server.call("session.create", {"name": name, "width": 160, "height": 90, **more})

    async def test_sessions_have_their_own_state_over_shared_scenes(self):
        info = self.create("own", copy_of="main", settings={"exposure": {"compensation": 2}})
        self.assertEqual((info["name"], info["scene"], info["viewers"]), ("own", "mirror", []))
        async with Viewer(self.server) as here, Viewer(self.server, session="own") as there:
            self.assertEqual(there.hello["session"], "own")
            await there.call("camera.set", {"eye": [4, 1, 1]})
            self.assertNotEqual((await here.call("camera.get"))["eye"], [4, 1, 1])
            self.assertEqual((await there.call("camera.get"))["eye"], [4, 1, 1])
            settings = (await here.call("settings.get"))["settings"]
            self.assertEqual(settings["exposure"]["compensation"], 0)
            await there.rest()
            await here.rest()
            heard = {message["method"] for message in here.notifications}
            self.assertNotIn("camera.changed", heard)

    async def test_bookmarks_belong_to_the_session_and_its_scene(self):
        self.create("one", copy_of="main")
        image = "data:image/jpeg;base64,/9j/"
        async with Viewer(self.server, session="one") as here, \
                Viewer(self.server, session="one") as there:
            await here.call("camera.set", {"eye": [4, 1, 1]})
            first = await here.call("bookmarks.add", {"thumbnail": image})
            self.assertEqual((first["scene"], first["bookmarks"][0]["name"]), ("mirror", "View 1"))
            self.assertEqual(first["bookmarks"][0]["eye"], [4, 1, 1])
            await here.call("bookmarks.add", {"name": "front", "eye": [0, 1, 5]})
            await here.call("bookmarks.rename", {"name": "View 1", "to": "side"})
            both = (await there.call("bookmarks.list"))["bookmarks"]
            self.assertEqual([bookmark["name"] for bookmark in both], ["side", "front"])
            self.assertEqual(both[0]["thumbnail"], image)
            self.assertNotIn("thumbnail", both[1])
            told = [message["params"] for message in there.notifications
                    if message["method"] == "bookmarks.changed"]
            self.assertEqual(told[-1]["list"]["bookmarks"], both)
            self.assertEqual(told[-1]["by"], here.hello["viewer"])
        self.create("copy", copy_of="one")
        listed = lambda session: self.server.call("bookmarks.list", session=session)["bookmarks"]
        self.assertEqual(listed("copy"), both)
        self.assertEqual(listed("main"), [])
        self.server.call("bookmarks.remove", {"name": "side"}, session="copy")
        self.assertEqual((len(listed("copy")), len(listed("one"))), (1, 2))
        self.server.call("scene.load", {"name": "furnace"}, session="copy")
        self.assertEqual(listed("copy"), [])
        self.server.call("scene.load", {"name": "mirror"}, session="copy")
        self.assertEqual(listed("copy"), both[1:], "bookmarks stay with their scene")

    def test_mistakes_in_bookmarks_name_the_member(self):
        self.create("one", copy_of="main")

        def refused(method, parameters, code, **expected):
            answer = self.server.ask("bookmarks." + method, parameters, session="one")
            self.assert_error(answer, code, **expected)
        self.server.call("bookmarks.add", {"name": "a"}, session="one")
        self.server.call("bookmarks.add", {"name": "b"}, session="one")
        refused("add", {"name": "a"}, CONFLICT, path="name")
        refused("add", {"name": ""}, -32602, path="name")
        refused("add", {"thumbnail": "javascript:0"}, -32602, path="thumbnail")
        refused("add", {"thumbnail": "data:image/png;base64," + 16384 * "A"}, -32602,
                path="thumbnail", limit="16384")
        refused("add", {"eye": [0, 0, 1], "target": [0, 0, 1]}, -32602, path="target")
        refused("rename", {"name": "c", "to": "d"}, NOT_FOUND, path="name")
        refused("rename", {"name": "a", "to": "b"}, CONFLICT, path="to")
        refused("remove", {"name": "c"}, NOT_FOUND, path="name")
        for number in range(62):
            self.server.call("bookmarks.add", {}, session="one")
        refused("add", {}, FULL, limit="64")

    def test_calls_without_a_stream_address_their_session(self):
        self.create("other", scene="furnace")
        self.assertEqual(self.server.call("scene.info", session="other")["name"], "furnace")
        self.assertEqual(self.server.call("scene.info")["name"], "mirror")
        capture = self.server.call("frame.capture", {"samples": 1}, session="other")
        self.assertEqual((capture["width"], capture["height"]), (160, 90))
        for path in ("/api/v1/sessions/other/frame.jpg", "/api/v1/sessions/main/frame.jpg"):
            self.assertEqual(self.server.get(path)[0], 200, path)
        self.assert_error(self.server.ask("camera.get", session="othr"), NOT_FOUND, path="session")
        self.assertEqual(self.server.get("/api/v1/sessions/othr/frame.jpg")[0], 404)

    async def test_the_url_addresses_one_session_and_enters_another(self):
        async with Viewer(self.server, session="for-a-balancer&enter=main") as viewer:
            self.assertEqual(viewer.hello["session"], "main")
            self.assertIsNone(viewer.hello["restore_state"])
        self.assertEqual(self.server.call("session.info", session="elsewhere&enter=main")["name"],
                         "main")
        self.assert_error(self.server.ask("session.info", session="main&enter=elsewhere"),
                          NOT_FOUND)

    async def test_reconnect_to_another_run_gets_an_unused_session(self):
        self.server.call("camera.fit")  # main is in use now
        lost = {"instance": "0123456789abcdef", "session": "main"}
        async with Viewer(self.server, greet=False) as first, \
                Viewer(self.server, greet=False) as second:
            hello = await first.call("hello", lost)
            self.assertEqual((hello["session"], hello["restore_state"]), ("main-01234567", True))
            hello = await second.call("hello", lost)
            self.assertEqual((hello["session"], hello["restore_state"]), ("main-01234567", False))
            self.assertEqual(self.server.call("session.info")["viewers"], [])
        async with Viewer(self.server) as viewer:
            same = {"instance": viewer.hello["instance"], "session": "main"}
            hello = await viewer.call("hello", same)
            self.assertEqual((hello["session"], hello["restore_state"]), ("main", None))

    def test_names_and_copied_sessions_are_checked(self):
        self.create("taken")
        self.assert_error(self.server.ask("session.create", {"name": "taken"}), CONFLICT,
                          path="name")
        self.assert_error(self.server.ask("session.create", {"name": "a/b"}), -32602, path="name")
        self.assert_error(self.server.ask("session.create", {"copy_of": "missing"}), NOT_FOUND,
                          path="copy_of")
        before = len(self.server.call("session.list")["sessions"])
        self.assert_error(self.server.ask("session.create", {"scene": "nothing", "width": 16,
                                                             "height": 16}),
                          NOT_FOUND, path="scene")
        self.assert_error(
            self.server.ask("session.create", {"settings": {"shadows": {"enabled": "no"}},
                                               "width": 16, "height": 16}),
            -32602, path="shadows.enabled")
        self.assert_error(self.server.ask("session.create", {"settings": [], "width": 16,
                                                             "height": 16}),
                          -32602, path="settings")
        self.assertEqual(len(self.server.call("session.list")["sessions"]), before,
                         "a session that could not be made is there")

    def test_session_and_viewer_limits_return_full(self):
        for name in ("a", "b"):
            self.create(name)
        self.assert_error(self.server.ask("session.create", {"width": 320, "height": 180}), FULL,
                          limit="pixels")
        self.create("c")
        self.assert_error(self.server.ask("session.create", {"width": 16, "height": 16}), FULL,
                          limit="4 sessions")
        self.assert_error(self.server.ask("stream.configure", {"width": 320}, session="a"), FULL,
                          limit="pixels")
        limits = self.server.call("session.list")["limits"]
        self.assertEqual((limits["sessions"], limits["pixels_used"]), (4, 160 * 90 * 4))
        self.server.call("session.close", {"session": "c"})
        self.create("d")

    async def test_a_viewer_that_joins_another_session_gets_its_frames(self):
        self.create("away", copy_of="main")
        self.server.call("camera.set", {"eye": [4, 1, 1]}, session="away")
        async with Viewer(self.server) as viewer, Viewer(self.server, session="away") as other:
            first = await viewer.next_frame()
            await viewer.rest()
            joined = await viewer.call("session.join", {"session": "away"})
            self.assertEqual((joined["session"], joined["viewer"]),
                             ("away", viewer.hello["viewer"]))
            fresh = await viewer.next_frame()
            self.assertTrue(fresh.header["flags"] & FLAG_DISCONTINUITY)
            self.assertGreater(fresh.header["frame_seq"], first.header["frame_seq"])
            self.assertEqual((await viewer.call("camera.get"))["eye"], [4, 1, 1])
            people = (await other.call("session.info"))["viewers"]
            self.assertEqual([person["you"] for person in people], [True, False])
            self.assert_error(await viewer.ask("session.join", {"session": "awy"}), NOT_FOUND,
                              path="session")
        self.assert_error(self.server.ask("session.join", {"session": "away"}), -32050)

    async def test_a_reconnected_viewer_finds_the_session_unchanged(self):
        self.create("kept", copy_of="main", settings={"exposure": {"compensation": 1}})
        viewer = Viewer(self.server, session="kept")
        await viewer.__aenter__()
        instance = viewer.hello["instance"]
        await viewer.call("camera.set", {"eye": [4, 1, 1]})
        before = await viewer.rest()
        viewer.socket.transport.abort()
        async with Viewer(self.server, session="kept") as again:
            self.assertEqual((again.hello["session"], again.hello["instance"]), ("kept", instance))
            self.assertEqual((await again.call("camera.get"))["eye"], [4, 1, 1])
            settings = (await again.call("settings.get"))["settings"]
            self.assertEqual(settings["exposure"]["compensation"], 1)
            after = await again.rest()
        self.assertEqual(after.header["state_rev"], before.header["state_rev"])
        self.assertEqual(after.payload, before.payload)

    async def test_joining_and_leaving_is_notified(self):
        self.create("room", copy_of="main")
        async with Viewer(self.server, session="room", name="Ada") as first:
            async with Viewer(self.server, session="room") as second:
                await self.until_viewers(first, [("Ada", True), (None, False)])
                await self.until_viewers(second, [("Ada", False), (None, True)])
            await self.until_viewers(first, [("Ada", True)])

    async def until_viewers(self, viewer, expected):
        for _ in range(100):
            received = [message["params"] for message in viewer.notifications
                        if message["method"] == "session.changed"]
            viewers = received[-1]["viewers"] if received else []
            if [(one["name"], one["you"]) for one in viewers] == expected:
                return
            await asyncio.sleep(0.05)
        self.fail(f"{expected} was never received, but {received[-1:]}")

    async def test_a_changed_frame_size_is_notified(self):
        self.create("sized", copy_of="main")
        async with Viewer(self.server, session="sized") as one, \
                Viewer(self.server, session="sized") as other:
            rev = (await other.call("session.info"))["rev"]
            await other.call("camera.get")
            other.notifications.clear()
            await one.call("stream.configure", {"width": 128, "height": 72})
            received = await other.notification("session.changed")
            self.assertEqual((received["width"], received["height"]), (128, 72))
            self.assertGreater(received["rev"], rev)
            other.notifications.clear()
            await one.call("stream.configure", {"width": 128, "height": 72, "quality": 50})
            await other.call("camera.get")
            self.assertEqual(other.notifications, [], "nothing changed for all")

    async def test_exclusive_control(self):
        self.create("led", copy_of="main")
        async with Viewer(self.server, session="led") as leader, \
                Viewer(self.server, session="led") as other:
            ids = leader.hello["viewer"], other.hello["viewer"]
            info = await leader.call("session.control", {"mode": "exclusive"})
            self.assertEqual([(one["viewer"], one["control"]) for one in info["viewers"]],
                             [(ids[0], True), (ids[1], False)])
            for method, params in (("camera.set", {"eye": [4, 4, 4]}), ("camera.fit", {}),
                                   ("settings.patch", {"patch": {"shadows": {"enabled": False}}}),
                                   ("scene.load", {"name": "furnace"}),
                                   ("stream.configure", {"width": 80}),
                                   ("session.control", {"mode": "shared"}),
                                   ("session.control", {"action": "take"}),
                                   ("session.close", {"session": "led"})):
                answer = await other.ask(method, params)
                self.assert_error(answer, FORBIDDEN, path="control")
            for method in ("camera.get", "settings.get", "session.info", "frame.buffers"):
                await other.call(method)
            await other.call("stream.configure", {"quality": 40})
            self.assertTrue((await other.call("stream.pause"))["paused"])
            self.assertFalse((await other.call("stream.resume"))["paused"])
            answer = await other.ask("stream.configure", {"quality": 90, "width": 80})
            self.assert_error(answer, FORBIDDEN, path="control")
            self.assertEqual((await other.call("stream.configure", {}))["quality"], 40,
                             "a refused call changes nothing")
            self.assert_error(self.server.ask("camera.fit", session="led"), FORBIDDEN)
            await leader.call("camera.set", {"eye": [4, 4, 4]})

            await leader.call("session.control", {"action": "give", "viewer": ids[1]})
            await other.call("camera.fit")
            self.assert_error(await leader.ask("camera.fit"), FORBIDDEN)
            await other.call("session.control", {"action": "release"})
            free = await other.ask("camera.fit")
            self.assert_error(free, FORBIDDEN, path="control", limit="take")
            self.assertIn("no viewer has control", free["error"]["message"])
            await leader.call("session.control", {"action": "take"})
            taken = await other.ask("camera.fit")
            self.assertIn("another viewer has control", taken["error"]["message"])
            await leader.call("camera.fit")
            await leader.call("session.control", {"mode": "shared"})
            await other.call("camera.fit")

    async def test_control_is_released_when_its_viewer_leaves(self):
        self.create("left", copy_of="main")
        async with Viewer(self.server, session="left") as stays:
            async with Viewer(self.server, session="left") as leaves:
                await leaves.call("session.control", {"mode": "exclusive"})
                self.assert_error(await stays.ask("session.control", {"action": "take"}), FORBIDDEN)
            await self.until_viewers(stays, [(None, True)])
            await stays.call("session.control", {"action": "take"})
            await stays.call("camera.fit")

    async def test_closing_a_session_is_notified_with_the_reason(self):
        self.create("ends", copy_of="main")
        async with Viewer(self.server, session="ends") as viewer, Viewer(self.server) as outsider:
            self.assert_error(await outsider.ask("session.close", {"session": "ends"}), FORBIDDEN)
            self.server.call("session.close", {"session": "ends"})
            code, reason = await viewer.closed()
            self.assertEqual((code, reason), (4003, "the session was closed"))
            received = await viewer.notification("session.closed")
            self.assertEqual(received, {"session": "ends", "reason": "the session was closed"})
            await outsider.call("camera.get")
        self.assert_error(self.server.ask("camera.get", session="ends"), NOT_FOUND)
        self.assert_error(self.server.ask("session.close", {"session": "main"}), CONFLICT)

    async def test_viewers_per_session_are_limited(self):
        self.create("small", copy_of="main")
        viewers = [Viewer(self.server, session="small") for _ in range(3)]
        for viewer in viewers:
            await viewer.__aenter__()
        async with Viewer(self.server) as late:
            self.assert_error(await late.ask("session.join", {"session": "small"}), FULL,
                              limit="3 viewers")
            self.assertEqual((await late.call("session.info"))["name"], "main")
        for viewer in viewers:
            await viewer.__aexit__()


class IdleSessions(ServerTestCase):
    arguments = ("--session-idle-timeout", "3")

    def test_a_session_with_a_short_idle_timeout_is_closed_sooner(self):
        names = lambda: {one["name"] for one in self.server.call("session.list")["sessions"]}
        self.server.call("session.create", {"name": "long", "idle_timeout": 600})
        self.server.call("session.create", {"name": "short", "idle_timeout": 1})
        self.server.wait_for(lambda: "short" not in names(), "the end of short", timeout=2)
        self.assertIn("long", names())
        self.server.wait_for(lambda: "long" not in names(), "the end of long", timeout=5)

    async def test_an_idle_session_is_closed(self):
        for name in ("watched", "called", "idle", "stepped"):
            self.server.call("session.create", {"name": name, "copy_of": "main"})
        self.server.call("frame.step", {"frames": 1, "dt": 0.04}, session="stepped")
        async with Viewer(self.server, session="watched"):
            for _ in range(10):
                await asyncio.sleep(0.4)
                self.server.call("camera.orbit", {"yaw": 5}, session="called")
            names = {one["name"] for one in self.server.call("session.list")["sessions"]}
            self.assertEqual(names, {"main", "watched", "called"})
        self.server.wait_for(lambda: len(self.server.call("session.list")["sessions"]) == 1,
                             "the end of idle sessions", timeout=6)
        self.assertRegex(self.server.log_text(), "the session ended: .* session=watched")


class FairDeviceShare(ServerTestCase):
    def watch(self, name):
        return Viewer(self.server, session=name)

    @unittest.skipIf(TIME_FACTOR > 1, "the heavy session draws no frame in time under a sanitizer")
    async def test_an_expensive_session_gets_only_its_share(self):
        """The light one, whose frames take a few milliseconds, gets several between two of the
        heavy one's, and the heavy one still about half of the time."""
        endless = {"accumulation": {"max_samples": 60000}}
        for name, (width, height) in {"light": (32, 18), "heavy": (1920, 1080)}.items():
            self.server.call("session.create", {"name": name, "copy_of": "main", "width": width,
                                                "height": height, "settings": endless})
        alone = {}
        for name in ("light", "heavy"):
            async with self.watch(name) as viewer:
                await self.keep_moving(name, viewer, 1.0)
                alone[name] = await self.keep_moving(name, viewer, 2.0)
        async with self.watch("light") as light, self.watch("heavy") as heavy:
            # How much more the light one gets depends on how soon its viewer, on the same
            # processors, answers.
            for _ in range(4):
                rates = await asyncio.gather(self.keep_moving("light", light, 3.0),
                                             self.keep_moving("heavy", heavy, 3.0))
                beside = dict(zip(("light", "heavy"), rates))
                print(f"frames a second: light {alone['light']:.1f} alone, {beside['light']:.1f} "
                      f"beside heavy; heavy {alone['heavy']:.1f} alone, {beside['heavy']:.1f} ",
                      end="")
                if beside["light"] > 2.5 * beside["heavy"] > alone["heavy"]:
                    break
        for name in ("light", "heavy"):
            self.server.call("session.close", {"session": name})
        self.assertGreater(beside["light"], 2 * beside["heavy"])
        self.assertGreater(beside["heavy"], 0.3 * alone["heavy"])

    async def keep_moving(self, name, viewer, seconds):
        """Frames a second while the camera moves all the time."""
        begin, before, step = time.monotonic(), viewer.frames_received, 0
        while time.monotonic() < begin + seconds:
            step += 1
            await viewer.notify("camera.set", {"eye": [4 + 0.01 * (step % 50), 2, 3]})
            await asyncio.sleep(0.015)
        return (viewer.frames_received - before) / (time.monotonic() - begin)


class ManySessions(ServerTestCase):
    arguments = ("--max-sessions", "300", "--release-after", "1", "--session-idle-timeout", "0")

    async def test_idle_sessions_use_almost_no_cpu(self):
        self.server.call("frame.capture", {"samples": 1})
        self.server.call("session.create", {"name": "warm", "copy_of": "main"})
        before = self.server.memory_bytes()
        for number in range(200):
            self.server.call("session.create", {"name": f"idle-{number}", "copy_of": "main"})
        grown = self.server.memory_bytes() - before
        cpu = self.server.cpu_seconds()
        await asyncio.sleep(2)
        used = self.server.cpu_seconds() - cpu
        print(f"200 idle sessions: {grown / 1e6:+.1f} MB, {used / 2:.1%} of a processor ", end="")
        self.assertLess(used, 0.1)
        assert_less_memory(self, grown, 100e6)

    async def test_images_of_unwatched_sessions_are_released_and_recreated(self):
        self.server.call("session.create", {"name": "seen", "copy_of": "main", "width": 640,
                                            "height": 360})
        async with Viewer(self.server, session="seen") as viewer:
            first = await viewer.rest()
        self.server.wait_for(lambda: "images released session=seen" in self.server.log_text(),
                             "the release", timeout=10)
        async with Viewer(self.server, session="seen") as viewer:
            again = await viewer.rest()
        self.assertGreater(again.header["render_id"], first.header["render_id"])
        apart = difference(decode_jpeg(first.payload), decode_jpeg(again.payload))
        self.assertLess(apart, 2, "not the same frame")
