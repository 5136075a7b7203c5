"""The pictures of the stream as a program takes them: the newest one, when it asks."""

import asyncio
import contextlib

from .errors import HeliographError

# The server lets go whoever acknowledges nothing for 10 s.
PATIENCE = 2.0  # seconds


class PictureStream:
    """Holds the newest picture until it is asked for, and acknowledges it only then: whoever is
    slow gets fewer pictures, not later ones. One that nobody asks for in `PATIENCE` is dropped, and
    the stream paused until the next is wanted: nothing is drawn for a program that thinks."""

    def __init__(self, connection):
        self.paused = False  # as the server said last
        self._connection = connection
        self._newest = None
        self._came_at = 0.0
        self._came = asyncio.Event()
        self._turn = asyncio.Lock()
        self._timer = None
        self._pausing = None

    def put(self, frame):
        """Takes what came from the server."""
        self._newest = frame
        self._came_at = asyncio.get_running_loop().time()
        self._came.set()
        self._watch()

    async def next(self):
        """The next picture; lets the stream begin where it is paused."""
        async with self._turn:
            if self.paused:
                await self._drop()
                await self._connection.call("stream.resume", {})
            while self._newest is None:
                self._connection.check()
                self._came.clear()
                await self._came.wait()
            frame = self._newest
            await self._drop()
            return frame

    async def pause(self):
        """Lets no more pictures be sent. After the server's answer none is on its way."""
        async with self._turn:
            try:
                await self._connection.call("stream.pause", {})
            finally:
                await self._drop()

    def end(self):
        """Nothing comes any more."""
        self._came.set()
        if self._timer:
            self._timer.cancel()

    async def _drop(self):
        """Empties the place of the newest, which acknowledges all that came."""
        if self._timer:
            self._timer.cancel()
            self._timer = None
        frame, self._newest = self._newest, None
        if frame is None:
            return
        held = asyncio.get_running_loop().time() - self._came_at
        await self._connection.notify("stream.ack", {
            "frame_seq": frame.header["frame_seq"], "present_us": int(held * 1e6)})

    def _watch(self):
        if self._timer is None:
            self._timer = asyncio.get_running_loop().call_later(PATIENCE, self._give_up)

    def _give_up(self):
        self._timer = None
        if self._turn.locked():  # somebody is about to take it
            self._watch()
        else:
            self._pausing = asyncio.ensure_future(self._pause_quietly())

    async def _pause_quietly(self):
        with contextlib.suppress(HeliographError, ConnectionError, asyncio.TimeoutError):
            await self.pause()
