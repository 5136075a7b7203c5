"""A live view of a session in notebooks.

With anywidget it can be dragged (notebook.js); with ipywidgets alone it is a live image; without
either, one image. All show the client's session, so that calls of the client are seen at once."""

import asyncio
import logging
import pathlib
import threading

log = logging.getLogger("heliograph")

CLOSES_WITHIN = 0.5  # seconds

MODULE = pathlib.Path(__file__).with_name("notebook.js")


class LiveFrames:
    """Frames of a session by a connection of their own, on a thread of their own, and movements of
    the camera. `show(frame)` is called for every frame until `close()`."""

    def __init__(self, client, show):
        self._client = client
        self._show = show
        self._closing = threading.Event()
        self._thread = threading.Thread(target=self._run, daemon=True)
        self._thread.start()

    @property
    def session(self):
        return self._client.info["session"]

    def receive(self, message):
        """Does what a message of notebook.js asks for."""
        camera = self._client.camera
        if message["kind"] == "orbit":
            camera.orbit(yaw=message["yaw"], pitch=message["pitch"])
        elif message["kind"] == "dolly":
            camera.orbit(dolly=message["factor"])
        elif message["kind"] == "fit":
            camera.fit()

    def close(self):
        self._closing.set()
        self._thread.join()
        self._client.close()

    def _run(self):
        while not self._closing.is_set():
            try:
                frame = self._client.next_frame(timeout=CLOSES_WITHIN)
            except asyncio.TimeoutError:  # nothing has changed
                continue
            except ConnectionError as ended:
                log.warning("the view of %s has ended: %s", self.session, ended)
                return
            try:
                self._show(frame)
            except Exception:
                log.exception("a frame could not be shown")


class StillView:
    """One image of the session, where neither anywidget nor ipywidgets is installed."""

    def __init__(self, client):
        self._client = client

    def _repr_png_(self):
        return self._client.capture(samples=1).data

    def close(self):
        self._client.close()


def _interactive_class():
    import anywidget
    import traitlets

    class InteractiveView(anywidget.AnyWidget):
        """A view that can be dragged."""

        _esm = MODULE
        frame = traitlets.Bytes().tag(sync=True)
        session = traitlets.Unicode().tag(sync=True)

        def __init__(self, client):
            super().__init__(session=client.info["session"])
            self._frames = LiveFrames(client, self._take)
            self.on_msg(lambda _, message, __: self._frames.receive(message))

        def _take(self, frame):
            self.frame = frame.data

        def close(self):
            self._frames.close()
            super().close()

    return InteractiveView


def _live_class():
    import ipywidgets

    class LiveView(ipywidgets.Image):
        """A live image. The client's calls move its camera."""

        def __init__(self, client):
            super().__init__(format="jpeg")
            self._frames = LiveFrames(client, self._take)

        def _take(self, frame):
            self.value = frame.data

        def close(self):
            self._frames.close()
            super().close()

    return LiveView


def create_widget(client):
    """The best view that the installed packages allow. It owns `client` and closes it."""
    for make_class in (_interactive_class, _live_class):
        try:
            return make_class()(client)
        except ImportError:
            continue
    return StillView(client)
