"""Images without a server of one's own: by the local program, or by a server that has jobs."""

from __future__ import annotations

import contextlib
import json
import os
import re
import shutil
import subprocess
import tempfile
import time
import urllib.error
import urllib.parse
import urllib.request
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

ENDED = ("done", "partial", "failed", "canceled")
StrPath = str | os.PathLike[str]


class RenderError(Exception):
    """An image or a job that failed; the text says why."""


def find_program() -> str:
    """The path of the program `heliograph`: that of the variable HELIOGRAPH_BINARY, else one in
    PATH, else that of a build folder around this package."""
    named = os.environ.get("HELIOGRAPH_BINARY") or shutil.which("heliograph")
    built = Path(__file__).resolve().parents[3] / "build" / "bin" / "heliograph"
    if not named and built.is_file():
        named = str(built)
    if not named:
        raise RenderError("there is no program heliograph: set HELIOGRAPH_BINARY to its path, or pass the address of "
                          "a server as url")
    return named


def _last_line(text: str) -> str:
    lines = text.strip().splitlines()
    return lines[-1].removeprefix("heliograph: ") if lines else "the program failed without a word"


def _render_here(entry: dict[str, Any], output: StrPath) -> None:
    """By the program `heliograph render`, which needs no server."""
    entry["scene"] = str(Path(entry["scene"]).absolute())
    entry["output"] = str(Path(output).absolute())
    done = subprocess.run([find_program(), "render", "--manifest", "-", "--progress", "none"],
                          input=json.dumps([entry]), capture_output=True, text=True, check=False)
    if done.returncode != 0:
        raise RenderError(_last_line(done.stderr))


class _Api:
    """HTTP requests to a server."""

    def __init__(self, url: str, token: str | None):
        self.url = url.rstrip("/")
        self.headers = {"Authorization": "Bearer " + token} if token else {}

    def request(self, method: str, path: str, body: bytes | None = None) -> bytes:
        request = urllib.request.Request(self.url + path, data=body, method=method, headers=self.headers)
        try:
            with urllib.request.urlopen(request, timeout=60) as answer:
                return answer.read()
        except urllib.error.HTTPError as refused:
            raise RenderError(refused.read().decode(errors="replace").strip()) from refused
        except urllib.error.URLError as unreachable:
            raise RenderError(f"there is no server at {self.url}: {unreachable.reason}") from unreachable

    def json(self, method: str, path: str, body: Any = None) -> Any:
        return json.loads(self.request(method, path, None if body is None else json.dumps(body).encode()))


def _render_there(api: _Api, entry: dict[str, Any], output: Path, timeout: float) -> None:
    """By a job of a server; a scene that is a file here is uploaded first."""
    scene = Path(entry["scene"])
    if scene.is_file():
        name = re.sub(r"[^\w-]", "_", scene.stem)
        api.request("PUT", "/api/v1/scenes/" + urllib.parse.quote(name), scene.read_bytes())
        entry["scene"] = name
    entry["output"] = output.name
    job = api.json("POST", "/api/v1/jobs", {"entries": [entry]})
    deadline = time.monotonic() + timeout
    while job["state"] not in ENDED:
        if time.monotonic() > deadline:
            api.json("DELETE", "/api/v1/jobs/" + job["job"])
            raise RenderError(f"the job was not done in {timeout} s")
        time.sleep(0.1)
        job = api.json("GET", "/api/v1/jobs/" + job["job"])
    if job["state"] != "done":
        reasons = [failure["reason"] for failure in job["failures"]]
        raise RenderError("; ".join(reasons) or "the job was canceled")
    for file in job["files"]:
        (output.parent / file["name"]).write_bytes(api.request("GET", file["url"]))


def render(scene: StrPath, output: StrPath, *, url: str | None = None, token: str | None = None,
           timeout: float = 3600.0, settings: Mapping[str, Any] | None = None, **members: Any) -> None:
    """Renders a scene into a file: render("helmet.glb", "helmet.png", width=512).

    With `url`, or the variable HELIOGRAPH_URL, by a server that has jobs; its `token` may be in HELIOGRAPH_TOKEN. Then
    `scene` is a name of its catalogue, or a file to upload. Otherwise by the local program, and no server is left.
    `members` are those of an entry of a manifest: width, height, camera, view, turntable, clip, samples, background and
    so on. Raises RenderError.
    """
    entry: dict[str, Any] = {"scene": str(scene), **members}
    if settings is not None:
        entry["settings"] = dict(settings)
    url = url or os.environ.get("HELIOGRAPH_URL")
    if not url:
        return _render_here(entry, output)
    return _render_there(_Api(url, token or os.environ.get("HELIOGRAPH_TOKEN")), entry, Path(output), timeout)


def _address_of(server: subprocess.Popen[str], log: Any) -> str:
    assert server.stdout
    for line in server.stdout:
        if line.startswith("listening on "):
            return line.split()[-1]
    server.wait()
    log.seek(0)
    raise RenderError(_last_line(log.read()))


@contextlib.contextmanager
def serve(*roots: StrPath, options: Mapping[str, Any] | None = None) -> Iterator[str]:
    """Starts a server of these folders on this machine, and stops it at the end. Gives its address:

        with heliograph.serve("models") as url, heliograph.connect(url) as view: ...

    `options` are those of `heliograph serve`: {"scene": "helmet", "max-viewers": 4}.
    """
    command = [find_program(), "serve", "--port", "0"]
    for root in roots:
        command += ["--scene-root", os.fspath(root)]
    for name, value in (options or {}).items():
        command += ["--" + name, str(value)]
    with tempfile.TemporaryFile(mode="w+") as log:
        server = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=log, text=True)
        try:
            yield _address_of(server, log)
        finally:
            server.terminate()
            try:
                server.wait(timeout=10)
            except subprocess.TimeoutExpired:
                server.kill()
                server.wait()
            if server.stdout:
                server.stdout.close()
