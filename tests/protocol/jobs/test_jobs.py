"""Jobs over HTTP and JSON-RPC: the queue, files, quota, webhooks, and a server that is killed."""

import asyncio
import hashlib
import hmac
import http.server
import io
import json
import os
import signal
import tempfile
import threading
import time
import zipfile

from harness.images import decode_png
from harness.server import Server, ServerTestCase
from harness.viewer import Viewer

CONTROL, VIEW, SECRET = "steering-0123456789", "watching-0123456789", "signing-0123456789"
ENDED = ("done", "partial", "failed", "canceled")


def small(**members):
    return {"scene": "mirror", "width": 48, "samples": 1, **members}


def slow():
    """An image that takes minutes."""
    return {"scene": "mirror", "width": 512, "samples": 65536,
            "settings": {"accumulation": {"max_samples": 65536}}}


class Client:
    """Requests about jobs."""

    def __init__(self, server):
        self.server = server

    def request(self, method, path, body=None, token=CONTROL, **headers):
        status, fields, answer = self.server.request(
            method, path, None if body is None else json.dumps(body),
            {"Authorization": "Bearer " + token, **headers})
        return status, fields, answer

    def create(self, *entries, **members):
        headers = members.pop("headers", {})
        status, _, answer = self.request("POST", "/api/v1/jobs", {"entries": entries, **members}, **headers)
        assert status == 202, answer
        return json.loads(answer)

    def status(self, job):
        status, _, answer = self.request("GET", "/api/v1/jobs/" + job["job"])
        assert status == 200, answer
        return json.loads(answer)

    def wait(self, job, *states, timeout=60):
        deadline = time.monotonic() + timeout
        while time.monotonic() < deadline:
            found = self.status(job)
            if found["state"] in (states or ENDED):
                return found
            time.sleep(0.05)
        raise AssertionError(f"the job is still {found}")


class Receiver:
    """A client's own server, which takes webhooks; the first one it refuses."""

    def __init__(self):
        self.received = []
        receiver = self

        class Handler(http.server.BaseHTTPRequestHandler):
            def do_POST(self):  # pylint: disable=invalid-name
                body = self.rfile.read(int(self.headers["Content-Length"]))
                receiver.received.append((body, self.headers["X-Heliograph-Signature"]))
                self.send_response(500 if len(receiver.received) == 1 else 204)
                self.end_headers()

            def log_message(self, *_):  # pylint: disable=arguments-differ
                pass

        self.server = http.server.HTTPServer(("127.0.0.1", 0), Handler)
        self.thread = threading.Thread(target=self.server.serve_forever)
        self.thread.start()

    @property
    def url(self):
        return f"http://127.0.0.1:{self.server.server_port}/done"

    def stop(self):
        self.server.shutdown()
        self.thread.join()
        self.server.server_close()


class Jobs(ServerTestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.arguments = ("--jobs", cls.folder.name, "--webhook-host", "127.0.0.1",
                         "--webhook-secret", SECRET)
        super().setUpClass()
        cls.client = Client(cls.server)

    def reset(self):
        """The sessions stay as they are."""

    def test_a_job_renders_files(self):
        job = self.client.create(small(output="a/{scene}.png"), small(format="jpeg"), name="two")
        self.assertEqual((job["state"], job["entries"], job["name"]), ("queued", 2, "two"))
        done = self.client.wait(job)
        self.assertEqual((done["state"], done["images_done"], done["failures"]), ("done", 2, []))
        self.assertEqual([file["name"] for file in done["files"]], ["0002_mirror.jpg", "a/mirror.png"])
        status, fields, image = self.client.request("GET", done["files"][1]["url"])
        self.assertEqual((status, fields["content-type"]), (200, "image/png"))
        self.assertEqual(len(image), done["files"][1]["bytes"])
        self.assertEqual(decode_png(image).width, 48)
        status, fields, nothing = self.client.request("HEAD", done["files"][1]["url"])
        self.assertEqual((status, fields["content-length"], nothing), (200, str(len(image)), b""))
        self.assertGreater(done["expires"], time.time() + 86400)

    def test_what_cannot_be_rendered_is_refused_or_fails_alone(self):
        for entry, path in (({"scene": "nowhere"}, "scene"), (small(output="../a.png"), "output"),
                            (small(output="/tmp/a.png"), "output"), (small(widht=3), "widht"),
                            (small(environment="nowhere"), "environment")):
            status, _, answer = self.client.request("POST", "/api/v1/jobs", {"entries": [small(), entry]})
            self.assertIn(status, (400, 404))
            self.assertIn(f"entries[1].{path}", answer.decode())
        broken = self.client.wait(self.client.create(small(output="a.png"), small(output="b.png", clip="no")))
        self.assertEqual(broken["state"], "partial")
        self.assertEqual([file["name"] for file in broken["files"]], ["a.png"])
        self.assertEqual([(failure["entry"], failure["scene"]) for failure in broken["failures"]],
                         [(2, "mirror")])
        self.assertIn("no clips", broken["failures"][0]["reason"])
        failed = self.client.wait(self.client.create(small(output="a.bmp")))
        self.assertEqual(failed["state"], "failed")
        self.assertIn("bmp", failed["failures"][0]["reason"])
        self.assertNotIn(self.folder.name, json.dumps(failed))

    def test_only_what_belongs_to_a_job_can_be_read(self):
        done = self.client.wait(self.client.create(small(output="a.png")))
        base = f"/api/v1/jobs/{done['job']}/files/"
        for name in ("b.png", "../manifest.json", "..%2Fmanifest.json", "%2e%2e/%2e%2e/jobs.sqlite", ""):
            self.assertEqual(self.client.request("GET", base + name)[0], 404, name)
        self.assertEqual(self.client.request("GET", "/api/v1/jobs/0123456789abcdef")[0], 404)
        self.assertEqual(self.client.request("PUT", "/api/v1/jobs/" + done["job"])[0], 405)

    def test_parts_of_files_can_be_asked_for(self):
        """As video players and download managers do."""
        done = self.client.wait(self.client.create(small(output="a.png")))
        url = done["files"][0]["url"]
        _, fields, whole = self.client.request("GET", url)
        self.assertEqual(fields["accept-ranges"], "bytes")
        status, part_fields, part = self.client.request("GET", url, Range="bytes=10-19")
        self.assertEqual((status, part, part_fields["content-range"]),
                         (206, whole[10:20], f"bytes 10-19/{len(whole)}"))
        status, _, rest = self.client.request("GET", url, **{"Range": "bytes=10-", "If-Range": fields["etag"]})
        self.assertEqual((status, rest), (206, whole[10:]))
        status, _, again = self.client.request("GET", url, **{"Range": "bytes=10-", "If-Range": '"other"'})
        self.assertEqual((status, again), (200, whole))
        status, beyond, _ = self.client.request("GET", url, Range=f"bytes={len(whole)}-")
        self.assertEqual((status, beyond["content-range"]), (416, f"bytes */{len(whole)}"))
        self.assertEqual(self.client.request("GET", url, **{"If-None-Match": fields["etag"]})[0], 304)
        status, head, _ = self.client.request("HEAD", url, Range="bytes=10-19")
        self.assertEqual((status, head["content-length"]), (200, str(len(whole))))

    def test_all_files_come_as_an_archive(self):
        done = self.client.wait(self.client.create(small(output="ä/a b.png"), small(output="c.jpg"),
                                                   name="Shop: 1/2"))
        url = f"/api/v1/jobs/{done['job']}/results.zip"
        status, fields, archive = self.client.request("GET", url)
        self.assertEqual((status, fields["content-type"]), (200, "application/zip"))
        self.assertEqual(fields["content-disposition"], 'attachment; filename="Shop__1_2.zip"')
        self.assertEqual(fields["content-length"], str(len(archive)))
        with zipfile.ZipFile(io.BytesIO(archive)) as files:
            self.assertIsNone(files.testzip())
            self.assertEqual(sorted(files.namelist()), ["c.jpg", "ä/a b.png"])
            for file in done["files"]:
                self.assertEqual(files.read(file["name"]), self.client.request("GET", file["url"])[2])
            made = time.mktime((*files.infolist()[0].date_time, 0, 0, 0)) - time.timezone
            self.assertLess(abs(made - done["created"]), 3)
        half = len(archive) // 2
        status, _, rest = self.client.request("GET", url, Range=f"bytes={half}-")
        self.assertEqual((status, rest), (206, archive[half:]))
        self.assertEqual(self.client.request("GET", url.replace(done["job"], "nowhere"))[0], 404)
        empty = self.client.wait(self.client.create(small(output="a.png", clip="no")))
        self.assertEqual(self.client.request("GET", f"/api/v1/jobs/{empty['job']}/results.zip")[0], 404)

    def test_a_key_creates_one_job(self):
        first = self.client.create(small(), headers={"Idempotency-Key": "order 7"})
        again = self.client.create(small(), headers={"Idempotency-Key": "order 7"})
        self.assertEqual(first["job"], again["job"])
        status, _, answer = self.client.request("POST", "/api/v1/jobs", {"entries": [small(width=50)]},
                                                **{"Idempotency-Key": "order 7"})
        self.assertEqual(status, 409, answer)
        self.client.wait(first)

    def test_priorities_and_cancellation(self):
        running = self.client.create(slow())
        self.client.wait(running, "running")
        low = self.client.create(small(), priority=-1)
        high = self.client.create(small(), priority=5)
        waiting = self.client.create(small())
        self.assertEqual(self.client.request("DELETE", "/api/v1/jobs/" + waiting["job"])[0], 200)
        self.assertEqual(self.client.status(waiting)["state"], "canceled")
        self.client.request("DELETE", "/api/v1/jobs/" + running["job"])
        self.assertEqual(self.client.wait(running, timeout=15)["state"], "canceled")
        low, high = self.client.wait(low), self.client.wait(high)
        self.assertLess(high["ended"], low["started"])
        status, _, answer = self.client.request("GET", "/api/v1/jobs?state=canceled")
        self.assertEqual(status, 200)
        self.assertEqual({job["state"] for job in json.loads(answer)["jobs"]}, {"canceled"})
        self.assertEqual(self.client.request("GET", "/api/v1/jobs?stat=done")[0], 400)

    async def test_viewers_are_told(self):
        async with Viewer(self.server) as viewer:
            job = await viewer.call("job.create", {"entries": [small()]})
            self.assertEqual(job["state"], "queued")
            self.client.wait(job)
            deadline = time.monotonic() + 10
            while (states := self.states_told(viewer, job))[-1:] != ["done"] and time.monotonic() < deadline:
                await asyncio.sleep(0.02)
            # A newer state replaces one that waits to be sent.
            self.assertIn(states[0], ("queued", "running"))
            self.assertEqual(states[-1], "done")
            listed = await viewer.call("job.list", {"limit": 1})
            self.assertEqual(len(listed["jobs"]), 1)

    def states_told(self, viewer, job):
        return [message["params"]["state"] for message in viewer.notifications
                if message["method"] == "job.changed" and message["params"]["job"] == job["job"]]

    def test_a_webhook_is_signed_and_sent_until_it_is_taken(self):
        receiver = Receiver()
        self.addCleanup(receiver.stop)
        refused = self.client.request("POST", "/api/v1/jobs", {"entries": [small()],
                                                               "webhook": "http://example.org/"})
        self.assertEqual(refused[0], 400)
        job = self.client.wait(self.client.create(small(), webhook=receiver.url))
        self.server.wait_for(lambda: len(receiver.received) == 2, "a second attempt", timeout=30)
        for body, signature in receiver.received:
            expected = hmac.new(SECRET.encode(), body, hashlib.sha256).hexdigest()
            self.assertEqual(signature, "sha256=" + expected)
            self.assertEqual(json.loads(body)["job"], job["job"])


class RenderersBesideViewers(ServerTestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.arguments = ("--jobs", cls.folder.name)
        super().setUpClass()

    def test_a_job_waits_while_an_image_moves(self):
        asyncio.run(self.move_beside_a_job())

    def test_a_job_that_begins_while_an_image_moves_waits_at_once(self):
        asyncio.run(self.begin_beside_movement())

    def test_a_renderer_that_stopped_after_it_was_continued_is_continued_again(self):
        """It stops itself, which may come after the signal that ends a short movement."""
        asyncio.run(self.stop_a_renderer())

    async def stop_a_renderer(self):
        client = Client(self.server)
        job = client.create(slow())
        await asyncio.to_thread(client.wait, job, "running")
        await asyncio.sleep(1)  # so that no image moves
        await self.wait_for_renderer(stopped=False)
        os.kill(next(iter(renderers(self.server.process.pid))), signal.SIGSTOP)
        await asyncio.sleep(1)  # so that it has stopped
        await self.wait_for_renderer(stopped=False)
        client.request("DELETE", "/api/v1/jobs/" + job["job"])
        await asyncio.to_thread(client.wait, job, timeout=10)

    async def begin_beside_movement(self):
        with tempfile.TemporaryDirectory() as folder, \
                Server("--jobs", folder, new_session=True) as server:
            client = Client(server)
            async with Viewer(server) as viewer, viewer.moving():
                await viewer.next_frame()
                job = await asyncio.to_thread(client.create, slow())
                await asyncio.to_thread(client.wait, job, "running")
                await self.wait_for_renderer(stopped=True, server=server)
            await self.wait_for_renderer(stopped=False, server=server)
            client.request("DELETE", "/api/v1/jobs/" + job["job"])
            await asyncio.to_thread(client.wait, job, timeout=10)

    async def move_beside_a_job(self):
        client = Client(self.server)
        job = client.create(slow())
        await asyncio.to_thread(client.wait, job, "running")
        async with Viewer(self.server) as viewer:
            await self.wait_for_renderer(stopped=False)
            async with viewer.moving():
                await self.wait_for_renderer(stopped=True)
            await self.wait_for_renderer(stopped=False)
            async with viewer.moving():
                await self.wait_for_renderer(stopped=True)
                client.request("DELETE", "/api/v1/jobs/" + job["job"])
                ended = await asyncio.to_thread(client.wait, job, timeout=10)
                self.assertEqual(ended["state"], "canceled")

    async def wait_for_renderer(self, stopped, server=None):
        deadline = time.monotonic() + 15
        pid = (server or self.server).process.pid
        while (states := list(renderers(pid).values())) != [stopped]:
            self.assertLess(time.monotonic(), deadline, f"renderers are stopped: {states}")
            await asyncio.sleep(0.05)


def renderers(server):
    """The processes that a server has started, and whether each is stopped."""
    states = {}
    for process in filter(str.isdigit, os.listdir("/proc")):
        try:
            with open(f"/proc/{process}/stat", encoding="ascii") as file:
                state, parent = file.read().rsplit(")", 1)[1].split()[:2]
        except (FileNotFoundError, ProcessLookupError):
            continue
        if int(parent) == server:
            states[int(process)] = state == "T"
    return states


class KilledServer(ServerTestCase):
    """What a kill -9 at any stage leaves of a job."""

    @classmethod
    def setUpClass(cls):
        """Each test has servers of its own."""

    @classmethod
    def tearDownClass(cls):
        """Each test stops them."""

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = folder.name

    def tearDown(self):
        """No server is left."""

    def serve(self, *arguments):
        server = Server("--jobs", self.folder, "--token", CONTROL, *arguments)
        return server, Client(server)

    def test_every_stage(self):
        server, client = self.serve()
        job = client.create(*[small(output=f"{i}.png", width=256, samples=16) for i in range(4)])
        for reached in (lambda job: True, lambda job: job["state"] == "running",
                        lambda job: job["images_done"] >= 1 or job["state"] in ENDED,
                        lambda job: job["images_done"] >= 3 or job["state"] in ENDED):
            server.wait_for(lambda reached=reached: reached(client.status(job)), "the stage", timeout=60, pause=0.01)
            server.process.kill()
            server.process.wait()
            server, client = self.serve()
        done = client.wait(job)
        self.assertEqual((done["state"], [file["name"] for file in done["files"]]),
                         ("done", [f"{i}.png" for i in range(4)]))
        for file in done["files"]:
            self.assertEqual(decode_png(client.request("GET", file["url"])[2]).width, 256)
        server.stop()

    def test_a_server_that_ends_puts_its_job_back(self):
        server, client = self.serve()
        job = client.create(slow())
        client.wait(job, "running")
        server.stop()
        server, client = self.serve()
        self.assertEqual(client.wait(job, "running")["attempts"], 2)
        client.request("DELETE", "/api/v1/jobs/" + job["job"])
        self.assertEqual(client.wait(job)["state"], "canceled")
        server.stop()

    def test_a_read_only_token_reads(self):
        server, client = self.serve("--view-token", VIEW)
        job = client.wait(client.create(small(output="a.png")))
        self.assertEqual(client.request("GET", job["files"][0]["url"], token=VIEW)[0], 200)
        self.assertEqual(client.request("GET", f"/api/v1/jobs/{job['job']}/results.zip", token=VIEW)[0], 200)
        self.assertEqual(client.request("GET", job["files"][0]["url"], token="guessed")[0], 401)
        self.assertEqual(client.request("POST", "/api/v1/jobs", {"entries": [small()]}, token=VIEW)[0], 403)
        self.assertEqual(client.request("DELETE", "/api/v1/jobs/" + job["job"], token=VIEW)[0], 403)
        many = {"entries": [small(output=f"{'x' * 200}{i}.png") for i in range(1000)]}
        self.assertEqual(client.request("POST", "/api/v1/jobs", many, token=VIEW)[0], 413)
        status, _, answer = client.request("POST", "/api/v1/jobs", many)
        self.assertEqual(status, 202)
        client.request("DELETE", "/api/v1/jobs/" + json.loads(answer)["job"])
        server.stop()

    def test_quota_and_expiry(self):
        server, client = self.serve("--job-quota", "1000", "--keep-jobs", "10")
        job = client.wait(client.create(small(), small()))
        self.assertEqual(job["state"], "failed")
        self.assertIn("quota", job["failures"][-1]["reason"])
        self.assertEqual(client.request("POST", "/api/v1/jobs", {"entries": [small()]})[0], 503)
        gone = os.path.join(self.folder, "jobs", job["job"])
        server.wait_for(lambda: not os.path.exists(gone), "the expiry", timeout=50, pause=0.5)
        self.assertEqual(client.request("GET", "/api/v1/jobs/" + job["job"])[0], 404)
        server.stop()
