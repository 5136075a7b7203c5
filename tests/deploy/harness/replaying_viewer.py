"""A viewer that restores its view: whenever its connection is lost it reconnects and sends its state
again, as the browser client does."""

import asyncio
import base64
import json
import struct
import sys
import time
import uuid
from dataclasses import dataclass, field
from typing import Optional

import websockets

SUBPROTOCOL = "heliograph.v1"
FIRST_PAUSE, LONGEST_PAUSE = 0.1, 1.0


@dataclass
class ViewState:
    """The whole state of a viewer."""

    scene: str
    eye: tuple = (0.0, 2.0, 8.0)
    target: tuple = (0.0, 1.0, 0.0)
    settings: dict = field(default_factory=dict)
    size: tuple = (160, 90)

    def camera(self):
        return {"eye": list(self.eye), "target": list(self.target), "up": [0, 1, 0],
                "vertical_fov": 50.0}


@dataclass
class Loss:
    """An interruption, in seconds of the monotonic clock."""

    at: float
    code: Optional[int]
    back_at: Optional[float] = None  # the first frame of the restored view

    @property
    def seconds(self):
        return None if self.back_at is None else self.back_at - self.at


class ReplayingViewer:
    """An asynchronous context manager; acknowledges every frame."""

    def __init__(self, url, token, view):
        self.url = url  # http://host:port/
        self.token = token
        self.view = view
        self.session = f"viewer-{uuid.uuid4().hex[:12]}"
        self.losses = []
        self.frames = 0
        self.last_image = None
        self.longest_gap = 0.0  # seconds between two frames while connected
        self.round_trips = []   # seconds from camera.set to its frame
        self.node = None        # the balancer's cookie
        self.last_failure = None
        self.connected = asyncio.Event()
        self._sequence = 0
        self._sent_at = {}
        self._whole = None      # the state and the input whose frame ends an interruption
        self._is_whole = False
        self._shown_rev, self._shown_input = -1, 0
        self._last_frame_at = None
        self._answers = {}
        self._next_id = 1
        self._socket = None
        self._ending = False

    async def __aenter__(self):
        self._task = asyncio.create_task(self._live())
        await self.whole(timeout=180)
        return self

    async def __aexit__(self, *_):
        self._ending = True
        if self._socket:
            await self._socket.close()
        self._task.cancel()
        await asyncio.gather(self._task, return_exceptions=True)

    async def whole(self, timeout=20):
        """Waits for a frame of the complete view."""
        deadline = time.monotonic() + timeout
        while not self.connected.is_set() or not self._is_whole:
            if self._task.done():
                self._task.result()
            if time.monotonic() > deadline:
                raise AssertionError(f"no frame in {timeout} s; interruptions: {self.losses}, "
                                     f"latest failure: {self.last_failure!r}")
            await asyncio.sleep(0.01)

    async def look(self, eye):
        """Moves the camera, also of the view to restore."""
        self.view.eye = tuple(eye)
        await self._send_camera()

    async def wait_frames(self, count, timeout=60):
        """Waits for this many more frames."""
        expected, deadline = self.frames + count, time.monotonic() + timeout
        while self.frames < expected:
            if time.monotonic() > deadline:
                raise AssertionError(f"no {count} frames in {timeout} s")
            await asyncio.sleep(0.01)

    async def call(self, method, params=None, timeout=60):
        number, self._next_id = self._next_id, self._next_id + 1
        waiting = asyncio.get_running_loop().create_future()
        self._answers[number] = waiting
        await self._socket.send(json.dumps(
            {"jsonrpc": "2.0", "id": number, "method": method, "params": params or {}}))
        answer = await asyncio.wait_for(waiting, timeout)
        if "error" in answer:
            raise RuntimeError(f"{method}: {answer['error']}")
        return answer["result"]

    def awaited(self):
        """Camera moves without a frame that shows them."""
        return sorted(self._sent_at)

    async def drop(self):
        """Drops the connection as a bad network would; the viewer reconnects by itself."""
        count = len(self.losses)
        self._socket.transport.abort()
        while len(self.losses) == count:
            await asyncio.sleep(0.01)

    async def greet_once(self):
        """Connects, calls hello and disconnects, without reconnecting."""
        async with _connect(self.url, self.token, None) as self._socket:
            reading = asyncio.create_task(self._read(self._socket))
            try:
                await self.call("hello", {"client": "passer-by"}, timeout=20)
            finally:
                reading.cancel()
                await asyncio.gather(reading, return_exceptions=True)

    def forget_gaps(self):
        self.longest_gap, self._last_frame_at = 0.0, None

    async def _live(self):
        pause = FIRST_PAUSE
        while not self._ending:
            try:
                async with _connect(self.url, self.token, self.node) as socket:
                    self._socket = socket
                    self.node = _cookie(socket) or self.node
                    pause = FIRST_PAUSE
                    await self._converse(socket)
                code = socket.close_code
            except (OSError, asyncio.TimeoutError, websockets.WebSocketException) as failure:
                code = getattr(self._socket, "close_code", None) if self.connected.is_set() else None
                self.last_failure = failure
            if self._ending:
                return
            if self.connected.is_set():
                self.losses.append(Loss(time.monotonic(), code))
            self.connected.clear()
            self._is_whole = False
            await asyncio.sleep(pause)
            pause = min(2 * pause, LONGEST_PAUSE)

    async def _converse(self, socket):
        reading = asyncio.create_task(self._read(socket))
        try:
            saying = asyncio.create_task(self._say_everything())
            await asyncio.wait({reading, saying}, return_when=asyncio.FIRST_COMPLETED)
            if saying.done() and not saying.cancelled():
                saying.result()
            await reading
        finally:
            saying.cancel()
            reading.cancel()
            await asyncio.gather(saying, reading, return_exceptions=True)

    async def _say_everything(self):
        view = self.view
        self._whole, self._shown_rev, self._shown_input = None, -1, 0
        self._sent_at.clear()
        hello = await self.call("hello", {"client": "replaying viewer"})
        self.viewer = hello["viewer"]
        await self._enter_session()
        if (await self.call("scene.list"))["current"] != view.scene:
            await self.call("scene.load", {"name": view.scene})
        await self.call("stream.configure", {"width": view.size[0], "height": view.size[1]})
        # Only a change causes a frame that shows it; otherwise the first frame is right.
        rev = sequence = 0
        present = (await self.call("settings.get"))["settings"]
        if not _holds(present, view.settings):
            rev = (await self.call("settings.patch", {"patch": view.settings}))["rev"]
        if not _holds(await self.call("camera.get"), view.camera()):
            await self._send_camera()
            sequence = self._sequence
        self._whole = (rev, sequence)
        self.connected.set()
        self._notice_whole(time.monotonic())

    async def _enter_session(self):
        """Joins its own session, and creates it if it is missing, as on another node."""
        try:
            await self.call("session.create", {"name": self.session})
        except RuntimeError as exists:
            if "-32601" in str(exists):
                return  # a server that has one session only
            self.last_failure = exists
        await self.call("session.join", {"session": self.session})

    async def _send_camera(self):
        self._sequence += 1
        self._sent_at[self._sequence] = time.monotonic()
        await self.call("camera.set", {**self.view.camera(), "seq": self._sequence})

    async def _read(self, socket):
        try:
            async for message in socket:
                if isinstance(message, bytes):
                    await self._receive_frame(socket, message)
                else:
                    answer = json.loads(message)
                    waiting = self._answers.pop(answer.get("id"), None)
                    if waiting and not waiting.done():
                        waiting.set_result(answer)
        finally:
            for waiting in self._answers.values():
                waiting.cancel()
            self._answers.clear()

    def _notice_whole(self, now):
        if self._is_whole or self._whole is None:
            return
        rev, sequence = self._whole
        if self._shown_rev < rev or self._shown_input < sequence:
            return
        self._is_whole = True
        if self.losses and self.losses[-1].back_at is None:
            self.losses[-1].back_at = now

    async def _receive_frame(self, socket, message):
        header_bytes, = struct.unpack_from("<H", message, 8)
        frame, = struct.unpack_from("<I", message, 12)
        echo, = struct.unpack_from("<I", message, 20)
        rev, = struct.unpack_from("<I", message, 24)
        now = time.monotonic()
        self.frames += 1
        self.last_image = message[header_bytes:]
        if self._last_frame_at is not None:
            self.longest_gap = max(self.longest_gap, now - self._last_frame_at)
        self._last_frame_at = now
        for sequence in [number for number in self._sent_at if number <= echo]:
            self.round_trips.append(now - self._sent_at.pop(sequence))
        self._shown_rev, self._shown_input = max(self._shown_rev, rev), max(self._shown_input, echo)
        self._notice_whole(now)
        await socket.send(json.dumps({"jsonrpc": "2.0", "method": "stream.ack",
                                      "params": {"frame_seq": frame}}))


def _holds(present, expected):
    """Whether `present` contains every member of `expected`; numbers within a tolerance."""
    if isinstance(expected, dict):
        return all(name in present and _holds(present[name], value)
                   for name, value in expected.items())
    if isinstance(expected, list):
        return len(present) == len(expected) and all(map(_holds, present, expected))
    if isinstance(expected, float) or isinstance(present, float):
        return abs(present - expected) < 1e-4
    return present == expected


def _connect(url, token, node):
    shown = base64.urlsafe_b64encode(token.encode()).decode().rstrip("=")
    headers = {"Cookie": node} if node else {}
    name = "extra_headers" if int(websockets.__version__.split(".", maxsplit=1)[0]) < 14 \
        else "additional_headers"
    return websockets.connect(
        url.replace("http://", "ws://") + "ws", max_size=None, compression=None,
        subprotocols=[SUBPROTOCOL, f"{SUBPROTOCOL}.token.{shown}"], open_timeout=5, close_timeout=1,
        ping_interval=None, **{name: headers})


def _cookie(socket):
    """The balancer's cookies, to send when reconnecting."""
    response = getattr(socket, "response", None)
    headers = response.headers if response is not None else socket.response_headers
    given = headers.get("Set-Cookie")
    return given.split(";")[0] if given else None


if sys.version_info < (3, 10):
    raise ImportError("Python 3.10 or newer is needed")
