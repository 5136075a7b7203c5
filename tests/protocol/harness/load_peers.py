"""Peers that are slow or dead at every point of a connection."""

import asyncio
import contextlib
import json
import socket
import struct

from harness.load_socket import LoadSocket
from harness.raw_socket import TEXT, RawSocket, frame

HELLO = frame(TEXT, json.dumps({"jsonrpc": "2.0", "id": 1, "method": "hello",
                                "params": {"client": "dead"}}).encode())
SMALL_BUFFER = 4096  # bytes
LATE = 1.0  # seconds


def silent(server, _):
    return RawSocket(server)


def half_a_head(server, _):
    raw = RawSocket(server)
    raw.send(f"GET / HTTP/1.1\r\nHost: {server.host}:{server.port}\r\nX-Half: ".encode())
    return raw


def half_a_body(server, _):
    raw = RawSocket(server)
    raw.send(f"POST /rpc HTTP/1.1\r\nHost: {server.host}:{server.port}\r\n"
             "Content-Length: 1000\r\n\r\n{".encode())
    return raw


def no_greeting(server, session):
    raw = RawSocket(server)
    raw.upgrade(f"/ws?session={session}")
    return raw


def half_a_message(server, session):
    raw = no_greeting(server, session)
    raw.send(frame(TEXT, b'{"jsonrpc"', length=1000))
    return raw


def no_acknowledgement(server, session):
    raw = RawSocket(server, receive_buffer=1 << 20)
    raw.upgrade(f"/ws?session={session}")
    raw.send(HELLO)
    return raw


def nothing_read(server, session):
    raw = RawSocket(server, receive_buffer=SMALL_BUFFER)
    raw.upgrade(f"/ws?session={session}")
    raw.send(HELLO)
    return raw


def stream_not_read(server, session):
    raw = RawSocket(server, receive_buffer=SMALL_BUFFER)
    raw.send(f"GET /api/v1/sessions/{session}/stream.mjpg HTTP/1.1\r\n"
             f"Host: {server.host}:{server.port}\r\n\r\n".encode())
    return raw


# Those that receive frames of the session, or would.
VIEWERS = (no_greeting, half_a_message, no_acknowledgement, nothing_read, stream_not_read)
DEAD = (silent, half_a_head, half_a_body, *VIEWERS)
# One acknowledges late, one comes and resets its connection, again and again.
PLACES = len(VIEWERS) + 2


async def come_and_reset(server, session):
    reset = struct.pack("ii", 1, 0)  # SO_LINGER: the connection ends with RST
    while True:
        def visit():
            with nothing_read(server, session) as raw:
                raw.socket.setsockopt(socket.SOL_SOCKET, socket.SO_LINGER, reset)
        with contextlib.suppress(OSError):
            await asyncio.to_thread(visit)
        await asyncio.sleep(0.1)


@contextlib.asynccontextmanager
async def surround(server, session):
    """All of them are there. Gives the one that is only late."""
    dead = [await asyncio.to_thread(peer, server, session) for peer in DEAD]
    late = await LoadSocket.open(server, session)
    late.acknowledge_after = LATE
    resetting = asyncio.create_task(come_and_reset(server, session))
    try:
        yield late
    finally:
        resetting.cancel()
        with contextlib.suppress(asyncio.CancelledError):
            await resetting
        late.abort()
        for raw in dead:
            raw.socket.close()
