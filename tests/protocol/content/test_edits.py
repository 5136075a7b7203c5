"""Edits of a session: lights, materials, environment; picking and inspection."""

import base64
import json
import math
import os
import shutil
import tempfile

from harness.models import Model
from harness.images import decode_png, difference
from harness.server import Server, ServerTestCase
from harness.viewer import Viewer


class Edits(ServerTestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        given = os.environ["HELIOGRAPH_SCENES"]
        for name in ("mirror.glb", "furnace.glb", "sky.hdr", "white.hdr"):
            shutil.copy(os.path.join(given, name), cls.folder.name)
        model = Model(os.path.join(given, "furnace.glb"))
        model.add_light("sun", color=(1.0, 0.5, 0.25))
        model.add_light("sun", kind="point", intensity=20.0, translation=[0, 3, 0])
        model.save(os.path.join(cls.folder.name, "lit.glb"))
        glass = next(one for one in model.json["materials"] if one["name"] == "diffuse")
        glass["extensions"] = {"KHR_materials_transmission": {"transmissionFactor": 0.75},
                               "KHR_materials_ior": {"ior": 1.25}}
        model.json.setdefault("extensionsUsed", []).extend(glass["extensions"])
        model.save(os.path.join(cls.folder.name, "glass.glb"))
        with open(os.path.join(cls.folder.name, "broken.hdr"), "wb") as file:
            file.write(b"#?RADIANCE\nnothing")
        cls.server = Server("--scene", "mirror", "--set", "antialiasing.jitter=false",
                            scenes=cls.folder.name)

    def reset(self):
        super().reset()
        self.server.call("scene.load", {"name": "lit"})
        self.server.call("camera.fit")
        self.server.call("settings.patch", {"patch": {
            "environment": {"intensity": 0.1}, "accumulation": {"max_samples": 48}}})

    def image(self):
        capture = self.server.call("frame.capture")
        return decode_png(base64.b64decode(capture["data"]))

    def light(self, name="sun"):
        lights = self.server.call("lights.list")["lights"]
        return next(light for light in lights if light["name"] == name)

    def test_lights_are_listed_with_members_of_their_type(self):
        sun, point = self.server.call("lights.list")["lights"]
        self.assertEqual((sun["name"], sun["type"], sun["enabled"]), ("sun", "directional", True))
        self.assertEqual((sun["intensity"], sun["color"]), (3.0, [1.0, 0.5, 0.25]))
        self.assertAlmostEqual(sun["direction"][1], -1, places=5)
        self.assertEqual((point["name"], point["type"]), ("sun 2", "point"))
        self.assertEqual(point["position"], [0, 3, 0])
        self.assertNotIn("angular_diameter", point)
        self.assertNotIn("position", sun)

    def test_a_patched_light_shows_in_the_next_frame(self):
        before = self.image()
        state = self.server.call("lights.patch", {"light": "sun", "patch": {"enabled": False}})
        self.assertFalse(state["light"]["enabled"])
        dark = self.image()
        self.assertLess(dark.mean(), before.mean() - 0.5)
        self.server.call("lights.patch", {"light": "sun", "patch": {"enabled": True}})
        self.server.call("lights.patch", {"light": "sun", "patch": {"intensity": 9}})
        self.assertGreater(self.image().mean(), before.mean() + 0.5)
        self.server.call("lights.patch", {"light": "sun", "patch": {"intensity": None}})
        self.assertEqual(self.light()["intensity"], 3.0)
        self.assertLess(difference(self.image(), before), 0.3 * difference(dark, before))

    def test_invalid_patches_are_refused_atomically(self):
        before = self.server.call("lights.list")
        for patch, path, limit in (
                ({"intensity": 1, "colour": [1, 1, 1]}, "patch.colour", "color"),
                ({"intensity": -1}, "patch.intensity", "0 to"),
                ({"intensity": "bright"}, "patch.intensity", ""),
                ({"color": [1, 2]}, "patch.color", ""),
                ({"angular_diameter": 91}, "patch.angular_diameter", "90"),
                ({"intensity": 1, "position": [0, 0, 0]}, "patch.position", ""),
                ({"direction": [0, 0, 0]}, "patch.direction", ""),
                ([], "patch", "")):
            answer = self.server.ask("lights.patch", {"light": "sun", "patch": patch})
            self.assert_error(answer, -32602, path=path, limit=limit)
        answer = self.server.ask("lights.patch", {"light": "sum", "patch": {}})
        self.assert_error(answer, -32004, path="light")
        self.assertIn("sun", answer["error"]["message"])
        self.assert_error(self.server.ask("lights.patch", {"light": "sun"}), -32602, path="patch")
        self.assertEqual(self.server.call("lights.list"), before)

    def test_a_patched_material_shows_in_the_next_frame(self):
        before = self.image()
        names = [one["name"] for one in self.server.call("materials.list")["materials"]]
        self.assertIn("diffuse", names)
        state = self.server.call("materials.patch", {
            "material": "diffuse", "patch": {"base_color": [1, 0, 0], "roughness": 0.5}})
        self.assertEqual(state["material"]["base_color"], [1, 0, 0])
        red = self.image()
        self.assertGreater(difference(red, before), 1)
        self.server.call("materials.patch", {
            "material": "diffuse", "patch": {"base_color": None, "roughness": None}})
        self.assertLess(difference(self.image(), before), 0.3 * difference(red, before))
        self.server.call("materials.patch",
                         {"material": "diffuse", "patch": {"emissive": [0, 5, 0]}})
        self.assertGreater(self.image().mean(), before.mean())
        for patch, path in (({"roughness": 2}, "patch.roughness"),
                            ({"rouhgness": 1}, "patch.rouhgness"),
                            ({"base_color": 1}, "patch.base_color")):
            answer = self.server.ask("materials.patch", {"material": "diffuse", "patch": patch})
            self.assert_error(answer, -32602, path=path)

    def material(self, name="diffuse"):
        materials = self.server.call("materials.list")["materials"]
        return next(material for material in materials if material["name"] == name)

    def patch_material(self, **patch):
        return self.server.call("materials.patch", {"material": "diffuse", "patch": patch})

    def test_factors_of_extensions_are_listed_and_show_in_the_next_frame(self):
        file = self.material()
        self.assertEqual((file["ior"], file["clearcoat"], file["sheen_color"]), (1.5, 0, [0, 0, 0]))
        self.assertNotIn("transmission", file)
        # On a dark surface that reflects the most.
        self.server.call("settings.patch", {"patch": {"environment": {"intensity": 1}}})
        dark = self.patch_material(base_color=[0.02, 0.02, 0.02], roughness=0.2)["material"]
        before = self.image()
        for patch in ({"sheen_color": [0, 0, 1], "sheen_roughness": 0.5},
                      {"specular_color": [0, 0, 0]}, {"ior": 2.5}, {"clearcoat": 1.0},
                      {"diffuse_transmission": 1.0, "diffuse_transmission_color": [1, 0, 0]},
                      {"iridescence": 1.0, "iridescence_ior": 2.5,
                       "iridescence_thickness_maximum": 500}):
            changed = self.patch_material(**patch)["material"]
            self.assertEqual(set(changed["changed"]), set(dark["changed"]) | set(patch))
            edited = self.image()
            self.assertGreater(difference(edited, before), 0.1, patch)
            back = self.patch_material(**dict.fromkeys(patch))["material"]
            self.assertEqual(back, dark)
            self.assertLess(difference(self.image(), before), 0.5 * difference(edited, before))

    def test_a_volume_tints_light_that_scatters_through(self):
        self.assertEqual(self.material()["thickness"], 0)
        self.server.call("settings.patch", {"patch": {"environment": {"intensity": 1}}})
        white = self.patch_material(diffuse_transmission=1.0)["material"]
        before = self.image()
        volume = {"thickness": 1, "attenuation_distance": 0.1, "attenuation_color": [1, 0, 0]}
        changed = self.patch_material(**volume)["material"]
        self.assertEqual(set(changed["changed"]), {"diffuse_transmission"} | set(volume))
        tinted = self.image()
        self.assertGreater(difference(tinted, before), 0.1)
        self.assertEqual(self.patch_material(**dict.fromkeys(volume))["material"], white)
        self.assertLess(difference(self.image(), before), 0.5 * difference(tinted, before))

    def test_factors_of_extensions_have_limits(self):
        for patch, path, limit in (({"clearcoat": 1.5}, "patch.clearcoat", "0 to 1"),
                                   ({"ior": 0.5}, "patch.ior", ""),
                                   ({"sheen_color": [0, 2, 0]}, "patch.sheen_color[1]", "0 to 1"),
                                   ({"attenuation_distance": -1}, "patch.attenuation_distance", ""),
                                   ({"iridescence_ior": 0.5}, "patch.iridescence_ior", "1 to"),
                                   ({"anisotropy": 2}, "patch.anisotropy", "0 to 1"),
                                   ({"diffuse_transmission": -1}, "patch.diffuse_transmission",
                                    "0 to 1"),
                                   ({"anisotropy_rotation": 7}, "patch.anisotropy_rotation", ""),
                                   ({"dispersion": 0.5}, "patch.dispersion", ""),
                                   ({"transmission": 0.5}, "patch.transmission", ""),
                                   ({"alpha_cutoff": 0.5}, "patch.alpha_cutoff", "")):
            answer = self.server.ask("materials.patch", {"material": "diffuse", "patch": patch})
            self.assert_error(answer, -32602, path=path, limit=limit)

    def test_glass_is_edited_and_documents_carry_it(self):
        self.server.call("scene.load", {"name": "glass"})
        glass = self.material()
        self.assertEqual((glass["ior"], glass["transmission"], glass["thickness"]), (1.25, 0.75, 0))
        # Its image is noisy: rough glass in the light of an environment.
        self.server.call("settings.patch", {"patch": {"accumulation": {"max_samples": 256}}})
        before = self.image()
        self.patch_material(transmission=0.25, thickness=0.5, attenuation_distance=0.25,
                            attenuation_color=[1, 0, 0])
        edited = self.image()
        self.assertGreater(difference(edited, before), 0.2)
        state = self.server.call("edits.get")
        self.assertEqual(state["edits"]["materials"], [{"material": "diffuse", "patch": {
            "transmission": 0.25, "thickness": 0.5, "attenuation_distance": 0.25,
            "attenuation_color": [1, 0, 0]}}])
        self.patch_material(transmission=None, thickness=None, attenuation_distance=None,
                            attenuation_color=None)
        self.assertEqual(self.material(), glass)
        self.server.call("edits.apply", {"edits": state["edits"]})
        self.assertEqual(self.material()["transmission"], 0.25)
        self.assertLess(difference(self.image(), edited), 0.5 * difference(edited, before))

    def test_edits_do_not_affect_other_sessions(self):
        methods = {one["name"] for one in self.server.call("rpc.discover")["methods"]}
        if "session.create" not in methods:
            self.skipTest("this server makes no other sessions")
        self.server.call("session.create",
                         {"name": "other", "scene": "lit", "width": 64, "height": 36})
        try:
            self.server.call("lights.patch", {"light": "sun", "patch": {"intensity": 7}})
            call = {"jsonrpc": "2.0", "id": 1, "method": "lights.list"}
            _, _, body = self.server.request("POST", "/rpc?session=other", json.dumps(call))
            lights = json.loads(body)["result"]["lights"]
            self.assertEqual(lights[0]["intensity"], 3.0)
        finally:
            self.server.call("session.close", {"session": "other"})

    def test_another_scene_has_its_own_edits(self):
        self.server.call("lights.patch", {"light": "sun", "patch": {"intensity": 7}})
        self.server.call("scene.load", {"name": "lit"})
        self.assertEqual(self.light()["intensity"], 3.0)

    async def test_edits_are_notified_to_other_viewers(self):
        async with Viewer(self.server) as causer, Viewer(self.server) as other:
            await causer.call("lights.patch", {"light": "sun", "patch": {"intensity": 5}})
            heard = await other.notification("lights.changed")
            self.assertEqual(heard["light"]["intensity"], 5)
            self.assertEqual(heard["by"], causer.hello["viewer"])
            await causer.call("materials.patch",
                              {"material": "diffuse", "patch": {"roughness": 0.3}})
            heard = await other.notification("materials.changed")
            self.assertAlmostEqual(heard["material"]["roughness"], 0.3)
            await causer.call("environment.set", {"name": "white"})
            self.assertEqual((await other.notification("environment.changed"))["current"], "white")
            await causer.call("scene.unload")
            self.assertEqual((await other.notification("scene.unloaded"))["name"], "lit")

    def test_a_chosen_environment_stays_with_other_scenes(self):
        shown = self.server.call("scene.info")["name"]
        self.server.call("environment.set", {"name": "white"})
        for name in ("mirror", shown):
            self.server.call("scene.load", {"name": name})
            self.assertEqual(self.server.call("environment.list")["current"], "white")
        self.server.call("environment.set", {"name": None})

    def test_environments(self):
        listed = self.server.call("environment.list")
        names = [one["name"] for one in listed["environments"]]
        self.assertEqual(sorted(names), ["broken", "sky", "studio", "white"])
        self.assertIsNone(listed["current"])
        before = self.image()
        state = self.server.call("environment.set", {"name": "white", "rotation": 40})
        self.assertEqual((state["current"], state["rotation"]), ("white", 40))
        white = self.image()
        self.assertGreater(difference(white, before), 5)
        state = self.server.call("environment.set", {"name": "studio"})
        self.assertEqual(state["current"], "studio")
        self.assertGreater(difference(self.image(), white), 5)
        state = self.server.call("environment.set", {"name": None, "rotation": 0})
        self.assertIsNone(state["current"])
        self.assertLess(difference(self.image(), before), 0.2 * difference(white, before))
        self.assert_error(self.server.ask("environment.set", {"name": "whiet"}), -32004,
                          path="name")
        self.assert_error(self.server.ask("environment.set", {"name": "../sky"}), -32004,
                          path="name")
        self.assert_error(self.server.ask("environment.set", {"name": "broken"}), -32602,
                          path="name")
        self.assert_error(self.server.ask("environment.set", {"rotation": 181}), -32602,
                          path="rotation")

    def test_picked_positions_project_to_the_picked_pixel(self):
        self.server.call("camera.set", {"name": "main"})
        camera = self.server.call("camera.get")
        # The ball "diffuse": radius as the generator has it, middle at (0, .6, 0).
        middle = [0, 0.6, 0]
        height = math.tan(math.radians(camera["vertical_fov"]) / 2)
        y = 0.5 - 0.5 * (middle[1] / camera["eye"][2]) / height
        picked = self.server.call("scene.pick", {"x": 0.5, "y": y})
        self.assertTrue(picked["hit"])
        self.assertEqual((picked["object"], picked["material"]), ("diffuse", "diffuse"))
        away = [a - b for a, b in zip(picked["position"], middle)]
        radius = math.hypot(*away)
        self.assertLess(abs(radius - 0.45), 0.1)
        for normal, expected in zip(picked["normal"], away):
            self.assertAlmostEqual(normal, expected / radius, delta=0.1)
        self.assertAlmostEqual(picked["distance"], math.dist(picked["position"], camera["eye"]),
                               places=3)
        sky = self.server.call("scene.pick", {"x": 0, "y": 0})
        self.assertEqual(sky, {"hit": False, "position": None, "normal": None, "distance": None,
                               "object": None, "material": None, "node": None})
        self.assert_error(self.server.ask("scene.pick", {"x": 1.5, "y": 0}), -32602, path="x")
        self.assert_error(self.server.ask("scene.pick", {"x": 0.5}), -32602, path="y")

    def test_picked_positions_lie_below_the_point_and_not_the_pixel(self):
        self.server.call("scene.load", {"name": "mirror"})
        self.server.call("settings.patch", {"patch": {"antialiasing": {"jitter": True}}})
        self.server.call("camera.set", {"eye": [0, 1.5, 6], "target": [0, 0.6, 0]})
        camera = self.server.call("camera.get")
        height = math.tan(math.radians(camera["vertical_fov"]) / 2)
        forward = [b - a for a, b in zip(camera["eye"], camera["target"])]
        # The floor is y = 0; in the plane x = 0 a point of the image is an angle.
        for y in (0.8, 0.802, 0.804, 0.806):
            angle = math.atan2(forward[1], -forward[2]) - math.atan((2 * y - 1) * height)
            expected = camera["eye"][2] - camera["eye"][1] / math.tan(-angle)
            picked = self.server.call("scene.pick", {"x": 0.5, "y": y})["position"]
            for value, exact in zip(picked, (0, 0, expected)):
                self.assertAlmostEqual(value, exact, delta=2e-3)

    def test_every_buffer_can_be_inspected(self):
        inspected = self.server.call("frame.inspect", {"x": 0.5, "y": 0.35})
        self.assertEqual((inspected["column"], inspected["row"]), (80, 31))
        values = {one["name"]: one for one in inspected["buffers"]}
        listed = [one["name"] for one in self.server.call("frame.buffers")["buffers"]]
        self.assertEqual([one["name"] for one in inspected["buffers"]], listed)
        depth = values["gbuffer.motion.view_z"]
        self.assertEqual((len(depth["value"]), depth["unit"]), (1, "metres"))
        picked = self.server.call("scene.pick", {"x": 0.5, "y": 0.35})
        self.assertTrue(picked["hit"])
        self.assertLess(depth["value"][0], picked["distance"] + 1e-3)
        self.assertEqual(len(values["gbuffer.instance"]["value"]), 1)
        self.assertEqual(len(values["gbuffer.depth_slope"]["value"]), 2)
        self.assertEqual(len(values["hdr"]["value"]), 4)

    def test_an_orbit_keeps_its_distance(self):
        before = self.server.call("camera.get")
        distance = math.dist(before["eye"], before["target"])
        after = self.server.call("camera.orbit", {"yaw": 90})
        self.assertAlmostEqual(math.dist(after["eye"], after["target"]), distance, places=4)
        self.assertEqual(after["target"], before["target"])
        arm = [a - b for a, b in zip(before["eye"], before["target"])]
        turned = [a - b for a, b in zip(after["eye"], after["target"])]
        self.assertAlmostEqual(turned[0], arm[2], places=4)
        self.assertAlmostEqual(turned[1], arm[1], places=4)
        self.assertAlmostEqual(turned[2], -arm[0], places=4)
        over = self.server.call("camera.orbit", {"pitch": 180})
        rise = (over["eye"][1] - over["target"][1]) / distance
        self.assertAlmostEqual(rise, math.sin(math.radians(89)), places=4)
        near = self.server.call("camera.orbit", {"dolly": 0.5})
        self.assertAlmostEqual(math.dist(near["eye"], near["target"]), distance / 2, places=4)
        far = self.server.call("camera.orbit", {"distance": 7})
        self.assertAlmostEqual(math.dist(far["eye"], far["target"]), 7, places=4)
        self.assert_error(self.server.ask("camera.orbit", {"dolly": 0}), -32602, path="dolly")

    def test_an_orbit_keeps_the_camera_in_range(self):
        far = self.server.call("camera.set", {"eye": [0, 0, 9e8], "target": [0, 0, 0]})
        for params, path in (({"dolly": 1000}, "dolly"),
                             ({"distance": 1e9, "dolly": 2}, "distance"),
                             ({"distance": 1e9, "dolly": 1000, "yaw": 1}, "distance")):
            answer = self.server.ask("camera.orbit", params)
            self.assert_error(answer, -32602, path=path, limit="-1e9 to 1e9")
            self.assertIn("out of range", answer["error"]["message"])
            self.assertEqual(self.server.call("camera.get"), far)
        self.server.call("camera.set", {"target": [0, 0, -9e8]})
        self.server.call("camera.orbit", {"yaw": 30})
        self.server.call("camera.set", {"eye": [0, 0, 0]})
        self.assert_error(self.server.ask("camera.orbit", {"yaw": 180}), -32602, path="yaw")
        at_most = self.server.call("camera.set", {"eye": [0, 0, 1e9], "target": [0, 0, 0]})
        pose = {name: at_most[name] for name in ("eye", "target", "up")}
        self.server.call("camera.set", pose)
        self.server.call("camera.orbit", {"distance": 1e9})

    def test_edits_and_picks_without_a_scene_are_refused(self):
        self.server.call("scene.unload")
        for method, params in (("lights.list", {}), ("materials.list", {}), ("camera.get", {}),
                               ("scene.pick", {"x": 0.5, "y": 0.5}), ("scene.info", {}),
                               ("frame.inspect", {"x": 0.5, "y": 0.5}), ("frame.capture", {})):
            self.assert_error(self.server.ask(method, params), -32050)
        self.assertIsNone(self.server.call("scene.list")["current"])
        self.server.call("scene.unload")
        self.server.call("scene.load", {"name": "lit"})
        self.assertGreater(self.image().deviation(), 5)
