"""What Granja and Pereira (2021) show and state: figures, tables and findings of section 4."""

import dataclasses

from plan import MOVEMENTS

TITLES = {"svgf": "our SVGF", "rectification": "history rectification",
          "adapted": "adapted blur", "separable": "separable blur",
          "reinhard": "Reinhard tone mapping"}
MOVEMENT_TITLES = {"static": "static camera", "moving_camera": "moving camera",
                   "moving_objects_light": "moving objects and light"}
SWEPT_TITLES = {"cubes_distance": "surface roughness", "breakfast_room": "shadow angle, degrees"}
SCENE_TITLES = {"cubes_distance": "Cubes Distance", "breakfast_room": "Breakfast Room",
                "icosphere": "Icosphere", "glossy_sponza_1": "Glossy Sponza 1",
                "glossy_sponza_2": "Glossy Sponza 2", "glossy_sponza_3": "Glossy Sponza 3",
                "shadow_objects": "Shadow Objects", "pillars": "Pillars"}


@dataclasses.dataclass(frozen=True)
class Figure:
    number: int
    scene: str
    before: str
    after: str
    movements: tuple = MOVEMENTS


# The paper shows no moving camera for shadows: "almost no differences to the static camera".
QUALITY = (
    Figure(5, "cubes_distance", "svgf", "rectification"),
    Figure(6, "cubes_distance", "rectification", "adapted"),
    Figure(7, "cubes_distance", "adapted", "separable"),
    Figure(8, "cubes_distance", "separable", "reinhard"),
    Figure(9, "breakfast_room", "svgf", "rectification", ("static", "moving_objects_light")),
    Figure(10, "breakfast_room", "rectification", "adapted", ("static", "moving_objects_light")),
    Figure(11, "breakfast_room", "adapted", "separable", ("static", "moving_objects_light")),
)
TIMES = (
    Figure(12, "cubes_distance", "svgf", "rectification"),
    Figure(13, "breakfast_room", "svgf", "rectification"),
    Figure(14, "cubes_distance", "rectification", "adapted"),
    Figure(15, "breakfast_room", "rectification", "adapted"),
    Figure(16, "cubes_distance", "adapted", "separable"),
    Figure(17, "breakfast_room", "adapted", "separable"),
)

# Tables 1 and 2: frames per second, (max, avg, min).
RATES = {
    "cubes_distance": (80.1, 79.2, 76.5), "icosphere": (79.8, 77.2, 76.1),
    "glossy_sponza_1": (51.9, 51.5, 51.2), "glossy_sponza_2": (45.6, 45.3, 45.2),
    "glossy_sponza_3": (44.5, 43.4, 43.1), "shadow_objects": (86.8, 84.4, 83.8),
    "pillars": (83.7, 82.6, 82.1), "breakfast_room": (45.5, 45.1, 44.9),
}
# Section 4.2: the four blur iterations of SVGF in Cubes Distance at roughness 0.3, milliseconds.
BLUR_MS = (1.93, 1.87, 1.86, 1.86)
BLUR_ROUGHNESS = 0.3


@dataclasses.dataclass(frozen=True)
class Finding:
    """A statement of the text about the change from `before` to `after`.

    kind: "rises", "falls" (paired t test, p < .05), "similar" (two one-sided tests: the change lies
    within `margin`), "more_in_motion" (the change with `movement` is larger than in a static view),
    "falls_along" (the change decreases as the swept value rises), or "lower_in_motion" (`after`
    itself is lower with `movement` than in a static view).
    """
    key: str
    figure: int
    statement: str
    kind: str
    movements: tuple
    values: tuple
    measure: str = "ssim"
    margin: float = 0.01


STATIC, CAMERA, OBJECTS = (("static",), ("moving_camera",), ("moving_objects_light",))
LOW_ANGLES, HIGH_ANGLES = (0.0, 0.5, 1.0, 2.0), (8.0, 10.0, 12.0)
EVERY = ()

FINDINGS = (
    Finding("5a-zero", 5, "Static: an increase at roughness 0", "rises", STATIC, (0.0,)),
    Finding("5a-low", 5, "Static: a decrease at .1 to .4", "falls", STATIC, (0.1, 0.2, 0.3, 0.4)),
    Finding("5a-high", 5, "Static: a similar quality at .6 and 1", "similar", STATIC, (0.6, 1.0)),
    Finding("5a-noise", 5, "Static: temporally unstable noise becomes more apparent", "rises",
            STATIC, EVERY, "flicker"),
    Finding("5b-low", 5, "Moving camera: an increase at 0 and .1", "rises", CAMERA, (0.0, 0.1)),
    Finding("5b-mid", 5, "Moving camera: a decrease at .2 to .4", "falls", CAMERA,
            (0.2, 0.3, 0.4)),
    Finding("5b-high", 5, "Moving camera: a similar result at .6 and 1", "similar", CAMERA,
            (0.6, 1.0)),
    Finding("5b-better", 5, "Moving camera: better results than static, from less ghosting",
            "more_in_motion", CAMERA, EVERY),
    Finding("5c-lower", 5, "Moving objects and light: a larger divergence from ground truth",
            "lower_in_motion", OBJECTS, EVERY),
    Finding("6-similar", 6, "Adapted blur: the quality remains very similar", "similar", MOVEMENTS,
            EVERY),
    Finding("6-noise", 6, "Adapted blur: less temporally unstable noise (static, above .2)",
            "falls", STATIC, (0.3, 0.4, 0.6, 1.0), "flicker"),
    Finding("7-low", 7, "Separable blur: low roughness is affected by over blurring", "falls",
            MOVEMENTS, (0.0, 0.1)),
    Finding("7-high", 7, "Separable blur: largely unchanged above", "similar", MOVEMENTS,
            (0.3, 0.4, 0.6, 1.0)),
    Finding("8-slight", 8, "Reinhard: a slight divergence from ground truth", "falls", MOVEMENTS,
            EVERY),
    Finding("8-similar", 8, "Reinhard: the results stay largely the same", "similar", MOVEMENTS,
            EVERY),
    Finding("9a-low", 9, "Static: improvements towards low angles", "rises", STATIC, LOW_ANGLES),
    Finding("9a-high", 9, "Static: a worsening towards high angles", "falls", STATIC, HIGH_ANGLES),
    Finding("9a-gradual", 9, "Static: the worsening is gradual", "falls_along", STATIC, EVERY),
    Finding("9b-better", 9, "Moving objects and light: more positive than static",
            "more_in_motion", OBJECTS, EVERY),
    Finding("10-similar", 10, "Adapted blur: the quality remains very similar", "similar",
            ("static", "moving_objects_light"), EVERY),
    Finding("10-noise", 10, "Adapted blur: less noise (static, above 6 degrees)", "falls", STATIC,
            HIGH_ANGLES, "flicker"),
    Finding("11-low", 11, "Separable blur: low angles are affected by over blurring", "falls",
            ("static", "moving_objects_light"), (0.0, 0.5, 1.0)),
    Finding("11-high", 11, "Separable blur: similar at other angles", "similar",
            ("static", "moving_objects_light"), (4.0, 6.0, 8.0, 10.0, 12.0)),
)
