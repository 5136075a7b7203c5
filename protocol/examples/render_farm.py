#!/usr/bin/env python3
"""Renders a manifest with the workers of dask.distributed, and gathers the report.

    render_farm.py jobs.jsonl --scheduler tcp://head:8786 --report report.json
    render_farm.py jobs.jsonl --workers 4 --threads 1      # on this machine

Each task is a shard of the manifest, rendered by `heliograph render --shard`. When a worker dies, its shard is rendered
by another one, which keeps the files that were complete. All workers need the program, the scenes and the output folder
under the same paths. Needs Debian's python3-distributed.
"""

import argparse
import json
import os
import subprocess
import sys
import tempfile

from heliograph import find_program

SOME_FAILED = 3
# Workers that sample their own stack every ten milliseconds take several percent of a core each, while they do nothing
# but wait for the renderer.
QUIET_WORKERS = {"distributed.worker.profile.enabled": False, "distributed.admin.tick.interval": "500 ms",
                 "distributed.admin.tick.limit": "1 minute"}


def render_shard(manifest, shard, folder, arguments, threads):
    """The report of one shard. Runs on a worker."""
    environment = {**os.environ, **({"LP_NUM_THREADS": str(threads)} if threads else {})}
    # Workers give freed memory back at once, which is for Python's objects: a renderer would fetch the memory of each
    # frame from the kernel again, and take twice as long.
    environment.pop("MALLOC_TRIM_THRESHOLD_", None)
    with tempfile.TemporaryDirectory() as scratch:
        report = os.path.join(scratch, "report.json")
        command = [find_program(), "render", "--manifest", manifest, "--shard", shard, "--resume", "--progress", "none",
                   "--report", report, *arguments]
        if threads:
            command = ["taskset", "--cpu-list", own_processors(threads), *command]
        done = subprocess.run(command, cwd=folder, env=environment, capture_output=True, text=True,
                              check=False)
        if not os.path.exists(report) or os.path.getsize(report) == 0:
            raise RuntimeError(done.stderr.strip() or f"the renderer ended with {done.returncode}")
        with open(report, encoding="utf-8") as file:
            return json.load(file)


def own_processors(threads):
    """Of this worker, which are no other's of the same machine: those of a local cluster are numbered."""
    from distributed import get_worker  # pylint: disable=import-outside-toplevel

    name = get_worker().name
    available = sorted(os.sched_getaffinity(0))
    first = name * threads if isinstance(name, int) else 0
    return ",".join(str(available[(first + i) % len(available)]) for i in range(threads))


def merge(reports):
    """One report of all shards, in the order of the manifest."""
    entries = sorted((entry for report in reports for entry in report["entries"]), key=lambda entry: entry["entry"])
    totals = {name: sum(report[name] for report in reports) for name in ("done", "failed", "images", "kept")}
    return {"entries": entries, **totals, "devices": sorted({report.get("device", "none") for report in reports})}


def count_entries(manifest):
    with open(manifest, encoding="utf-8") as file:
        text = file.read()
    return len(json.loads(text)) if text.lstrip().startswith("[") else len(text.split("\n{"))


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("manifest")
    parser.add_argument("--scheduler", help="address of a running scheduler [workers of this machine]")
    parser.add_argument("--workers", type=int, default=os.cpu_count(), help="without --scheduler")
    parser.add_argument("--threads", type=int, default=0, help="processors of each shard [all]")
    parser.add_argument("--shards", type=int, help="[two for each worker]")
    parser.add_argument("--retries", type=int, default=3, help="of a shard whose renderer failed")
    parser.add_argument("--folder", default=".", help="where outputs begin")
    parser.add_argument("--report")
    parser.add_argument("arguments", nargs="*", help="for heliograph render, after --")
    options = parser.parse_args()
    import dask  # pylint: disable=import-outside-toplevel
    from distributed import Client, LocalCluster  # pylint: disable=import-outside-toplevel

    cluster = None
    if not options.scheduler:
        dask.config.set(QUIET_WORKERS)
        cluster = LocalCluster(n_workers=options.workers, threads_per_worker=1, dashboard_address=None)
    with Client(options.scheduler or cluster) as client:
        workers = max(1, len(client.scheduler_info()["workers"]))
        shards = min(options.shards or 2 * workers, count_entries(options.manifest))
        manifest, folder = os.path.abspath(options.manifest), os.path.abspath(options.folder)
        tasks = [client.submit(render_shard, manifest, f"{i + 1}/{shards}", folder, options.arguments, options.threads,
                               pure=False, retries=options.retries) for i in range(shards)]
        report = merge(client.gather(tasks))
    if cluster:
        cluster.close()
    text = json.dumps(report, indent=2)
    if options.report:
        with open(options.report, "w", encoding="utf-8") as file:
            file.write(text + "\n")
    print(f"{report['done']} done, {report['failed']} failed, {report['images']} images, {report['kept']} kept")
    return 0 if report["failed"] == 0 else SOME_FAILED


if __name__ == "__main__":
    sys.exit(main())
