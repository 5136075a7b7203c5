"""Khronos' glTF-Render-Fidelity set: its files, its views, and what renders a view here.

The set is a checkout of KhronosGroup/glTF-Render-Fidelity-Generator, which has the views, full
images, environments and (as a submodule) models; or of KhronosGroup/glTF-Render-Fidelity, the site,
which has the views with all defaults filled in, thumbnails, and the generator as a submodule.
"""

import json
import math
from dataclasses import dataclass
from pathlib import Path

SITE, GENERATOR = "glTF-Render-Fidelity", "glTF-Render-Fidelity-Generator"
CONFIGS = ("test/config.json", f"{GENERATOR}/test/config.json", "comparison/results/config.json")
# Full images before thumbnails, which are 512 pixels wide (src/scripts/thumbnail_worker.mjs).
IMAGE_FOLDERS = ("test/goldens", f"{GENERATOR}/test/goldens", "public/images/goldens",
                 "public/thumbnails/goldens")
IMAGE_NAMES = ("{}-golden.png", "{}-golden.thumb.webp")
# What a view does not say (src/config-reader.ts of the generator).
DEFAULTS = {"lighting": "../../../environments/lightroom_14b.hdr",
            "dimensions": {"width": 768, "height": 768},
            "target": {"x": 0.0, "y": 0.0, "z": 0.0},
            "orbit": {"theta": 0.0, "phi": 90.0, "radius": 1.0},
            "verticalFoV": 45.0, "renderSkybox": False, "exclude": []}
LFS_POINTER = b"version https://git-lfs"
# That of Cycles by default; three-gpu-pathtracer takes 8.
BOUNCES = 12
# All engines use three.js' ACES curve at exposure 1 (test/renderers of the generator), which is
# ours at 0 EV. The path tracer samples a sun as a part of the environment, as theirs do.
SETTINGS = {"tone_map": {"curve": "aces"}, "exposure": {"mode": "manual", "compensation": 0.0},
            "environment": {"separate_sun": False}, "background": {"ground": "off"}}


@dataclass(frozen=True)
class Scenario:
    """A view of a model: degrees, and the units of the file."""
    name: str
    model: str
    lighting: str
    width: int
    height: int
    target: tuple
    theta: float
    phi: float
    radius: float
    vertical_fov: float
    sky: bool
    excluded: frozenset


def is_file(path):
    """Whether its content is there: Git leaves a pointer where LFS is missing."""
    if not path.is_file():
        return False
    with path.open("rb") as file:
        return file.read(len(LFS_POINTER)) != LFS_POINTER


def scenario_of(entry):
    def filled(member):
        return {**DEFAULTS[member], **entry.get(member, {})}

    size, target, orbit = filled("dimensions"), filled("target"), filled("orbit")
    whole = {**DEFAULTS, **entry}
    return Scenario(name=entry["name"], model=entry["model"], lighting=whole["lighting"],
                    width=int(size["width"]), height=int(size["height"]),
                    target=(target["x"], target["y"], target["z"]), theta=orbit["theta"],
                    phi=orbit["phi"], radius=orbit["radius"], vertical_fov=whole["verticalFoV"],
                    sky=whole["renderSkybox"], excluded=frozenset(whole["exclude"]))


class FidelitySet:
    """`config`: the file that lists the engines and the views."""

    def __init__(self, roots, config):
        self.roots = roots
        content = json.loads(config.read_text(encoding="utf-8"))
        self.engines = [renderer["name"] for renderer in content["renderers"]]
        self.scenarios = [scenario_of(entry) for entry in content["scenarios"]]

    def file(self, reference):
        """A model or an environment, which views name relative to a page three folders deep."""
        parts = [part for part in Path(reference).parts if part != ".."]
        for root in self.roots:
            for folder in (root, root / GENERATOR):
                path = folder.joinpath(*parts)
                if is_file(path):
                    return path
        return None

    def images(self, scenario):
        """The images of the engines that take part in a view, by their names."""
        found = {}
        for engine in self.engines:
            if engine in scenario.excluded:
                continue
            candidates = (root / folder / scenario.name / name.format(engine)
                          for folder in IMAGE_FOLDERS for root in self.roots
                          for name in IMAGE_NAMES)
            path = next(filter(is_file, candidates), None)
            if path:
                found[engine] = path
        return found


def find_set(assets):
    """The set in the folder `assets` or in one of its name below it, or None."""
    folders = (assets / GENERATOR, assets / SITE, assets)
    roots = [folder for folder in folders if folder.is_dir()]
    for root in roots:
        for name in CONFIGS:
            if is_file(root / name):
                return FidelitySet(roots, root / name)
    return None


def view_of(scenario):
    """The camera as `heliograph render --manifest` takes it.

    three.js' spherical coordinates: phi from +Y, theta from +Z towards +X. Without a radius the
    camera is at the target and looks where it would look from outside.
    """
    theta, phi = math.radians(scenario.theta), math.radians(scenario.phi)
    outward = (math.sin(phi) * math.sin(theta), math.cos(phi), math.sin(phi) * math.cos(theta))
    eye = [t + scenario.radius * o for t, o in zip(scenario.target, outward)]
    target = list(scenario.target)
    if scenario.radius == 0:
        target = [e - o for e, o in zip(eye, outward)]
    # Perpendicular to the direction, so that it is right at the poles, too.
    up = [-math.cos(phi) * math.sin(theta), math.sin(phi), -math.cos(phi) * math.cos(theta)]
    return {"eye": eye, "target": target, "up": up, "vertical_fov": scenario.vertical_fov}


def manifest_entry(scenario, model, environment, output, samples, hybrid=False):
    """One entry of the manifest. Our equirectangular mapping is three.js': no rotation."""
    entry = {"scene": str(model), "environment": str(environment), "output": str(output),
             "width": scenario.width, "height": scenario.height, "view": view_of(scenario),
             "background": "sky" if scenario.sky else "transparent", "samples": samples,
             "settings": SETTINGS}
    if not hybrid:
        entry["reference"] = "full"
        entry["settings"] = {**SETTINGS, "reference": {"bounces": BOUNCES}}
    return entry
