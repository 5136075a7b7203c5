"""Uploads that are deleted: what goes, what stays, and what uses them meanwhile."""

import asyncio
import base64
import os
import pathlib
import shutil
import tempfile
import time

from harness.images import decode_png, difference
from harness.server import TIME_FACTOR, ServerTestCase
from harness.upload_client import CONTROL, KINDS, RED, SKY, VIEW, UploadClient, mirror, one_node
from harness.viewer import Viewer


class Deletion(ServerTestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.quota = 2 * len(mirror()) + 2000
        cls.arguments = ("--scene", "mirror", "--uploads", cls.folder.name, "--token", CONTROL,
                         "--view-token", VIEW, "--upload-quota", str(cls.quota))
        super().setUpClass()
        cls.server.headers = {"Authorization": "Bearer " + CONTROL}
        cls.client = UploadClient(cls.server)

    def setUp(self):
        super().setUp()
        for kind in KINDS:
            for name in self.files(kind):
                os.unlink(os.path.join(self.folder.name, kind, name))

    def files(self, kind):
        return sorted(os.listdir(os.path.join(self.folder.name, kind)))

    def put(self, kind, name):
        status, answer = self.client.put(kind, name)
        self.assertEqual(status, 201, answer)

    def delete(self, kind, name):
        self.assertEqual(self.client.delete(kind, name), (204, ""))

    def test_a_deleted_upload_is_gone_from_the_list_and_the_disk(self):
        for kind in KINDS:
            before = self.client.entries(kind)
            self.put(kind, "mine")
            self.assertIn("mine", self.client.entries(kind))
            self.delete(kind, "mine")
            self.assertEqual(self.client.entries(kind), before)
            self.assertEqual(self.files(kind), [])
            self.assertEqual(self.client.delete(kind, "mine")[0], 404, "it is gone already")
            self.put(kind, "mine")
            self.delete(kind, "mine")

    def test_lists_tell_what_was_uploaded(self):
        for kind, given in (("scenes", "mirror"), ("environments", "studio"), ("images", None)):
            self.put(kind, "mine")
            listed = self.client.entries(kind)
            self.assertIs(listed["mine"]["uploaded"], True)
            if given:
                self.assertIs(listed[given]["uploaded"], False)

    def test_files_in_other_places_of_the_folder_are_not_uploads(self):
        def place(path, data):
            file = pathlib.Path(self.folder.name, path)
            file.parent.mkdir(exist_ok=True)
            file.write_bytes(data)
            return file
        sky = place("scenes/placed.hdr", SKY)
        self.addCleanup(sky.unlink)
        bricks = place("images/more/bricks.png", RED)
        self.addCleanup(shutil.rmtree, bricks.parent)
        self.assertIs(self.client.entries("environments")["placed"]["uploaded"], False)
        self.assertEqual(self.client.delete("environments", "placed")[0], 409)
        self.assertTrue(sky.exists())
        self.assertIs(self.client.entries("images")["more/bricks"]["uploaded"], False)
        self.assertEqual(self.client.delete("images", "more/bricks")[0], 400)
        self.assertEqual(self.client.delete("images", "bricks")[0], 404)
        self.assertTrue(bricks.exists())

    def test_files_of_scene_roots_are_not_deleted(self):
        roots = os.environ["HELIOGRAPH_SCENES"]
        for kind, name in (("scenes", "mirror"), ("scenes", "furnace"), ("environments", "studio")):
            status, answer = self.client.delete(kind, name)
            self.assertEqual((status, answer.strip()),
                             (409, "It was not uploaded: only uploads can be deleted."), name)
            self.assertIn(name, self.client.entries(kind))
        self.assertTrue(os.path.exists(os.path.join(roots, "mirror.glb")))

    def test_an_upload_that_a_file_of_a_scene_root_hides_is_deleted(self):
        """As after a restart with another root; its bytes count for the quota."""
        with open(os.path.join(self.folder.name, "scenes", "mirror.glb"), "wb") as file:
            file.write(mirror())
        self.assertFalse(self.client.entries("scenes")["mirror"]["uploaded"])
        self.delete("scenes", "mirror")
        self.assertEqual(self.files("scenes"), [])
        self.assertIn("mirror", self.client.entries("scenes"))
        self.assertEqual(self.client.delete("scenes", "mirror")[0], 409)

    def test_names_are_those_of_uploads(self):
        outside = os.path.join(self.folder.name, "outside.glb")
        with open(outside, "wb") as file:
            file.write(mirror())
        self.addCleanup(os.unlink, outside)
        self.put("scenes", "mine")
        for kind in KINDS:
            for name in ("..", "../outside", "..%2foutside", "%2e%2e%2foutside", "a/b", ".hidden",
                         "mine.glb", "%6dine", "x" * 65, "-rf"):
                status, answer = self.client.delete(kind, name)
                self.assertEqual(status, self.client.put(kind, name)[0], (kind, name))
                self.assertIn(status, (400, 404), (kind, name))
                self.assertNotIn(self.folder.name, answer)
        self.assertEqual(self.files("scenes"), ["mine.glb"])
        self.assertTrue(os.path.exists(outside))

    def test_only_who_may_upload_may_delete(self):
        for kind in KINDS:
            self.put(kind, "mine")
            self.assertEqual(self.client.delete(kind, "mine", VIEW),
                             (403, "This token is read-only and cannot delete uploads.\n"))
            self.assertEqual(self.client.delete(kind, "no", VIEW)[0], 403, "nor learn of names")
            self.assertEqual(self.client.delete(kind, "mine", "wrong-token-1")[0], 401)
            status, _ = self.client.delete(kind, "mine", Origin="http://evil.example")
            self.assertEqual(status, 403)
            self.assertIn("mine", self.client.entries(kind))

    def test_bytes_of_deleted_files_count_no_longer(self):
        for name in ("one", "two"):
            self.put("scenes", name)
        self.assertEqual(self.client.put("scenes", "three")[0], 503)
        self.delete("scenes", "one")
        self.put("scenes", "three")

    async def test_a_session_goes_on_with_a_deleted_scene(self):
        self.put("scenes", "mine")
        self.server.call("scene.load", {"name": "mine"})
        async with Viewer(self.server, token=CONTROL) as viewer:
            await viewer.rest()
            self.delete("scenes", "mine")
            await viewer.call("camera.set", {"eye": [1.0, 3.0, 5.0], "target": [0.0, 0.5, 0.0]})
            await viewer.rest()
            self.assertEqual((await viewer.call("scene.info"))["name"], "mine")
            listed = await viewer.call("scene.list")
            self.assertEqual(listed["current"], "mine")
            self.assertNotIn("mine", [scene["name"] for scene in listed["scenes"]])
            await viewer.call("frame.capture", {"samples": 1})
            created = await viewer.call("session.create", {"copy_of": "main"})
            self.assertEqual(created["scene"], "mine", "a copy needs no file")
            await viewer.call("session.close", {"session": created["name"]})
            # What needs the file again says that it is gone, and the scene stays.
            self.assert_error(await viewer.ask("scene.load", {"name": "mine"}), -32004, path="name")
            material = (await viewer.call("materials.list"))["materials"][0]["name"]
            answer = await viewer.ask("textures.set", {
                "material": material, "slot": "base_color", "removed": True})
            self.assert_error(answer, -32004, path="scene")
            self.assertIn("the file of mine is gone", answer["error"]["message"])
            status, _, answer = self.server.get("/api/v1/sessions/main/scene.glb")
            self.assertEqual(status, 409, answer)
            self.assertEqual((await viewer.call("scene.info"))["name"], "mine")

    def test_a_deleted_environment_stays_where_it_is_shown(self):
        self.put("environments", "mine")
        self.server.call("environment.set", {"name": "mine"})
        self.addCleanup(self.server.call, "environment.set", {"name": None})
        before = self.image()
        self.assertEqual(self.server.get("/api/v1/environments/mine/thumbnail.png")[0], 200)
        self.delete("environments", "mine")
        listed = self.server.call("environment.list")
        self.assertEqual(listed["current"], "mine")
        self.assertNotIn("mine", self.client.entries("environments"))
        self.assertEqual(self.server.get("/api/v1/environments/mine/thumbnail.png")[0], 404)
        self.server.call("scene.load", {"name": "furnace"})
        self.server.call("scene.load", {"name": "mirror"})
        self.server.call("camera.fit")
        self.assertEqual(self.server.call("environment.list")["current"], "mine")
        after = self.image()
        answer = self.server.ask("environment.set", {"name": "mine"})
        self.assert_error(answer, -32004, path="name")
        self.server.call("environment.set", {"name": "studio"})
        self.assertLess(difference(after, before), 0.3 * difference(self.image(), before))

    def image(self):
        return decode_png(base64.b64decode(self.server.call("frame.capture")["data"]))

    def test_a_deleted_image_stays_where_it_is_shown(self):
        self.put("images", "mine")
        material = self.server.call("materials.list")["materials"][0]["name"]
        slot = {"material": material, "slot": "base_color"}
        self.server.call("textures.set", {**slot, "image": "mine"})
        self.delete("images", "mine")
        shown = [texture for texture in self.server.call("textures.list")["textures"]
                 if texture.get("image") == "mine"]
        self.assertEqual([one["material"] for one in shown], [material])
        answer = self.server.ask("textures.set", {**slot, "image": "mine"})
        self.assert_error(answer, -32004, path="image")
        document = self.server.call("edits.get")["edits"]
        self.server.call("materials.patch", {"material": material, "patch": {"roughness": 0.25}})
        applied = self.server.call("edits.apply", {"edits": document})
        self.assertEqual(applied["edits"], document, "what is shown needs no file")
        self.assertEqual(self.server.call("edits.get")["edits"]["textures"],
                         [{**slot, "image": "mine"}])
        other = {**slot, "slot": "normal", "image": None}
        for number, textures in enumerate(([*document["textures"], other],
                                           [other, *document["textures"]])):
            edits = {**document, "textures": textures, "hidden": [0]}
            answer = self.server.ask("edits.apply", {"edits": edits})
            self.assert_error(answer, -32004, path=f"edits.textures[{number}].image")
            self.assertIn('"mine"', answer["error"]["message"])
            self.assertEqual(self.server.call("edits.get")["edits"], document, "nothing changes")
        answer = self.server.ask("scene.load", {"name": "mirror", "edits": document})
        self.assert_error(answer, -32004, path="edits.textures[0].image")
        self.server.call("textures.set", {**slot, "image": None})

    def test_textures_of_a_scene_whose_file_is_another_now_are_refused(self):
        self.put("scenes", "mine")
        self.server.call("scene.load", {"name": "mine"})
        nodes = self.server.call("nodes.list")["nodes"]
        self.server.call("selection.set", {"nodes": [node["id"] for node in nodes]})
        slot = {"material": self.server.call("materials.list")["materials"][0]["name"],
                "slot": "base_color", "removed": True}
        self.delete("scenes", "mine")
        self.assertEqual(self.client.request("PUT", "scenes", "mine", one_node(slot["material"]),
                                             CONTROL)[0], 201)
        answer = self.server.ask("textures.set", slot)
        self.assert_error(answer, -32009, path="scene")
        self.assertEqual(len(self.server.call("nodes.list")["nodes"]), len(nodes))
        self.server.call("scene.load", {"name": "mirror"})

    async def test_viewers_of_all_sessions_are_told(self):
        self.server.call("session.create", {"name": "other"})
        self.addCleanup(self.server.call, "session.close", {"session": "other"})
        async with Viewer(self.server, token=CONTROL) as main, \
                Viewer(self.server, session="other", token=VIEW) as other:
            for kind in KINDS:
                self.put(kind, "mine")
                self.delete(kind, "mine")
                for viewer in (main, other):
                    await self.wait_to_be_told(viewer, kind[:-1], deleted=True)
            # A deletion may replace the upload before it; what was refused is not told.
            self.client.delete("scenes", "mine")
            self.client.delete("scenes", "mirror")
            await main.call("session.info")
            self.assertEqual([change["kind"] for change in self.told(main) if change["deleted"]],
                             ["scene", "environment", "image"])
            self.put("scenes", "mine")
            await self.wait_to_be_told(other, "scene", deleted=False)

    async def wait_to_be_told(self, viewer, kind, deleted):
        deadline = time.monotonic() + 15 * TIME_FACTOR
        while self.told(viewer)[-1:] != [{"kind": kind, "name": "mine", "deleted": deleted}]:
            self.assertLess(time.monotonic(), deadline, self.told(viewer))
            await asyncio.sleep(0.02)

    def told(self, viewer):
        return [message["params"] for message in viewer.notifications
                if message["method"] == "uploads.changed"]


class NoUploads(ServerTestCase):
    def setUp(self):
        pass

    def test_have_nothing_to_delete(self):
        for kind in KINDS:
            self.assertEqual(UploadClient(self.server).delete(kind, "mirror")[0], 405)
        self.assertTrue(os.path.exists(os.path.join(os.environ["HELIOGRAPH_SCENES"], "mirror.glb")))
