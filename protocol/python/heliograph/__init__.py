"""Client of the Heliograph render server: heliograph.v1 over one WebSocket.

    import heliograph

    with heliograph.connect("http://127.0.0.1:8080") as view:
        view.scene.load(name="atrium")
        view.camera.orbit(yaw=20)
        view.capture().save("atrium.png")
        depth = view.array("gbuffer.motion.view_z")      # NumPy

`connect` is for scripts and notebooks, `connect_async` for asyncio. Every method of the protocol is
a method here, under the same name; capture, array, step, next_frame and listen add waiting, decoding
and frames. Needs python3-websockets; NumPy only for arrays.
"""

from .client import AsyncClient, Client, connect, connect_async
from .errors import HeliographError
from .images import Capture, Depth, Frame

__all__ = ["AsyncClient", "Capture", "Client", "Depth", "Frame", "HeliographError", "connect",
           "connect_async"]
