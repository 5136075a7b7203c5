#!/usr/bin/env python3
"""Compares the cameras of a scene with stored images; fails if one looks different.

    visual_regression.py --scene atrium --folder expected --update     stores the images
    visual_regression.py --scene atrium --folder expected              compares with them

If an image differs, NAME.actual.npy and NAME.actual.png are written beside NAME.npy.
"""

import argparse
import os
import re
import sys

import numpy

from own_session import add_options, open_view


def file_name(camera):
    return re.sub(r"[^A-Za-z0-9_-]+", "_", camera) or "camera"


def render_cameras(view, frames):
    """Renders every camera of the scene in lockstep, from a reset: repeatable results."""
    view.frame.run()
    for camera in view.scene.info()["cameras"] or ["fit"]:
        if camera == "fit":
            view.camera.fit()
        else:
            view.camera.set(name=camera)
        try:
            view.step(frames)
            rendered = view.array(), view.capture()
        finally:
            view.frame.run()
        yield file_name(camera), *rendered


def check(folder, name, actual, image, tolerance):
    """Whether the mean difference to the stored image, 0 to 255, is at most `tolerance`."""
    stored = os.path.join(folder, name + ".npy")
    expected = numpy.load(stored) if os.path.exists(stored) else None
    if expected is None or expected.shape != actual.shape:
        difference = 255.0
    else:
        difference = float(numpy.abs(expected.astype(float) - actual).mean())
    good = difference <= tolerance
    print(f"{name}: {'same' if good else 'DIFFERENT'}, {difference:.4f}")
    if not good:
        numpy.save(os.path.join(folder, name + ".actual.npy"), actual)
        image.save(os.path.join(folder, name + ".actual.png"))
    return good


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    add_options(parser)
    parser.add_argument("--scene")
    parser.add_argument("--size", type=int, nargs=2, default=(640, 360))
    parser.add_argument("--frames", type=int, default=32)
    parser.add_argument("--tolerance", type=float, default=0.5)
    parser.add_argument("--folder", default="expected")
    parser.add_argument("--update", action="store_true", help="store the current images")
    options = parser.parse_args()
    os.makedirs(options.folder, exist_ok=True)
    good = True
    with open_view(options, *options.size, options.scene) as view:
        for name, actual, image in render_cameras(view, options.frames):
            if options.update:
                numpy.save(os.path.join(options.folder, name + ".npy"), actual)
                print(f"{name}: stored")
            else:
                good &= check(options.folder, name, actual, image, options.tolerance)
    sys.exit(0 if good else 1)


if __name__ == "__main__":
    main()
