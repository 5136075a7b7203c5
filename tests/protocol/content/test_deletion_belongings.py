"""What belongs to uploads when they are deleted: small images, memory, jobs that name them."""

import json
import pathlib
import re
import tempfile
import time
import unittest

from harness.server import TIME_FACTOR, Server
from harness.upload_client import UploadClient


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
        client = UploadClient(server)
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
        client = UploadClient(server)

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
        client = UploadClient(server)
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
        client = UploadClient(server)
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
