"""Uploads of scenes and environments: off by default, checked completely, stored atomically."""

import json
import os
import struct
import tempfile
import threading

from harness.gltf import document
from harness.raw_socket import RawSocket
from harness.server import Server, ServerTestCase

CONTROL, VIEW = "steering-0123456789", "watching-0123456789"
BEARER = {"Authorization": "Bearer " + CONTROL}
RADIANCE_HEADER = b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n"


def scene_file(name):
    with open(os.path.join(os.environ["HELIOGRAPH_SCENES"], name), "rb") as file:
        return file.read()


def glb(content, binary=b""):
    """A binary glTF of this JSON."""
    text = json.dumps(content).encode()
    text += b" " * (-len(text) % 4)
    chunks = struct.pack("<I4s", len(text), b"JSON") + text
    if binary:
        chunks += struct.pack("<I4s", len(binary), b"BIN\0") + binary
    return struct.pack("<4sII", b"glTF", 2, 12 + len(chunks)) + chunks


class Uploads(ServerTestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.mirror = scene_file("mirror.glb")
        cls.arguments = ("--uploads", cls.folder.name, "--token", CONTROL, "--view-token", VIEW,
                         "--max-upload-bytes", str(len(cls.mirror) + 1000),
                         "--upload-quota", str(2 * len(cls.mirror) + 2000))
        super().setUpClass()

    def setUp(self):
        for kind in ("scenes", "environments"):
            for name in os.listdir(os.path.join(self.folder.name, kind)):
                os.unlink(os.path.join(self.folder.name, kind, name))

    def put(self, name, body, token=CONTROL, kind="scenes"):
        status, _, answer = self.server.request("PUT", f"/api/v1/{kind}/{name}", body,
                                                {"Authorization": "Bearer " + token})
        return status, answer.decode()

    def catalogue(self):
        body = json.dumps({"jsonrpc": "2.0", "id": 1, "method": "scene.list"})
        _, _, answer = self.server.request("POST", "/rpc", body, BEARER)
        return [scene["name"] for scene in json.loads(answer)["result"]["scenes"]]

    def left_over(self):
        return [file for _, _, files in os.walk(os.path.join(self.folder.name, "incoming"))
                for file in files]

    def test_an_uploaded_scene_can_be_loaded(self):
        status, answer = self.put("my-scene_2", self.mirror)
        self.assertEqual(status, 201, answer)
        self.assertEqual(json.loads(answer)["bytes"], len(self.mirror))
        self.assertGreater(json.loads(answer)["triangles"], 0)
        self.assertIn("my-scene_2", self.catalogue())
        body = json.dumps({"jsonrpc": "2.0", "id": 1, "method": "scene.load",
                           "params": {"name": "my-scene_2"}})
        _, _, loaded = self.server.request("POST", "/rpc", body, BEARER)
        self.assertEqual(json.loads(loaded)["result"]["name"], "my-scene_2")
        self.assertEqual(self.put("my-scene_2", self.mirror)[0], 201, "it may be replaced")
        self.assertEqual(self.left_over(), [])

    def test_other_methods_and_paths_are_refused(self):
        for method in ("GET", "HEAD", "POST", "PATCH", "OPTIONS"):
            status, headers, _ = self.server.request(method, "/api/v1/scenes/mirror", None, BEARER)
            self.assertEqual((status, headers["allow"]), (405, "PUT, DELETE"), method)

    def test_names_cannot_leave_the_folder_or_replace_other_scenes(self):
        for name in ("..", "../x", "a/b", "%2e%2e%2fx", ".hidden", "a.glb", "x" * 65, "-rf"):
            self.assertIn(self.put(name, self.mirror)[0], (400, 404), name)
        self.assertEqual(self.put("mirror", self.mirror)[0], 409)
        self.assertEqual(os.listdir(os.path.join(self.folder.name, "scenes")), [])

    def test_invalid_scenes_are_refused(self):
        external, escape = (document([0, 0, 0, 1, 0, 0, 0, 1, 0], [0, 1, 2])[0] for _ in range(2))
        external["buffers"][0]["uri"] = "x.bin"
        escape["buffers"][0]["uri"] = "../../../etc/passwd"
        for body in (b"", b"glTF", b"nonsense" * 20, b"\x89PNG\r\n\x1a\n" + b"x" * 50,
                     self.mirror[:-10], self.mirror + b"tail", glb({}), glb(external), glb(escape),
                     b'{"asset":{"version":"2.0"}}', struct.pack("<4sII", b"glTF", 1, 12),
                     self.mirror[:2000] + b"\xff" * 500 + self.mirror[2500:2600]):
            status, answer = self.put("broken", body)
            self.assertEqual(status, 400, (body[:40], answer))
            self.assertNotIn(self.folder.name, answer, "paths of the server are not revealed")
        self.assertNotIn("broken", self.catalogue())
        self.assertEqual(self.left_over(), [])

    def environments(self):
        return self.server.call("environment.list")["environments"]

    def test_an_uploaded_environment_can_be_chosen_and_has_a_thumbnail(self):
        self.server.headers = BEARER
        self.addCleanup(setattr, self.server, "headers", {})
        panorama = RADIANCE_HEADER + b"-Y 4 +X 8\n" + bytes([80, 120, 200, 128]) * 32
        status, answer = self.put("my-sky", panorama, kind="environments")
        self.assertEqual(status, 201, answer)
        self.assertEqual(json.loads(answer), {"name": "my-sky", "bytes": len(panorama),
                                              "width": 8, "height": 4})
        self.assertIn("my-sky", [one["name"] for one in self.environments()])
        self.assertNotIn("my-sky", self.catalogue())
        self.server.call("environment.set", {"name": "my-sky"})
        self.server.call("environment.set", {"name": None})
        for name in ("my-sky", "studio"):
            address = f"/api/v1/environments/{name}/thumbnail.png"
            for headers in (BEARER, {"Authorization": "Bearer " + VIEW}):
                status, sent, image = self.server.request("GET", address, None, headers)
                self.assertEqual((status, sent["content-type"]), (200, "image/png"))
                self.assertEqual(struct.unpack(">II", image[16:24]), (160, 80))
        missing = self.server.request("GET", "/api/v1/environments/no/thumbnail.png")
        self.assertEqual(missing[0], 404)
        self.assertEqual(self.put("studio", panorama, kind="environments")[0], 409)

    def test_invalid_environments_are_refused(self):
        whole = RADIANCE_HEADER + b"-Y 4 +X 8\n" + bytes([80, 120, 200, 128]) * 32
        exr = struct.pack("<I", 20000630) + b"\2\0\0\0" + b"x" * 50
        for body in (self.mirror, whole[:-9], exr, b"#?RADIANCE\n\n-Y 9999 +X 9999\n" + b"x" * 90,
                     RADIANCE_HEADER + b"-Y 0 +X 0\n"):
            status, answer = self.put("broken", body, kind="environments")
            self.assertEqual(status, 400, (body[:40], answer))
            self.assertNotIn(self.folder.name, answer, "paths of the server are not revealed")
        for name in ("../x", "a.hdr", "%2e%2e%2fx"):
            self.assertIn(self.put(name, whole, kind="environments")[0], (400, 404), name)
        self.assertEqual(self.put("sky2", whole, VIEW, "environments")[0], 403)
        self.assertEqual(os.listdir(os.path.join(self.folder.name, "environments")), [])
        self.assertEqual(self.left_over(), [])

    def test_expect_100_continue(self):
        """As curl does for larger files, and then waits a second without a response."""
        expect = b"\r\nExpect: 100-continue\r\n\r\n"
        with RawSocket(self.server) as raw:
            raw.send(self.head("asked", len(self.mirror)).strip() + expect)
            self.assertEqual(raw.read_until(b"\r\n\r\n"), b"HTTP/1.1 100 Continue\r\n\r\n")
            raw.send(self.mirror)
            self.assertIn(b" 201 ", raw.read_until(b"\r\n"))
        with RawSocket(self.server) as raw:
            raw.send(self.head("asked", len(self.mirror) + 1001).strip() + expect)
            self.assertIn(b" 413 ", raw.read_until(b"\r\n"))
        call = json.dumps({"jsonrpc": "2.0", "id": 1, "method": "camera.get"}).encode()
        head = (f"POST /rpc HTTP/1.1\r\nHost: {self.server.host}:{self.server.port}\r\n"
                f"Authorization: Bearer {CONTROL}\r\nContent-Length: {len(call)}").encode()
        with RawSocket(self.server) as raw:
            raw.send(head + expect)
            self.assertEqual(raw.read_until(b"\r\n\r\n"), b"HTTP/1.1 100 Continue\r\n\r\n")
            raw.send(call)
            self.assertIn(b" 200 ", raw.read_until(b"\r\n"))

    def test_too_large_is_refused_before_it_is_sent(self):
        with RawSocket(self.server) as raw:
            raw.send(self.head("large", len(self.mirror) + 1001))
            self.assertIn(b" 413 ", raw.read_until(b"\r\n"))
        with RawSocket(self.server) as raw:
            raw.send(self.head("endless", None) + b"Transfer-Encoding: chunked\r\n\r\n")
            self.assertIn(b" 411 ", raw.read_until(b"\r\n"))

    def head(self, name, length):
        head = (f"PUT /api/v1/scenes/{name} HTTP/1.1\r\n"
                f"Host: {self.server.host}:{self.server.port}\r\n"
                f"Authorization: Bearer {CONTROL}\r\n")
        return (head + (f"Content-Length: {length}\r\n\r\n" if length is not None else "")).encode()

    def test_the_quota_counts_stored_and_incoming_bytes(self):
        self.assertEqual(self.put("one", self.mirror)[0], 201)
        with RawSocket(self.server) as raw:
            raw.send(self.head("half", len(self.mirror)) + self.mirror[:1000])
            self.server.wait_for(self.left_over, "the begin of the upload")
            self.assertEqual(self.put("three", self.mirror)[0], 503)
        self.server.wait_for(lambda: not self.left_over(), "the end of the broken upload")
        self.assertEqual(self.put("two", self.mirror)[0], 201)
        self.assertEqual(self.put("three", self.mirror)[0], 503)
        self.assertEqual(sorted(os.listdir(os.path.join(self.folder.name, "scenes"))),
                         ["one.glb", "two.glb"])

    def test_read_only_tokens_cannot_upload(self):
        self.assertEqual(self.put("mine", self.mirror[:500], VIEW)[0], 403)
        self.assertEqual(self.put("mine", self.mirror[:500], "wrong-token-1")[0], 401)
        status, _, _ = self.server.request("PUT", "/api/v1/scenes/mine", self.mirror[:500],
                                           {**BEARER, "Origin": "http://evil.example"})
        self.assertEqual(status, 403)
        self.assertEqual(self.catalogue().count("mine"), 0)

    def test_an_incomplete_upload_is_never_listed(self):
        seen = set()
        stop = threading.Event()

        def watch():
            while not stop.is_set():
                seen.update(self.catalogue())
        observer = threading.Thread(target=watch)
        observer.start()
        try:
            self.put("broken", self.mirror[:-10])
            with RawSocket(self.server) as raw:
                raw.send(self.head("half", len(self.mirror)) + self.mirror[:-1])
                self.server.wait_for(self.left_over, "the begin of the upload")
        finally:
            stop.set()
            observer.join()
        self.server.wait_for(lambda: not self.left_over(), "the end of the broken upload")
        self.assertFalse(seen & {"broken", "half"})


class NoUploads(ServerTestCase):
    def setUp(self):
        pass

    def test_are_the_default(self):
        status, _, _ = self.server.request("PUT", "/api/v1/scenes/x", b"glTF")
        self.assertEqual(status, 405)
        with RawSocket(self.server) as raw:
            raw.send(b"PUT /api/v1/scenes/x HTTP/1.1\r\nHost: 127.0.0.1\r\n"
                     b"Content-Length: 1000000\r\n\r\n")
            self.assertIn(b" 413 ", raw.read_until(b"\r\n"))

    def test_a_folder_that_cannot_be_written_is_named(self):
        with self.assertRaisesRegex(RuntimeError, "/proc/nowhere"):
            Server("--uploads", "/proc/nowhere")
