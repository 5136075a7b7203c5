"""Random clients in several roles against a model of the contract:
random_clients.py --histories 10000 [--seed N]

A history is a list of steps of two participants with control tokens, one with a view token, one that
acknowledges frames only now and then, and callers over HTTP, in two sessions. One that breaks the
contract is shrunk to the steps that are needed, and printed."""

import argparse
import asyncio
import json
import os
import random
import sys

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))

from harness.contract_model import Broken  # noqa: E402
from harness.random_play import CONTROL, VIEW, VIEWERS, Play  # noqa: E402
from harness.server import Server  # noqa: E402

ACTORS = [*VIEWERS, "http", "http_view"]
# Modelled by random_play.py, or too slow for thousands of histories.
NOT_GENERIC = {"hello", "scene.load", "scene.unload", "scene.cancel", "environment.set",
               "stream.configure", "stream.ack", "frame.step", "frame.run", "frame.capture",
               "reference.start", "settings.patch", "settings.preset", "camera.set",
               "session.create", "session.join", "session.detach", "session.control", "session.close",
               "job.create", "job.cancel", "job.list", "job.status"}


def server_arguments():
    return ("--token", CONTROL, "--view-token", VIEW, "--scene", "mirror", "--max-sessions", "1000",
            "--max-connections-per-client", "1000")


def random_step(rng):
    actor = rng.choice(ACTORS)
    act = rng.choice(("camera", "camera", "settings", "settings", "control", "control", "join",
                      "step", "step", "run", "capture", "generic", "generic", "acknowledge",
                      "pause", "reconnect", "close", "burst"))
    arguments = {
        "camera": lambda: [round(rng.uniform(1, 4), 3), round(rng.uniform(1, 4), 3), 3.0],
        "settings": lambda: round(rng.uniform(-2, 2), 2),
        "control": lambda: {
            "mode": rng.choice((None, None, "shared", "exclusive", "exclusive")),
            "action": rng.choice((None, None, "take", "give", "release")),
            "viewer": rng.choice((None, None, *VIEWERS, "v0"))},
        "join": lambda: rng.choice((0, 1)),
        "step": lambda: [rng.randrange(3), rng.choice((0.0, 0.04))],
        "generic": lambda: rng.random(),
        "pause": lambda: rng.choice((True, False)),
        "burst": lambda: rng.randrange(2, 5),
    }.get(act, lambda: None)()
    return [actor, act, arguments]


def random_history(seed, length):
    rng = random.Random(seed)
    return [random_step(rng) for _ in range(rng.randrange(length // 2, length + 1))]


async def shrink(play, history):
    """The shortest part of the history that still breaks: without halves, quarters, single steps."""
    size = max(1, len(history) // 2)
    while True:
        at = 0
        while at < len(history):
            shorter = history[:at] + history[at + size:]
            if await play(shorter):
                history = shorter
            else:
                at += size
        if size == 1:
            return history
        size //= 2


async def run(server, histories, seed=1, length=14, report=print):
    """Gives the sentences about histories that broke the contract."""
    answer = await Play(server, "", []).http("rpc.discover", {}, CONTROL, "main")
    methods = [method for method in answer["result"]["methods"]
               if method["name"] not in NOT_GENERIC and method.get("examples")]
    count = 0

    async def fault_of(history):
        nonlocal count
        count += 1
        try:
            await Play(server, f"h{count}", methods).run(history)
        except Broken as broken:
            return str(broken)
        return ""

    faults = []
    for number in range(seed, seed + histories):
        history = random_history(number, length)
        if fault := await fault_of(history):
            shrunk = await shrink(fault_of, history)
            fault = await fault_of(shrunk) or fault + " (not every time)"
            faults.append(f"seed {number}: {fault}\n    {json.dumps(shrunk)}")
            report(faults[-1])
            if len(faults) == 5 or not server.alive:
                break
        if (number - seed + 1) % 500 == 0:
            report(f"{number - seed + 1} histories")
    return faults


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--histories", type=int, default=10000)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--play", help="a history as it was printed, instead of random ones")
    options = parser.parse_args()
    with Server(*server_arguments()) as server:
        server.headers["Authorization"] = "Bearer " + CONTROL
        if options.play:
            asyncio.run(Play(server, "played", []).run(json.loads(options.play)))
            return
        faults = asyncio.run(run(server, options.histories, options.seed))
    print(f"{options.histories} histories, {len(faults)} broke the contract")
    sys.exit(1 if faults else 0)


if __name__ == "__main__":
    main()
