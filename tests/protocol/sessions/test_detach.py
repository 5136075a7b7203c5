"""A camera of one's own in a shared session, also with a view token."""

from harness.server import ServerTestCase
from harness.viewer import Viewer

CONTROL, VIEW = "steering-0123456789", "watching-0123456789"
FORBIDDEN, NOT_FOUND, CONFLICT = -32001, -32004, -32009


class LookAround(ServerTestCase):
    arguments = ("--token", CONTROL, "--view-token", VIEW)

    def setUp(self):
        self.server.headers = {"Authorization": "Bearer " + CONTROL}
        super().setUp()

    async def test_a_read_only_viewer_moves_its_own_camera_and_nothing_else(self):
        async with Viewer(self.server, token=VIEW) as viewer:
            self.assert_error(await viewer.ask("camera.set", {"eye": [4, 1, 1]}), FORBIDDEN)
            shared = self.server.call("camera.get")
            joined = await viewer.call("session.detach")
            own = joined["session"]
            self.assertEqual(joined["info"]["follows"], "main")
            self.assertEqual((await viewer.call("camera.get"))["eye"], shared["eye"])
            await viewer.call("camera.set", {"eye": [4, 1, 1]})
            self.assertEqual((await viewer.call("camera.get"))["eye"], [4, 1, 1])
            self.assertEqual(self.server.call("camera.get"), shared)
            await viewer.call("stream.configure", {"width": 120, "height": 60})
            self.assertEqual(self.server.call("session.info")["width"], 160)
            for method, params in (("settings.patch", {"patch": {}}), ("scene.unload", {}),
                                   ("session.close", {"session": own})):
                self.assert_error(await viewer.ask(method, params), FORBIDDEN)
            self.assert_error(await viewer.ask("session.detach"), CONFLICT)

            patch = {"exposure": {"compensation": 1.5}}
            self.server.call("settings.patch", {"patch": patch})
            settings = (await viewer.call("settings.get"))["settings"]
            self.assertEqual(settings["exposure"]["compensation"], 1.5)
            self.server.call("settings.patch", {"patch": {"exposure": None}})
            await viewer.rest()
            self.assertIn("settings.changed", {told["method"] for told in viewer.notifications})

            await viewer.call("session.join", {"session": "main"})
            self.assertEqual(await viewer.call("camera.get"), self.server.call("camera.get"))
            names = [one["name"] for one in self.server.call("session.list")["sessions"]]
            self.assertEqual(names, ["main"], "a view without its viewer ends")

    async def test_a_viewer_with_control_changes_the_scene_in_the_session_only(self):
        async with Viewer(self.server, token=CONTROL) as viewer:
            own = (await viewer.call("session.detach"))["session"]
            error = await viewer.ask("settings.patch", {"patch": {}})
            self.assert_error(error, FORBIDDEN, path="session")
            await viewer.call("camera.orbit", {"yaw": 20})
            async with Viewer(self.server, token=CONTROL) as other:
                self.assert_error(await other.ask("session.join", {"session": own}), NOT_FOUND)
        self.assert_error(self.server.ask("camera.get", session=own), NOT_FOUND)
