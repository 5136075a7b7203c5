#!/usr/bin/env python3
"""Renders a small image of every scene in a folder of the server's catalogue.

    thumbnails.py --models props --folder thumbnails

Scenes that cannot be loaded are reported and skipped.
"""

import argparse
import os
import sys

import heliograph
from own_session import add_options, set_samples, open_view


def thumbnail(view, name, samples):
    view.scene.load(name=name)
    view.camera.fit()
    return view.capture(samples=samples)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    add_options(parser)
    parser.add_argument("--models", default="", help="a folder below the server's scene roots")
    parser.add_argument("--size", type=int, default=256)
    parser.add_argument("--samples", type=int, default=32)
    parser.add_argument("--folder", default="thumbnails")
    options = parser.parse_args()
    below = options.models.rstrip("/") + "/" if options.models else ""
    with open_view(options, options.size, options.size) as view:
        set_samples(view, options.samples)
        for scene in view.scene.list()["scenes"]:
            name = scene["name"]
            if not name.startswith(below):
                continue
            try:
                image = thumbnail(view, name, options.samples)
            except heliograph.HeliographError as error:
                print(f"{name}: {error}", file=sys.stderr)
                continue
            path = os.path.join(options.folder, name + ".png")
            os.makedirs(os.path.dirname(path) or ".", exist_ok=True)
            image.save(path)
            print(path)


if __name__ == "__main__":
    main()
