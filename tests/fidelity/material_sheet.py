"""The sheet of the chart of materials: hybrid, truth and difference of every row, with labels."""

import numpy
from PIL import Image, ImageDraw, ImageFont

GAIN = 4  # of a difference of code values
GAP, LINE, LABELS = 8, 16, 190  # pixels
LEAST_SQUARE = 96  # narrower ones are enlarged, so that there is room below them
TITLES = ("hybrid; values", "path traced; SSIM", f"difference x {GAIN}; FLIP")
INK, PAPER, RED = (20, 20, 20), (255, 255, 255), (200, 20, 20)


def difference(image, truth):
    apart = numpy.abs(image.astype(int) - truth.astype(int)) * GAIN
    return numpy.clip(apart, 0, 255).astype(numpy.uint8)


def captions(row):
    """Below the cells of the three strips: values and what was measured."""
    return ([ball.value for ball in row.balls], [f"{ball.ssim:.3f}" for ball in row.balls],
            [f"{ball.flip:.3f}" for ball in row.balls])


def strips(row):
    """Hybrid, truth and difference as images, of whole pixels enlarged where they are small."""
    factor = -(-LEAST_SQUARE // row.image.shape[0])
    arrays = (row.image, row.truth, difference(row.image, row.truth))
    return [Image.fromarray(array.repeat(factor, 0).repeat(factor, 1)) for array in arrays]


def draw_row(sheet, top, row, images, missed):
    """`images`: its strips. `missed`: whether the row has missed its bar."""
    draw, font = ImageDraw.Draw(sheet), ImageFont.load_default()
    width, size = images[0].size
    draw.text((GAP, top + size // 2), row.name, RED if missed else INK, font)
    for number, (strip, texts) in enumerate(zip(images, captions(row))):
        left = LABELS + number * (width + GAP)
        sheet.paste(strip, (left, top))
        for index, text in enumerate(texts):
            draw.text((left + index * size + 2, top + size + 2), text, INK, font)


def sheet_of(rows, missed):
    """An image of all rows. `missed`: the names of those that miss their bars."""
    images = [strips(row) for row in rows]
    width, size = images[0][0].size
    sheet = Image.new("RGB", (LABELS + 3 * (width + GAP), LINE + len(rows) * (size + LINE)), PAPER)
    draw, font = ImageDraw.Draw(sheet), ImageFont.load_default()
    for number, title in enumerate(TITLES):
        draw.text((LABELS + number * (width + GAP), 2), title, INK, font)
    for number, row in enumerate(rows):
        draw_row(sheet, LINE + number * (size + LINE), row, images[number], row.name in missed)
    return sheet
