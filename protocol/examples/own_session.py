"""Shared by the example programs: options of the connection, and a session of their own."""

import contextlib
import os
import ssl

import heliograph

IDLE_TIMEOUT = 30  # seconds without viewers and calls


def add_options(parser):
    parser.add_argument("--url", default="http://127.0.0.1:8080")
    parser.add_argument("--token", default=os.environ.get("HELIOGRAPH_TOKEN"),
                        help="the server's token; default: the variable HELIOGRAPH_TOKEN")
    parser.add_argument("--tls-ca", metavar="FILE", 
                        help="certificates to trust in addition to the system's")
    parser.add_argument("--session", help="an existing session, whose changes remain; default: "
                                          "a session of its own, closed at the end")


def connect(options):
    trust = ssl.create_default_context() if options.tls_ca else None
    if trust:
        trust.load_verify_locations(options.tls_ca)
    return heliograph.connect(options.url, session=options.session, token=options.token, ssl=trust)


def set_samples(view, samples):
    """Lets a static view accumulate this many samples per pixel, for captures to wait for."""
    view.settings.patch(patch={"accumulation": {"enabled": True, "max_samples": samples}})


@contextlib.contextmanager
def open_view(options, width, height, scene=None):
    """A client in a session of this size that shows the scene, or the scene of main."""
    with connect(options) as view:
        if options.session:
            if scene:
                view.scene.load(name=scene)
            view.stream.configure(width=width, height=height)
            yield view
            return
        shown = {"scene": scene} if scene else {"copy_of": "main"}
        own = view.session.create(width=width, height=height, idle_timeout=IDLE_TIMEOUT, **shown)["name"]
        try:
            view.session.join(session=own)
            yield view
        finally:
            # If the connection was lost, or the program killed, it ends after its idle timeout.
            with contextlib.suppress(ConnectionError):
                view.session.close(session=own)
