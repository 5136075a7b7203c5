"""Uploads that are deleted: what goes, what stays, and what uses them meanwhile."""

import asyncio
import base64
import json
import os
import pathlib
import re
import tempfile
import time
import unittest

from harness.images import decode_png, difference, encode_png
from harness.server import TIME_FACTOR, Server, ServerTestCase
from harness.viewer import Viewer

CONTROL, VIEW = "steering-0123456789", "watching-0123456789"
KINDS = ("scenes", "environments", "images")
SKY = b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 4 +X 8\n" + bytes([80, 120, 200, 128]) * 32
RED = encode_png((255, 0, 0))


def mirror():
    with open(os.path.join(os.environ["HELIOGRAPH_SCENES"], "mirror.glb"), "rb") as file:
        return file.read()


class Client:
    """Sends and deletes files."""

    def __init__(self, server):
        self.server = server

    def put(self, kind, name, token=CONTROL):
        body = {"scenes": mirror(), "environments": SKY, "images": RED}[kind]
        return self.request("PUT", kind, name, body, token)

    def delete(self, kind, name, token=CONTROL, **headers):
        return self.request("DELETE", kind, name, None, token, **headers)

    def request(self, method, kind, name, body, token, **headers):
        status, _, answer = self.server.request(
            method, f"/api/v1/{kind}/{name}", body, {"Authorization": "Bearer " + token, **headers})
        return status, answer.decode()

    def entries(self, kind):
        """What is listed of a kind, by name."""
        method = {"scenes": "scene.list", "environments": "environment.list",
                  "images": "images.list"}[kind]
        return {entry["name"]: entry for entry in self.server.call(method)[kind]}


class Deletion(ServerTestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.quota = 2 * len(mirror()) + 2000
        cls.arguments = ("--scene", "mirror", "--uploads", cls.folder.name, "--token", CONTROL,
                         "--view-token", VIEW, "--upload-quota", str(cls.quota))
        super().setUpClass()
        cls.server.headers = {"Authorization": "Bearer " + CONTROL}
        cls.client = Client(cls.server)

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
        for kind, given in (("scenes", "mirror"), ("environments", "studio")):
            self.put(kind, "mine")
            listed = self.client.entries(kind)
            self.assertTrue(listed["mine"]["uploaded"])
            self.assertFalse(listed[given]["uploaded"])

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
        answer = self.server.ask("scene.load", {"name": "mirror", "edits": document})
        self.assert_error(answer, -32004, path="edits.textures[0].image")
        self.server.call("textures.set", {**slot, "image": None})

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


class Belongings(unittest.TestCase):
    """What the server has made of an upload, and jobs that name it."""

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def start(self, *arguments):
        server = Server("--scene", "mirror", "--uploads", str(self.folder / "uploads"), *arguments,
                        environment={"XDG_CACHE_HOME": str(self.folder / "cache")})
        self.addCleanup(server.stop)
        return server

    def wait(self, condition, what, timeout=60):
        deadline = time.monotonic() + timeout * TIME_FACTOR
        while not condition():
            self.assertLess(time.monotonic(), deadline, what)
            time.sleep(0.1)

    def test_the_small_image_of_a_scene_goes_with_it(self):
        server = self.start()
        client = Client(server)
        self.assertEqual(client.put("scenes", "mine")[0], 201)
        address = "/api/v1/scenes/mine/thumbnail.jpg"
        self.wait(lambda: server.get(address)[0] == 200, "the thumbnail did not come")
        images = (self.folder / "cache").rglob
        self.assertEqual(len(list(images("*.jpg"))), 1)
        self.assertEqual(client.delete("scenes", "mine")[0], 204)
        self.assertEqual(server.get(address)[0], 404)
        self.assertEqual(list(images("*.jpg")), [])

    def test_memory_of_a_deleted_scene_is_freed_when_no_session_shows_it(self):
        server = self.start()
        client = Client(server)

        def in_memory():
            text = server.get("/metrics")[2].decode()
            return int(re.search(r"^heliograph_scene_cache_entries (\d+)", text, re.MULTILINE)[1])
        self.assertEqual(client.put("scenes", "mine")[0], 201)
        server.call("scene.load", {"name": "mine"})
        self.assertEqual(in_memory(), 2)
        self.assertEqual(client.delete("scenes", "mine")[0], 204)
        self.assertEqual(in_memory(), 2, "it is shown")
        server.call("scene.load", {"name": "mirror"})
        self.wait(lambda: in_memory() == 1, "a scene that no session shows stays")
        self.assertEqual(client.put("scenes", "mine")[0], 201)
        for name in ("mine", "mirror"):
            server.call("scene.load", {"name": name})
        self.assertEqual(in_memory(), 2, "kept for the next load")
        self.assertEqual(client.delete("scenes", "mine")[0], 204)
        self.wait(lambda: in_memory() == 1, "a scene that no session shows stays")

    def test_a_job_finds_uploads_until_they_are_deleted(self):
        server = self.start("--jobs", str(self.folder / "jobs"))
        client = Client(server)
        for kind in ("scenes", "environments"):
            self.assertEqual(client.put(kind, "mine")[0], 201)
        entry = {"scene": "mine", "environment": "mine", "width": 48, "samples": 1}
        job = server.call("job.create", {"entries": [entry]})["job"]

        def state():
            return server.call("job.status", {"job": job})["state"]
        self.wait(lambda: state() not in ("queued", "running"), "the job does not end")
        self.assertEqual(state(), "done")
        self.assertEqual(client.delete("environments", "mine")[0], 204)
        answer = server.ask("job.create", {"entries": [entry]})
        self.assertEqual(answer["error"]["data"]["path"], "entries[0].environment")

    def test_an_entry_of_a_job_whose_scene_was_deleted_fails_alone(self):
        server = self.start("--jobs", str(self.folder / "jobs"))
        client = Client(server)
        self.assertEqual(client.put("scenes", "mine")[0], 201)
        slow = server.call("job.create", {"entries": [
            {"scene": "mirror", "width": 512, "samples": 65536,
             "settings": {"accumulation": {"max_samples": 65536}}}]})
        waiting = server.call("job.create", {"entries": [
            {"scene": name, "width": 48, "samples": 1, "output": name + ".png"}
            for name in ("mine", "mirror")]})
        self.assertEqual(client.delete("scenes", "mine")[0], 204)
        answer = server.ask("job.create", {"entries": [{"scene": "mine"}]})
        self.assertEqual(answer["error"]["data"]["path"], "entries[0].scene")
        server.call("job.cancel", {"job": slow["job"]})

        def status():
            return server.call("job.status", {"job": waiting["job"]})
        self.wait(lambda: status()["state"] not in ("queued", "running"), "the job does not end")
        ended = status()
        self.assertEqual(ended["state"], "partial")
        self.assertEqual([file["name"] for file in ended["files"]], ["mirror.png"])
        self.assertEqual([(failure["entry"], failure["scene"], failure["reason"])
                          for failure in ended["failures"]],
                         [(1, "mine", "the file does not exist")])
        self.assertNotIn(str(self.folder), json.dumps(ended))


class NoUploads(ServerTestCase):
    def setUp(self):
        pass

    def test_have_nothing_to_delete(self):
        for kind in KINDS:
            self.assertEqual(Client(self.server).delete(kind, "mirror")[0], 405)
        self.assertTrue(os.path.exists(os.path.join(os.environ["HELIOGRAPH_SCENES"], "mirror.glb")))
