"""Measures the capacity of a running server: adds sessions and viewers in steps, with moving cameras,
and prints the cost of each step. Use it on the machine and with the scene in question:
  capacity.py http://127.0.0.1:8080/ --token TOKEN --scene glossy_sponza_1 --size 640x360"""

import argparse
import asyncio
import math
import os
import statistics
import sys
import time
import uuid

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))

from harness.replaying_viewer import ReplayingViewer, ViewState  # noqa: E402
from harness.servers import measurement  # noqa: E402

STEPS = ((1, 1), (1, 4), (2, 1), (4, 1))  # sessions and viewers of each
COUNTERS = {"cpu": "process_cpu_seconds_total", "frames": "heliograph_frames_sent_total",
            "bytes": "heliograph_sent_bytes_total", "render": "heliograph_render_seconds_sum",
            "renders": "heliograph_render_seconds_count",
            "encode": "heliograph_encode_seconds_sum", "encodes": "heliograph_encode_seconds_count"}
COLUMNS = ("sessions", "viewers", "cameras", "frames/s of a viewer", "processors",
           "CPU ms per frame", "ms to render", "ms to encode", "kB per frame",
           "Mbit/s of a viewer", "ms input to frame p50", "p95", "MB resident")


class StepViewers:
    """Viewers in their own sessions; an asynchronous context manager."""

    def __init__(self, options, sessions, each):
        self.leaders, self.viewers = [], []
        width, height = (int(number) for number in options.size.split("x"))
        for _ in range(sessions):
            name = f"capacity-{uuid.uuid4().hex[:8]}"
            for place in range(each):
                viewer = ReplayingViewer(options.url, options.token,
                                         ViewState(options.scene, size=(width, height)))
                viewer.session = name
                self.viewers.append(viewer)
                if place == 0:
                    self.leaders.append(viewer)

    async def __aenter__(self):
        for viewer in self.viewers:
            await viewer.__aenter__()
        return self

    async def __aexit__(self, *_):
        for viewer in self.viewers:
            await viewer.__aexit__()

    async def move(self, seconds):
        """Orbits the camera of every session, thirty times per second."""
        started = time.monotonic()
        while (passed := time.monotonic() - started) < seconds:
            for viewer in self.leaders:
                await viewer.look((6 * math.sin(0.5 * passed), 2.0, 6 * math.cos(0.5 * passed)))
            await asyncio.sleep(1 / 30)

    async def wait_idle(self):
        """Waits until no more frames arrive."""
        seen = None
        while (frames := sum(viewer.frames for viewer in self.viewers)) != seen:
            seen = frames
            await asyncio.sleep(3)


async def measure(options, sessions, each, moving):
    async with StepViewers(options, sessions, each) as step:
        if moving:
            await step.move(2)  # let the link controller of every stream converge
        else:
            await step.wait_idle()
        for viewer in step.viewers:
            viewer.round_trips.clear()
        before, started = await counters(options), time.monotonic()
        await (step.move(options.seconds) if moving else asyncio.sleep(options.seconds))
        seconds = time.monotonic() - started
        after = await counters(options)
        spent = {name: after[name] - before[name] for name in before}
        trips = sorted(trip for viewer in step.leaders for trip in viewer.round_trips)
        resident = await asyncio.to_thread(measurement, options.url,
                                           "heliograph_resident_memory_bytes", token=options.token)
    return row(sessions, each, moving, spent, seconds, trips, resident)


async def counters(options):
    values = {}
    for name, full in COUNTERS.items():
        values[name] = await asyncio.to_thread(measurement, options.url, full, token=options.token)
    return values


def row(sessions, each, moving, spent, seconds, trips, resident):
    viewers = sessions * each

    def ratio(value, count, scale=1.0):
        return f"{scale * value / count:.1f}" if count else "-"

    return (sessions, viewers, "moving" if moving else "static",
            ratio(spent["frames"] / seconds, viewers), f"{spent['cpu'] / seconds:.2f}",
            # Unlike wall clock time it does not depend on other load of the machine.
            ratio(spent["cpu"], spent["renders"], 1e3),
            ratio(spent["render"], spent["renders"], 1e3),
            ratio(spent["encode"], spent["encodes"], 1e3),
            ratio(spent["bytes"], spent["frames"], 1e-3),
            f"{8e-6 * spent['bytes'] / seconds / viewers:.2f}",
            f"{1e3 * statistics.median(trips):.0f}" if trips else "-",
            f"{1e3 * trips[int(0.95 * len(trips))]:.0f}" if trips else "-",
            f"{resident / 1e6:.0f}")


async def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n", maxsplit=1)[0])
    parser.add_argument("url")
    parser.add_argument("--token", required=True)
    parser.add_argument("--scene", default="glossy_sponza_1")
    parser.add_argument("--size", default="640x360")
    parser.add_argument("--seconds", type=float, default=10)
    options = parser.parse_args()
    print("| " + " | ".join(COLUMNS) + " |\n|" + "---|" * len(COLUMNS), flush=True)
    for sessions, each, moving in [(*step, True) for step in STEPS] + [(4, 1, False)]:
        values = await measure(options, sessions, each, moving)
        print("| " + " | ".join(map(str, values)) + " |", flush=True)


if __name__ == "__main__":
    asyncio.run(main())
