"""One WebSocket of heliograph.v1: calls with answers, notifications, frames. asyncio."""

import asyncio
import base64
import collections
import json
import logging
import urllib.parse
from ssl import SSLError

import websockets

from .errors import HeliographError
from .frame_stream import FrameStream
from .images import Frame

SUBPROTOCOL = "heliograph.v1"
# Slightly more than the server's timeout of captures.
CALL_TIMEOUT = 310  # seconds

log = logging.getLogger("heliograph")


def websocket_address(url, session):
    """"http://host:8080/" or "host:8080" -> "ws://host:8080/ws?session=main"."""
    if "://" not in url:
        url = "http://" + url
    parts = urllib.parse.urlsplit(url)
    scheme = {"http": "ws", "https": "wss", "ws": "ws", "wss": "wss"}[parts.scheme]
    query = urllib.parse.urlencode({"session": session}) if session else ""
    return urllib.parse.urlunsplit((scheme, parts.netloc, "/ws", query, ""))


def offered_subprotocols(token):
    """The token is a second subprotocol, so that it is in no address and no log."""
    if not token:
        return [SUBPROTOCOL]
    encoded = base64.urlsafe_b64encode(token.encode()).decode().rstrip("=")
    return [SUBPROTOCOL, f"{SUBPROTOCOL}.token.{encoded}"]


class Connection:
    """Lives as long as its socket: exceptions of listeners are logged."""

    def __init__(self, socket, url):
        self.url = url
        self._socket = socket
        self._answers = {}
        self._next_id = 0
        self._listeners = collections.defaultdict(list)
        self.ended = None  # why, once the connection has ended
        self.frames = FrameStream(self)
        self._reader = asyncio.ensure_future(self._read())

    @classmethod
    async def open(cls, url, *, session=None, token=None, ssl=None, timeout=30):
        options = {"ssl": ssl} if ssl else {}
        try:
            socket = await asyncio.wait_for(
                websockets.connect(websocket_address(url, session), max_size=None, compression=None,
                                   subprotocols=offered_subprotocols(token), **options), timeout)
        except SSLError:
            raise
        except (OSError, asyncio.TimeoutError) as error:
            reason = getattr(error, "strerror", None) or str(error) or "it took too long"
            raise ConnectionError(
                f"no server answers at {url}: {reason}; heliograph serve starts one") from error
        return cls(socket, url)

    async def close(self):
        await self._socket.close()
        await self._reader

    def check(self):
        """Raises ConnectionError if the connection has ended."""
        if self.ended:
            raise ConnectionError(self.ended)

    async def call(self, method, params, timeout=CALL_TIMEOUT):
        """Returns the result. Raises HeliographError if the server refuses, ConnectionError if the
        connection has ended."""
        self.check()
        self._next_id += 1
        number = self._next_id
        answer = self._answers[number] = asyncio.get_running_loop().create_future()
        try:
            await self._send({"jsonrpc": "2.0", "id": number, "method": method, "params": params})
            result = await asyncio.wait_for(answer, timeout)
        finally:
            self._answers.pop(number, None)
        if method.startswith("stream.") and "paused" in result:
            self.frames.paused = result["paused"]
        return result

    async def notify(self, method, params):
        """A call without an answer."""
        await self._send({"jsonrpc": "2.0", "method": method, "params": params})

    def listen(self, method, callback):
        """Calls `callback(params)` for every notification of that name. Returns a function that
        removes the listener."""
        self._listeners[method].append(callback)
        return lambda: self._listeners[method].remove(callback)

    async def _send(self, message):
        try:
            await self._socket.send(json.dumps(message))
        except websockets.ConnectionClosed as closed:
            raise ConnectionError(str(closed)) from closed

    async def _read(self):
        ended = "the connection was lost"
        try:
            async for message in self._socket:
                self._receive(message)
            ended = "the server closed the connection"
        except websockets.ConnectionClosed as closed:
            ended = str(closed)
        finally:
            self.ended = ended
            self._fail_all(lambda: ConnectionError(ended))
            self.frames.end()

    def _fail_all(self, error):
        for answer in self._answers.values():
            if not answer.done():
                answer.set_exception(error())

    def _receive(self, message):
        try:
            if isinstance(message, str):
                self._take(json.loads(message))
            else:
                self.frames.put(Frame.parse(message))
        except Exception:
            log.exception("a message of the server could not be parsed")

    def _take(self, message):
        if "method" in message:
            self._tell(message["method"], message.get("params", {}))
        elif "error" in message and message.get("id") is None:
            # The id could not be read: fail all pending calls, or one would wait for its timeout.
            self._fail_all(lambda: HeliographError(message["error"]))
        else:
            self._answer(message)

    def _tell(self, method, params):
        for callback in list(self._listeners[method]):
            try:
                callback(params)
            except Exception:
                log.exception("a listener to %s failed", method)

    def _answer(self, message):
        answer = self._answers.get(message["id"])
        if answer is None or answer.done():
            return
        if "error" in message:
            answer.set_exception(HeliographError(message["error"]))
        else:
            answer.set_result(message["result"])
