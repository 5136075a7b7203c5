"""Client of the Heliograph render server: heliograph.v1 over one WebSocket.

    import heliograph

    with heliograph.connect("http://127.0.0.1:8080") as view:
        view.scene.load(name="atrium")
        view.camera.orbit(yaw=20)
        view.capture().save("atrium.png")
        depth = view.array("gbuffer.motion.view_z")      # NumPy

    heliograph.render("helmet.glb", "helmet.png", width=512)      # without a server

`connect` is for scripts and notebooks, `connect_async` for asyncio. Every method of the protocol is
a method here, under the same name; capture, array, step, next_frame and listen add waiting, decoding
and frames. Needs python3-websockets; NumPy only for arrays.
"""

from .errors import HeliographError
from .local import RenderError, find_program, render, serve

try:
    from .client import AsyncClient, Client, connect, connect_async
    from .images import Capture, Depth, Frame
except ModuleNotFoundError as missing:
    if missing.name != "websockets":
        raise

    def __getattr__(name):
        """Connections need a package that is not installed; render() does not."""
        if name in ("AsyncClient", "Capture", "Client", "Depth", "Frame", "connect", "connect_async"):
            raise ImportError(f"heliograph.{name} needs the package websockets: install python3-websockets, or "
                              "websockets by pip")
        raise AttributeError(name)

__all__ = ["AsyncClient", "Capture", "Client", "Depth", "Frame", "HeliographError", "RenderError", "connect",
           "connect_async", "find_program", "render", "serve"]
