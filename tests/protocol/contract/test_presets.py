"""Presets of the denoiser, listed and applied."""

from harness.server import ServerTestCase
from harness.viewer import Viewer


class Presets(ServerTestCase):
    def test_presets_are_listed_in_the_order_of_the_paper(self):
        presets = self.server.call("settings.presets")["presets"]
        self.assertEqual([preset["name"] for preset in presets],
                         ["svgf", "rectification", "adapted", "separable", "reinhard", "best"])
        self.assertTrue(all(preset["description"] for preset in presets))

    def test_a_preset_resets_the_denoiser_and_nothing_else(self):
        defaults = self.server.call("settings.get")["settings"]
        self.server.call("settings.patch", {"patch": {
            "exposure": {"compensation": 1.5}, "specular": {"half_resolution": True},
            "shadow_blur": {"normal_power": 3.0, "depth_sigma": 2.0, "iterations": 2},
            "reprojection": {"depth_tolerance": 50.0}}})
        before = self.server.call("settings.get")
        answer = self.server.call("settings.preset", {"name": "svgf"})
        self.assertEqual(answer["applied"]["specular_temporal"]["rectification"], "off")
        after = self.server.call("settings.get")
        self.assertGreater(after["rev"], before["rev"])
        self.assertEqual(after["settings"]["specular_blur"]["kernel"], "full")
        self.assertEqual(after["settings"]["exposure"]["compensation"], 1.5)
        self.assertEqual(after["settings"]["shadow_blur"]["normal_power"],
                         defaults["shadow_blur"]["normal_power"])
        self.server.call("settings.preset", {"name": "best"})
        best = self.server.call("settings.get")["settings"]
        for group in ("exposure", "specular"):
            self.assertEqual(best.pop(group), before["settings"][group])
            defaults.pop(group)
        self.assertEqual(best, defaults)

    def test_an_unknown_preset_is_refused(self):
        before = self.server.call("settings.get")
        self.assert_error(self.server.ask("settings.preset", {"name": "beste"}), -32004,
                          path="name")
        self.assert_error(self.server.ask("settings.preset", {}), -32602, path="name")
        self.assertEqual(self.server.call("settings.get"), before)

    async def test_other_viewers_are_notified(self):
        async with Viewer(self.server) as causer, Viewer(self.server) as other:
            await causer.call("settings.preset", {"name": "separable"})
            changed = await other.notification("settings.changed")
            self.assertEqual(changed["patch"]["shadow_blur"]["variance_update"], "vertical_only")
            self.assertEqual(changed["by"], causer.hello["viewer"])
