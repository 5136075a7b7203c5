"""Pointers of other viewers, and cameras that follow another viewer's."""

import asyncio

from harness.server import ServerTestCase
from harness.viewer import Viewer

CONTROL, VIEW = "steering-0123456789", "watching-0123456789"
INVALID, NOT_FOUND, CONFLICT, NOT_READY = -32602, -32004, -32009, -32050


def heard(viewer, method):
    return [told["params"] for told in viewer.notifications if told["method"] == method]


async def eventually(condition, timeout=15):
    for _ in range(timeout * 50):
        if result := condition():
            return result
        await asyncio.sleep(0.02)
    raise AssertionError("it did not happen")


class Pointers(ServerTestCase):
    arguments = ("--token", CONTROL, "--view-token", VIEW)

    def setUp(self):
        self.server.headers = {"Authorization": "Bearer " + CONTROL}
        super().setUp()

    async def test_others_see_what_a_viewer_points_at_also_one_with_a_view_token(self):
        async with Viewer(self.server, token=VIEW, name="Ada") as pointing, \
                Viewer(self.server, token=CONTROL) as other:
            await pointing.call("pointer.set", {"position": [1, 2, 3]})
            ada = pointing.hello["viewer"]
            self.assertEqual(await other.notification("pointer.changed"),
                             {"viewer": ada, "name": "Ada", "position": [1, 2, 3]})
            await pointing.notify("pointer.set", {})
            gone = await eventually(lambda: heard(other, "pointer.changed")[1:])
            self.assertEqual(gone, [{"viewer": ada, "name": "Ada", "position": None}])
            self.assertEqual(heard(pointing, "pointer.changed"), [])

    async def test_a_pointer_ends_with_its_viewer(self):
        async with Viewer(self.server, token=CONTROL) as other:
            async with Viewer(self.server, token=VIEW) as pointing:
                await pointing.call("pointer.set", {"position": [1, 2, 3]})
            last = await eventually(lambda: heard(other, "pointer.changed")[1:])
            self.assertIsNone(last[0]["position"])

    async def test_viewers_with_cameras_of_their_own_point_at_the_same_scene(self):
        self.server.call("session.create", {"name": "apart", "width": 64, "height": 36})
        self.addCleanup(self.server.ask, "session.close", {"session": "apart"})
        async with Viewer(self.server, token=CONTROL) as shared, \
                Viewer(self.server, token=VIEW) as first, \
                Viewer(self.server, token=VIEW) as second, \
                Viewer(self.server, token=CONTROL, session="apart") as apart:
            for viewer in (first, second):
                await viewer.call("session.detach")
            for viewer, others in ((first, (shared, second)), (shared, (first, second))):
                for other in others:
                    other.notifications.clear()
                await viewer.call("pointer.set", {"position": [0, 1, 0]})
                for other in others:
                    told = await other.notification("pointer.changed")
                    self.assertEqual(told["viewer"], viewer.hello["viewer"])
            self.assertEqual(heard(apart, "pointer.changed"), [])

    async def test_mistakes_name_the_member(self):
        async with Viewer(self.server, token=VIEW) as viewer, \
                Viewer(self.server, token=VIEW) as other:
            for position in ([0, 0, 1.1e9], [-1.1e9, 0, 0], [0, 0], [0, 0, 0, 0], "here",
                             ["x", 0, 0]):
                answer = await viewer.ask("pointer.set", {"position": position})
                self.assert_error(answer, INVALID)
                self.assertTrue(answer["error"]["data"]["path"].startswith("position"), answer)
            await viewer.call("session.info")
            self.assertEqual(heard(other, "pointer.changed"), [])
        self.assert_error(self.server.ask("pointer.set", {"position": [0, 0, 0]}), NOT_READY)

    async def test_the_newest_of_many_positions_arrives(self):
        async with Viewer(self.server, token=VIEW) as viewer, \
                Viewer(self.server, token=VIEW) as other:
            for step in range(500):
                await viewer.notify("pointer.set", {"position": [step, 0, 0]})
            await eventually(lambda: heard(other, "pointer.changed")[-1:] and
                             heard(other, "pointer.changed")[-1]["position"] == [499, 0, 0])
            seen = [told["position"][0] for told in heard(other, "pointer.changed")]
            self.assertEqual(seen, sorted(seen), "none comes after a newer one")


class Follow(ServerTestCase):
    arguments = ("--token", CONTROL, "--view-token", VIEW)

    def setUp(self):
        self.server.headers = {"Authorization": "Bearer " + CONTROL}
        super().setUp()

    async def eye_at(self, viewer, eye):
        for _ in range(500):
            if (await viewer.call("camera.get"))["eye"] == eye:
                return
            await asyncio.sleep(0.02)
        self.fail(f"the camera did not come to {eye}")

    async def test_a_viewer_has_the_camera_of_another_until_it_moves_its_own(self):
        async with Viewer(self.server, token=VIEW) as ada, \
                Viewer(self.server, token=VIEW) as bob:
            for viewer in (ada, bob):
                await viewer.call("session.detach")
            await ada.call("camera.set", {"eye": [4, 1, 1]})
            await bob.call("viewer.follow", {"viewer": ada.hello["viewer"]})
            self.assertEqual((await bob.call("camera.get"))["eye"], [4, 1, 1])
            await ada.call("camera.set", {"eye": [4, 2, 1]})
            self.assertEqual((await bob.call("camera.get"))["eye"], [4, 2, 1])
            told = heard(bob, "camera.changed")[-1]
            self.assertEqual((told["by"], told["camera"]["eye"]), (ada.hello["viewer"], [4, 2, 1]))
            await bob.call("camera.set", {"eye": [1, 4, 1]})
            await ada.call("camera.set", {"eye": [4, 3, 1]})
            self.assertEqual((await bob.call("camera.get"))["eye"], [1, 4, 1])
            await bob.call("viewer.follow", {"viewer": ada.hello["viewer"]})
            await bob.call("viewer.follow", {})
            await ada.call("camera.set", {"eye": [4, 4, 1]})
            self.assertEqual((await bob.call("camera.get"))["eye"], [4, 3, 1])

    async def test_the_follower_is_told_when_the_other_leaves(self):
        async with Viewer(self.server, token=VIEW) as bob:
            await bob.call("session.detach")
            async with Viewer(self.server, token=VIEW) as ada:
                await ada.call("session.detach")
                await bob.call("viewer.follow", {"viewer": ada.hello["viewer"]})
                await ada.call("camera.set", {"eye": [4, 1, 1]})
            told = await bob.notification("viewer.unfollowed")
            self.assertEqual(told, {"viewer": ada.hello["viewer"]})
            self.assertEqual((await bob.call("camera.get"))["eye"], [4, 1, 1])
            await bob.call("camera.set", {"eye": [1, 4, 1]})

    async def test_frames_show_the_camera_that_is_followed(self):
        async with Viewer(self.server, token=VIEW) as ada, \
                Viewer(self.server, token=VIEW) as bob:
            for viewer in (ada, bob):
                await viewer.call("session.detach")
            await bob.call("viewer.follow", {"viewer": ada.hello["viewer"]})
            await bob.rest()
            await ada.call("camera.set", {"eye": [4, 1, 1]})
            rev = (await bob.call("camera.get"))["rev"]
            await bob.frame_where(lambda frame: frame.header["state_rev"] >= rev)

    async def test_what_cannot_be_followed(self):
        async with Viewer(self.server, token=CONTROL) as shared, \
                Viewer(self.server, token=VIEW) as ada, Viewer(self.server, token=VIEW) as bob:
            for viewer in (ada, bob):
                await viewer.call("session.detach")
            first, second = ada.hello["viewer"], bob.hello["viewer"]
            self.assert_error(await shared.ask("viewer.follow", {"viewer": first}), CONFLICT,
                              path="session")
            for unknown in (first, "v999"):
                self.assert_error(await ada.ask("viewer.follow", {"viewer": unknown}), NOT_FOUND,
                                  path="viewer")
            self.assert_error(await ada.ask("viewer.follow", {"viewer": ""}), INVALID,
                              path="viewer")
            await ada.call("viewer.follow", {"viewer": second})
            self.assert_error(await bob.ask("viewer.follow", {"viewer": first}), CONFLICT,
                              path="viewer")
            await bob.call("viewer.follow", {"viewer": shared.hello["viewer"]})
            await shared.call("camera.set", {"eye": [4, 1, 1]})
            for viewer in (ada, bob):
                await self.eye_at(viewer, [4, 1, 1])
        self.assert_error(self.server.ask("viewer.follow", {"viewer": "v1"}), NOT_READY)
