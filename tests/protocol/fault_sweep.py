"""Lets calls of the server fail, the first, the second, and so on, while it works:
fault_sweep.py --points 400

After each fault the server still runs, or has ended with one line that says why; another session's
frames go on; and the same request works. Exits with 1 otherwise."""

import argparse
import asyncio
import errno
import os
import sys
import tempfile
import time

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))

from harness.fault_stage import (ANSWER_TIMEOUT, Cut, Refused, Stage,  # noqa: E402
                                 is_connected)
from harness.faults import ALL_CALLS, DEVICE_LOST, OUT_OF_DEVICE_MEMORY  # noqa: E402

END_DELAY = 0.1  # seconds from the end of a process's connections to its own


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
                    around_end=0, **rule):
        """The n-th call fails, for n from 1 to what the action makes. `must_work`: the caller goes
        on as if nothing were wrong, as after EINTR; `restart`: with a new server each time;
        `around_end`: also every third call so near the last, where answers are made."""
        counted = {name: value for name, value in rule.items() if name == "only"}
        calls = await self.count(function, action, **counted)
        name = f"{action}: {function}" + (f" on {rule['only']}" if rule.get("only") else "")
        numbers = spread(calls, points or self.points)
        if around_end:
            numbers = sorted({*numbers, *range(max(1, calls - around_end), calls + around_end, 3)})
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
            await asyncio.sleep(END_DELAY)
            if await self.has_ended(what):
                return
            self.wrong.append(f"{what}: the other session's viewer was disconnected\n"
                              f"{tail(stage.server)}")
            stage.observer = None
        if not await is_connected(stage.worker):
            stage.worker = None
        await stage.connect()


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
    for action, points in (("pages", 4), ("open", 4), ("render", 40), ("capture", 4), ("load", 3)):
        await sweep.sweep("operator_new", errno.ENOMEM, action, points=points,
                          around_end=15 if action == "pages" else 0)
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
