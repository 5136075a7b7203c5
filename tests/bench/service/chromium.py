"""The same work as a headless browser does it: three.js, in software."""

import functools
import http.server
import json
import os
import shutil
import subprocess
import threading

from measures import Unavailable


class Handler(http.server.SimpleHTTPRequestHandler):
    """Files of several folders: the page, the package three, the models."""

    folders = {}

    def translate_path(self, path):
        first, _, rest = path.split("?")[0].lstrip("/").partition("/")
        folder = self.folders.get(first)
        return os.path.join(folder, os.path.normpath("/" + rest).lstrip("/")) if folder else "/nowhere"

    def log_message(self, *_):  # pylint: disable=arguments-differ
        pass


class Chromium:
    """Installs three.js into a folder at the first use, and serves it with the models."""

    def __init__(self, folder, here):
        self.folder, self.here = os.path.join(folder, "three"), here
        self.server = None

    def __enter__(self):
        return self

    def __exit__(self, *_):
        if self.server:
            self.server.shutdown()
            self.server.server_close()

    @functools.cached_property
    def program(self):
        for name in ("chromium", "chromium-browser", "google-chrome"):
            if shutil.which(name):
                return shutil.which(name)
        raise Unavailable("there is no Chromium")

    @functools.cached_property
    def base(self):
        """The address of the server."""
        if not shutil.which("npm"):
            raise Unavailable("there is no npm")
        os.makedirs(self.folder)
        done = subprocess.run(["npm", "install", "--prefix", self.folder, "--no-audit", "--no-fund", "three",
                               "playwright-core"], check=False, capture_output=True, text=True)
        if done.returncode:
            raise Unavailable("npm cannot install three")
        Handler.folders = {"page": self.here, "three": os.path.join(self.folder, "node_modules", "three"), "models": "/"}
        self.server = http.server.ThreadingHTTPServer(("127.0.0.1", 0), Handler)
        threading.Thread(target=self.server.serve_forever, daemon=True).start()
        return f"http://127.0.0.1:{self.server.server_port}/"

    def run(self, work):
        """Seconds of each image, by one page that stays open."""
        program, base = self.program, self.base
        request = json.dumps({"browser": program, "base": base, **work})
        done = subprocess.run(["node", os.path.join(self.here, "three_images.mjs"), request], check=False,
                              capture_output=True, text=True,
                              env={**os.environ, "PLAYWRIGHT": os.path.join(self.folder, "node_modules", "playwright-core",
                                                                           "index.mjs")})
        if done.returncode:
            raise Unavailable(f"three.js failed: {done.stderr.strip().splitlines()[-1:]}")
        return json.loads(done.stdout)

    def median_of_images(self, models, views, size):
        seconds = sorted(self.run({"models": models, "views": views, "size": [size, size]}))
        return seconds[len(seconds) // 2]

    def screenshot(self, model, times):
        """From the start of the browser to its first image: median."""
        seconds = sorted(self.run({"models": [model], "views": [[30, 17]], "size": [512, 512], "cold": True})[0]
                         for _ in range(times))
        return seconds[len(seconds) // 2]
