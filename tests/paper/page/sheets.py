"""Figures 18 and 19 and the strips of crops: images with close-ups, and differences in false colour."""

import dataclasses

import numpy
from matplotlib import colormaps
from PIL import Image, ImageDraw

import measures
import paper
from plan import LADDER

TRUTH = "ground_truth"
ROWS = LADDER + ("best", TRUTH)
GREEN, RED = (0, 170, 70), (225, 40, 40)
# Code values of luma that have the brightest colour of a difference.
RANGE = 48.0


@dataclasses.dataclass(frozen=True)
class Box:
    x: int
    y: int
    width: int
    height: int

    def crop(self, image):
        return image.crop((self.x, self.y, self.x + self.width, self.y + self.height))

    def overlaps(self, other):
        return (abs(self.x - other.x) < self.width) and (abs(self.y - other.y) < self.height)


@dataclasses.dataclass
class View:
    """A scene with one movement: the last frame of every technique."""
    scene: str
    movement: str
    value: float
    images: dict
    green: Box
    red: Box

    @property
    def name(self):
        return f"{self.scene}-{self.movement}".replace("_", "-")


def load(path):
    with Image.open(path) as image:
        return image.convert("RGB")


def luma(image):
    return numpy.asarray(image, float) @ measures.LUMA


def busiest(a, b, width, height, taken=()):
    """The box in which two images differ most, apart from those that are taken."""
    difference = numpy.abs(luma(a) - luma(b))
    sums = numpy.pad(difference.cumsum(0).cumsum(1), ((1, 0), (1, 0)))
    step = max(1, height // 4)
    best, most = None, -1.0
    for y in range(0, difference.shape[0] - height + 1, step):
        for x in range(0, difference.shape[1] - width + 1, step):
            total = (sums[y + height, x + width] - sums[y, x + width] - sums[y + height, x]
                     + sums[y, x])
            box = Box(x, y, width, height)
            if total > most and not any(box.overlaps(other) for other in taken):
                best, most = box, total
    return best


def view_of(results, scene, movement):
    paths = {row: results.image(scene, movement, row) for row in ROWS}
    images = {row: load(path) for row, path in paths.items() if path}
    if TRUTH not in images or len(images) < 2:
        return None
    first = next(iter(images.values()))
    width, height = max(8, first.width // 5), max(6, first.height // 5)
    # Where the first step of the ladder changes most, and where the wider blurs do.
    green = busiest(images["svgf"], images["rectification"], width, height)
    red = busiest(images["rectification"], images["separable"], width, height, [green])
    return View(scene, movement, results.view_value(scene), images, green, red)


def all_views(results):
    found = []
    for scene in paper.SCENE_TITLES:
        for movement in paper.MOVEMENT_TITLES:
            view = view_of(results, scene, movement)
            if view:
                found.append(view)
    return found


def difference(image, truth):
    """Luma in false colour: black none, yellow RANGE code values or more."""
    share = numpy.clip(numpy.abs(luma(image) - luma(truth)) / RANGE, 0.0, 1.0)
    return Image.fromarray((colormaps["inferno"](share)[..., :3] * 255.0).round().astype("uint8"))


def scale_bar(width=256, height=12):
    ramp = numpy.tile(numpy.linspace(0.0, 1.0, width), (height, 1))
    return Image.fromarray((colormaps["inferno"](ramp)[..., :3] * 255.0).round().astype("uint8"))


def enlarged(image, width):
    factor = max(1, round(width / image.width))
    return image.resize((image.width * factor, image.height * factor), Image.Resampling.NEAREST)


def with_contrast(image, gain):
    """As the paper's figure 19: around the mean."""
    values = numpy.asarray(image, float)
    mean = values.mean()
    return Image.fromarray(numpy.clip((values - mean) * gain + mean, 0.0, 255.0).astype("uint8"))


def cell(view, row, gain=1.0):
    """The whole image with both boxes, and the two close-ups below it."""
    whole = view.images[row]
    if gain != 1.0:
        whole = with_contrast(whole, gain)
    scale = max(1, round(480 / whole.width))
    top = whole.resize((whole.width * scale, whole.height * scale), Image.Resampling.NEAREST)
    draw = ImageDraw.Draw(top)
    for box, color in ((view.green, GREEN), (view.red, RED)):
        draw.rectangle((box.x * scale, box.y * scale, (box.x + box.width) * scale - 1,
                        (box.y + box.height) * scale - 1), outline=color, width=3)
    half = top.width // 2 - 2
    height = half * view.green.height // view.green.width
    sheet = Image.new("RGB", (top.width, top.height + 4 + height), (255, 255, 255))
    sheet.paste(top, (0, 0))
    for index, (box, color) in enumerate(((view.green, GREEN), (view.red, RED))):
        close = box.crop(whole).resize((half, height), Image.Resampling.NEAREST)
        ImageDraw.Draw(close).rectangle((0, 0, half - 1, height - 1), outline=color, width=3)
        sheet.paste(close, (index * (half + 4), top.height + 4))
    return sheet


def sheet_views(views):
    """Of figure 18: the views that the paper shows; of figure 19: one of soft shadows."""
    wanted = [("cubes_distance", movement) for movement in paper.MOVEMENT_TITLES]
    wanted.append(("breakfast_room", "moving_objects_light"))
    by_name = {(view.scene, view.movement): view for view in views}
    eighteen = [by_name[name] for name in wanted if name in by_name]
    shadows = [by_name[name] for name in (("shadow_objects", "static"),
                                          ("breakfast_room", "moving_camera")) if name in by_name]
    return eighteen, shadows[:1]


SHEETS = {18: (LADDER + ("best", TRUTH), 1.0),
          19: (("svgf", "rectification", "adapted", "best", TRUTH), 2.0)}


def scores(view, row):
    """(SSIM, FLIP) of what is shown."""
    image, truth = (numpy.asarray(view.images[each]) for each in (row, TRUTH))
    return measures.ssim(image, truth), measures.flip(image, truth)
