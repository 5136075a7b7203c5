"""Buffers appear and disappear with the settings, and never block other settings."""

import base64
import os
import tempfile

from harness.images import decode_jpeg, decode_png, difference
from harness.server import Server, ServerTestCase
from harness.viewer import Viewer

WITHOUT_REFLECTIONS = {"specular": {"enabled": False}}
VIEW_OF_REFLECTIONS = {"view": {"buffer": "specular.denoised"}}


class Sessions:
    """What the tests ask sessions of their own."""

    def own(self, name, **options):
        if "scene" not in options:
            options = {"copy_of": "main", **options}
        self.server.call("session.create", {"name": name, "width": 64, "height": 36, **options})
        self.addCleanup(self.server.ask, "session.close", {"session": name})
        return name

    def patch(self, session, *patches):
        for patch in patches:
            self.server.call("settings.patch", {"patch": patch}, session=session)

    def ask_for(self, session, buffer="output"):
        return self.server.ask("frame.capture", {"buffer": buffer, "samples": 1}, session=session)

    def capture(self, session, buffer="output"):
        answer = self.ask_for(session, buffer)
        self.assertIn("result", answer, answer)
        return decode_png(base64.b64decode(answer["result"]["data"], validate=True))

    def listed(self, session):
        return {buffer["name"]
                for buffer in self.server.call("frame.buffers", session=session)["buffers"]}

    def brightness(self, session):
        rgb = self.capture(session).rgb
        return sum(rgb) / len(rgb)

    def assert_exposed(self, session):
        """Whether settings reach the renderer: the exposure of an image."""
        self.patch(session, {"exposure": {"compensation": -8}})
        self.assertLess(self.brightness(session), 40)
        self.patch(session, {"exposure": {"compensation": 8}})
        self.assertGreater(self.brightness(session), 150)


class SettingsTakeEffect(Sessions, ServerTestCase):
    def test_when_the_viewed_buffer_does_not_exist(self):
        self.own("view")
        self.capture("view")
        self.patch("view", WITHOUT_REFLECTIONS, VIEW_OF_REFLECTIONS)
        self.assert_exposed("view")
        self.patch("view", {"accumulation": {"max_samples": 3}})
        state = self.server.call("frame.capture", session="view")
        self.assertEqual(state["samples"], 3)

    def test_when_one_patch_selects_and_removes_the_buffer(self):
        self.own("both")
        self.capture("both")
        self.patch("both", {**WITHOUT_REFLECTIONS, **VIEW_OF_REFLECTIONS})
        self.assert_exposed("both")
        self.patch("both", {"specular": None, "view": {"buffer": "specular.radiance"}})
        self.assertIn("specular.radiance", self.server.call("settings.get", session="both")
                      ["settings"]["view"]["buffer"])
        self.capture("both", "specular.radiance")

    def test_of_a_session_created_with_them(self):
        wanted = {**WITHOUT_REFLECTIONS, **VIEW_OF_REFLECTIONS}
        self.own("made", settings=wanted)
        self.assert_exposed("made")
        self.own("made-of-it", copy_of="made")
        self.assert_exposed("made-of-it")
        self.own("with-scene", scene="furnace", settings=wanted)
        self.assert_exposed("with-scene")

    def test_with_another_scene_and_with_presets(self):
        self.own("other")
        self.patch("other", {"view": {"buffer": "specular.blur.even"}})
        self.capture("other")
        self.server.call("settings.preset", {"name": "svgf"}, session="other")
        self.assert_exposed("other")
        self.server.call("scene.load", {"name": "furnace"}, session="other")
        self.assert_exposed("other")

    def test_in_lockstep(self):
        self.own("steps")
        self.capture("steps")
        self.patch("steps", WITHOUT_REFLECTIONS, VIEW_OF_REFLECTIONS)
        images = []
        for compensation in (-8, 8):
            self.patch("steps", {"exposure": {"compensation": compensation}})
            self.server.call("frame.step", {"frames": 1, "dt": 0.1}, session="steps")
            images.append(self.brightness("steps"))
        self.assertLess(images[0] + 50, images[1])
        self.assert_error(self.ask_for("steps", "specular.denoised"), -32004, path="buffer")

    async def test_viewers_see_the_output_until_the_buffer_exists_again(self):
        self.own("shown")
        async with Viewer(self.server, session="shown") as viewer:
            async def seen():
                return decode_jpeg((await viewer.rest()).payload)
            await viewer.call("settings.patch", {"patch": {"view": {"buffer": "specular.radiance"}}})
            buffer = await seen()
            await viewer.call("settings.patch", {"patch": WITHOUT_REFLECTIONS})
            without = await seen()
            await viewer.call("settings.patch", {"patch": {"view": None}})
            self.assertLess(difference(await seen(), without), 2)
            await viewer.call("settings.patch",
                              {"patch": {"view": {"buffer": "specular.radiance"}}})
            await viewer.call("settings.patch", {"patch": {"specular": None}})
            again = await seen()
            self.assertGreater(difference(again, without), 2)
            self.assertLess(difference(again, buffer), 2)


class TheListFollows(Sessions, ServerTestCase):
    def assert_complete(self, session, present, absent=()):
        """Everything listed can be captured, and so can and cannot what is named."""
        self.capture(session)
        names = self.listed(session)
        self.assertLessEqual(set(present), names)
        self.assertFalse(names & set(absent))
        for name in present:
            self.capture(session, name)
        for name in absent:
            self.assert_error(self.ask_for(session, name), -32004, path="buffer")

    def test_the_reference(self):
        self.own("reference")
        hybrid = ("gbuffer.normals", "specular.denoised")
        self.patch("reference", {"reference": {"use": "off"}})
        self.assert_complete("reference", hybrid, ["reference"])
        self.server.call("reference.start", {"samples": 2}, session="reference")
        self.assert_complete("reference", ["reference"], hybrid)
        self.server.call("reference.stop", session="reference")
        self.assert_complete("reference", hybrid, ["reference"])
        self.patch("reference", {"view": {"buffer": "gbuffer.normals"}})

    def test_passes_that_are_disabled_and_enabled(self):
        self.own("passes", settings=WITHOUT_REFLECTIONS)
        self.assert_complete("passes", ["visibility.denoised"], ["specular.denoised"])
        self.patch("passes", {"specular": None})
        self.assert_complete("passes", ["visibility.denoised", "specular.denoised"])

    def test_a_preset(self):
        self.own("preset")
        of_svgf = ["visibility.blur.odd"]
        self.assert_complete("preset", ["visibility.blur.even"], of_svgf)
        self.server.call("settings.preset", {"name": "svgf"}, session="preset")
        self.assert_complete("preset", of_svgf)
        self.server.call("settings.preset", {"name": "best"}, session="preset")
        self.assert_complete("preset", ["visibility.blur.even"], of_svgf)

    def test_a_capture_immediately_after_the_patch(self):
        self.own("at-once")
        self.capture("at-once")
        for use, buffer in (("always", "reference"), ("off", "gbuffer.normals")):
            self.patch("at-once", {"reference": {"use": use}})
            self.capture("at-once", buffer)

    def test_unknown_buffers_are_refused(self):
        self.own("names")
        self.assert_error(self.ask_for("names", "gbuffer.norml"), -32602, path="buffer",
                          limit="frame.buffers")
        answer = self.server.ask("settings.patch", {"patch": {"view": {"buffer": "depht"}}},
                                 session="names")
        self.assert_error(answer, -32602, path="view.buffer", limit="frame.buffers")


class FromTheStart(Sessions, ServerTestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.fault = os.path.join(cls.folder.name, "lose")
        cls.server = Server("--set", "specular.enabled=false", "--set",
                            "view.buffer=specular.denoised",
                            environment={"HELIOGRAPH_TEST_DEVICE_LOSS": cls.fault})

    def reset(self):
        pass  # what it was started with is what is tested

    def losses(self):
        page = self.server.get("/metrics")[2].decode()
        return [line for line in page.splitlines()
                if line.startswith("heliograph_device_losses_total")]

    def test_options_and_the_loss_of_the_device(self):
        self.assert_exposed("main")
        self.own("second", scene="mirror")
        self.assert_exposed("second")
        before = self.losses()
        with open(self.fault, "w", encoding="ascii"):
            pass
        self.patch("main", {"exposure": {"compensation": 1}})
        self.server.ask("frame.capture")
        self.server.wait_for(lambda: self.losses() != before, "the loss")
        self.server.wait_for(lambda: self.server.get("/health/ready")[0] == 200, "the recovery")
        for session in ("main", "second"):
            self.assertGreater(self.brightness(session), 20)
            self.assert_exposed(session)
