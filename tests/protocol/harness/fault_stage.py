"""What fault_sweep.py lets a server do: sessions that load, render, capture and so on."""

import asyncio
import contextlib
import itertools
import json
import os
import shutil
import time
import urllib.parse

from websockets import ConnectionClosed

from harness.faults import FaultyServer
from harness.viewer import Viewer

ANSWER_TIMEOUT = 30  # seconds
# Seconds. Beside images that move all the time a renderer runs for one in 25 of them, and its first
# start on a machine, without cached shaders, takes several.
JOB_TIMEOUT = 400
BEARER = {"Authorization": "Bearer steering-0123456789"}


class Cut(Exception):
    """The connection ended without an answer."""


class Refused(Exception):
    """The request was answered with an error."""


class Stage:
    """A server with a viewer that watches one session while another session works."""

    def __init__(self, folder):
        self.folder = folder
        self.scenes = os.path.join(folder, "scenes")
        self.uploads = os.path.join(folder, "uploads")
        self.jobs = os.path.join(folder, "jobs")
        self.serial = itertools.count(1)
        if not os.path.exists(self.scenes):
            shutil.copytree(os.environ["HELIOGRAPH_SCENES"], self.scenes)
            for name in ("one", "two"):
                shutil.copy(os.path.join(self.scenes, "mirror.glb"),
                            os.path.join(self.scenes, name + ".glb"))

    async def start(self, faults=""):
        self.server = await asyncio.to_thread(
            FaultyServer, "--scene", "mirror", "--uploads", self.uploads, "--jobs", self.jobs,
            "--max-connections-per-client", "1000", scenes=self.scenes, faults=faults)
        self.server.call("session.create", {"name": "work", "copy_of": "main"})
        self.observer = self.worker = None
        await self.connect()
        await self.worker.rest()

    async def connect(self):
        """Connects what is not connected."""
        if not self.observer:
            self.observer = await Viewer(self.server).__aenter__()
            await self.observer.call("stream.pause")  # no call of its own fails
        if not self.worker:
            self.worker = await Viewer(self.server, session="work").__aenter__()

    async def stop(self):
        for viewer in (self.observer, self.worker):
            if viewer:
                with contextlib.suppress(Exception):
                    await viewer.__aexit__()
        await asyncio.to_thread(self.server.__exit__)

    async def http(self, method, path, body=None):
        try:
            status, _, answer = await asyncio.to_thread(
                self.server.request, method, path, body, BEARER, ANSWER_TIMEOUT)
        except TimeoutError:
            raise
        except OSError as failure:
            raise Cut(str(failure)) from failure
        except Exception as failure:  # of http.client, which has no common class
            raise Cut(repr(failure)) from failure
        if status >= 400:
            raise Refused(f"{status} {answer[:200]!r}")
        return answer

    async def ask(self, method, params=None):
        """Asks for the session that works."""
        try:
            answer = await self.worker.ask(method, params, ANSWER_TIMEOUT)
        except asyncio.CancelledError as failure:
            raise Cut("the socket was closed") from failure
        except Exception as failure:
            if isinstance(failure, asyncio.TimeoutError):
                raise
            raise Cut(repr(failure)) from failure
        if "error" in answer:
            raise Refused(answer["error"]["message"])
        return answer["result"]

    async def frame_of(self, viewer, revision):
        closed = asyncio.create_task(viewer.closed(ANSWER_TIMEOUT))
        frame = asyncio.create_task(
            viewer.frame_where(lambda it: it.header["state_rev"] >= revision, ANSWER_TIMEOUT))
        await asyncio.wait([closed, frame], return_when=asyncio.FIRST_COMPLETED)
        closed.cancel()
        if frame.done():
            return frame.result()
        frame.cancel()
        raise Cut("the socket was closed")

    # What the sessions do, each to its end.

    async def load(self):
        name = ("one", "two")[next(self.serial) % 2]
        os.utime(os.path.join(self.scenes, name + ".glb"))  # so that no cached scene is shown
        await self.ask("scene.load", {"name": name})

    async def environment(self):
        await self.ask("environment.set", {"name": ("sky", "white")[next(self.serial) % 2]})

    async def render(self):
        camera = await self.ask("camera.orbit", {"yaw": 10})
        await self.frame_of(self.worker, camera["rev"])

    async def rebuild(self):
        enabled = next(self.serial) % 2 == 0
        applied = await self.ask("settings.patch", {"patch": {"indirect": {"enabled": enabled}}})
        await self.frame_of(self.worker, applied["rev"])

    async def capture(self):
        await self.ask("frame.capture", {"samples": 1})

    async def capture_values(self):
        await self.ask("frame.capture", {"samples": 1, "format": "exr"})

    async def step(self):
        try:
            await self.ask("frame.step", {"frames": 2, "dt": 0.04})
        finally:
            await self.ask("frame.run")

    async def session(self):
        await self.ask("session.create", {"name": f"s{next(self.serial)}", "copy_of": "main"})
        await self.ask("session.close", {"session": f"s{next(self.serial) - 1}"})

    async def open(self):
        """Another viewer comes, sees a frame and leaves."""
        viewer = Viewer(self.server, session="work", greet=False)
        try:
            await asyncio.wait_for(viewer.__aenter__(), ANSWER_TIMEOUT)
        except asyncio.TimeoutError:
            raise
        except Exception as failure:
            raise Cut(repr(failure)) from failure
        try:
            answer = await viewer.ask("hello", {"client": "fault sweep"}, ANSWER_TIMEOUT)
            if "error" in answer:
                raise Refused(answer["error"]["message"])
            await self.frame_of(viewer, 0)
        except (asyncio.CancelledError, ConnectionClosed) as failure:
            raise Cut("the socket was closed") from failure
        finally:
            with contextlib.suppress(Exception):
                await viewer.__aexit__()

    async def pages(self):
        for path in ("/", "/metrics", "/health/ready", "/api/v1/sessions/main/frame.png?samples=1"):
            await self.http("GET", path)

    async def upload(self):
        name = f"u{next(self.serial)}"
        with open(os.path.join(self.scenes, "mirror.glb"), "rb") as file:
            await self.http("PUT", "/api/v1/scenes/" + name, file.read())
        os.remove(os.path.join(self.uploads, "scenes", name + ".glb"))

    async def job(self):
        entry = {"scene": "mirror", "width": 16, "height": 16, "samples": 1}
        created = json.loads(await self.http("POST", "/api/v1/jobs",
                                             json.dumps({"entries": [entry]})))
        deadline = time.monotonic() + JOB_TIMEOUT
        while True:
            job = json.loads(await self.http("GET", "/api/v1/jobs/" + created["job"]))
            if job["state"] not in ("queued", "running"):
                break
            if time.monotonic() > deadline:
                raise TimeoutError(f"the job is still {job['state']}")
            await asyncio.sleep(0.05)
        if job["state"] != "done":
            raise Refused(f"{job['failures']}")
        for file in job["files"]:
            await self.http("GET", urllib.parse.urlsplit(file["url"]).path)


async def is_connected(viewer):
    """Whether the server answers a ping: the end of a connection reaches the viewer with a delay."""
    try:
        await asyncio.wait_for(await viewer.socket.ping(), ANSWER_TIMEOUT)
    except ConnectionClosed:
        return False
    return True
