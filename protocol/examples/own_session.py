"""What the other programs here share: how to reach a server, and a session to work in."""

import contextlib
import os
import ssl

import heliograph


def add_options(parser):
    parser.add_argument("--url", default="http://127.0.0.1:8080")
    parser.add_argument("--token", default=os.environ.get("HELIOGRAPH_TOKEN"),
                        help="where the server asks for one; HELIOGRAPH_TOKEN if left out")
    parser.add_argument("--tls-ca", metavar="FILE", help="whom to trust besides the system's own")
    parser.add_argument("--session", help="where to work, and to leave what was changed; if left "
                                          "out, one of its own that ends with the program")


def connect(options):
    trust = ssl.create_default_context() if options.tls_ca else None
    if trust:
        trust.load_verify_locations(options.tls_ca)
    return heliograph.connect(options.url, session=options.session, token=options.token, ssl=trust)


def gather(view, samples):
    """Lets pictures at rest have so many samples per pixel, for captures to wait for."""
    view.settings.patch(patch={"accumulation": {"enabled": True, "max_samples": samples}})


@contextlib.contextmanager
def open_view(options, width, height, scene=None):
    """A client in a session of this size that shows the scene, or what main shows."""
    with connect(options) as view:
        if options.session:
            if scene:
                view.scene.load(name=scene)
            view.stream.configure(width=width, height=height)
            yield view
            return
        shown = {"scene": scene} if scene else {"copy_of": "main"}
        own = view.session.create(width=width, height=height, **shown)["name"]
        try:
            view.session.join(session=own)
            yield view
        finally:
            # Without a connection it ends by itself, when nobody has been there for a while.
            with contextlib.suppress(ConnectionError):
                view.session.close(session=own)
