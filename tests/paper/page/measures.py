"""Measures of images, in NumPy: SSIM (Wang et al. 2004) and FLIP (Andersson et al. 2020)."""

import math

import numpy
from scipy import ndimage

LUMA = numpy.array((0.2126, 0.7152, 0.0722))
# An observer 0.7 m from a monitor of 0.7 m and 3840 pixels: the paper's standard.
PIXELS_PER_DEGREE = 0.7 * (3840 / 0.7) * math.pi / 180.0


def ssim(image, truth):
    """Of luma in code values: 11 x 11 Gaussian window, sigma 1.5, where the whole window fits."""
    a, b = (numpy.asarray(each, float)[..., :3] @ LUMA for each in (image, truth))

    def window(values):
        return ndimage.gaussian_filter(values, 1.5, truncate=3.5)

    mean_a, mean_b = window(a), window(b)
    variance_a = window(a * a) - mean_a ** 2
    variance_b = window(b * b) - mean_b ** 2
    covariance = window(a * b) - mean_a * mean_b
    c1, c2 = (0.01 * 255.0) ** 2, (0.03 * 255.0) ** 2
    similarity = ((2.0 * mean_a * mean_b + c1) * (2.0 * covariance + c2)
                  / ((mean_a ** 2 + mean_b ** 2 + c1) * (variance_a + variance_b + c2)))
    return float(similarity[5:-5, 5:-5].mean())


# Linear sRGB to CIE XYZ of a D65 white, and the white itself.
TO_XYZ = numpy.array(((10135552 / 24577794, 8788810 / 24577794, 4435075 / 24577794),
                      (2613072 / 12288897, 8788810 / 12288897, 887015 / 12288897),
                      (1425312 / 73733382, 8788810 / 73733382, 70074185 / 73733382)))
WHITE = TO_XYZ @ numpy.ones(3)
# Contrast sensitivity of achromatic, red-green and blue-yellow: a1, b1, a2, b2 (table 1).
SENSITIVITY = ((1.0, 0.0047, 0.0, 1e-5), (1.0, 0.0053, 0.0, 1e-5), (34.1, 0.04, 13.5, 0.025))
COLOR_POWER, FEATURE_POWER = 0.7, 0.5
FEATURE_WIDTH = 0.082  # degrees
PART_OF_RANGE, MAPPED_TO = 0.4, 0.95


def linear(codes):
    value = numpy.asarray(codes, float)[..., :3] / 255.0
    return numpy.where(value <= 0.04045, value / 12.92, ((value + 0.055) / 1.055) ** 2.4)


def opponent(rgb):
    """YCxCz, a linear version of L*a*b*."""
    x, y, z = numpy.moveaxis(rgb @ TO_XYZ.T / WHITE, -1, 0)
    return numpy.stack((116.0 * y - 16.0, 500.0 * (x - y), 200.0 * (y - z)), -1)


def from_opponent(colors):
    y = (colors[..., 0] + 16.0) / 116.0
    x, z = colors[..., 1] / 500.0 + y, y - colors[..., 2] / 200.0
    return (numpy.stack((x, y, z), -1) * WHITE) @ numpy.linalg.inv(TO_XYZ).T


def hunt_lab(rgb):
    """L*a*b* with chroma that grows with lightness (Hunt effect)."""
    value = rgb @ TO_XYZ.T / WHITE
    limit = 6.0 / 29.0
    curve = numpy.where(value > limit ** 3, numpy.cbrt(value),
                        value / (3.0 * limit ** 2) + 4.0 / 29.0)
    x, y, z = numpy.moveaxis(curve, -1, 0)
    lightness = 116.0 * y - 16.0
    return numpy.stack((lightness, 0.01 * lightness * 500.0 * (x - y),
                        0.01 * lightness * 200.0 * (y - z)), -1)


def hyab(a, b):
    difference = a - b
    return numpy.abs(difference[..., 0]) + numpy.hypot(difference[..., 1], difference[..., 2])


def grid(radius):
    reach = numpy.arange(-radius, radius + 1)
    return numpy.meshgrid(reach, reach)


def convolved(channel, kernel):
    return ndimage.correlate(channel, kernel, mode="nearest")


def seen(colors):
    """What an observer resolves: each opponent channel through its contrast sensitivity."""
    widest = max(max(b1, b2) for _, b1, _, b2 in SENSITIVITY)
    radius = math.ceil(3.0 * math.sqrt(widest / (2.0 * math.pi ** 2)) * PIXELS_PER_DEGREE)
    x, y = grid(radius)
    square = (x ** 2 + y ** 2) / PIXELS_PER_DEGREE ** 2
    channels = []
    for index, (a1, b1, a2, b2) in enumerate(SENSITIVITY):
        kernel = (a1 * math.sqrt(math.pi / b1) * numpy.exp(-math.pi ** 2 * square / b1)
                  + a2 * math.sqrt(math.pi / b2) * numpy.exp(-math.pi ** 2 * square / b2))
        channels.append(convolved(colors[..., index], kernel / kernel.sum()))
    return numpy.clip(from_opponent(numpy.stack(channels, -1)), 0.0, 1.0)


def color_difference(a, b):
    """0..1: HyAB distance of what is seen, its upper part compressed."""
    distance = hyab(hunt_lab(seen(a)), hunt_lab(seen(b))) ** COLOR_POWER
    green, blue = (hunt_lab(numpy.array(color)) for color in ((0.0, 1.0, 0.0), (0.0, 0.0, 1.0)))
    most = float(hyab(green, blue)) ** COLOR_POWER
    knee = PART_OF_RANGE * most
    return numpy.where(distance < knee, MAPPED_TO / knee * distance,
                       MAPPED_TO + (distance - knee) / (most - knee) * (1.0 - MAPPED_TO))


def balanced(kernel):
    """Positive weights sum to 1, negative ones to -1."""
    return numpy.where(kernel > 0.0, kernel / kernel[kernel > 0.0].sum(),
                       kernel / -kernel[kernel < 0.0].sum())


def feature_difference(a, b):
    """0..1: of edges and points in the achromatic channel."""
    deviation = 0.5 * FEATURE_WIDTH * PIXELS_PER_DEGREE
    x, y = grid(math.ceil(3.0 * deviation))
    bell = numpy.exp(-(x ** 2 + y ** 2) / (2.0 * deviation ** 2))
    edge, point = balanced(-x * bell), balanced((x ** 2 / deviation ** 2 - 1.0) * bell)

    def strength(image, kernel):
        grey = (image[..., 0] + 16.0) / 116.0
        return numpy.hypot(convolved(grey, kernel), convolved(grey, kernel.T))

    difference = numpy.maximum(numpy.abs(strength(a, edge) - strength(b, edge)),
                               numpy.abs(strength(a, point) - strength(b, point)))
    return numpy.clip(difference / math.sqrt(2.0), 0.0, 1.0) ** FEATURE_POWER


def flip_map(image, truth):
    a, b = opponent(linear(image)), opponent(linear(truth))
    return color_difference(a, b) ** (1.0 - feature_difference(a, b))


def flip(image, truth):
    """Mean of the error map: 0 equal, 1 as different as can be."""
    return float(flip_map(image, truth).mean())
