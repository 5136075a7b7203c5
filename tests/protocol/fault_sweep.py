"""Lets calls of the server fail, the first, the second, and so on, while it works:
fault_sweep.py --points 400

After each fault the server still runs, or has ended with one line that says why; another session's
frames go on; and the same request works. Exits with 1 otherwise."""

import argparse
import asyncio
import contextlib
import errno
import itertools
import json
import os
import shutil
import sys
import tempfile
import time
import urllib.parse

from websockets import ConnectionClosed

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))

from harness.faults import (DEVICE_LOST, ALL_CALLS, OUT_OF_DEVICE_MEMORY,  # noqa: E402
                            FaultyServer)
from harness.viewer import Viewer  # noqa: E402

ANSWER_TIMEOUT = 30  # seconds
JOB_TIMEOUT = 120  # seconds: a process of the lowest priority
END_DELAY = 0.1  # seconds from the end of a process's connections to its own
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


class Sweep:
    """Counts what was injected, and collects what went wrong."""

    def __init__(self, stage, points, report):
        self.stage = stage
        self.points = points
        self.report = report
        self.injected = {}  # by kind
        self.outcomes = {}  # of the requests whose calls failed
        self.wrong = []

    def note(self, kind, outcome, count=1):
        self.injected[kind] = self.injected.get(kind, 0) + count
        self.outcomes[outcome] = self.outcomes.get(outcome, 0) + 1

    async def attempt(self, action):
        try:
            await getattr(self.stage, action)()
            return "done"
        except Refused as refusal:
            return f"refused: {refusal}"
        except Cut as cut:
            return f"cut: {cut}"
        except (TimeoutError, asyncio.TimeoutError) as late:
            return f"no answer: {late}"

    async def count(self, function, action, **rule):
        """How many calls the action makes."""
        await self.renew_viewers(f"before {action}")
        self.stage.server.faults.arm(function, 0, **rule)
        outcome = await self.attempt(action)
        calls, _ = self.stage.server.faults.disarm(function)
        if outcome != "done":
            self.wrong.append(f"{action} without a fault: {outcome}")
        return calls

    async def sweep(self, function, error, action, *, points=None, must_work=False, restart=False,
                    **rule):
        """The n-th call fails, for n from 1 to what the action makes. `must_work`: the caller goes
        on as if nothing were wrong, as after EINTR; `restart`: with a new server each time."""
        counted = {name: value for name, value in rule.items() if name == "only"}
        calls = await self.count(function, action, **counted)
        name = f"{action}: {function}" + (f" on {rule['only']}" if rule.get("only") else "")
        numbers = spread(calls, points or self.points)
        for number in numbers:
            await self.inject(function, number, error, action, name, must_work, **rule)
            if restart and self.stage.server.alive:
                await self.stage.stop()
                await self.stage.start()
        self.report(f"{name} {describe(error, rule)}: {len(numbers)} of {calls} calls")

    async def inject(self, function, number, error, action, name, must_work, **rule):
        what = f"{name} {number} {describe(error, rule)}"
        server = self.stage.server
        server.faults.arm(function, number, error, **rule)
        try:
            outcome = await self.attempt(action)
        except Exception as failure:  # whatever it is: told with the rest
            outcome = f"failed: {failure!r}"
        _, injected = server.faults.disarm(function)
        if injected == 0:
            return
        self.note(f"{function} {describe(error, rule)}", outcome.split(":")[0], injected)
        if outcome.startswith(("no answer", "failed")) or (must_work and outcome != "done"):
            self.wrong.append(f"{what}: {outcome}\n{tail(server)}")
        if outcome.startswith("cut"):
            await asyncio.sleep(END_DELAY)
        await self.check_rest(what, action)

    async def check_rest(self, what, action):
        """The other session's frames go on, and the same request works."""
        stage = self.stage
        try:
            if await self.has_ended(what):
                return
            await self.renew_viewers(what)
            await stage.observer.call("stream.resume")
            camera = await asyncio.wait_for(stage.observer.call("camera.orbit", {"yaw": 5}),
                                            ANSWER_TIMEOUT)
            await stage.frame_of(stage.observer, camera["rev"])
            await stage.observer.call("stream.pause")
            deadline = time.monotonic() + ANSWER_TIMEOUT
            while (outcome := await self.attempt(action)) != "done":
                if time.monotonic() > deadline:
                    raise AssertionError(f"the next request: {outcome}")
                await asyncio.sleep(0.1)
                await stage.connect()
        except (Exception, asyncio.CancelledError) as failure:
            await asyncio.sleep(END_DELAY)
            if await self.has_ended(what):
                return
            self.wrong.append(f"after {what}: {failure!r}\n{tail(stage.server)}")
            await stage.stop()
            await stage.start()

    async def has_ended(self, what):
        """Whether the server has ended, which it may with one line; starts another."""
        stage = self.stage
        if stage.server.alive:
            return False
        code, fault = stage.server.process.wait(), end_fault(stage.server)
        if fault:
            self.wrong.append(f"{what}: {fault} (code {code})\n{tail(stage.server)}")
        else:
            self.outcomes["ended"] = self.outcomes.get("ended", 0) + 1
            self.report(f"{what}: the server ended\n{tail(stage.server)}")
        await stage.stop()
        await stage.start()
        return True

    async def renew_viewers(self, what):
        """The worker's own socket may have been lost; the observer's may not."""
        stage = self.stage
        if not await is_connected(stage.observer):
            self.wrong.append(f"{what}: the other session's viewer was disconnected\n"
                              f"{tail(stage.server)}")
            stage.observer = None
        if not await is_connected(stage.worker):
            stage.worker = None
        await stage.connect()


async def is_connected(viewer):
    """Whether the server answers a ping: the end of a connection reaches the viewer with a delay."""
    try:
        await asyncio.wait_for(await viewer.socket.ping(), ANSWER_TIMEOUT)
    except ConnectionClosed:
        return False
    return True


def end_fault(server):
    """What is wrong with how the server has ended; nothing: with one line that says why."""
    code = server.process.wait()
    lines = [line for line in server.log_text().splitlines() if line.startswith("heliograph: ")]
    if code != 1:
        return "was ended by a signal" if code < 0 else "ended without a fault"
    return "" if len(lines) == 1 else f"ended with {len(lines)} lines"


def spread(calls, points):
    """At most so many numbers of calls: the first ones, then some of the others up to the last."""
    if calls <= points:
        return list(range(1, calls + 1))
    dense = points // 2
    rest = points - dense
    return sorted({*range(1, dense + 1),
                   *(dense + (calls - dense) * i // rest for i in range(1, rest + 1))})


def describe(error, rule):
    if error > 0:
        return errno.errorcode[error]
    if error < 0:
        return {DEVICE_LOST: "device lost", OUT_OF_DEVICE_MEMORY: "out of device memory"}[error]
    return f"short {rule['amount']}"


def tail(server):
    return "    " + "\n    ".join(server.log_text().splitlines()[-6:])


WORK = ("load", "environment", "render", "rebuild", "capture", "capture_values", "step", "session",
        "open", "pages", "upload")


async def sweep_memory(sweep):
    for action in WORK:
        await sweep.sweep("operator_new", errno.ENOMEM, action)
        await sweep.sweep("malloc", errno.ENOMEM, action)


async def sweep_files(sweep):
    scene, incoming = {"only": ".glb"}, {"only": "incoming"}
    for error in (errno.EMFILE, errno.EIO):
        await sweep.sweep("open", error, "load", **scene)
    await sweep.sweep("pread", errno.EIO, "load", **scene)
    await sweep.sweep("pread", errno.EINTR, "load", must_work=True, **scene)
    await sweep.sweep("pread", 0, "load", amount=1000, times=ALL_CALLS, points=1, must_work=True,
                      **scene)
    await sweep.sweep("read", errno.EIO, "environment", only=".hdr")
    await sweep.sweep("mkdir", errno.ENOSPC, "upload", **incoming)
    for error in (errno.EMFILE, errno.ENOSPC):
        await sweep.sweep("open", error, "upload", **incoming)
    for error in (errno.ENOSPC, errno.EIO):
        await sweep.sweep("write", error, "upload", **incoming)
    await sweep.sweep("write", errno.EINTR, "upload", must_work=True, **incoming)
    await sweep.sweep("write", 0, "upload", amount=1000, times=ALL_CALLS, points=1, must_work=True,
                      **incoming)
    await sweep.sweep("rename", errno.EIO, "upload")


async def sweep_sockets(sweep):
    for action in ("pages", "open"):
        await sweep.sweep("accept", errno.EMFILE, action, must_work=True)
        await sweep.sweep("recvmsg", errno.EINTR, action, must_work=True)
        await sweep.sweep("recvmsg", errno.ECONNRESET, action)
        await sweep.sweep("sendmsg", errno.EPIPE, action)
        await sweep.sweep("sendmsg", errno.ENOBUFS, action)
        await sweep.sweep("epoll_wait", errno.EINTR, action, must_work=True)
        for function in ("recvmsg", "sendmsg"):
            await sweep.sweep(function, 0, action, amount=100, times=ALL_CALLS, points=1,
                              must_work=True)


async def sweep_jobs(sweep):
    database = {"only": "jobs.sqlite"}
    for function, error in (("pwrite", errno.ENOSPC), ("pwrite", errno.EIO), ("fsync", errno.EIO),
                            ("pread", errno.EIO)):
        await sweep.sweep(function, error, "job", **database)
    await sweep.sweep("write", errno.ENOSPC, "job", only="manifest.json")
    await sweep.sweep("pipe2", errno.EMFILE, "job")
    await sweep.sweep("fork", errno.EAGAIN, "job")
    await sweep.sweep("operator_new", errno.ENOMEM, "job")


async def sweep_driver(sweep):
    functions = [name for name in sweep.stage.server.faults.functions if name.startswith("vk")]
    for function in functions:
        for action in ("load", "rebuild", "capture", "environment"):
            await sweep.sweep(function, OUT_OF_DEVICE_MEMORY, action)
    for function in ("vkQueueSubmit2", "vkWaitSemaphores", "vkAllocateMemory", "vkCreateImage"):
        for action in ("load", "render", "rebuild"):
            await sweep.sweep(function, DEVICE_LOST, action, restart=True)


async def sweep_shortly(sweep):
    """A call of every kind, in seconds."""
    for action, points in (("pages", 4), ("open", 4), ("capture", 4), ("load", 3)):
        await sweep.sweep("operator_new", errno.ENOMEM, action, points=points)
    await sweep.sweep("pread", errno.EIO, "load", points=1, only=".glb")
    await sweep.sweep("write", errno.ENOSPC, "upload", points=1, only="incoming")
    await sweep.sweep("rename", errno.EIO, "upload", points=1)
    await sweep.sweep("accept", errno.EMFILE, "pages", points=1, must_work=True)
    await sweep.sweep("sendmsg", errno.EPIPE, "open", points=2)
    await sweep.sweep("recvmsg", errno.ECONNRESET, "open", points=2)
    await sweep.sweep("vkCreateImage", OUT_OF_DEVICE_MEMORY, "rebuild", points=1)
    await sweep.sweep("vkQueueSubmit2", DEVICE_LOST, "load", points=1)


PARTS = {"short": sweep_shortly, "memory": sweep_memory, "files": sweep_files,
         "sockets": sweep_sockets, "jobs": sweep_jobs, "driver": sweep_driver}


async def run(points, parts, report=print):
    """Gives the sweep, with what was injected and what was wrong."""
    with tempfile.TemporaryDirectory() as folder:
        stage = Stage(folder)
        await stage.start()
        sweep = Sweep(stage, points, report)
        try:
            for part in parts:
                await PARTS[part](sweep)
        finally:
            await stage.stop()
        return sweep


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--points", type=int, default=400, help="of each function and request")
    parser.add_argument("--only", action="append", choices=PARTS)
    options = parser.parse_args()
    sweep = asyncio.run(run(options.points, options.only or [*PARTS]))
    for kind, count in sorted(sweep.injected.items()):
        print(f"{kind}: {count}")
    print(f"{sum(sweep.injected.values())} faults, outcomes {sweep.outcomes}")
    for wrong in sweep.wrong:
        print("WRONG", wrong)
    sys.exit(1 if sweep.wrong else 0)


if __name__ == "__main__":
    main()
