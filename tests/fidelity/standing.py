"""Where one engine stands among others: images, similarity to the path traced ones, places."""

import sys
from dataclasses import dataclass
from pathlib import Path

import numpy
from PIL import Image

sys.path.append(str(Path(__file__).resolve().parent.parent / "paper" / "page"))
import measures  # noqa: E402

# Pixels of a border that are alike, and of a background, differ by no more code values.
BACKGROUND_RANGE = 8
ASPECT_TOLERANCE = 0.01


@dataclass(frozen=True)
class Score:
    """Means over the path traced images of other engines."""
    ssim: float
    flip: float


def common_size(scenario, images, most_width):
    """Of the narrowest image: nothing is enlarged. `images`: of Pillow."""
    width = min([most_width, scenario.width, *(image.width for image in images)])
    return width, max(1, round(width * scenario.height / scenario.width))


def has_aspect(image, scenario):
    ratio = image.width / image.height * scenario.height / scenario.width
    return abs(ratio - 1.0) <= ASPECT_TOLERANCE


def scaled(image, size):
    """[h, w, 4] code values, alpha not premultiplied; Pillow filters them premultiplied."""
    return numpy.asarray(image.convert("RGBA").resize(size, Image.Resampling.LANCZOS))


def over_white(rgba):
    """[h, w, 3] code values as a page shows them: the set's viewers have a white background."""
    alpha = rgba[..., 3:].astype(float) / 255.0
    return rgba[..., :3] * alpha + 255.0 * (1.0 - alpha)


def border_of(rgba):
    return numpy.concatenate((rgba[0], rgba[-1], rgba[:, 0], rgba[:, -1]))


def silhouette(rgba):
    """Where the model is: by alpha, or by what differs from a plain border; None: neither tells."""
    if (rgba[..., 3] < 128).any():
        return rgba[..., 3] >= 128
    border = border_of(rgba)[:, :3].astype(int)
    if (border.max(0) - border.min(0)).max() > BACKGROUND_RANGE:
        return None
    difference = numpy.abs(rgba[..., :3].astype(int) - numpy.median(border, 0))
    return difference.max(-1) > BACKGROUND_RANGE


def silhouette_difference(image, truths):
    """Share of two silhouettes' union that only one has; None: there is nothing to compare.

    To the most similar of the path traced ones, since these disagree about glass, which is opaque
    in some and as clear as the background in others.
    """
    ours = silhouette(image)
    if ours is None:
        return None
    shares = []
    for truth in truths:
        theirs = silhouette(truth)
        if theirs is not None and (ours | theirs).any():
            shares.append(float((ours ^ theirs).sum() / (ours | theirs).sum()))
    return min(shares, default=None)


def scores_of(images, truths):
    """`images`: [h, w, 3] by engine; `truths`: names of those that are path traced.

    A path traced image is compared with those of the others. Without any other it has no score.
    """
    known = {}

    def pair(first, second):
        key = frozenset((first, second))
        if key not in known:
            known[key] = (measures.ssim(images[first], images[second]),
                          measures.flip(images[first], images[second]))
        return known[key]

    scores = {}
    for engine in images:
        pairs = [pair(engine, truth) for truth in truths if truth != engine]
        if pairs:
            scores[engine] = Score(*(float(value) for value in numpy.mean(pairs, 0)))
    return scores


def places_of(scores, engine):
    """By SSIM and by FLIP, from 1 on; engines that are equal share the better place."""
    own = scores[engine]
    return (1 + sum(score.ssim > own.ssim for score in scores.values()),
            1 + sum(score.flip < own.flip for score in scores.values()))
