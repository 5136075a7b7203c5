"""The public clients: with asyncio, or without."""

import asyncio
import threading

from .connection import Connection
from .methods import Methods
from .images import Capture
from .widget import create_widget


def _description(client, connection):
    if connection.ended:
        return f"<heliograph.{type(client).__name__} of {connection.url}, closed>"
    return (f"<heliograph.{type(client).__name__} of {connection.url}, session "
            f"{client.info['session']}, {client.info['device']['name']}>")


class AsyncClient(Methods):
    """A viewer in a session. Every method of the protocol is one of its own or of its groups:
    `await client.camera.orbit(yaw=15)`. Frames are streamed only while `next_frame` is called; a
    client that does not call it may stay connected for any time."""

    def __init__(self, connection):
        super().__init__(self._call)
        self._connection = connection
        self.info = None  # the result of hello

    def __repr__(self):
        return _description(self, self._connection)

    async def _call(self, method, params):
        return await self._connection.call(method, params)

    async def greet(self, name):
        self.info = await self.hello(client=name)
        await self._connection.frames.pause()

    async def capture(self, buffer="output", *, format="png", samples=None, marks=False):
        """One buffer as a file. Waits for this many samples per pixel, at most the setting
        accumulation.max_samples, which is also the default. `marks`: with the scene's measurements
        and annotations drawn over the image."""
        params = {"buffer": buffer, "format": format}
        if marks:
            params["marks"] = True
        if samples is not None:
            params["samples"] = samples
        return Capture.from_result(await self._call("frame.capture", params))

    async def array(self, buffer="output", *, samples=None):
        """One buffer as a NumPy array; frame.buffers describes its channels."""
        return (await self.capture(buffer, format="npy", samples=samples)).numpy()

    async def step(self, frames=1, dt=1 / 30):
        """Renders exactly this many frames, `dt` seconds apart. The session is in lockstep from the
        first call until `frame.run`: its time advances only with steps."""
        return await self._call("frame.step", {"frames": frames, "dt": dt})

    async def next_frame(self, timeout=60):
        """The newest frame of the stream that was not returned yet. The first call starts the
        stream. It pauses when frames arrive and this is not called for 2 s; the next call
        resumes it with the newest frame."""
        return await asyncio.wait_for(self._connection.frames.next(), timeout)

    async def stop_frames(self):
        """Pauses the stream."""
        await self._connection.frames.pause()

    def listen(self, notification, callback):
        """Calls `callback(params)` for every such notification. Returns a function that removes the
        listener. Exceptions of the callback are logged by the logger "heliograph"."""
        return self._connection.listen(notification, callback)

    async def close(self):
        await self._connection.close()

    async def __aenter__(self):
        return self

    async def __aexit__(self, *_):
        await self.close()


async def connect_async(url="http://127.0.0.1:8080", *, session=None, token=None, ssl=None,
                        name="python"):
    """A connection to the session of that name ("main" without one), as an AsyncClient.

    token: The token, if the server requires one.
    ssl: For https: an ssl.SSLContext in place of Python's default, for instance
        ssl.create_default_context(cafile="private-ca.pem").
    """
    connection = await Connection.open(url, session=session, token=token, ssl=ssl)
    client = AsyncClient(connection)
    try:
        await client.greet(name)
    except BaseException:
        await connection.close()
        raise
    return client


class Client(Methods):
    """The same without asyncio, which runs in a background thread: `client.camera.orbit(yaw=15)`.
    In a notebook a client at the end of a cell is shown as an image."""

    def __init__(self, url, options):
        super().__init__(self._call)
        self._url, self._options = url, options
        self._loop = asyncio.new_event_loop()
        self._thread = threading.Thread(target=self._loop.run_forever, daemon=True)
        self._thread.start()
        try:
            self._client = self._run(connect_async(url, **options))
        except BaseException:
            self._end_thread()
            raise

    def __repr__(self):
        return _description(self, self._client._connection)

    @property
    def info(self):
        """The result of hello."""
        return self._client.info

    def capture(self, buffer="output", *, format="png", samples=None, marks=False):
        """See AsyncClient.capture."""
        return self._run(self._client.capture(buffer, format=format, samples=samples, marks=marks))

    def array(self, buffer="output", *, samples=None):
        """See AsyncClient.array."""
        return self._run(self._client.array(buffer, samples=samples))

    def step(self, frames=1, dt=1 / 30):
        """See AsyncClient.step."""
        return self._run(self._client.step(frames, dt))

    def next_frame(self, timeout=60):
        """See AsyncClient.next_frame."""
        return self._run(self._client.next_frame(timeout))

    def stop_frames(self):
        """See AsyncClient.stop_frames."""
        self._run(self._client.stop_frames())

    def listen(self, notification, callback):
        """See AsyncClient.listen. The callback runs in the background thread and cannot call this
        client: that thread receives the answers."""
        return self._client.listen(notification, callback)

    def widget(self):
        """A live view of this session for notebooks, with a connection of its own: with anywidget
        it can be dragged, with ipywidgets it is a live image, without either one image."""
        options = {**self._options, "session": self.info["session"], "name": "notebook"}
        return create_widget(Client(self._url, options))

    def close(self):
        if self._thread.is_alive():
            self._run(self._client.close())
            self._end_thread()

    def _repr_png_(self):
        return self.capture(samples=1).data

    def _call(self, method, params):
        return self._run(self._client._call(method, params))

    def _run(self, work):
        if threading.current_thread() is self._thread:
            work.close()
            raise RuntimeError("a listener cannot call its own client: call from another thread")
        return asyncio.run_coroutine_threadsafe(work, self._loop).result()

    def _end_thread(self):
        self._loop.call_soon_threadsafe(self._loop.stop)
        self._thread.join()
        self._loop.close()

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.close()


def connect(url="http://127.0.0.1:8080", *, session=None, token=None, ssl=None, name="python"):
    """A connection to the session of that name ("main" without one), as a Client. See
    connect_async."""
    return Client(url, {"session": session, "token": token, "ssl": ssl, "name": name})
