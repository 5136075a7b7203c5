"""Loads a server with many viewers in many sessions: load.py --sessions 50 --viewers 500

In the open model inputs come at a schedule, whether frames come or not, and their latency counts from
when they were due; in the closed model each camera moves again when its frame has come. Stages: sessions and viewers
come, what is beyond the limits is refused, one session moves, all move (too much) and stop, all move
in the closed model, and peers that are slow or dead at every point of a connection surround one that
moves. Prints latencies, refusals and memory, and exits with 1 on any fault."""

import argparse
import asyncio
import contextlib
import itertools
import math
import os
import re
import resource
import statistics
import sys
import time
from dataclasses import dataclass, field

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))

from harness.load_measures import (Input, describe, histogram, latencies_of, percentile,  # noqa: E402
                                   recovered_after)
from harness.load_peers import DEAD, PLACES, surround  # noqa: E402
from harness.load_socket import LoadSocket, Refused  # noqa: E402
from harness.server import TIME_FACTOR, Server  # noqa: E402

MEBIBYTE = 1 << 20
SHOWN_WITHIN = 20 * TIME_FACTOR  # seconds, of the last input of a stage
TOLD_WITHIN = 1 * TIME_FACTOR  # seconds, that a refusal may take
RECOVERED_WITHIN = 2 * TIME_FACTOR  # seconds, after an overload
ENDED_WITHIN = 60 * TIME_FACTOR  # seconds, dead peers
CONNECTING = 20  # viewers that connect at the same time
FULL, TRY_LATER = -32029, 1013


@dataclass
class Plan:
    sessions: int
    viewers: int
    seconds: float  # of a stage
    rate: float  # inputs per second of each session that moves
    beyond: int  # how many are tried beyond each limit
    wait_for_peers: bool  # until the server has ended all that are dead
    tolerance: float  # seconds more than usual that count as usual
    size: tuple = (160, 90)

    def arguments(self):
        """Options of a server that has room for this and no more."""
        return ("--max-sessions", str(self.sessions + 1), "--max-all-viewers", str(self.viewers),
                "--max-viewers", str(math.ceil(self.viewers / self.sessions)),
                "--max-connections", "4096", "--max-connections-per-client", "4096")


@dataclass
class LoadedSession:
    name: str
    viewers: list = field(default_factory=list)
    inputs: list = field(default_factory=list)  # of this stage
    answer: asyncio.Future = None  # of the last one

    @property
    def leader(self):
        return self.viewers[0]


class Load:
    def __init__(self, server, plan, report=print):
        self.server, self.plan, self.report = server, plan, report
        self.faults = []
        self.sessions = [LoadedSession(f"load-{i}") for i in range(plan.sessions)]
        self.lateness = []  # of what this program sent itself
        self.angles = itertools.count()

    def expect(self, condition, fault):
        if not condition:
            self.faults.append(fault)

    async def metric(self, name):
        page = (await asyncio.to_thread(self.server.get, "/metrics"))[2].decode()
        return float(re.search(rf"^heliograph_{name} (\S+)$", page, re.MULTILINE)[1])

    # Viewers and sessions come.

    async def add(self, session):
        """A viewer; seconds from connecting to its first frame."""
        began = time.monotonic()
        viewer = await LoadSocket.open(self.server, session.name)
        width, height = self.plan.size
        viewer.notify("stream.configure", {"width": width, "height": height})
        session.viewers.append(viewer)
        return await viewer.frame_of(0) - began

    async def come(self, wanted, what):
        """Adds viewers to the sessions that are named, and gives the memory of each in bytes."""
        before = await self.metric("resident_memory_bytes")
        room = asyncio.Semaphore(CONNECTING)

        async def enter(session):
            async with room:
                return await self.add(session)

        first = await asyncio.gather(*[enter(session) for session in wanted])
        await self.rest()
        each = (await self.metric("resident_memory_bytes") - before) / len(wanted)
        self.report(f"{len(wanted)} {what}: first frame {describe(first)}; "
                    f"{each / MEBIBYTE:.3f} MiB each")
        return each

    async def rest(self):
        """Until no frame has come for half a second."""
        def frames():
            return sum(len(viewer.frames) for viewer in self.all_viewers())
        seen = -1
        while (now := frames()) != seen:
            seen = now
            await asyncio.sleep(0.5)

    def all_viewers(self):
        return [viewer for session in self.sessions for viewer in session.viewers]

    async def fill(self):
        async with asyncio.timeout(600 * TIME_FACTOR):
            for session in self.sessions:
                await asyncio.to_thread(self.server.call, "session.create",
                                        {"name": session.name, "copy_of": "main"})
            await self.come(self.sessions, "sessions with a viewer")
            more = self.plan.viewers - self.plan.sessions
            others = [self.sessions[i % len(self.sessions)] for i in range(more)]
            if others:
                return await self.come(others, "more viewers")
        return 0.0

    # What is beyond the limits.

    async def refused(self, attempt, codes, what):
        """How long each refusal took."""
        taken = []
        for _ in range(self.plan.beyond):
            began = time.monotonic()
            try:
                await asyncio.wait_for(attempt(), 30 * TIME_FACTOR)
                self.faults.append(f"{what} beyond the limit was let in")
            except Refused as refusal:
                taken.append(time.monotonic() - began)
                self.expect(refusal.code in codes, f"{what} beyond the limit: {refusal}")
        if taken:
            self.expect(max(taken) <= TOLD_WITHIN, f"{what}: told after {max(taken):.2f} s")
        return taken

    async def refuse(self, when):
        async def viewer():
            await (await LoadSocket.open(self.server, "main")).frame_of(0)

        async def session():
            answer = await asyncio.to_thread(self.server.ask, "session.create", {"copy_of": "main"})
            if "error" in answer:
                raise Refused(answer["error"]["code"])

        for attempt, codes, what in ((viewer, (TRY_LATER, FULL), "a viewer"),
                                     (session, (FULL,), "a session")):
            taken = await self.refused(attempt, codes, what)
            self.report(f"{when}, {what} beyond the limit: refused after {describe(taken)}")

    # Cameras move.

    def turn(self, session, due):
        """The next input of a session; a future of its answer."""
        self.lateness.append(time.monotonic() - due)
        angle = 0.02 * next(self.angles)
        one = Input(due)
        session.inputs.append(one)
        answer = session.leader.ask("camera.set", {
            "seq": len(session.inputs), "eye": [3 * math.cos(angle), 2, 3 * math.sin(angle)]})

        def answered(future):
            if not future.exception():
                one.rev = future.result()["rev"]

        answer.add_done_callback(answered)
        session.answer = answer
        return answer

    async def move_open(self, session, begin, end):
        for i in itertools.count():
            due = begin + i / self.plan.rate
            if due >= end:
                return
            await asyncio.sleep(max(0, due - time.monotonic()))
            self.turn(session, due)

    async def move_closed(self, session, end):
        while time.monotonic() < end:
            camera = await self.turn(session, time.monotonic())
            await session.leader.frame_of(camera["rev"])

    def begin_stage(self):
        for session in self.sessions:
            session.inputs.clear()
            for viewer in session.viewers:
                del viewer.frames[:-1]
        self.lateness.clear()
        self.began = (time.monotonic(), self.server.cpu_seconds(), time.process_time())

    async def shown(self, moved):
        """Until every viewer has been shown the last input of its session, or not in time."""
        async def session_shown(session):
            camera = await session.answer
            await asyncio.gather(*[viewer.frame_of(camera["rev"]) for viewer in session.viewers])

        with contextlib.suppress(asyncio.TimeoutError):
            await asyncio.wait_for(asyncio.gather(*[session_shown(session) for session in moved],
                                                  return_exceptions=True), SHOWN_WITHIN)

    def latencies(self, sessions):
        now = time.monotonic()
        return [one for session in sessions for viewer in session.viewers
                for one in latencies_of(session.inputs, viewer.frames, now)]

    def tell(self, what, moved):
        seconds, served, own = (now - then for now, then in zip(
            (time.monotonic(), self.server.cpu_seconds(), time.process_time()), self.began))
        found = self.latencies(moved)
        frames = [frame for session in moved for viewer in session.viewers for frame in viewer.frames[1:]]
        missing = sum(not one.shown for one in found)
        self.expect(not missing, f"{what}: {missing} of {len(found)} inputs were never shown")
        values = [one.seconds for one in found]
        self.report(f"{what}: {describe(values)}; {len(frames) / seconds:.1f} frames/s to viewers, "
                    f"sent at scale {statistics.median(frame.scale for frame in frames):.2f}, "
                    f"processors {served / seconds:.1f} and {own / seconds:.1f} for this program, "
                    f"which was late by {1000 * percentile(self.lateness, 0.99):.0f} ms (p99)")
        self.report("    up to ms: " + ", ".join(f"{bar} {count}" for bar, count in histogram(values)))
        return values

    async def one_moves(self, what="one session moves"):
        self.begin_stage()
        begin = time.monotonic() + 0.1
        await self.move_open(self.sessions[0], begin, begin + self.plan.seconds)
        await self.shown(self.sessions[:1])
        return self.tell(what, self.sessions[:1])

    async def overload(self, usual):
        """All sessions move, then all but the first stop."""
        self.begin_stage()
        begin = time.monotonic() + 0.1
        stop = begin + self.plan.seconds
        first = asyncio.create_task(self.move_open(
            self.sessions[0], begin, stop + RECOVERED_WITHIN + 1))
        others = [asyncio.create_task(self.move_open(session, begin, stop))
                  for session in self.sessions[1:]]
        await asyncio.sleep(self.plan.seconds / 2)
        await self.refuse("while all move")
        await asyncio.gather(*others)
        await first
        await self.shown(self.sessions)
        self.tell("all sessions move, then one", self.sessions)
        normal = 1.5 * percentile(usual, 0.99) + self.plan.tolerance
        after = recovered_after(self.latencies(self.sessions[:1])[:len(self.sessions[0].inputs)],
                                stop, normal, row=max(5, int(self.plan.rate / 2)))
        self.report(f"latency normal again (at most {1000 * normal:.0f} ms) {after:.2f} s after the others stopped")
        self.expect(after <= RECOVERED_WITHIN, f"latency was normal again only after {after:.2f} s")

    async def closed_model(self):
        self.begin_stage()
        begin = time.monotonic()
        await asyncio.gather(*[self.move_closed(session, begin + self.plan.seconds)
                               for session in self.sessions])
        await self.shown(self.sessions)
        served = [len(session.inputs) for session in self.sessions]
        self.report(f"closed model, {min(served)} to {max(served)} inputs of a session")
        self.expect(min(served) >= max(served) / 4, f"sessions were served {min(served)} to {max(served)} times")
        self.tell("closed model, all sessions", self.sessions)

    async def among_peers(self, usual):
        """One session moves while others are slow or dead."""
        session = self.sessions[0]
        kept = max(1, self.plan.viewers // self.plan.sessions - PLACES)
        for viewer in session.viewers[kept:]:
            viewer.abort()
        del session.viewers[kept:]
        await self.connected(len(self.all_viewers()))
        before = await self.metric("connections")
        async with surround(self.server, session.name) as late:
            beside = await self.one_moves(f"one session moves beside {len(DEAD)} dead and 2 slow peers")
            limit = 2 * percentile(usual, 0.99) + 2 * self.plan.tolerance
            self.expect(percentile(beside, 0.99) <= limit,
                        f"beside slow peers p99 is {percentile(beside, 0.99):.2f} s, limit {limit:.2f}")
            if self.plan.wait_for_peers:
                await self.ended(before)
            self.expect(not late.ended.done(), "a viewer that acknowledges late was disconnected")

    async def connected(self, viewers):
        while await self.metric("viewers") > viewers:
            await asyncio.sleep(0.1)

    async def ended(self, before):
        """Until the server has ended those that are dead. The late one stays; one may come and go."""
        began = time.monotonic()
        while await self.metric("connections") > before + 2:
            if time.monotonic() > began + ENDED_WITHIN:
                self.faults.append("dead peers are still connected")
                return
            session = self.sessions[0]
            self.turn(session, time.monotonic())
            await asyncio.sleep(0.2)
        self.report(f"    dead peers were ended {time.monotonic() - began:.0f} s after that")

    async def leave(self):
        for viewer in self.all_viewers():
            viewer.abort()
        for session in self.sessions:
            await asyncio.to_thread(self.server.call, "session.close", {"session": session.name})

    async def run(self):
        """Faults, an empty list if there were none."""
        await self.fill()
        await self.refuse("while nothing moves")
        usual = await self.one_moves()
        await self.rest()
        await self.overload(usual)
        await self.rest()
        await self.closed_model()
        await self.rest()
        self.expect(not any(viewer.ended.done() for viewer in self.all_viewers()), "a viewer was disconnected")
        await self.among_peers(usual)
        await self.leave()
        return self.faults


LONG = Plan(sessions=50, viewers=500, seconds=20, rate=10, beyond=20, wait_for_peers=True,
            tolerance=0.1)
# Beside other tests, which disturb for longer.
SHORT = Plan(sessions=3, viewers=24, seconds=1, rate=10, beyond=2, wait_for_peers=False,
             tolerance=0.5)


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    for name in ("sessions", "viewers", "beyond"):
        parser.add_argument(f"--{name}", type=int, default=getattr(LONG, name))
    for name in ("seconds", "rate"):
        parser.add_argument(f"--{name}", type=float, default=getattr(LONG, name))
    parser.add_argument("--size", default="160x90", help="of the frames")
    parser.add_argument("--scene", help="[that of the protocol tests]")
    parser.add_argument("--scene-root")
    options = parser.parse_args()
    plan = Plan(options.sessions, options.viewers, options.seconds, options.rate, options.beyond,
                wait_for_peers=True, tolerance=LONG.tolerance,
                size=tuple(int(side) for side in options.size.split("x")))
    resource.setrlimit(resource.RLIMIT_NOFILE, (8192, resource.getrlimit(resource.RLIMIT_NOFILE)[1]))
    chosen = ["--scene", options.scene] if options.scene else []
    with Server(*plan.arguments(), *chosen, scenes=options.scene_root) as server:
        faults = asyncio.run(Load(server, plan).run())
    print("\n".join(faults) or "nothing lost, refused at once, recovered")
    sys.exit(1 if faults else 0)


if __name__ == "__main__":
    main()
