"""`heliograph render` for sets: manifests, shards, interruptions, videos and backgrounds."""

import json
import os
import shutil
import signal
import subprocess
import tempfile
import unittest

import numpy

from harness.images import decode_png
from harness.memory import compares_memory
from harness.models import Model


def scene_file(name):
    return os.path.join(os.environ["HELIOGRAPH_SCENES"], name)


MIRROR = "mirror.glb"


class RenderSets(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = folder.name
        self.mirror = scene_file(MIRROR)
        self.empty = os.path.join(self.folder, "empty.glb")
        open(self.empty, "wb").close()

    def path(self, name):
        return os.path.join(self.folder, name)

    def command(self, *arguments):
        return [os.environ["HELIOGRAPH_BINARY"], "render", *arguments]

    def run_render(self, *arguments):
        """Exit code, the events and the error lines."""
        done = subprocess.run(self.command(*arguments), cwd=self.folder, capture_output=True,
                              timeout=120, check=False)
        return done.returncode, [json.loads(line) for line in done.stdout.splitlines()], done.stderr.decode()

    def manifest(self, entries, lines=False):
        text = "\n".join(map(json.dumps, entries)) if lines else json.dumps(entries)
        with open(self.path("jobs.json"), "w", encoding="utf-8") as file:
            file.write(text)
        return "jobs.json"

    def entries(self, count=3):
        return [{"scene": self.mirror, "output": f"{i}.png", "width": 48, "samples": 1}
                for i in range(count)]

    def images(self, ending=".png"):
        return sorted(name for name in os.listdir(self.folder) if name.endswith(ending))

    def bytes_of(self, name):
        with open(self.path(name), "rb") as file:
            return file.read()

    def test_a_manifest_takes_what_it_lacks_from_the_command_line(self):
        manifest = self.manifest([{"scene": self.mirror}, {"scene": self.mirror, "width": 32,
                                                           "output": "{scene}/small.jpg"}], lines=True)
        code, events, err = self.run_render("--manifest", manifest, "-o", "{scene}.png", "--width", "48",
                                            "--samples", "1")
        self.assertEqual((code, err), (0, ""))
        self.assertEqual(decode_png(self.bytes_of("mirror.png")).width, 48)
        self.assertEqual(self.bytes_of("mirror/small.jpg")[:2], b"\xff\xd8")
        kinds = [event["event"] for event in events]
        self.assertEqual(kinds, ["started", "image", "written", "done"] * 2 + ["finished"])
        self.assertEqual([event["seconds_left"] for event in events if event["event"] == "image"][1], 0)

    def test_a_broken_scene_fails_alone_with_its_reason_in_the_report(self):
        entries = self.entries()
        entries[1]["scene"] = self.empty
        code, events, err = self.run_render("--manifest", self.manifest(entries), "--report", "report.json")
        self.assertEqual(code, 3)
        self.assertIn("empty.glb: the file is empty", err)
        self.assertEqual(self.images(), ["0.png", "2.png"])
        report = json.loads(self.bytes_of("report.json"))
        self.assertEqual([(entry["entry"], entry["state"]) for entry in report["entries"]],
                         [(1, "done"), (2, "failed"), (3, "done")])
        self.assertEqual(report["entries"][1]["reason"], "the file is empty")
        self.assertEqual((report["done"], report["failed"]), (2, 1))
        self.assertEqual([event["reason"] for event in events if event["event"] == "failed"],
                         ["the file is empty"])

    def test_mistakes_in_a_manifest_are_told_before_anything_is_rendered(self):
        for saying, entry in (("entry 2: widht: .*mean width", {"widht": 3}),
                              ("entry 2: width: ", {"width": 3}),
                              ("entry 2: scene: is required", {"scene": None}),
                              ("entry 2: --output: .*bmp", {"output": "a.bmp"}),
                              ("entry 2: settings: shadow", {"settings": {"shadow": {"no": 1}}}),
                              ("entry 2: --background", {"background": "green"}),
                              ("entry 2: --background.*transparent",
                               {"background": "transparent", "output": "a.jpg"}),
                              ("entry 2: --orbit", {"orbit": [0, 0], "camera": "1"}),
                              ("entry 2: margin", {"margin": 0.5}),
                              ("entry 2: .*frame", {"output": "a{frame}.mp4"})):
            with self.subTest(saying):
                entries = self.entries(2)
                entries[1].update(entry)
                code, events, err = self.run_render("--manifest", self.manifest(entries))
                self.assertEqual((code, events), (1, []))
                self.assertRegex(err, saying)
                self.assertEqual(len(err.splitlines()), 1)
        code, _, err = self.run_render("--manifest", "nowhere.json")
        self.assertEqual(code, 1)
        self.assertIn("nowhere.json", err)
        self.assertEqual(self.images(), [])

    def test_shards_render_everything_once_with_the_same_bytes(self):
        # Views that follow each other share a renderer, each shard other ones.
        entries = [{**entry, "orbit": [40 * i, 10], "background": "transparent" if i > 2 else "sky"}
                   for i, entry in enumerate(self.entries(5))]
        manifest = self.manifest(entries)
        self.assertEqual(self.run_render("--manifest", manifest)[0], 0)
        alone = {name: self.bytes_of(name) for name in self.images()}
        for name in alone:
            os.unlink(self.path(name))
        counts = []
        for shard in ("1/3", "2/3", "3/3"):
            code, events, err = self.run_render("--manifest", manifest, "--shard", shard)
            self.assertEqual(code, 0, err)
            counts.append(sum(event["event"] == "written" for event in events))
        self.assertEqual(counts, [2, 2, 1])
        self.assertEqual({name: self.bytes_of(name) for name in self.images()}, alone)
        for wrong in ("0/3", "4/3", "1", "a/b", "1/3x"):
            self.assertIn("--shard", self.run_render("--manifest", manifest, "--shard", wrong)[2])

    def test_an_interrupted_set_goes_on_where_it_ended(self):
        entries = self.entries(4)
        entries[1].update(samples=65536, settings={"accumulation": {"max_samples": 65536}})
        manifest = self.manifest(entries)
        with subprocess.Popen(self.command("--manifest", manifest, "--report", "report.json"),
                              cwd=self.folder, stdout=subprocess.PIPE, stderr=subprocess.PIPE) as process:
            while b'"entry":2' not in process.stdout.readline():
                pass
            process.send_signal(signal.SIGINT)
            process.communicate(timeout=60)
        self.assertEqual(process.returncode, 130)
        self.assertEqual(self.images(), ["0.png"])
        self.assertEqual(self.images(".part"), [])
        states = [entry["state"] for entry in json.loads(self.bytes_of("report.json"))["entries"]]
        self.assertEqual(states, ["done", "canceled", "canceled", "canceled"])
        first = os.stat(self.path("0.png")).st_mtime_ns
        entries[1]["samples"] = 1
        code, events, err = self.run_render("--manifest", self.manifest(entries), "--resume")
        self.assertEqual(code, 0, err)
        self.assertEqual([event["file"] for event in events if event["event"] == "kept"], ["0.png"])
        self.assertEqual(os.stat(self.path("0.png")).st_mtime_ns, first)
        self.assertEqual(len(self.images()), 4)

    def test_a_full_disk_fails_the_entry_only(self):
        entries = self.entries(2)
        entries[0]["output"] = "/dev/full"
        entries[0]["format"] = "png"
        code, _, err = self.run_render("--manifest", self.manifest(entries))
        self.assertEqual(code, 3)
        self.assertRegex(err, r"cannot write /dev/full: No space left")
        self.assertEqual(self.images(), ["1.png"])

    def test_an_orbit_sees_the_whole_scene(self):
        entry = {"scene": self.mirror, "width": 48, "height": 48, "samples": 1, "buffer": "gbuffer.instance"}
        code, _, err = self.run_render("--manifest", self.manifest([
            {**entry, "output": f"{name}.npy", "orbit": [0, elevation], "margin": 0.2}
            for name, elevation in (("front", 0), ("above", 90))]))
        self.assertEqual((code, err), (0, ""))
        for name in ("front", "above"):
            shown = numpy.argwhere(numpy.load(self.path(name + ".npy")) > 0)
            # Within the margin of .2 of 48 pixels, and as large as it allows on one axis.
            self.assertGreaterEqual(shown.min(), 9)
            self.assertLessEqual(shown.max(), 39)

    def test_a_background_replaces_the_sky(self):
        model = Model(self.mirror)
        model.save(self.path("scene.glb"))
        shutil.copy(scene_file("sky.hdr"), self.folder)
        # Away from the scene: nothing but background.
        base = {"scene": "scene.glb", "width": 32, "height": 16, "samples": 2,
                "view": {"eye": [500, 500, 500], "target": [1000, 1000, 1000]}}
        code, _, err = self.run_render("--manifest", self.manifest([
            {**base, "output": "green.png", "background": "#00ff00"},
            {**base, "output": "clear.webp", "background": "transparent"},
            {"scene": "scene.glb", "width": 32, "height": 16, "samples": 2, "output": "front.png",
             "background": "#00ff00"},
            *({**base, "output": f"{background}.png", "background": background}
              for background in ("sky", "blurred"))]))
        self.assertEqual((code, err), (0, ""))
        sky, blurred = (numpy.frombuffer(decode_png(self.bytes_of(name)).rgb, numpy.uint8).astype(float)
                        for name in ("sky.png", "blurred.png"))
        self.assertGreater(numpy.abs(sky - blurred).max(), 2)
        self.assertLess(blurred.std(), sky.std())
        green = bytes([0, 255, 0])
        self.assertEqual(bytes(decode_png(self.bytes_of("green.png")).rgb), 32 * 16 * green)
        self.assertIn(b"ALPH", self.bytes_of("clear.webp"))
        front = bytes(decode_png(self.bytes_of("front.png")).rgb)
        shown = sum(front[i:i + 3] == green for i in range(0, len(front), 3))
        self.assertTrue(10 < shown < 32 * 16 - 10, shown)

    def test_shadows_on_the_ground_cover_a_part_of_the_background(self):
        def over_white(ground):
            code, _, err = self.run_render(scene_file("furnace.glb"), "-o", ground + ".png",
                                           "--width", "64", "--samples", "4", "--background",
                                           "#ffffff", "--set", "background.ground=" + ground)
            self.assertEqual((code, err), (0, ""))
            return numpy.frombuffer(decode_png(self.bytes_of(ground + ".png")).rgb, numpy.uint8)
        off, on = over_white("off"), over_white("on")
        shadow = (off == 255) & (on < 235)
        self.assertGreater(shadow.mean(), 0.03)
        self.assertGreater(on[shadow].max(), 200, "the shadow is not soft")
        self.assertGreater((on == 255).mean(), 0.3, "nothing is left of the background")

    def test_a_turntable_is_a_video(self):
        for name, beginning in (("turn.mp4", b"ftyp"), ("turn.webm", b"\x1a\x45\xdf\xa3")):
            code, _, err = self.run_render(self.mirror, "-o", name, "--turntable", "5", "--width", "64",
                                           "--samples", "1")
            self.assertEqual((code, err), (0, ""))
            self.assertIn(beginning, self.bytes_of(name)[:16])
        code, _, err = self.run_render(self.mirror, "-o", "turn.webp", "--format", "animated_webp",
                                       "--turntable", "5", "--width", "64", "--samples", "1")
        self.assertEqual((code, err), (0, ""))
        self.assertEqual(self.bytes_of("turn.webp").count(b"ANMF"), 5)
        if shutil.which("ffprobe"):
            found = subprocess.run(
                ["ffprobe", "-v", "error", "-count_frames", "-show_entries",
                 "stream=nb_read_frames,codec_name,width,r_frame_rate", "-of", "csv=p=0", self.path("turn.mp4")],
                capture_output=True, text=True, check=True).stdout.strip()
            self.assertEqual(found, "h264,64,30/1,5")

    def test_frames_of_a_turntable_have_the_bytes_of_a_new_renderer(self):
        arguments = (self.mirror, "-o", "turn_%d.png", "--turntable", "3", "--width", "96", "--samples", "2")
        self.assertEqual(self.run_render(*arguments)[0], 0)
        before = self.bytes_of("turn_2.png")
        os.remove(self.path("turn_2.png"))
        self.assertEqual(self.run_render(*arguments, "--resume")[0], 0)
        self.assertEqual(self.bytes_of("turn_2.png"), before)

    @compares_memory
    def test_frames_of_a_turntable_share_their_memory(self):
        def page_faults(frames):
            with subprocess.Popen(self.command(self.mirror, "-o", "turn.mp4", "--turntable", str(frames), "--width",
                                               "640", "--samples", "1"), cwd=self.folder) as process:
                _, status, used = os.wait4(process.pid, 0)
                process.returncode = os.waitstatus_to_exitcode(status)
            self.assertEqual(process.returncode, 0)
            return used.ru_minflt
        few, many = page_faults(2), page_faults(12)
        self.assertLess(many - few, few)

    def test_quality_of_a_video_is_that_of_its_frames(self):
        entry = {"scene": self.mirror, "width": 96, "turntable": 7, "quality": 0.9}
        code, events, err = self.run_render("--manifest", self.manifest([
            {**entry, "output": "turn.mp4"}, {**entry, "output": "turn_%d.png"}]))
        self.assertEqual((code, err), (0, ""))
        samples = {number: [event["samples"] for event in events
                            if event["event"] == "image" and event["entry"] == number] for number in (1, 2)}
        self.assertEqual(samples[1][0], samples[2][0])
        # Images stand alone: each is estimated.
        for number, (video, alone) in enumerate(zip(samples[1], samples[2])):
            self.assertIn(video, (alone, *(before / 2 for before in samples[1][:number])))

    def test_quality_is_that_of_the_converged_image(self):
        common = {"scene": self.mirror, "width": 96, "reference": "full"}
        code, _, err = self.run_render("--manifest", self.manifest([
            {**common, "output": "truth.png", "samples": 256},
            {**common, "output": "low.png", "quality": 0.9},
            {**common, "output": "high.png", "quality": 0.997},
            {**common, "output": "late.png", "time_limit": 0.01}]), "--report", "report.json")
        self.assertEqual((code, err), (0, ""))
        low, high, late = (entry["samples"] for entry in json.loads(self.bytes_of("report.json"))["entries"][1:])
        self.assertLess(low, high)
        self.assertLess(high, 256)
        self.assertLess(late, 64)
        truth = self.luma("truth.png")
        for name, asked in (("low.png", 0.9), ("high.png", 0.997)):
            self.assertGreater(similarity(truth, self.luma(name)), asked - 0.01, name)

    def luma(self, name):
        image = decode_png(self.bytes_of(name))
        rgb = numpy.frombuffer(bytes(image.rgb), dtype=numpy.uint8).reshape(image.height, image.width, 3)
        return rgb @ numpy.array([0.299, 0.587, 0.114])


def similarity(a, b):
    """The structural similarity over windows of 8 x 8 pixels."""
    c1, c2 = (0.01 * 255) ** 2, (0.03 * 255) ** 2
    windows = numpy.lib.stride_tricks.sliding_window_view
    u, v = (windows(image, (8, 8))[::4, ::4].reshape(-1, 64) for image in (a, b))
    mu, mv = u.mean(axis=1), v.mean(axis=1)
    covariance = ((u - mu[:, None]) * (v - mv[:, None])).mean(axis=1)
    return numpy.mean((2 * mu * mv + c1) * (2 * covariance + c2) /
                      ((mu ** 2 + mv ** 2 + c1) * (u.var(axis=1) + v.var(axis=1) + c2)))
