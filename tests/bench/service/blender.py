"""The same work as Blender does it: path traced by Cycles on the processor."""

import importlib.util
import json
import os
import shutil
import subprocess

from measures import Unavailable, similarity

# As cycles_images.py prints it.
RESULT = "seconds of the images: "
TRUTH_SAMPLES = 1024


class Blender:
    """Each call starts Blender once."""

    def __init__(self, folder, here):
        self.folder, self.here = os.path.join(folder, "blender"), here

    def run(self, models, views, size, samples, environment=None):
        """Seconds of each image: of models, then views, then numbers of samples. Without environment: in white."""
        if not shutil.which("blender"):
            raise Unavailable("there is no blender")
        shutil.rmtree(self.folder, ignore_errors=True)
        os.makedirs(self.folder)
        path = os.path.join(self.folder, "work.json")
        with open(path, "w", encoding="utf-8") as file:
            json.dump({"models": models, "views": views, "size": size, "samples": samples, "folder": self.folder,
                       "environment": environment}, file)
        done = subprocess.run(["blender", "--background", "--factory-startup", "--python-exit-code", "1", "--python",
                               os.path.join(self.here, "cycles_images.py"), "--", path], check=False,
                              capture_output=True, text=True)
        found = [line for line in done.stdout.splitlines() if line.startswith(RESULT)]
        if done.returncode or not found:
            raise Unavailable(f"Blender failed: {(done.stderr or done.stdout).strip().splitlines()[-1:]}")
        return json.loads(found[-1][len(RESULT):])

    def median_of_images(self, models, views, size):
        """With the 64 samples that people give Cycles for a thumbnail."""
        seconds = sorted(self.run(models, views, [size, size], [64]))
        return seconds[len(seconds) // 2]

    def samples_for(self, model, size, quality, environment):
        """The least power of two whose image is so similar to the converged one."""
        if not importlib.util.find_spec("skimage"):
            raise Unavailable("python3-skimage is not installed")
        tried = [2 ** power for power in range(1, 9)]
        self.run([model], [[0, 17]], list(size), [*tried, TRUTH_SAMPLES], environment)
        truth = os.path.join(self.folder, f"0_0_{TRUTH_SAMPLES}.png")
        for samples in tried:
            if similarity(os.path.join(self.folder, f"0_0_{samples}.png"), truth) >= quality:
                return samples
        raise Unavailable(f"Cycles needs more than {tried[-1]} samples")

    def turntable(self, model, frames, size, quality, environment):
        """At equal similarity, without the encoding of the video: from a part of the frames."""
        samples = self.samples_for(model, size, quality, environment)
        measured = 6
        views = [[360 * frame / measured, 17] for frame in range(measured)]
        seconds = self.run([model], views, list(size), [samples], environment)
        # The first one has the import in it.
        return seconds[0] + sum(seconds[1:]) / (measured - 1) * (frames - 1)
