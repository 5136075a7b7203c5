"""Images at other sizes, from other cameras and backgrounds than what viewers see."""

import re
import unittest

from harness.images import decode_png, difference
from harness.server import Server, ServerTestCase

IMAGE = "/api/v1/sessions/main/frame.png"


class Snapshots(ServerTestCase):
    def image(self, query=""):
        status, _, body = self.server.get(IMAGE + query)
        self.assertEqual(status, 200, body[:200])
        return decode_png(body)

    def size(self, query):
        image = self.image(query)
        return image.width, image.height

    def sessions(self):
        return [session["name"] for session in self.server.call("session.list")["sessions"]]

    def test_sizes(self):
        self.assertEqual(self.size(""), (160, 90))
        self.assertEqual(self.size("?width=64&height=48"), (64, 48))
        self.assertEqual(self.size("?width=320"), (320, 180))
        self.assertEqual(self.size("?height=45&samples=1"), (80, 45))

    def test_cameras_and_background(self):
        self.server.call("camera.set", {"eye": [3, 3, 3]})
        shown = self.image()
        by_name = self.image("?camera=main")
        self.assertGreater(difference(shown, by_name), 3)
        self.assertLess(difference(by_name, self.image("?camera=1")), 1)
        fitted = self.image("?fit")
        self.assertGreater(difference(fitted, shown), 3)
        self.assertLess(difference(fitted, self.image("?fit=true")), 1)
        self.assertLess(difference(shown, self.image("?fit=0")), 1)
        dark = self.image("?background=0")
        corner = dark.rgb[:3]
        self.assertEqual(corner, b"\0\0\0")
        self.assertNotEqual(shown.rgb[:3], corner)

    def test_transparent_images_have_coverage(self):
        status, headers, body = self.server.get(IMAGE + "?transparent=1&samples=4")
        self.assertEqual((status, headers["content-type"]), (200, "image/png"))
        color_type = body[25]
        self.assertEqual(color_type, 6, "red, green, blue and alpha")
        self.server.wait_for(lambda: self.sessions() == ["main"], "the end of the copy")
        for address in (IMAGE + "?transparent=1&buffer=skybox",
                        "/api/v1/sessions/main/frame.jpg?transparent=1"):
            status, _, body = self.server.get(address)
            self.assertEqual((status, b"frame.png of output" in body), (400, True), address)

    def test_the_session_and_its_viewers_do_not_notice(self):
        state = [self.server.call(method) for method in ("camera.get", "session.info")]
        self.image("?width=48&camera=main&background=0")
        self.server.get(IMAGE + "?camera=nowhere")
        again = [self.server.call(method) for method in ("camera.get", "session.info")]
        for one, other in zip(state, again):
            one.pop("idle_seconds", None), other.pop("idle_seconds", None)
            self.assertEqual(one, other)
        self.server.wait_for(lambda: self.sessions() == ["main"], "the end of the copies")

    def test_mistakes_in_the_query_are_refused(self):
        for query, status, told in (
                ("?sampels=3", 400, b"did you mean samples"), ("?widht=3", 400, b"mean width"),
                ("?width=15", 400, b"16"), ("?height=x", 400, b"integer"),
                ("?fit=maybe", 400, b"0 or 1"), ("?camera=nowhere", 404, b"no such camera"),
                ("?camera=mian", 404, b"did you mean main"), ("?camera=0", 404, b"camera"),
                ("?token=x", 400, b"not a parameter")):
            answer = self.server.get(IMAGE + query)
            self.assertEqual(answer[0], status, query)
            self.assertIn(told, answer[2], query)
        self.assertEqual(self.server.get(IMAGE + "?session=main&enter=main&samples=1")[0], 200)
        status, _, body = self.server.get("/api/v1/sessions/main/stream.mjpg?qualty=3")
        self.assertEqual(status, 400)
        self.assertIn(b"did you mean quality", body)


class LimitedSnapshots(unittest.TestCase):
    def test_limits_hold_for_copies(self):
        with Server("--max-sessions", "1") as server:
            status, headers, body = server.get(IMAGE + "?width=64")
            self.assertEqual(status, 503, body)
            self.assertEqual(server.get(IMAGE)[0], 200)

    def test_read_only_tokens_see_what_viewers_see(self):
        with Server("--token", "control-secret", "--view-token", "viewing-secret",
                    "--allow-host", "localhost") as server:
            server.headers = {"Authorization": "Bearer viewing-secret"}
            self.assertEqual(server.get(IMAGE)[0], 200)
            status, _, body = server.get(IMAGE + "?width=64")
            self.assertEqual(status, 403)
            self.assertIn(b"read-only", body)
            server.headers = {"Authorization": "Bearer control-secret"}
            self.assertEqual(server.get(IMAGE + "?width=64")[0], 200)
            self.assertIsNone(re.search("control-secret", server.log_text()))
