#!/usr/bin/env python3
"""The parts of the comparison with the glTF-Render-Fidelity set, without the program."""

import base64
import json
import math
import sys
import tempfile
import unittest
from pathlib import Path

try:
    import numpy
    from PIL import Image
    import engines
    import fidelity
    import lighting
    import materials
    import scenarios
    import standing
    from small_set import MODELS, SIZE, SmallSet, rgba
except ImportError as missing:
    print(f"skipped: {missing}")
    sys.exit(77)


def scenario(**members):
    return scenarios.scenario_of({"name": "khronos-Test", "model": "Test.gltf", **members})


def plain(color, size=48):
    return numpy.full((size, size, 3), color, float)


class Engines(unittest.TestCase):
    def test_path_tracers_are_those_of_the_table(self):
        names = ["babylon", "vray", "another", "blender-cycles"]
        self.assertEqual(engines.path_traced(names), ["blender-cycles", "vray"])
        self.assertEqual(engines.unknown(names), ["another"])


class Camera(unittest.TestCase):
    def test_of_a_view_computed_by_hand(self):
        """theta 90: from +X; phi 60: 30 degrees above; radius 2: sqrt(3) away, 1 above."""
        view = scenarios.view_of(scenario(target={"x": 1.0, "y": 2.0, "z": 3.0}, verticalFoV=30.0,
                                          orbit={"theta": 90.0, "phi": 60.0, "radius": 2.0}))
        numpy.testing.assert_allclose(view["eye"], (1.0 + math.sqrt(3.0), 3.0, 3.0), atol=1e-12)
        self.assertEqual(view["target"], [1.0, 2.0, 3.0])
        numpy.testing.assert_allclose(view["up"], (-0.5, math.sqrt(0.75), 0.0), atol=1e-12)
        self.assertEqual(view["vertical_fov"], 30.0)

    def test_defaults_look_from_the_front(self):
        view = scenarios.view_of(scenario())
        numpy.testing.assert_allclose(view["eye"], (0.0, 0.0, 1.0), atol=1e-12)
        numpy.testing.assert_allclose(view["up"], (0.0, 1.0, 0.0), atol=1e-12)

    def test_without_radius_looks_away_from_where_it_would_stand(self):
        view = scenarios.view_of(scenario(target={"y": 1.0}, orbit={"theta": 90.0, "radius": 0.0}))
        numpy.testing.assert_allclose(view["eye"], (0.0, 1.0, 0.0), atol=1e-12)
        numpy.testing.assert_allclose(view["target"], (-1.0, 1.0, 0.0), atol=1e-12)

    def test_is_level_everywhere(self):
        for theta in range(-180, 180, 25):
            for phi in (0, 5, 60, 90, 150, 180):
                view = scenarios.view_of(scenario(orbit={"theta": theta, "phi": phi}))
                forward = numpy.subtract(view["target"], view["eye"])
                self.assertAlmostEqual(float(forward @ view["up"]), 0.0, 12)
                self.assertAlmostEqual(float(numpy.cross(forward, view["up"])[1]), 0.0, 12)

    def test_entry_of_a_manifest(self):
        entry = scenarios.manifest_entry(scenario(dimensions={"height": 450}), "a.glb", "b.hdr",
                                         "c.png", 16)
        self.assertEqual((entry["width"], entry["height"]), (768, 450))
        self.assertEqual(entry["background"], "transparent")
        self.assertEqual(entry["reference"], "full")
        sky = scenarios.manifest_entry(scenario(renderSkybox=True), "a.glb", "b.hdr", "c.png", 16,
                                       hybrid=True)
        self.assertEqual(sky["background"], "sky")
        self.assertNotIn("reference", sky)


class Similarity(unittest.TestCase):
    """The measures through what the ranking calls; their details are tested in tests/paper."""

    def score(self, first, second):
        return standing.scores_of({"ours": first, "vray": second}, ["vray"])["ours"]

    def test_equal_images(self):
        image = numpy.random.default_rng(2).integers(0, 256, (48, 48, 3)).astype(float)
        score = self.score(image, image)
        self.assertEqual(score.flip, 0.0)
        self.assertAlmostEqual(score.ssim, 1.0, 9)

    def test_black_and_white(self):
        self.assertGreater(self.score(plain(0), plain(255)).flip, 0.95)
        self.assertLess(self.score(plain(0), plain(255)).ssim, 0.01)

    def test_is_symmetric(self):
        noise = numpy.random.default_rng(3).integers(0, 256, (2, 48, 48, 3)).astype(float)
        there, back = self.score(noise[0], noise[1]), self.score(noise[1], noise[0])
        self.assertAlmostEqual(there.flip, back.flip, 12)
        self.assertAlmostEqual(there.ssim, back.ssim, 12)
        self.assertGreater(there.flip, 0.1)


class Ranking(unittest.TestCase):
    def test_path_tracers_are_compared_with_the_others(self):
        images = {"babylon": plain(200), "vray": plain(100), "stellar": plain(110),
                  "ours": plain(104)}
        scores = standing.scores_of(images, ["stellar", "vray"])
        both = [standing.measures.flip(images["ours"], images[truth])
                for truth in ("vray", "stellar")]
        self.assertAlmostEqual(scores["ours"].flip, sum(both) / 2, 12)
        self.assertAlmostEqual(scores["vray"].flip, scores["stellar"].flip, 12)
        self.assertEqual(standing.places_of(scores, "ours")[1], 1)
        self.assertEqual(standing.places_of(scores, "babylon"), (4, 4))

    def test_the_only_path_tracer_has_no_place(self):
        scores = standing.scores_of({"ours": plain(90), "vray": plain(100)}, ["vray"])
        self.assertEqual(list(scores), ["ours"])

    def test_equal_engines_share_a_place(self):
        scores = {"a": standing.Score(0.9, 0.1), "b": standing.Score(0.9, 0.1),
                  "c": standing.Score(0.8, 0.05)}
        self.assertEqual(standing.places_of(scores, "a"), (1, 2))
        self.assertEqual(standing.places_of(scores, "b"), (1, 2))
        self.assertEqual(standing.places_of(scores, "c"), (3, 1))


class Silhouettes(unittest.TestCase):
    def test_by_alpha(self):
        image = rgba((9, 9, 9), (10, 10, 20, 20))
        self.assertEqual(int(standing.silhouette(image).sum()), 100)

    def test_by_a_plain_background(self):
        image = rgba((255, 255, 255))
        image[10:20, 10:30, :3] = 40
        self.assertEqual(int(standing.silhouette(image).sum()), 200)

    def test_not_before_a_sky(self):
        image = rgba((0, 0, 0))
        image[..., 0] = numpy.arange(48) * 5
        self.assertIsNone(standing.silhouette(image))
        self.assertIsNone(standing.silhouette_difference(image, [image]))

    def test_difference_is_a_share_of_the_union(self):
        ours = rgba((9, 9, 9), (10, 10, 20, 20))
        moved, far = rgba((9, 9, 9), (11, 10, 21, 20)), rgba((9, 9, 9), (30, 30, 40, 40))
        self.assertAlmostEqual(standing.silhouette_difference(ours, [moved]), 20 / 110)
        self.assertAlmostEqual(standing.silhouette_difference(ours, [far]), 1.0)
        self.assertAlmostEqual(standing.silhouette_difference(ours, [far, ours]), 0.0)


class Pixels(unittest.TestCase):
    def test_nothing_is_enlarged(self):
        images = [Image.new("RGBA", (200, 100)), Image.new("RGBA", (1536, 768))]
        view = scenario(dimensions={"width": 768, "height": 384})
        self.assertEqual(standing.common_size(view, images, 512), (200, 100))
        self.assertEqual(standing.common_size(view, images[1:], 512), (512, 256))
        self.assertTrue(standing.has_aspect(images[0], view))
        self.assertFalse(standing.has_aspect(Image.new("RGBA", (100, 100)), view))

    def test_transparent_pixels_leave_no_trace(self):
        """Their color, black here, may not darken an edge."""
        image = Image.fromarray(rgba((255, 255, 255), (0, 0, 24, 48)))
        shown = standing.over_white(standing.scaled(image, (17, 17)))
        self.assertGreater(shown.min(), 253.0)


class Materials(unittest.TestCase):
    def kinds(self, *entries, **document):
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "model.gltf"
            path.write_text(json.dumps({"materials": list(entries), **document}))
            return materials.kinds_of(path)

    def test_of_extensions(self):
        dielectric = {"pbrMetallicRoughness": {"metallicFactor": 0.0}}
        glass, clear = ({**dielectric, "extensions": {"KHR_materials_transmission": factor}}
                        for factor in ({"transmissionFactor": 1.0}, {}))
        cloth = {**dielectric, "extensions": {
            "KHR_materials_sheen": {"sheenColorFactor": [1, 0, 0]}}}
        coat = {**dielectric, "extensions": {"KHR_materials_clearcoat": {"clearcoatFactor": 1.0}}}
        self.assertEqual(self.kinds(coat, cloth, glass), ["glass", "cloth", "coat"])
        self.assertEqual(self.kinds(clear, dielectric), [])

    def test_metal_is_the_default(self):
        self.assertEqual(self.kinds({}), ["metal"])
        self.assertEqual(self.kinds({"extensions": {"KHR_materials_unlit": {}}}), [])

    def test_metalness_of_a_texture(self):
        surface = {"metallicRoughnessTexture": {"index": 0}}
        for blue, found in ((200, ["metal"]), (60, [])):
            with tempfile.TemporaryDirectory() as folder:
                file = Path(folder) / "texture.png"
                Image.new("RGB", (4, 4), (0, 255, blue)).save(file)
                uri = "data:image/png;base64," + base64.b64encode(file.read_bytes()).decode()
            self.assertEqual(self.kinds({"pbrMetallicRoughness": surface},
                                        textures=[{"source": 0}], images=[{"uri": uri}]), found)


class Lighting(unittest.TestCase):
    def test_code_values_become_radiance(self):
        with tempfile.TemporaryDirectory() as folder:
            source = Path(folder) / "sky.png"
            Image.fromarray(numpy.array([[[255, 0, 0], [188, 188, 188]]], numpy.uint8)).save(source)
            content = lighting.environment_file(source, Path(folder)).read_bytes()
        self.assertTrue(content.startswith(b"#?RADIANCE\n"))
        pixels = numpy.frombuffer(content[-8:], numpy.uint8).reshape(2, 4).astype(float)
        radiance = pixels[:, :3] * 2.0 ** (pixels[:, 3:] - 136.0)
        numpy.testing.assert_allclose(radiance, [[1, 0, 0], [0.5029] * 3], atol=0.005)

    def test_radiance_stays(self):
        self.assertEqual(lighting.environment_file(Path("a/b.hdr"), Path("c")), Path("a/b.hdr"))


class Files(SmallSet):
    def test_are_found(self):
        self.describe({"name": "khronos-A", "exclude": ["babylon"]}, {"name": "khronos-B"})
        for name in ("khronos-A", "khronos-B"):
            for engine in ("babylon", "vray", "removed"):
                self.add_image(name, engine, rgba((1, 2, 3)))
        pointer = self.root / "test/goldens/khronos-B/vray-golden.png"
        pointer.write_bytes(scenarios.LFS_POINTER + b".github.com/spec/v1\n")
        found = scenarios.find_set(self.assets)
        self.assertEqual([list(found.images(view)) for view in found.scenarios],
                         [["vray"], ["babylon"]])
        self.assertEqual(found.file(MODELS + "Triangle.gltf"), self.model)
        self.assertIsNone(found.file(MODELS + "Other.gltf"))

    def test_thumbnails_of_the_site(self):
        self.describe({"name": "khronos-A"})
        thumbnail = (self.assets / scenarios.SITE / "public/thumbnails/goldens/khronos-A"
                     / "vray-golden.thumb.webp")
        thumbnail.parent.mkdir(parents=True)
        Image.new("RGBA", (SIZE, SIZE)).save(thumbnail)
        found = scenarios.find_set(self.assets)
        self.assertEqual(found.images(found.scenarios[0]), {"vray": thumbnail})

    def test_no_set(self):
        with tempfile.TemporaryDirectory() as folder:
            self.assertIsNone(scenarios.find_set(Path(folder)))

    def test_what_is_not_compared_says_why(self):
        self.describe({"name": "khronos-A"}, {"name": "khronos-B", "model": MODELS + "B.gltf"})
        self.add_image("khronos-A", "babylon", rgba((1, 2, 3)))
        found = scenarios.find_set(self.assets)
        views = [fidelity.planned(found, view, self.assets) for view in found.scenarios]
        self.assertEqual(views[0].skipped, "there is no path traced image")
        self.assertIn("B.gltf is missing", views[1].skipped)
        self.assertIn("skipped: ", fidelity.row(views[1]))

    def compared(self, ours):
        self.describe({"name": "khronos-A"}, names=("babylon", "filament", "vray"))
        box = (16, 16, 48, 48)
        self.add_image("khronos-A", "vray", rgba((100, 90, 80), box, SIZE))
        self.add_image("khronos-A", "babylon", rgba((120, 90, 80), box, SIZE))
        self.add_image("khronos-A", "filament", rgba((140, 90, 80), box, SIZE))
        found = scenarios.find_set(self.assets)
        view = fidelity.planned(found, found.scenarios[0], self.assets)
        Image.fromarray(ours).save(view.output)
        fidelity.compare(view, 512)
        return view

    def test_bars(self):
        box = (16, 16, 48, 48)
        good = self.compared(rgba((110, 90, 80), box, SIZE))
        self.assertEqual(good.kinds, ["metal"])
        self.assertEqual(fidelity.missed_bars(good), [])
        bad = self.compared(rgba((200, 20, 20), box, SIZE))
        self.assertEqual(fidelity.missed_bars(bad)[:2], ["SSIM: place 3", "FLIP: place 3"])
        moved = self.compared(rgba((110, 90, 80), (17, 16, 49, 48), SIZE))
        self.assertIn("silhouette: 6.1%", fidelity.missed_bars(moved))
        self.assertIn("MISSED", fidelity.row(moved))


if __name__ == "__main__":
    unittest.main()
