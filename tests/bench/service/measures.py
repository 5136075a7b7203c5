"""What heliograph is measured at: processes from outside, as a user runs them."""

import glob
import importlib.util
import json
import os
import re
import shutil
import signal
import statistics
import subprocess
import sys
import time
from dataclasses import dataclass, field

MIB = 1024


class Unavailable(Exception):
    """Why something cannot be measured here."""


@dataclass
class Setup:
    binary: str
    root: str
    folder: str
    smoke: bool
    assets: str
    chromium: object
    blender: object

    def new_folder(self, name):
        path = os.path.join(self.folder, name)
        shutil.rmtree(path, ignore_errors=True)
        os.makedirs(path)
        return path


@dataclass
class ImageSet:
    folder: str
    entries: list
    seconds: list = field(default_factory=list)
    peak_mib: float = 0.0
    failed: int = 0

    @property
    def median(self):
        return statistics.median(self.seconds)

    @property
    def slow(self):
        return percentile(self.seconds, 0.95)


def percentile(values, share):
    ordered = sorted(values)
    return ordered[min(len(ordered) - 1, int(share * len(ordered)))]


def find_models(assets, most):
    """Files of models below a folder, always in the same order."""
    found = [path for extension in ("glb", "gltf")
             for path in glob.glob(os.path.join(assets, "gltf", "**", "*." + extension), recursive=True)]
    return sorted(found)[:most]


def named_model(assets, name):
    return next(path for path in find_models(assets, None) if name in os.path.basename(path))


def named_environment(assets, name):
    return next(path for path in glob.glob(os.path.join(assets, "hdr", "*.hdr")) if name in os.path.basename(path))


def run_measured(command, **options):
    """Seconds, status and peak memory (MiB) of a process, and the time of each line of its output."""
    started = time.monotonic()
    lines = []
    # Waited for by wait4, which tells its memory.
    process = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL,  # pylint: disable=R1732
                               text=True, **options)
    for line in process.stdout:
        lines.append((time.monotonic() - started, line))
    _, status, usage = os.wait4(process.pid, 0)
    process.returncode = os.waitstatus_to_exitcode(status)
    process.stdout.close()
    return time.monotonic() - started, process.returncode, usage.ru_maxrss / MIB, lines


def write_manifest(folder, entries):
    path = os.path.join(folder, "manifest.json")
    with open(path, "w", encoding="utf-8") as file:
        json.dump(entries, file)
    return path


def render_images(setup, models, views, size, quality):
    folder = setup.new_folder("images")
    entries = [{"scene": model, "output": f"{index}_{view}.png", "orbit": orbit, "width": size, "height": size,
                "quality": quality}
               for index, model in enumerate(models) for view, orbit in enumerate(views)]
    command = [setup.binary, "render", "--manifest", write_manifest(folder, entries), "--progress", "json"]
    _, status, peak, lines = run_measured(command, cwd=folder)
    if status not in (0, 3):
        raise RuntimeError(f"heliograph render ended with {status}")
    found = ImageSet(folder=folder, entries=entries, peak_mib=peak)
    # From file to file: with loading, as someone who waits for them sees it.
    before = 0.0
    for moment, line in lines:
        event = json.loads(line)["event"]
        if event == "written":
            found.seconds.append(moment - before)
        found.failed += event == "failed"
        if event in ("written", "failed"):
            before = moment
    return found


def similarity(path, truth):
    """SSIM of two image files, without alpha, by scikit-image."""
    from skimage.io import imread  # pylint: disable=import-outside-toplevel
    from skimage.metrics import structural_similarity  # pylint: disable=import-outside-toplevel

    return structural_similarity(imread(path)[..., :3], imread(truth)[..., :3], channel_axis=-1)


def similarity_to_truth(setup, images, most):
    """The least SSIM of some images to converged ones; None without scikit-image."""
    if not importlib.util.find_spec("skimage"):
        return None
    made = [entry for entry in images.entries if os.path.exists(os.path.join(images.folder, entry["output"]))]
    chosen = made[::max(1, len(made) // most)][:most]
    samples = 16 if setup.smoke else 2048
    truth = setup.new_folder("truth")
    entries = []
    for entry in chosen:
        entries.append({**entry, "samples": samples, "settings": {"accumulation": {"max_samples": samples}}})
        del entries[-1]["quality"]
    run_measured([setup.binary, "render", "--manifest", write_manifest(truth, entries), "--progress", "json"], cwd=truth)
    return min(similarity(os.path.join(images.folder, entry["output"]), os.path.join(truth, entry["output"]))
               for entry in chosen)


def render_turntable(setup, model, frames, size, quality, environment):
    folder = setup.new_folder("turntable")
    seconds, status, _, _ = run_measured(
        [setup.binary, "render", model, "-o", "turn.mp4", "--turntable", str(frames), "--width", str(size[0]),
         "--height", str(size[1]), "--quality", str(quality), "--environment", environment], cwd=folder)
    if status:
        raise RuntimeError(f"the turntable ended with {status}")
    return seconds


def start_to_image(setup, model, times):
    folder = setup.new_folder("start")
    command = [setup.binary, "render", model, "-o", "first.png", "--width", "512", "--height", "512", "--quality", "0.97"]
    runs = [run_measured(command, cwd=folder) for _ in range(times)]
    if any(status for _, status, _, _ in runs):
        raise RuntimeError("the first image failed")
    return statistics.median(seconds for seconds, *_ in runs)


def has_dask():
    return importlib.util.find_spec("distributed") is not None


@dataclass
class Farm:
    alone: float
    together: float
    cores: int
    efficiency: float
    lost: int


def below(pid):
    """The processes that a process has started, and those of these."""
    children = {}
    for name in filter(str.isdigit, os.listdir("/proc")):
        try:
            with open(f"/proc/{name}/stat", encoding="utf-8") as file:
                children.setdefault(int(file.read().rsplit(")", 1)[1].split()[1]), []).append(int(name))
        except (FileNotFoundError, ProcessLookupError):
            continue
    found, queue = [], [pid]
    while queue:
        more = children.get(queue.pop(), [])
        found += more
        queue += more
    return found


def kill_a_renderer(process):
    """The first `heliograph render` of a farm, once there is one. Whether one was killed."""
    while process.poll() is None:
        for pid in below(process.pid):
            try:
                with open(f"/proc/{pid}/comm", encoding="utf-8") as file:
                    if file.read().strip() == "heliograph":
                        os.kill(pid, signal.SIGKILL)
                        return True
            except (FileNotFoundError, ProcessLookupError):
                continue
        time.sleep(0.05)
    return False


def farm(setup, model, workers):
    """One process of one thread, the workers together, and again with one of them killed."""
    count, size = (4, 64) if setup.smoke else (64, 512)
    entries = [{"scene": model, "output": f"{i}.png", "orbit": [360 * i / count, 20], "width": size, "height": size,
                "samples": 16} for i in range(count)]
    environment = {**os.environ, "HELIOGRAPH_BINARY": setup.binary, "LP_NUM_THREADS": "1",
                   "PYTHONPATH": os.path.join(setup.root, "protocol", "python")}
    folder = setup.new_folder("alone")
    first = str(sorted(os.sched_getaffinity(0))[0])
    alone, *_ = run_measured(["taskset", "--cpu-list", first, setup.binary, "render", "--manifest",
                              write_manifest(folder, entries), "--progress", "json"], cwd=folder, env=environment)
    program = os.path.join(setup.root, "protocol", "examples", "render_farm.py")

    def command(place):
        return [sys.executable, program, write_manifest(place, entries), "--workers", str(workers), "--threads", "1",
                "--folder", place]

    folder = setup.new_folder("together")
    together, *_ = run_measured(command(folder), env=environment)
    folder = setup.new_folder("killed")
    with subprocess.Popen(command(folder), env=environment, stdout=subprocess.DEVNULL,
                          stderr=subprocess.DEVNULL) as process:
        kill_a_renderer(process)
    lost = sum(not os.path.exists(os.path.join(folder, entry["output"])) for entry in entries)
    cores = min(workers, len(os.sched_getaffinity(0)))
    return Farm(alone, together, cores, alone / (together * cores), lost)


def viewer_beside_jobs(setup, count, seconds):
    """The 95th percentile of the time from frame to frame of a viewer that orbits: alone, and beside jobs."""
    sys.path.insert(0, os.path.join(setup.root, "protocol", "python"))
    import heliograph  # pylint: disable=import-outside-toplevel,import-error

    scene = "Duck"
    folder = os.path.dirname(named_model(setup.assets, scene))
    command = [setup.binary, "serve", "--port", "0", "--scene-root", folder, "--scene", scene, "--jobs",
               setup.new_folder("jobs"), "--max-waiting-jobs", str(count + 1)]
    with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True) as server:
        try:
            url = re.search(r"listening on (\S+)", server.stdout.readline()).group(1)
            with heliograph.connect(url) as view:
                orbit(view, seconds / 2)
                alone = orbit(view, seconds)
                for _ in range(count):
                    view.job.create(entries=[{"scene": scene, "width": 512, "height": 512, "quality": 0.97}])
                orbit(view, seconds / 2)
                return alone, orbit(view, seconds)
        finally:
            server.terminate()


def orbit(view, seconds):
    """Moves the camera with every frame. The 95th percentile from frame to frame."""
    times, end = [], time.monotonic() + seconds
    before = time.monotonic()
    while before < end:
        view.camera.orbit(yaw=2.0)
        view.next_frame()
        now = time.monotonic()
        times.append(now - before)
        before = now
    return percentile(times, 0.95)
