"""Buffers as files, read with NumPy and OpenEXR, over JSON-RPC and HTTP."""

import base64
import io
import math
import os
import struct
import subprocess
import tempfile
import zlib

import numpy

from harness.images import decode_jpeg, decode_png
from harness.server import ServerTestCase

PIXEL_TYPES = {0: numpy.dtype("<u4"), 2: numpy.dtype("<f4")}


def read_exr(file):
    """Channels by name of a scan line image in blocks of 16 lines (ZIP), and its attributes."""
    assert struct.unpack_from("<II", file) == (20000630, 2), "not a plain OpenEXR file"
    position, attributes = 8, {}

    def text(at):
        end = file.index(b"\0", at)
        return file[at:end].decode(), end + 1

    while file[position]:
        name, position = text(position)
        _, position = text(position)
        size, = struct.unpack_from("<I", file, position)
        attributes[name] = file[position + 4:position + 4 + size]
        position += 4 + size
    left, top, right, bottom = struct.unpack("<4i", attributes["dataWindow"])
    width, height = right - left + 1, bottom - top + 1
    assert attributes["compression"] == b"\3", "not ZIP"
    kinds, at, listed = {}, 0, attributes["channels"]
    while listed[at]:
        end = listed.index(b"\0", at)
        kinds[listed[at:end].decode()] = PIXEL_TYPES[struct.unpack_from("<I", listed, end + 1)[0]]
        at = end + 17
    channels = {name: numpy.empty((height, width), kind) for name, kind in kinds.items()}
    blocks = math.ceil(height / 16)
    for offset in struct.unpack_from(f"<{blocks}Q", file, position + 1):
        first, size = struct.unpack_from("<iI", file, offset)
        packed = file[offset + 8:offset + 8 + size]
        lines = min(16, height - first)
        length = lines * width * 4 * len(kinds)
        data = packed if size == length else undo_prediction(zlib.decompress(packed))
        assert len(data) == length
        at = 0
        for line in range(first, first + lines):
            for name, kind in kinds.items():
                channels[name][line] = numpy.frombuffer(data, kind, width, at)
                at += 4 * width
    return channels, attributes


def undo_prediction(data):
    """The bytes as they were before OpenEXR took differences and sorted them by half."""
    values = numpy.frombuffer(data, numpy.uint8).astype(numpy.int64)
    values[1:] -= 128
    values = (numpy.cumsum(values) % 256).astype(numpy.uint8)
    half = (len(values) + 1) // 2
    restored = numpy.empty_like(values)
    restored[0::2], restored[1::2] = values[:half], values[half:]
    return restored.tobytes()


class Files(ServerTestCase):
    arguments = ("--scene", "mirror", "--set", "antialiasing.jitter=false")

    def reset(self):
        super().reset()
        self.server.call("camera.set", {"name": "main"})

    def capture(self, **request):
        result = self.server.call("frame.capture", {"samples": 1, **request})
        return base64.b64decode(result["data"]), result

    def array(self, buffer, **request):
        return numpy.load(io.BytesIO(self.capture(buffer=buffer, format="npy", **request)[0]),
                          allow_pickle=False)

    def exr(self, buffer="output", **request):
        return read_exr(self.capture(buffer=buffer, format="exr", **request)[0])[0]

    def test_every_buffer_is_an_array(self):
        for buffer in self.server.call("frame.buffers")["buffers"]:
            values = self.array(buffer["name"])
            self.assertIn(values.ndim, (2, 3), buffer)
            self.assertLessEqual(values.shape[0], 90, buffer)
            kind = {"output": "uint8", "gbuffer.instance": "uint32",
                    "indirect.half.instance": "uint32",
                    "sampling.plan": "uint32"}.get(buffer["name"], "float32")
            self.assertEqual(values.dtype, kind, buffer)

    def test_arrays_have_the_shape_of_their_buffer(self):
        for buffer, shape in (("output", (90, 160, 3)), ("gbuffer.instance", (90, 160)),
                              ("gbuffer.motion.view_z", (90, 160)),
                              ("gbuffer.depth_slope", (90, 160, 2)), ("hdr", (90, 160, 4)),
                              ("output.radiance", (90, 160, 4))):
            self.assertEqual(self.array(buffer).shape, shape, buffer)

    def test_the_array_of_the_output_equals_the_png(self):
        image = decode_png(self.capture()[0])
        self.assertEqual(self.array("output").tobytes(), image.rgb)

    def test_depth_is_in_metres(self):
        depth = self.array("gbuffer.motion.view_z")
        there = self.array("gbuffer.instance") > 0
        self.assertTrue((depth[there] > 0).all())
        self.assertTrue(numpy.isinf(depth[~there]).all(), "as in EXR files")
        camera = self.server.call("camera.get")
        picked = self.server.call("scene.pick", {"x": 0.5 + 0.5 / 160, "y": 0.5 + 0.5 / 90})
        view = numpy.subtract(camera["target"], camera["eye"])
        along = numpy.dot(numpy.subtract(picked["position"], camera["eye"]),
                          view / numpy.linalg.norm(view))
        self.assertAlmostEqual(depth[45, 80], along, places=4)

    def test_exr_holds_radiance_and_surfaces(self):
        layers = self.exr()
        for name in ("R", "G", "B", "depth.Z", "normals.X", "normals.Y", "normals.Z", "motion.X",
                     "motion.Y", "albedo.R", "albedo.G", "albedo.B", "surface.roughness",
                     "surface.metallic", "instance.id"):
            self.assertEqual(layers[name].shape, (90, 160), name)
        there = layers["instance.id"] > 0
        self.assertTrue(0.2 < there.mean() < 0.95, "the camera sees spheres and sky")
        normals = numpy.stack([layers["normals." + axis] for axis in "XYZ"])
        lengths = numpy.linalg.norm(normals, axis=0)
        self.assertTrue(numpy.allclose(lengths[there], 1, atol=1e-4))
        self.assertTrue((lengths[~there] == 0).all())
        self.assertTrue(numpy.isinf(layers["depth.Z"][~there]).all())
        numpy.testing.assert_array_equal(layers["depth.Z"][there],
                                         self.array("gbuffer.motion.view_z")[there])
        radiance = self.array("output.radiance")
        numpy.testing.assert_array_equal(layers["R"], radiance[..., 0])
        self.assertTrue(numpy.allclose(layers["albedo.R"][there], 1, atol=0.02))

    def test_exr_of_a_buffer_holds_its_values(self):
        self.assertEqual(list(self.exr("gbuffer.motion.view_z")), ["Y"])
        numpy.testing.assert_array_equal(self.exr("gbuffer.motion.view_z")["Y"],
                                         self.array("gbuffer.motion.view_z"))
        self.assertEqual(sorted(self.exr("hdr")), ["A", "B", "G", "R"])
        numpy.testing.assert_array_equal(self.exr("hdr")["G"], self.array("hdr")[..., 1])
        instances = self.exr("gbuffer.instance")["Y"]
        self.assertEqual(instances.dtype, numpy.uint32)
        numpy.testing.assert_array_equal(instances, self.array("gbuffer.instance"))

    def test_radiance_is_the_output_before_tone_mapping(self):
        patch = {"tone_map": {"curve": "linear"}, "exposure": {"compensation": -3}}
        self.server.call("settings.patch", {"patch": patch})
        radiance = self.array("output.radiance", samples=4)[..., :3] / 8
        shown = self.array("output", samples=4) / 255
        linear = numpy.where(shown <= 0.04045, shown / 12.92, ((shown + 0.055) / 1.055) ** 2.4)
        self.assertGreater(radiance.std(), 0.01)
        self.assertLess(numpy.abs(radiance.clip(0, 1) - linear).max(), 0.02)

    def test_exr_of_the_reference_has_no_surface_layers(self):
        self.server.call("settings.patch", {"patch": {"reference": {"use": "always"}}})
        self.assertEqual(sorted(self.exr()), ["B", "G", "R"])
        self.assert_error(self.server.ask("scene.pick", {"x": 0.5, "y": 0.5}), -32009)

    def test_files_are_served_over_http(self):
        for kind, content, begins in (("png", "image/png", b"\x89PNG"),
                                      ("jpg", "image/jpeg", b"\xff\xd8"),
                                      ("npy", "application/x-npy", b"\x93NUMPY"),
                                      ("exr", "image/x-exr", b"\x76\x2f\x31\x01")):
            status, headers, body = self.server.get(f"/api/v1/sessions/main/frame.{kind}")
            self.assertEqual((status, headers["content-type"]), (200, content))
            self.assertEqual(body[:len(begins)], begins)
        _, _, body = self.server.get("/api/v1/sessions/main/frame.npy?buffer=gbuffer.instance")
        numpy.testing.assert_array_equal(numpy.load(io.BytesIO(body)),
                                         self.array("gbuffer.instance"))
        for path, status in (("main/frame.bmp", 404), ("none/frame.exr", 404),
                             ("main/frame.npy?buffer=nothing", 400),
                             ("main/frame.exr?samples=0", 400)):
            self.assertEqual(self.server.get("/api/v1/sessions/" + path)[0], status, path)

    def render(self, name, *arguments):
        """What `heliograph render` writes into a file of that name."""
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, name)
            done = subprocess.run(
                [os.environ["HELIOGRAPH_BINARY"], "render",
                 os.path.join(os.environ["HELIOGRAPH_SCENES"], "mirror.glb"), "-o", path,
                 "--width", "64", "--height", "36", "--samples", "2", *arguments],
                capture_output=True, text=True, timeout=60)
            if done.returncode:
                return done.stderr
            with open(path, "rb") as file:
                return file.read()

    def test_the_command_line_writes_the_same_files(self):
        channels, _ = read_exr(self.render("image.exr"))
        radiance = numpy.load(io.BytesIO(self.render("it.npy", "--buffer", "output.radiance")))
        numpy.testing.assert_array_equal(channels["G"], radiance[..., 1])
        self.assertIn("depth.Z", channels)
        self.assertIn(".bmp", self.render("image.bmp"))

    def test_a_jpeg_has_full_colour(self):
        file, result = self.capture(format="jpeg")
        self.assertEqual(result["format"], "jpeg")
        self.assertTrue(decode_jpeg(file).full_chroma)
