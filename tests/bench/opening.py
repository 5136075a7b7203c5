#!/usr/bin/env python3
"""Measures what sessions that are opened at once cost a viewer who is there, and how long they take to show something.

    HELIOGRAPH_BINARY=build/bin/heliograph tests/bench/opening.py --scene-root build/scenes -- --scene glossy_sponza_1

One viewer moves the camera of the session main, in a process of its own. Then all others create a session each, a copy
of main, and view it. Gaps are the longest times from one frame of the first viewer to its next: as the server rendered
them, and as they came. --most-gap-ms and --most-first-s make it a check.
"""

import argparse
import asyncio
import importlib.util
import math
import multiprocessing
import os
import statistics
import sys
import time
from dataclasses import dataclass

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.join(HERE, "..", "protocol"))

INPUT_EVERY = 0.01  # seconds
LEFT_OPEN = 1.0  # seconds, after the first frame of the last session
TIMEOUT = 120  # seconds, of the processes
SKIPPED = 77


@dataclass
class Address:
    """What a viewer needs to know of a server that another process has started."""

    host: str
    port: int
    tls: object = None

    @property
    def websocket_url(self):
        return f"ws://{self.host}:{self.port}/ws"

    def seen(self, _, answer):
        return answer


@dataclass
class Stages:
    """Events that the processes share."""

    begins: object  # the others open their sessions
    ends: object


async def configure(viewer, size):
    await viewer.call("stream.configure", {"max_fps": 120, "quality": 80, "width": size[0], "height": size[1]})


def take_times(viewer, times):
    """When each new frame was rendered, by the server's clock, and when it came, in seconds."""
    while not viewer.frames.empty():
        frame = viewer.frames.get_nowait()
        rendered = (frame.header["render_start_us"] + frame.header["render_us"]) / 1e6
        times.append((rendered, frame.received_at))


async def move(viewer, ends):
    """Times of the frames that came meanwhile."""
    eye = (await viewer.call("camera.get"))["eye"]
    angle, times = 0.0, []
    while not ends.is_set():
        angle += 0.05
        await viewer.notify("camera.set", {"eye": [eye[0] + 0.3 * math.sin(angle), eye[1],
                                                   eye[2] + 0.3 * math.cos(angle)]})
        await asyncio.sleep(INPUT_EVERY)
        take_times(viewer, times)
    return times


def watch(address, size, stages, frames):
    from harness.viewer import Viewer  # pylint: disable=import-outside-toplevel

    async def run():
        async with Viewer(address) as viewer:
            await configure(viewer, size)
            frames.put(await move(viewer, stages.ends))
    asyncio.run(run())


def open_session(address, name, size, stages, firsts):
    """Puts the time from the beginning to the first frame, in seconds."""
    from harness.viewer import Viewer  # pylint: disable=import-outside-toplevel

    async def run():
        async with Viewer(address, greet=False) as maker:
            await maker.call("session.create", {"name": name, "copy_of": "main"})
        async with Viewer(address, session=name) as viewer:
            await configure(viewer, size)
            frame = await viewer.next_frame(timeout=TIMEOUT)
            firsts.put(frame.received_at)
            while not stages.ends.is_set():
                await asyncio.sleep(0.05)
    stages.begins.wait(TIMEOUT)
    asyncio.run(run())


def longest_gap(times, begin, end):
    """Of neighbours of which one is within; as long as the time where there are none."""
    inside = [i for i, time_of in enumerate(times) if begin <= time_of <= end]
    if not inside:
        return end - begin
    near = times[max(inside[0] - 1, 0):inside[-1] + 2]
    return max((b - a for a, b in zip(near, near[1:])), default=end - begin)


def measure(address, options):
    context = multiprocessing.get_context("spawn")
    stages = Stages(context.Event(), context.Event())
    frames, firsts = context.Queue(), context.Queue()
    watching = context.Process(target=watch, args=(address, options.size, stages, frames), daemon=True)
    opening = [context.Process(target=open_session, args=(address, f"opened-{i}", options.size, stages, firsts),
                               daemon=True) for i in range(options.sessions)]
    for process in (watching, *opening):
        process.start()
    time.sleep(options.settle)
    begin = time.monotonic()
    stages.begins.set()
    shown = [firsts.get(timeout=TIMEOUT) - begin for _ in opening]
    time.sleep(LEFT_OPEN)
    stages.ends.set()
    found = frames.get(timeout=TIMEOUT)
    for process in (watching, *opening):
        process.join(TIMEOUT)
    rendered, received = zip(*found)
    end = begin + max(shown)
    before = begin - options.settle / 2
    return {"first_median_s": statistics.median(shown), "first_last_s": max(shown),
            "gap_before_ms": 1e3 * longest_gap(received, before, begin),
            "gap_rendered_ms": 1e3 * longest_gap(rendered, begin, end),
            "gap_received_ms": 1e3 * longest_gap(received, begin, end)}


def size_of(text):
    width, height = text.split("x")
    return int(width), int(height)


def add_server_arguments(parser):
    parser.add_argument("--size", type=size_of, default=(1280, 720))
    parser.add_argument("--scene-root", required=True)
    parser.add_argument("arguments", nargs="*", help="behind --: those of heliograph serve")


def start_server(options, sessions):
    """With room for as many beside main."""
    from harness.server import Server  # pylint: disable=import-outside-toplevel
    return Server("--max-sessions", str(sessions + 1), "--set", "reference.use=off", *options.arguments,
                  scenes=options.scene_root)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    add_server_arguments(parser)
    parser.add_argument("--sessions", type=int, default=16)
    parser.add_argument("--settle", type=float, default=6.0, help="seconds in which one viewer is alone")
    parser.add_argument("--most-gap-ms", type=float, help="of rendered frames")
    parser.add_argument("--most-first-s", type=float, help="of the last session")
    options = parser.parse_args()
    if not importlib.util.find_spec("websockets"):
        print("skipped: python3-websockets is not installed")
        return SKIPPED
    with start_server(options, options.sessions) as server:
        result = measure(Address(server.host, server.port), options)
    print(f"{options.sessions} sessions of {options.size[0]}x{options.size[1]} opened at once: first frames after "
          f"{result['first_median_s']:.2f} s, the last {result['first_last_s']:.2f} s; longest gap of the viewer who "
          f"was there {result['gap_rendered_ms']:.0f} ms as rendered, {result['gap_received_ms']:.0f} ms as received, "
          f"{result['gap_before_ms']:.0f} ms before")
    missed = (options.most_gap_ms is not None and result["gap_rendered_ms"] > options.most_gap_ms or
              options.most_first_s is not None and result["first_last_s"] > options.most_first_s)
    return 1 if missed else 0


if __name__ == "__main__":
    sys.exit(main())
