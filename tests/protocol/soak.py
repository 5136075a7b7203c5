"""Keeps a server busy for a long time and checks that nothing is lost or reordered and that memory
does not grow: soak.py --seconds 3600

One viewer moves the camera and changes settings, others receive JPEG and H.264 over WebSocket,
further ones connect and drop the connection, sessions are created, joined and closed, images are
captured. With --faults a further session loads, uploads and renders jobs while calls of the server fail. Exits
with 1 on any fault."""

import argparse
import asyncio
import contextlib
import math
import os
import statistics
import sys
import tempfile
import time

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))

from harness.memory import NOT_COMPARED, SANITIZERS  # noqa: E402
from harness.server import Server  # noqa: E402
from harness.soak_faults import FaultyWork  # noqa: E402
from harness.viewer import Viewer  # noqa: E402

MEGABYTE = 1e6
# What memory may grow by. Within the first minute pools still fill, by 0.9 MB from half to half of
# sixteen seconds; from then on by 0.1 MB.
GROWTH = 0.01
FILLING, FILLING_SECONDS = 2 * MEGABYTE, 60
LOG_TAIL = 4000  # characters of the server's log, where something is wrong


class Observer:
    """Checks the order of everything that one viewer is sent."""

    def __init__(self, name, viewer):
        self.name = name
        self.viewer = viewer
        self.frames = 0
        self.faults = []
        self.patches = 0  # that it was told of
        self._revision = 0

    async def run(self):
        last = {"frame_seq": 0, "render_id": 0, "state_rev": 0, "input_seq_echo": 0}
        while True:
            header = (await self.viewer.next_frame(timeout=60)).header
            self.frames += 1
            for member in ("render_id", "state_rev", "input_seq_echo"):
                if header[member] < last[member]:
                    self.faults.append(f"{self.name}: {member} {last[member]} -> {header[member]}")
            if header["frame_seq"] <= last["frame_seq"]:
                self.faults.append(f"{self.name}: frame {header['frame_seq']} came twice")
            last = header
            self.check_notifications()

    def check_notifications(self):
        news = self.viewer.notifications[:]
        del self.viewer.notifications[:len(news)]  # of hours they would fill the memory
        for note in news:
            if note["method"] != "settings.changed":
                continue
            self.patches += 1
            revision = note["params"]["rev"]
            if revision <= self._revision:
                self.faults.append(f"{self.name}: settings of {revision} after {self._revision}")
            self._revision = revision


async def drive(viewer, state):
    """Moves for a second, changes a setting, stays static for half a second."""
    while not state["ending"]:
        for _ in range(50):
            state["seq"] += 1
            angle = 0.02 * state["seq"]
            await viewer.notify("camera.set", {"seq": state["seq"], "eye": [
                3 * math.cos(angle), 2, 3 * math.sin(angle)]})
            await asyncio.sleep(0.02)
        state["patches"] += 1  # so that each differs from the one before
        compensation = 0.1 * (state["patches"] % 10)
        await viewer.call("settings.patch",
                          {"patch": {"exposure": {"compensation": compensation}}})
        await asyncio.sleep(0.5)


async def come_and_go(server, state):
    # Until told to end: wait_for() swallows a cancellation that comes together with a frame.
    while not state["ending"]:
        visitor = Viewer(server)
        await visitor.__aenter__()
        await visitor.next_frame(timeout=60)
        visitor.socket.transport.abort()
        await asyncio.sleep(0.3)


async def make_and_close(server, state):
    """A session with its own camera and a viewer, again and again. Memory is compared from one to
    the next, while each is there. Where calls are made to fail, some are made for it."""
    async with Viewer(server, greet=False) as outside:
        while not state["ending"]:
            name = ""
            try:
                name = (await outside.call("session.create", {"copy_of": "main"}))["name"]
                await visit(server, name, state)
            except AssertionError:
                if not state["faults"]:
                    raise
                state["disturbed"] += 1
                if name:
                    await outside.ask("session.close", {"session": name})
            await asyncio.sleep(1)


async def visit(server, name, state):
    async with Viewer(server, session=name) as inside:
        await inside.call("camera.orbit", {"yaw": 30})
        await inside.next_frame(timeout=60)
        await inside.call("frame.capture", {"samples": 1})
        state["captures"] += 1
        state["memory"].append(server.memory_bytes())
        await inside.call("session.close", {"session": name})


async def soak(server, seconds, report=print, faulty=None):
    """Gives what was wrong, an empty list if nothing was. `faulty`: what lets calls fail meanwhile."""
    state = {"seq": 0, "patches": 0, "captures": 0, "memory": [], "ending": False,
             "faults": faulty is not None, "disturbed": 0}
    async with Viewer(server) as driver, Viewer(server) as jpeg, \
            Viewer(server, greet=False) as video:
        await video.call("hello", {"client": "soak", "codecs": ["h264", "jpeg"]})
        observers = [Observer("driver", driver), Observer("jpeg", jpeg), Observer("video", video)]
        tasks = [asyncio.create_task(observer.run()) for observer in observers]
        working = [asyncio.create_task(drive(driver, state)),
                   asyncio.create_task(make_and_close(server, state))]
        if faulty:
            working.append(asyncio.create_task(faulty.run(state)))
        tasks += [*working, asyncio.create_task(come_and_go(server, state))]
        begin = time.monotonic()
        while time.monotonic() < begin + seconds:
            await asyncio.sleep(min(10, seconds / 8))
            failed = [task for task in tasks if task.done()]
            if failed:
                return [repr(task.exception()) for task in failed]
            injected = f"{faulty.injected} faults, {len(faulty.wrong)} wrong, " if faulty else ""
            report(f"{time.monotonic() - begin:6.0f} s, {sum(w.frames for w in observers)} frames, "
                   f"{state['patches']} patches, {state['captures']} captures, {injected}"
                   f"{server.memory_bytes() / MEGABYTE:.1f} MB")
        state["ending"] = True
        await asyncio.gather(*working)
        faults = await check_end(state, observers)
        if faulty:
            faults += faulty.wrong
            if faulty.injected == 0:
                faults.append("no call failed")
            if state["disturbed"] > state["captures"]:
                faults.append(f"{state['disturbed']} of the sessions that came and went were disturbed")
        for task in tasks:
            task.cancel()
        await asyncio.gather(*tasks, return_exceptions=True)
    if SANITIZERS:
        report(NOT_COMPARED)
        return faults
    # Once pools have filled. Medians: the memory of a closed session returns a moment later, so that
    # single samples hold two.
    memory = state["memory"]
    settled = memory[len(memory) // 4:]
    if len(settled) < 4:
        return [*faults, "too few sessions came and went to compare"]
    half = len(settled) // 2
    before = statistics.median(settled[:half])
    grown = statistics.median(settled[half:]) - before
    if grown > GROWTH * before + (FILLING if seconds < FILLING_SECONDS else 0):
        faults.append(f"memory grew by {grown / MEGABYTE:.1f} MB")
    return faults


async def check_end(state, observers):
    jpeg = observers[1]
    for _ in range(100):
        jpeg.check_notifications()
        heard = jpeg.patches
        if heard == state["patches"]:
            break
        await asyncio.sleep(0.1)
    faults = [fault for observer in observers for fault in observer.faults]
    if heard != state["patches"]:
        faults.append(f"{state['patches']} patches, but {heard} notifications")
    return faults


def tell(line):
    """At once, also into a file."""
    print(line, flush=True)


async def soak_with_faults(seconds, report=tell):
    with tempfile.TemporaryDirectory() as folder:
        faulty = FaultyWork(folder)
        await faulty.stage.start()
        try:
            faults = await soak(faulty.stage.server, seconds, report, faulty)
            if faults:
                report(faulty.stage.server.log_text()[-LOG_TAIL:])
            return faults
        finally:
            with contextlib.suppress(asyncio.CancelledError):
                await faulty.stage.stop()


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seconds", type=float, default=3600)
    parser.add_argument("--faults", action="store_true", help="let calls of the server fail meanwhile")
    options = parser.parse_args()
    if options.faults:
        faults = asyncio.run(soak_with_faults(options.seconds))
    else:
        with Server() as server:
            faults = asyncio.run(soak(server, options.seconds, tell))
    flat = "" if SANITIZERS else ", memory flat"
    print("\n".join(faults) or f"nothing lost, nothing out of order{flat}")
    sys.exit(1 if faults else 0)


if __name__ == "__main__":
    main()
