"""What is measured: the runs of heliograph-experiments, at a size that fits the machine."""

import dataclasses

LADDER = ("svgf", "rectification", "adapted", "separable", "reinhard")
LATER = ("best", "fast_history", "percentile", "gradient")
UPSAMPLED = "best_upsampled"
INDIRECT = "best_indirect"
MOVEMENTS = ("static", "moving_camera", "moving_objects_light")
REFLECTIONS = ("cubes_distance", "icosphere", "glossy_sponza_1", "glossy_sponza_2",
               "glossy_sponza_3")
SHADOWS = ("shadow_objects", "pillars", "breakfast_room")
SCENES = REFLECTIONS + SHADOWS
# The scenes of figures 5 to 11, and the movements that they show.
SWEPT = {"cubes_distance": MOVEMENTS, "breakfast_room": ("static", "moving_objects_light")}
# The movements of figures 18 and 19; of other scenes a moving camera is shown.
SHOWN = {"cubes_distance": MOVEMENTS, "breakfast_room": ("moving_camera", "moving_objects_light"),
         "shadow_objects": ("static", "moving_camera")}
ROUGHNESS = (0.0, 0.1, 0.2, 0.3, 0.4, 0.6, 1.0)
ANGLES = (0.0, 0.5, 1.0, 2.0, 4.0, 6.0, 8.0, 10.0, 12.0)


@dataclasses.dataclass(frozen=True)
class Size:
    """How large a measurement is. Sweeps repeat it per value, technique, movement and seed."""
    name: str
    sweep: str              # frame size of figures 5 to 11
    view: str               # frame size of images and times
    frames: int
    view_frames: int
    timed_frames: int
    samples: int            # of ground truth
    view_samples: int
    seeds: tuple
    texture_size: int
    roughness: tuple = ROUGHNESS
    angles: tuple = ANGLES
    scenes: tuple = SCENES
    frames_over_time: int = 64
    frame_rate: int = 30
    together: bool = False  # all values of a sweep in one run: starting costs more than rendering

    def values(self, scene):
        return self.roughness if scene in REFLECTIONS else self.angles

    def value_of_images(self, scene):
        """The swept value that images, times and the comparison of all scenes show."""
        wanted = 0.2 if scene in REFLECTIONS else 10.0
        return min(self.values(scene), key=lambda value: abs(value - wanted))


SIZES = {
    "tiny": Size("tiny", "64x36", "64x36", 4, 4, 4, 4, 4, (1, 2), 32, (0.0, 0.2), (0.0, 10.0),
                 ("cubes_distance", "breakfast_room"), 6, together=True),
    "small": Size("small", "160x90", "256x144", 20, 16, 12, 64, 48, (1, 2, 3), 64),
    "full": Size("full", "640x360", "1280x720", 60, 60, 60, 1024, 1024, (1, 2, 3, 4, 5, 6, 7, 8), 512,
                 frame_rate=60),
}


@dataclasses.dataclass(frozen=True)
class Unit:
    """One run of heliograph-experiments; a finished one is not repeated."""
    name: str
    what: str
    arguments: tuple
    rows: int     # lines of progress that it prints
    cost: float   # relative to other units


def pixels(size):
    width, height = size.split("x")
    return int(width) * int(height)


def heaviness(scene):
    return 2.0 if "sponza" in scene else 1.0


class Planner:
    def __init__(self, size, device=""):
        self.size = size
        self.device = device

    def unit(self, name, what, scene, frame_size, rows, frames, samples, *options, moments=1):
        """moments: how many frames have ground truth"""
        arguments = ["--scenes", scene, "--size", frame_size, "--frames", str(frames),
                     "--frame-rate", str(self.size.frame_rate), "--samples", str(max(1, samples)),
                     "--texture-size", str(self.size.texture_size), *options]
        if self.device:
            arguments += ["--device", self.device]
        cost = pixels(frame_size) * heaviness(scene) * (rows * frames + moments * samples)
        return Unit(name, what, tuple(arguments), rows, cost)

    @staticmethod
    def moments(movements):
        """Ground truth of the frames that are compared: one in a static view, else three."""
        return sum(1 if movement == "static" else 3 for movement in movements)

    def sweep(self, name, scene, values, presets, movements, seeds, *options, truth=True):
        """truth: whether an earlier unit has not left ground truth already"""
        size = self.size
        rows = len(values) * len(movements) * len(seeds) * len(presets)
        texts = [f"{value:g}" for value in values]
        return self.unit(name, f"quality of {scene} at {', '.join(texts)}", scene, size.sweep,
                         rows, size.frames, size.samples, "--values", ",".join(texts), "--presets",
                         ",".join(presets), "--movements", ",".join(movements), "--seeds",
                         ",".join(map(str, seeds)), "--without-timings", *options,
                         moments=len(values) * self.moments(movements) if truth else 0)

    def sweeps(self):
        """Figures 5 to 11. A unit per value, which can be kept, unless that costs more."""
        for scene, movements in SWEPT.items():
            values = self.size.values(scene)
            parts = [values] if self.size.together else [(value,) for value in values]
            for part in parts:
                name = "_".join(["sweep", scene, *(f"{value:g}" for value in part)])
                yield self.sweep(name, scene, part, LADDER, movements, self.size.seeds)

    def later_techniques(self):
        """Further lines of these figures: techniques that the paper does not have."""
        for scene, movements in SWEPT.items():
            values, seeds = self.size.values(scene), self.size.seeds[:1]
            yield self.sweep(f"later_{scene}", scene, values, LATER, movements, seeds, truth=False)
            yield self.sweep(f"upsampled_{scene}", scene, values, ("best",), movements, seeds,
                             "--draw-scale", "0.67", truth=False)

    def images(self):
        """Figures 18 and 19, and the strips of every scene."""
        size = self.size
        for scene in size.scenes:
            movements = SHOWN.get(scene, ("moving_camera",))
            presets = LADDER + ("best",)
            yield self.unit(f"view_{scene}", f"images of {scene}", scene, size.view,
                            len(presets) * len(movements), size.view_frames, size.view_samples,
                            "--values", f"{size.value_of_images(scene):g}", "--presets",
                            ",".join(presets), "--movements", ",".join(movements), "--seeds",
                            str(size.seeds[0]), "--without-timings",
                            moments=self.moments(movements))

    def all_scenes(self):
        """Every scene with every movement."""
        for scene in self.size.scenes:
            yield self.sweep(f"scene_{scene}", scene, (self.size.value_of_images(scene),),
                             ("svgf", "rectification", "reinhard", "best"), MOVEMENTS,
                             self.size.seeds[:1])

    def indirect(self):
        """Indirect diffuse light: compared with the path tracer with global illumination."""
        for scene in self.size.scenes:
            yield self.sweep(f"indirect_{scene}", scene, (self.size.value_of_images(scene),),
                             ("best", "reinhard"), ("moving_camera",), self.size.seeds[:1],
                             "--truth", "full")

    def times(self):
        """Figures 12 to 17, then tables 1 and 2."""
        size = self.size
        presets = LADDER + ("best",)
        for scene in SWEPT:
            values = size.values(scene)
            yield self.unit(f"times_{scene}", f"times of {scene}", scene, size.view,
                            len(presets) * len(values), size.timed_frames, 0,
                            "--without-quality", "--movements", "static", "--presets",
                            ",".join(presets), "--values", ",".join(f"{v:g}" for v in values))
        for scene in size.scenes:
            yield self.unit(f"rates_{scene}", f"frame rates of {scene}", scene, size.view, 4,
                            size.timed_frames, 0, "--without-quality", "--movements",
                            "moving_camera,moving_objects_light", "--presets", "reinhard,best")

    def over_time(self):
        size = self.size
        for scene in ("cubes_distance", "breakfast_room"):
            for name, setting in (("denoised", "false"), ("accumulated", "true")):
                yield self.unit(f"over_time_{name}_{scene}", f"static view of {scene} over time",
                                scene, size.sweep, 4, size.frames_over_time, size.samples,
                                "--without-quality", "--without-timings", "--over-time",
                                "--values", f"{size.value_of_images(scene):g}",
                                "--presets", "svgf,rectification,reinhard,best",
                                "--set", f"accumulation.enabled={setting}")

    def units(self):
        """The most telling first: a page can be made of what is finished."""
        return [*self.sweeps(), *self.times(), *self.images(), *self.over_time(),
                *self.later_techniques(), *self.indirect(), *self.all_scenes()]

    def comparison(self, preset, against):
        """A preset of a file beside another, in every scene and with every movement."""
        size = self.size
        for scene in size.scenes:
            values = size.values(scene)
            chosen = sorted({values[0], values[len(values) // 2], size.value_of_images(scene)})
            rows = 2 * len(MOVEMENTS) * (len(size.seeds) + 1) * len(chosen)
            yield self.unit(f"preset_{scene}", f"both presets in {scene}", scene, size.sweep,
                            rows, size.frames, size.samples, "--values",
                            ",".join(f"{value:g}" for value in chosen), "--preset", preset,
                            "--against", against, "--seeds", ",".join(map(str, size.seeds)))
