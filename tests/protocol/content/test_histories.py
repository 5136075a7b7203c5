"""Histories are reset where the new frame has nothing in common with the previous one."""

import base64

from harness.images import decode_png
from harness.server import Server, ServerTestCase
from harness.viewer import FLAG_DISCONTINUITY, Viewer


class Histories(ServerTestCase):
    @classmethod
    def setUpClass(cls):
        # One frame for every change, so that each is seen.
        cls.server = Server("--scene", "mirror", "--set", "accumulation.max_samples=1")

    def history_lengths(self):
        """How many lengths of history there are in the image: surfaces that have just been
        seen for the first time, all of them, have one; so has the background."""
        capture = self.server.call("frame.capture",
                                   {"buffer": "visibility.history_length", "samples": 1})
        image = decode_png(base64.b64decode(capture["data"], validate=True))
        pixels = zip(image.rgb[0::3], image.rgb[1::3], image.rgb[2::3])
        return len(set(pixels))

    def move(self):
        """Steps beside the spheres, so that some of the floor comes into view each time."""
        for step in range(6):
            self.server.call("camera.set", {"eye": [3 - 0.1 * step, 2, 3], "target": [0, 0.5, 0]})
            lengths = self.history_lengths()
        self.assertGreater(lengths, 2, "there is no history at all")

    def assert_forgets(self, what):
        self.assertLessEqual(self.history_lengths(), 2, f"{what}: the history was not reset")

    def test_switching_a_light_resets_the_history(self):
        # With ambient occlusion the history of visibility goes on without shadows.
        self.server.call("settings.patch", {"patch": {"indirect": {"enabled": False}}})
        for group, name in (("lighting", "direct"), ("lighting", "environment_diffuse"),
                            ("lighting", "environment_specular"), ("lighting", "emissive"),
                            ("shadows", "enabled"), ("ambient", "occlusion")):
            for value in (False, True):
                self.move()
                self.server.call("settings.patch", {"patch": {group: {name: value}}})
                self.assert_forgets(f"{group}.{name} = {value}")

    def test_another_sun_resets_the_history(self):
        for value in (False, True):
            self.move()
            self.server.call("settings.patch", {"patch": {"environment": {"separate_sun": value}}})
            self.assert_forgets("environment.separate_sun")

    def test_a_camera_jump_resets_the_history(self):
        self.move()
        self.server.call("camera.fit")
        self.assert_forgets("camera.fit")

    def test_another_scene_or_environment_resets_the_history(self):
        self.move()
        self.server.call("scene.load", {"name": "mirror"})
        self.assert_forgets("scene.load")

    def test_motion_keeps_the_history(self):
        self.move()
        self.server.call("settings.patch", {"patch": {"tone_map": {"curve": "aces"}}})
        self.server.call("settings.patch", {"patch": {"environment": {"rotation": 5}}})
        self.server.call("camera.set", {"eye": [2.4, 2, 3]})
        self.assertGreater(self.history_lengths(), 2)

    async def test_frames_after_a_jump_have_the_discontinuity_flag(self):
        async with Viewer(self.server) as viewer:
            async def flags_after(method, parameters, seq):
                await viewer.call("camera.set", {"seq": seq})
                await viewer.call(method, parameters)
                await viewer.call("camera.set", {"seq": seq + 1})
                flags, echo = 0, 0
                while echo != seq + 1:
                    frame = await viewer.next_frame()
                    echo = frame.header["input_seq_echo"]
                    # A frame may be rendered between the calls.
                    flags |= frame.header["flags"] if echo in (seq, seq + 1) else 0
                return flags & FLAG_DISCONTINUITY
            await flags_after("camera.set", {"eye": [3, 2, 3]}, 1)
            self.assertFalse(await flags_after("camera.set", {"eye": [3, 2, 2.9]}, 3))
            self.assertTrue(await flags_after("camera.fit", {}, 5))
