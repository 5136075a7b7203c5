#!/usr/bin/env python3
"""Measures how many frames a second sessions get that all move, each with one viewer.

    HELIOGRAPH_BINARY=build/bin/heliograph tests/bench/moving_sessions.py --sessions 16 --scene-root build/scenes -- \\
        --scene glossy_sponza_1 --set motion.scale=1

Sessions are copies of main, and their viewers run in processes of their own, several in each. --least-frames and
--least-slowest make it a check.
"""

import argparse
import asyncio
import importlib.util
import multiprocessing
import os
import statistics
import sys
import time

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, HERE)
sys.path.insert(0, os.path.join(HERE, "..", "protocol"))

from opening import SKIPPED, TIMEOUT, Address, add_server_arguments, configure, move, start_server  # noqa: E402

VIEWERS_IN_A_PROCESS = 2


def watch(address, names, size, ends, results):
    """Puts each name when its session shows something, and the times of its frames in the end."""
    from harness.viewer import Viewer  # pylint: disable=import-outside-toplevel

    async def run(name):
        async with Viewer(address, greet=False) as maker:
            await maker.call("session.create", {"name": name, "copy_of": "main"})
        async with Viewer(address, session=name) as viewer:
            await configure(viewer, size)
            await viewer.next_frame(timeout=TIMEOUT)
            results.put(name)
            results.put(await move(viewer, ends))

    async def run_all():
        await asyncio.gather(*[run(name) for name in names])
    asyncio.run(run_all())


async def measure(address, sessions, options):
    """Times of frames, a list for each session."""
    context = multiprocessing.get_context("spawn")
    ends, results = context.Event(), context.Queue()
    names = [f"moving-{sessions}-{i}" for i in range(sessions)]
    processes = [context.Process(target=watch, args=(address, names[i:i + VIEWERS_IN_A_PROCESS], options.size, ends,
                                                     results), daemon=True)
                 for i in range(0, sessions, VIEWERS_IN_A_PROCESS)]
    for process in processes:
        process.start()
    for _ in names:
        results.get(timeout=TIMEOUT)
    await asyncio.sleep(options.settle)
    begin = time.monotonic()
    await asyncio.sleep(options.seconds)
    end = time.monotonic()
    ends.set()
    found = [results.get(timeout=TIMEOUT) for _ in names]
    for process in processes:
        process.join(TIMEOUT)
    from harness.viewer import Viewer  # pylint: disable=import-outside-toplevel
    async with Viewer(address, greet=False) as closer:
        for name in names:
            await closer.call("session.close", {"session": name})
    return [[received for _, received in session if begin <= received <= end] for session in found]


def summary(times, seconds):
    each = [len(session) / seconds for session in times]
    gaps = [1e3 * (b - a) for session in times for a, b in zip(session, session[1:])]
    return {"all": sum(each), "slowest": min(each), "median_ms": statistics.median(gaps),
            "p99_ms": statistics.quantiles(gaps, n=100)[98]}


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    add_server_arguments(parser)
    parser.add_argument("--sessions", type=int, nargs="+", default=[16], help="one measurement for each number")
    parser.add_argument("--settle", type=float, default=3.0, help="seconds before frames count")
    parser.add_argument("--seconds", type=float, default=8.0, help="in which they count")
    parser.add_argument("--least-frames", type=float, help="a second, of all sessions")
    parser.add_argument("--least-slowest", type=float, help="a second, of the slowest session")
    options = parser.parse_args()
    if not importlib.util.find_spec("websockets"):
        print("skipped: python3-websockets is not installed")
        return SKIPPED
    missed = False
    with start_server(options, max(options.sessions)) as server:
        for sessions in options.sessions:
            found = summary(asyncio.run(measure(Address(server.host, server.port), sessions, options)),
                            options.seconds)
            print(f"{sessions} moving sessions of {options.size[0]}x{options.size[1]}: {found['all']:.0f} frames a second "
                  f"in all, the slowest {found['slowest']:.1f}; between frames {found['median_ms']:.1f} ms, 99th "
                  f"percentile {found['p99_ms']:.1f} ms", flush=True)
            missed |= options.least_frames is not None and found["all"] < options.least_frames
            missed |= options.least_slowest is not None and found["slowest"] < options.least_slowest
    return 1 if missed else 0


if __name__ == "__main__":
    sys.exit(main())
