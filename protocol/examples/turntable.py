#!/usr/bin/env python3
"""Turns the camera once about the scene and writes a picture at every stop.

    turntable.py --scene atrium --pictures 36 --folder turntable

The same command gives the same files, byte for byte: time passes only where it is told to.
"""

import argparse
import os

from own_session import add_options, open_view


def turntable(view, pictures, folder, frames_each):
    os.makedirs(folder, exist_ok=True)
    view.frame.step(frames=0, dt=1 / 30)              # from here on, time is ours
    try:
        for number in range(pictures):
            if number:
                view.camera.orbit(yaw=360 / pictures)
            view.step(frames_each)                    # the denoiser gathers over these
            view.capture().save(os.path.join(folder, f"{number:03d}.png"))
    finally:
        view.frame.run()                              # and the world's again


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    add_options(parser)
    parser.add_argument("--scene")
    parser.add_argument("--size", type=int, nargs=2, default=(1280, 720))
    parser.add_argument("--pictures", type=int, default=36)
    parser.add_argument("--frames-each", type=int, default=16)
    parser.add_argument("--folder", default="turntable")
    options = parser.parse_args()
    with open_view(options, *options.size, options.scene) as view:
        turntable(view, options.pictures, options.folder, options.frames_each)
    print(f"{options.pictures} pictures in {options.folder}")


if __name__ == "__main__":
    main()
