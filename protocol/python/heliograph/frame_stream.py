"""The frames of the stream on demand: the newest one when the program asks for it."""

import asyncio
import contextlib

from .errors import HeliographError

# The server disconnects a viewer that acknowledges nothing for 10 s.
PAUSE_AFTER = 2.0  # seconds


class FrameStream:
    """Holds the newest frame until the program takes it, and acknowledges it only then: a slow
    program gets fewer frames, not later ones. A frame that is not taken for `PAUSE_AFTER` is
    dropped, and the stream is paused until the next call: nothing is rendered for an idle program."""

    def __init__(self, connection):
        self.paused = False  # the server's last answer
        self._connection = connection
        self._newest = None
        self._arrived_at = 0.0
        self._arrived = asyncio.Event()
        self._lock = asyncio.Lock()
        self._timer = None
        self._pausing = None

    def put(self, frame):
        """Stores a frame from the server."""
        self._newest = frame
        self._arrived_at = asyncio.get_running_loop().time()
        self._arrived.set()
        self._watch()

    async def next(self):
        """The next frame; resumes a paused stream."""
        async with self._lock:
            if self.paused:
                await self._drop()
                await self._connection.call("stream.resume", {})
            while self._newest is None:
                self._connection.check()
                self._arrived.clear()
                await self._arrived.wait()
            frame = self._newest
            await self._drop()
            return frame

    async def pause(self):
        """Pauses the stream. After the server's answer no frame is in flight."""
        async with self._lock:
            try:
                await self._connection.call("stream.pause", {})
            finally:
                await self._drop()

    def end(self):
        """The connection has ended."""
        self._arrived.set()
        if self._timer:
            self._timer.cancel()

    async def _drop(self):
        """Drops the newest frame and acknowledges all frames up to it."""
        if self._timer:
            self._timer.cancel()
            self._timer = None
        frame, self._newest = self._newest, None
        if frame is None:
            return
        held = asyncio.get_running_loop().time() - self._arrived_at
        await self._connection.notify("stream.ack", {
            "frame_seq": frame.header["frame_seq"], "present_us": int(held * 1e6)})

    def _watch(self):
        if self._timer is None:
            self._timer = asyncio.get_running_loop().call_later(PAUSE_AFTER, self._time_out)

    def _time_out(self):
        self._timer = None
        if self._lock.locked():  # a call is about to take it
            self._watch()
        else:
            self._pausing = asyncio.ensure_future(self._pause_quietly())

    async def _pause_quietly(self):
        with contextlib.suppress(HeliographError, ConnectionError, asyncio.TimeoutError):
            await self.pause()
