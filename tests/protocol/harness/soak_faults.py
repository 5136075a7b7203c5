"""Calls that fail while soak.py runs, beside the viewers that it watches."""

import asyncio
import errno
import itertools

from harness.fault_stage import Cut, Refused, Stage, is_connected
from harness.faults import OUT_OF_DEVICE_MEMORY

PAUSE = 1  # seconds between requests
# Request, function, error, and the file. None is a call that a session makes while its viewers only watch and move.
FAULTS = (
    ("load", "open", errno.EMFILE, ".glb"),
    ("load", "pread", errno.EIO, ".glb"),
    ("load", "vkAllocateMemory", OUT_OF_DEVICE_MEMORY, ""),
    ("load", "vkCreateBuffer", OUT_OF_DEVICE_MEMORY, ""),
    ("rebuild", "vkCreateImage", OUT_OF_DEVICE_MEMORY, ""),
    ("environment", "read", errno.EIO, ".hdr"),
    ("upload", "mkdir", errno.ENOSPC, "incoming"),
    ("upload", "write", errno.ENOSPC, "incoming"),
    ("upload", "rename", errno.EIO, ""),
    ("upload", "fork", errno.EAGAIN, ""),
    ("job", "pwrite", errno.ENOSPC, "jobs.sqlite"),
    ("job", "fsync", errno.EIO, "jobs.sqlite"),
    ("job", "fork", errno.EAGAIN, ""),
    ("open", "accept", errno.EMFILE, ""),
)


class FaultyWork:
    """A session of its own whose requests fail at one call and must work the next time."""

    def __init__(self, folder):
        self.stage = Stage(folder)
        self.injected = 0
        self.wrong = []

    async def run(self, state):
        for action, function, error, file in itertools.cycle(FAULTS):
            if state["ending"]:
                return
            what = f"{action}: {function} {error} {file}"
            with self.stage.server.faults.fault(function, 1, error, only=file) as counts:
                await self.attempt(what, action)
            self.injected += counts[1]
            if not await is_connected(self.stage.worker):
                self.stage.worker = None
            await self.stage.connect()
            again = f"after {what} the same request"
            if failure := await self.attempt(again, action):
                self.wrong.append(f"{again}: {failure}")
            self.forget()
            await asyncio.sleep(PAUSE)

    def forget(self):
        """What the session was sent and nothing waits for: of hours it would fill the memory."""
        worker = self.stage.worker
        worker.notifications.clear()
        while not worker.frames.empty():
            worker.frames.get_nowait()

    async def attempt(self, what, action):
        """Why it was refused, or nothing."""
        try:
            await getattr(self.stage, action)()
        except (Refused, Cut) as failure:
            return repr(failure)
        except (TimeoutError, asyncio.TimeoutError) as late:
            self.wrong.append(f"{what}: no answer: {late}")
        return ""
