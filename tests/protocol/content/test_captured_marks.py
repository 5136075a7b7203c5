"""Measurements and annotations drawn over captures: where they are, and in which files."""

import base64
import math
import os
import shutil
import tempfile

from harness.images import Image, decode_png
from harness.models import Model
from harness.server import Server, ServerTestCase

IMAGE = "/api/v1/sessions/main/frame"
SEEN = 12  # of 255: what changes by more is drawn, not noise
PIN = 14  # pixels from its centre, at the heights of these images
# Of the label beside a pin with a short text, from the pin's centre.
LABEL = 60


def direction(a, b):
    length = math.dist(a, b)
    return [(y - x) / length for x, y in zip(a, b)]


def dot(a, b):
    return sum(x * y for x, y in zip(a, b))


def cross(a, b):
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


def project(camera, position, image):
    """Where a perspective camera shows a point, pixels from the top left corner."""
    forward = direction(camera["eye"], camera["target"])
    right = direction([0, 0, 0], cross(forward, camera["up"]))
    up = cross(right, forward)
    offset = [b - a for a, b in zip(camera["eye"], position)]
    scale = image.height / 2 / math.tan(math.radians(camera["vertical_fov"]) / 2)
    scale /= dot(offset, forward)
    return (image.width / 2 + scale * dot(offset, right),
            image.height / 2 - scale * dot(offset, up))


def changed(before: Image, after: Image):
    """The pixels that differ, as (column, row)."""
    assert (before.width, before.height) == (after.width, after.height)
    return [(i % before.width, i // before.width) for i in range(before.width * before.height)
            if any(abs(before.rgb[3 * i + c] - after.rgb[3 * i + c]) > SEEN for c in range(3))]


class CapturedMarks(ServerTestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        model = Model(os.path.join(os.environ["HELIOGRAPH_SCENES"], "furnace.glb"))
        mesh = next(node["mesh"] for node in model.json["nodes"] if "mesh" in node)
        ball = model.add_node(name="ball", mesh=mesh, translation=[6, 0, 0])
        model.add_clip("roll", ball, [0, 1], [[6, 0, 0], [6, 0, 2]])
        model.save(os.path.join(cls.folder.name, "balls.glb"))
        shutil.copy(os.path.join(os.environ["HELIOGRAPH_SCENES"], "mirror.glb"), cls.folder.name)
        cls.server = Server("--scene", "balls", scenes=cls.folder.name)

    def reset(self):
        super().reset()
        self.server.call("scene.load", {"name": "balls"})
        self.server.call("annotations.clear")
        self.server.call("measurements.clear")
        node = self.server.call("nodes.list", {"search": "ball"})["nodes"][0]["id"]
        self.server.call("camera.fit", {"nodes": [node]})
        answer = self.server.ask("frame.capture", {"marks": True, "samples": 1})
        if "cannot be drawn" in answer.get("error", {}).get("message", ""):
            self.skipTest(answer["error"]["message"])

    def capture(self, **params):
        answer = self.server.call("frame.capture", params)
        return decode_png(base64.b64decode(answer["data"]))

    def annotate(self, text="x"):
        point = self.server.call("scene.snap", {"x": 0.5, "y": 0.5, "radius": 0})
        return self.server.call("annotations.add", {
            "surface": point["surface"], "text": text})["annotations"][-1]

    def place(self, position, image):
        return project(self.server.call("camera.get"), position, image)

    def drawn(self):
        """The image without and the pixels that marks change in it."""
        before = self.capture()
        return before, changed(before, self.capture(marks=True))

    def assert_within(self, pixels, x, y, width, height):
        self.assertTrue(pixels, "nothing is drawn")
        outside = [(column, row) for column, row in pixels
                   if abs(column + 0.5 - x) > width or abs(row + 0.5 - y) > height]
        self.assertEqual(outside, [])

    def test_without_marks_nothing_changes(self):
        self.assertEqual(self.drawn()[1], [])
        self.annotate()
        image = self.capture()
        self.assertEqual(changed(image, self.capture(marks=False)), [])

    def test_annotations_are_at_their_place(self):
        one = self.annotate()
        image, pixels = self.drawn()
        x, y = self.place(one["position"], image)
        self.assert_within(pixels, x, y, LABEL, PIN)
        self.assertGreater(max(column for column, _ in pixels), x + PIN, "it has a label")

    def test_annotations_follow_the_pose_of_the_frame(self):
        self.annotate()
        self.server.call("animation.play", {"clip": "roll"})
        self.server.call("animation.pause")
        places = []
        for seconds in (0.0, 0.4):
            self.server.call("animation.seek", {"seconds": seconds})
            image, pixels = self.drawn()
            moved = self.server.call("annotations.list")["annotations"][0]
            places.append(self.place(moved["position"], image))
            if 0 < places[-1][0] < image.width and 0 < places[-1][1] < image.height:
                self.assert_within(pixels, *places[-1], LABEL, PIN)
            else:
                self.assertEqual(pixels, [])
        self.assertGreater(math.dist(*places), 2)

    def test_hidden_annotations_are_faint_and_have_no_label(self):
        one = self.annotate("A longer text, for the label")
        before = self.capture()
        after = self.capture(marks=True)
        strongest = self.contrast(before, after)
        camera = self.server.call("camera.get")
        behind = [2 * target - eye for eye, target in zip(camera["eye"], camera["target"])]
        self.server.call("camera.set", {"eye": behind})
        self.assertEqual(self.server.call("annotations.hidden")["hidden"], [one["id"]])
        before, pixels = self.drawn()
        x, y = self.place(one["position"], before)
        self.assert_within(pixels, x, y, PIN, PIN)
        self.assertLess(self.contrast(before, self.capture(marks=True)), 0.6 * strongest)

    @staticmethod
    def contrast(before, after):
        return max(abs(a - b) for a, b in zip(before.rgb, after.rgb))

    def test_measurements_are_lines_with_their_text(self):
        point = self.server.call("scene.snap", {"x": 0.5, "y": 0.5, "radius": 0})["position"]
        camera = self.server.call("camera.get")
        ends = [[p + 0.3 * side * u for p, u in zip(point, camera["up"])] for side in (-1, 1)]
        self.server.call("measurements.add", {"kind": "distance",
                                              "points": [{"position": end} for end in ends]})
        image, pixels = self.drawn()
        (x1, y1), (x2, y2) = (self.place(end, image) for end in ends)
        self.assert_within(pixels, (x1 + x2) / 2, (y1 + y2) / 2, LABEL / 2 + abs(x2 - x1) / 2,
                           PIN + abs(y2 - y1) / 2)
        for x, y in ((x1, y1), (x2, y2)):
            if 0 <= x < image.width and 0 <= y < image.height:
                self.assertIn((int(x), int(y)), pixels, "the ends are marked")

    def test_addresses_of_images(self):
        one = self.annotate()

        def image(query):
            status, _, body = self.server.get(IMAGE + ".png" + query)
            self.assertEqual(status, 200, body[:200])
            return decode_png(body)

        plain, marked = image(""), image("?marks=1")
        x, y = self.place(one["position"], plain)
        self.assert_within(changed(plain, marked), x, y, LABEL, PIN)
        self.assertEqual(changed(plain, image("?marks=0")), [])
        large = image("?marks=1&width=320&samples=1")
        self.assertEqual((large.width, large.height), (320, 180))
        for kind in ("jpg", "webp"):
            self.assertEqual(self.server.get(IMAGE + f".{kind}?marks=1&samples=1")[0], 200)
        files = [self.server.get(IMAGE + f".png?transparent=1&samples=1{more}")
                 for more in ("", "&marks=1")]
        self.assertEqual([file[0] for file in files], [200, 200])
        self.assertNotEqual(files[0][2], files[1][2], "marks are drawn without background too")

    def test_other_buffers_and_values_are_refused(self):
        for params in ({"buffer": "gbuffer.normals"}, {"format": "npy"}, {"format": "exr"},
                       {"buffer": "gbuffer.normals", "format": "npy"}):
            answer = self.server.ask("frame.capture", {**params, "marks": True})
            self.assert_error(answer, -32602, path="marks", limit="buffer output")
        self.assert_error(self.server.ask("frame.capture", {"marks": 1}), -32602, path="marks")
        for address, told in ((".npy?marks=1", b"png, jpeg or webp"),
                              (".exr?marks=1", b"png, jpeg or webp"),
                              (".png?marks=1&buffer=gbuffer.normals", b"buffer output"),
                              (".png?marks=maybe", b"0 or 1"), (".png?mark=1", b"mean marks")):
            status, _, body = self.server.get(IMAGE + address)
            self.assertEqual(status, 400, address)
            self.assertIn(told, body, address)
