"""deploy/balancer/nginx.conf: viewers, uploads, streams and downloads through a real nginx."""

import http.client
import os
import tempfile
import unittest

from harness.images import decode_png
from harness.proxies import Nginx, installed
from harness.server import ServerTestCase
from harness.viewer import Viewer


@unittest.skipUnless(installed("nginx"), "nginx is not installed")
class BehindNginx(ServerTestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        uploads = os.path.join(cls.folder.name, "uploads")
        os.mkdir(uploads)
        cls.arguments = ("--trust-proxy", "127.0.0.1", "--uploads", uploads)
        super().setUpClass()
        cls.direct = cls.server.port
        cls.nginx = Nginx(cls.folder.name, cls.direct)
        cls.server.port = cls.nginx.port

    @classmethod
    def tearDownClass(cls):
        cls.server.port = cls.direct
        cls.nginx.stop()
        super().tearDownClass()

    async def test_a_viewer_gets_frames(self):
        async with Viewer(self.server) as viewer:
            self.assertEqual(viewer.hello["session"], "main")
            await viewer.next_frame()

    def test_images_come_as_from_the_server(self):
        status, _, image = self.server.get("/api/v1/sessions/main/frame.png?samples=1")
        self.assertEqual((status, decode_png(image).width), (200, 160))

    def test_a_stream_is_not_collected_first(self):
        connection = http.client.HTTPConnection("127.0.0.1", self.nginx.port, timeout=30)
        self.addCleanup(connection.close)
        connection.request("GET", "/api/v1/sessions/main/stream.mjpg")
        response = connection.getresponse()
        self.assertIn("multipart/x-mixed-replace", response.getheader("content-type"))
        self.assertIn(b"\xff\xd8", response.read(4096))

    def test_pages_of_its_own_origin_may_call(self):
        origin = f"http://127.0.0.1:{self.nginx.port}"
        status, _, _ = self.server.request("POST", "/rpc", b'{"jsonrpc":"2.0","id":1,"method":"hello"}',
                                           {"Content-Type": "application/json", "Origin": origin,
                                            "X-Forwarded-For": "203.0.113.7"})
        self.assertEqual(status, 200)
        status, _, _ = self.server.request("POST", "/rpc", b"{}", {"Origin": "http://elsewhere.example"})
        self.assertEqual(status, 403)

    def test_an_upload_arrives(self):
        with open(os.path.join(os.environ["HELIOGRAPH_SCENES"], "mirror.glb"), "rb") as file:
            status, _, answer = self.server.request("PUT", "/api/v1/scenes/through_nginx", file.read())
        self.assertEqual(status, 201, answer)
