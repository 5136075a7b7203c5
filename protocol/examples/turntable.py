#!/usr/bin/env python3
"""Moves the camera once around the scene and writes an image at every stop.

    turntable.py --scene atrium --images 36 --folder turntable

The same command writes the same files, byte for byte: it runs in lockstep.
"""

import argparse
import os

from own_session import add_options, open_view


def turntable(view, images, folder, frames_each):
    os.makedirs(folder, exist_ok=True)
    view.frame.step(frames=0, dt=1 / 30)              # enter lockstep
    try:
        for number in range(images):
            if number:
                view.camera.orbit(yaw=360 / images)
            view.step(frames_each)                    # the denoiser accumulates these
            view.capture().save(os.path.join(folder, f"{number:03d}.png"))
    finally:
        view.frame.run()                              # leave lockstep


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    add_options(parser)
    parser.add_argument("--scene")
    parser.add_argument("--size", type=int, nargs=2, default=(1280, 720))
    parser.add_argument("--images", type=int, default=36)
    parser.add_argument("--frames-each", type=int, default=16)
    parser.add_argument("--folder", default="turntable")
    options = parser.parse_args()
    with open_view(options, *options.size, options.scene) as view:
        turntable(view, options.images, options.folder, options.frames_each)
    print(f"{options.images} images in {options.folder}")


if __name__ == "__main__":
    main()
