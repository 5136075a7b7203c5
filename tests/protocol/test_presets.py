"""Presets: named choices of settings, listed and applied."""

from harness.server import ServerTestCase
from harness.viewer import Viewer


class Presets(ServerTestCase):
    def test_the_ladder_is_listed_in_its_order(self):
        presets = self.server.call("settings.presets")["presets"]
        self.assertEqual([preset["name"] for preset in presets],
                         ["svgf", "rectification", "adapted", "separable", "reinhard", "best"])
        self.assertTrue(all(preset["description"] for preset in presets))

    def test_a_preset_changes_the_denoiser_and_nothing_else(self):
        self.server.call("settings.patch", {"patch": {"exposure": {"compensation": 1.5}}})
        before = self.server.call("settings.get")
        answer = self.server.call("settings.preset", {"name": "svgf"})
        self.assertEqual(answer["applied"]["specular_temporal"]["rectification"], "off")
        after = self.server.call("settings.get")
        self.assertGreater(after["rev"], before["rev"])
        self.assertEqual(after["settings"]["specular_blur"]["kernel"], "full")
        self.assertEqual(after["settings"]["exposure"]["compensation"], 1.5)
        self.server.call("settings.preset", {"name": "best"})
        best = self.server.call("settings.get")["settings"]
        self.assertEqual(best, before["settings"])

    def test_an_unknown_preset_is_refused(self):
        before = self.server.call("settings.get")
        self.assert_error(self.server.ask("settings.preset", {"name": "beste"}), -32004,
                          path="name")
        self.assert_error(self.server.ask("settings.preset", {}), -32602, path="name")
        self.assertEqual(self.server.call("settings.get"), before)

    async def test_other_viewers_hear_of_it(self):
        async with Viewer(self.server) as causer, Viewer(self.server) as other:
            await causer.call("settings.preset", {"name": "separable"})
            changed = await other.notification("settings.changed")
            self.assertEqual(changed["patch"]["shadow_blur"]["variance_update"], "vertical_only")
            self.assertEqual(changed["by"], causer.hello["viewer"])
