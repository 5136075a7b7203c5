"""The command `heliograph render`, as its users call it."""

import json
import os
import shutil
import subprocess
import tempfile
import unittest

from harness.images import decode_png, difference
from harness.models import Model

SMALL = ("--width", "64", "--samples", "1")


def scene_file(name):
    return os.path.join(os.environ["HELIOGRAPH_SCENES"], name)


class Render(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.scenes = tempfile.TemporaryDirectory()
        model = Model(scene_file("mirror.glb"))
        model.add_clip("hop", 0, [0.0, 0.5], [[0, 0, 0], [0, 1, 0]])
        # A second camera, without a name.
        camera = dict(model.json["cameras"][0])
        camera.pop("name", None)
        model.json["cameras"].append(camera)
        model.add_node(camera=len(model.json["cameras"]) - 1, translation=[0, 1, 9])
        cls.two = os.path.join(cls.scenes.name, "two.glb")
        model.save(cls.two)
        shutil.copy(scene_file("sky.hdr"), cls.scenes.name)
        cls.empty = os.path.join(cls.scenes.name, "empty.glb")
        open(cls.empty, "wb").close()

    @classmethod
    def tearDownClass(cls):
        cls.scenes.cleanup()

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = folder.name

    def run_render(self, *arguments):
        """Exit code, standard output and its error lines."""
        done = subprocess.run([os.environ["HELIOGRAPH_BINARY"], "render", *arguments], cwd=self.folder,
                              capture_output=True, timeout=120, check=False)
        return done.returncode, done.stdout, done.stderr.decode()

    def renders(self, *arguments):
        """The files that it writes, by name."""
        code, out, err = self.run_render(*arguments)
        self.assertEqual((code, out), (0, b""), err)
        return sorted(os.listdir(self.folder))

    def refuses(self, saying, *arguments):
        code, out, err = self.run_render(*arguments)
        self.assertIn(code, (1, 2), err)
        self.assertEqual(out, b"")
        self.assertEqual(len(err.splitlines()), 1, err)
        self.assertRegex(err, saying)
        self.assertEqual(os.listdir(self.folder), [], "a file was left behind")

    def image(self, name):
        with open(os.path.join(self.folder, name), "rb") as file:
            return decode_png(file.read())

    def test_one_side_gives_the_other(self):
        self.renders(scene_file("mirror.glb"), "-o", "wide.png", *SMALL)
        self.assertEqual((self.image("wide.png").width, self.image("wide.png").height), (64, 36))
        self.renders(scene_file("mirror.glb"), "-o", "high.png", "--height", "72", "--samples", "1")
        self.assertEqual((self.image("high.png").width, self.image("high.png").height), (128, 72))

    def test_standard_output(self):
        code, out, err = self.run_render(scene_file("mirror.glb"), "-o", "-", *SMALL)
        self.assertEqual((code, err), (0, ""))
        self.assertEqual(decode_png(out).width, 64)
        code, out, _ = self.run_render(scene_file("mirror.glb"), "-o", "-", "--format", "npy", *SMALL)
        self.assertEqual((code, out[:6]), (0, b"\x93NUMPY"))
        self.assertEqual(os.listdir(self.folder), [])
        self.refuses("one image", self.two, "-o", "-", "--camera", "all", *SMALL)
        self.refuses("--timings", self.two, "-o", "-", "--timings", *SMALL)

    def test_frames_are_numbered_by_the_name(self):
        self.assertEqual(self.renders(self.two, "-o", "run_%03d.png", "--clip", "hop", "--frames", "2",
                                      *SMALL), ["run_000.png", "run_001.png"])
        self.assertEqual(self.renders(self.two, "-o", "a.png", "--clip", "hop", "--frames", "2",
                                      *SMALL)[:2], ["a_0000.png", "a_0001.png"])

    def test_cameras_by_number_and_all_of_them(self):
        self.assertEqual(self.renders(self.two, "-o", "{scene}_{camera}.png", "--camera", "all",
                                      *SMALL), ["two_camera 2.png", "two_main.png"])
        self.renders(self.two, "-o", "second.png", "--camera", "2", *SMALL)
        second = self.image("second.png")
        self.assertLess(difference(second, self.image("two_camera 2.png")), 0.5)
        self.assertGreater(difference(second, self.image("two_main.png")), 2)

    def test_a_turntable_ends_where_it_began(self):
        files = self.renders(self.two, "-o", "{frame:02}.png", "--turntable", "4", *SMALL)
        self.assertEqual(files, ["00.png", "01.png", "02.png", "03.png"])
        self.assertGreater(difference(self.image("00.png"), self.image("02.png")), 1)
        self.renders(self.two, "-o", "still.png", *SMALL)
        self.assertLess(difference(self.image("00.png"), self.image("still.png")), 0.5)

    def camera_path(self, **members):
        """A file of a path that leads from the right of the scene to its front."""
        path = os.path.join(self.scenes.name, "path.json")
        keys = [{"eye": [4, 1, 0], "target": [0, 0, 0]}, {"eye": [0, 1, 4], "target": [0, 0, 0]}]
        with open(path, "w", encoding="utf-8") as file:
            json.dump({"keys": keys, **members}, file)
        return path

    def test_a_camera_moves_along_a_path(self):
        arguments = (self.two, "-o", "{frame:02}.png", "--fps", "5", *SMALL)
        files = self.renders(*arguments, "--path", self.camera_path(seconds=1))
        self.assertEqual(files, ["00.png", "01.png", "02.png", "03.png", "04.png"])
        open_end = self.image("04.png")
        way = difference(self.image("00.png"), open_end)
        self.assertGreater(way, 1)
        self.renders(*arguments, "--path", self.camera_path(seconds=2, closed=True))
        self.assertLess(difference(self.image("05.png"), open_end), way / 2, "half of the way")

    def test_paths_that_cannot_be_followed_are_told(self):
        arguments = (self.two, "-o", "{frame:02}.png", *SMALL)
        self.refuses("number of frames", *arguments, "--path", self.camera_path(), "--turntable", "3")
        self.refuses("--camera", *arguments, "--path", self.camera_path(), "--camera", "1")
        self.refuses(r"keys", *arguments, "--path", self.camera_path(keys=[]))
        self.refuses(r"seconds: .*0\.1 to 3600", *arguments, "--path", self.camera_path(seconds=0))
        same = [{"eye": [1, 0, 0], "target": [1, 0, 0]}] * 2
        self.refuses("coincide", *arguments, "--path", self.camera_path(keys=same))

    def test_an_exploded_view_fits_into_the_image(self):
        for name, amount in (("whole.png", "0"), ("apart.png", "2")):
            self.renders(self.two, "-o", name, "--orbit", "20,20", *SMALL, "--set",
                         f"view.explode={amount}")
        self.assertGreater(difference(self.image("whole.png"), self.image("apart.png")), 1)

    def test_a_broken_scene_fails_alone(self):
        missing = os.path.join(self.scenes.name, "missing.glb")
        code, out, err = self.run_render(self.empty, self.two, missing, "-o", "{scene}.png", *SMALL)
        self.assertEqual((code, out), (3, b""))
        self.assertEqual(os.listdir(self.folder), ["two.png"])
        self.assertRegex(err, r"empty\.glb: the file is empty\n.*missing\.glb: .*not exist\n.*2 of 3")
        code, _, _ = self.run_render(self.empty, missing, "-o", "{scene}.png", *SMALL)
        self.assertEqual(code, 1)

    def test_mistakes_are_told_before_anything_is_rendered(self):
        mirror = scene_file("mirror.glb")
        for saying, arguments in (
                ("no/.*no such folder", (mirror, "-o", "no/out.png")),
                ("is a folder", (mirror, "-o", self.folder)),
                ("bmp", (mirror, "-o", "out.bmp")),
                ("mean scene", (mirror, "-o", "{scen}.png")),
                (r"\{scene\}", (mirror, self.two, "-o", "out.png")),
                (r"\{camera\}", (self.two, "-o", "out.png", "--camera", "all")),
                ("--buffer.*mean output", (mirror, "-o", "out.png", "--buffer", "outptu")),
                ("mirror.glb: --camera.*mean main", (mirror, "-o", "out.png", "--camera", "mian")),
                ("--camera.* 9", (mirror, "-o", "out.png", "--camera", "9")),
                ("two.glb: --clip.*mean hop", (self.two, "-o", "out.png", "--clip", "hpo")),
                ("mirror.glb: --clip.*no clips", (mirror, "-o", "out.png", "--clip", "hop")),
                ("hop is 0.5 s long", (self.two, "-o", "out.png", "--clip", "hop", "--time", "0.6")),
                ("--frames", (mirror, "-o", "out.png", "--frames", "3")),
                ("--turntable", (self.two, "-o", "o.png", "--turntable", "3", "--frames", "3")),
                ("--clip", (mirror, "-o", "out.png", "--time", "1")),
                ("empty.glb: .*empty", (self.empty, "-o", "out.png")),
                ("empty.glb", (mirror, "-o", "out.png", "--environment", self.empty)),
                ("option --widht; did you mean --width", (mirror, "-o", "out.png", "--widht", "3"))):
            with self.subTest(saying):
                self.refuses(saying, *arguments)

    def test_files_that_cannot_be_written_are_told_first(self):
        taken = os.path.join(self.folder, "out.png")
        os.mkdir(taken)
        code, _, err = self.run_render(scene_file("mirror.glb"), "-o", "/proc/out.png", *SMALL)
        self.assertEqual(code, 1)
        self.assertIn("cannot write /proc/out.png", err)
        code, _, err = self.run_render(scene_file("mirror.glb"), "-o", "out.png", *SMALL)
        self.assertEqual(code, 1)
        self.assertIn("out.png is a folder", err)
        # Two scenes of one name must not overwrite each other's image.
        other = os.path.join(self.folder, "mirror.glb")
        shutil.copy(scene_file("mirror.glb"), other)
        code, _, err = self.run_render(scene_file("mirror.glb"), other, "-o", "{scene}.png", *SMALL)
        self.assertEqual(code, 3)
        self.assertIn("written twice", err)

    def test_frames_beyond_the_clip_are_told(self):
        code, _, err = self.run_render(self.two, "-o", "a.png", "--clip", "hop", "--fps", "2",
                                       "--frames", "3", *SMALL)
        self.assertEqual(code, 0)
        self.assertRegex(err, r"two\.glb: the clip hop is 0\.5 s long: frames from 2 on repeat it")
