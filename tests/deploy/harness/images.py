"""The images under test, built as the documentation says, where no registry can be reached: the base
image is made from Debian's packages."""

import glob
import os
import re
import shutil
import subprocess
import tempfile

from .commands import Skip, program, run

HERE = os.path.dirname(os.path.abspath(__file__))
ROOT = os.path.normpath(os.path.join(HERE, "../../.."))
BASE = "debian:trixie-slim"
SERVER = "heliograph:latest"
BALANCER = "heliograph-balancer:latest"
PROMETHEUS = "heliograph-prometheus:latest"


def cache_folder():
    """Keeps the base image and the compiler's cache from one run of the tests to the next."""
    folder = os.environ.get("HELIOGRAPH_DEPLOY_CACHE") or os.path.expanduser(
        "~/.cache/heliograph-deploy")
    os.makedirs(folder, exist_ok=True)
    return folder


def add_base(machine, suite="trixie"):
    """Imports Debian, as small as the registry's slim image and trusting whom this machine does."""
    archive = os.path.join(cache_folder(), f"debian-{suite}-slim.tar")
    if not os.path.exists(archive):
        bootstrap(suite, archive, "tar")
    machine.docker("import", "--change", 'CMD ["bash"]', archive, f"debian:{suite}-slim")


def bootstrap(suite, target, form):
    """Makes a system of Debian's essential packages: an archive or a folder."""
    partial = target + ".partial"
    excluded = ["/usr/share/man/*", "/usr/share/doc/*", "/usr/share/locale/*"]
    options = [f"--dpkgopt=path-exclude={pattern}" for pattern in excluded]
    options += ["--dpkgopt=path-include=/usr/share/doc/*/copyright", "--dpkgopt=force-unsafe-io"]
    trusted = glob.glob("/usr/local/share/ca-certificates/*.crt")
    if trusted:
        options += [f"--customize-hook=copy-in {' '.join(trusted)} /usr/local/share/ca-certificates",
                    '--customize-hook=chroot "$1" update-ca-certificates']
    options.append('--customize-hook=rm -rf "$1"/var/lib/apt/lists/* "$1"/etc/resolv.conf '
                   '"$1"/etc/hostname')
    try:
        run(program("mmdebstrap"), "--quiet", f"--format={form}", "--variant=minbase", "--mode=root",
            "--include=ca-certificates", *options, suite, partial, debian_mirror(),
            timeout=600)
    except RuntimeError as failure:
        raise Skip(f"Debian {suite} cannot be bootstrapped: {failure}") from failure
    os.rename(partial, target)


def debian_mirror():
    """The mirror that this machine's apt uses."""
    uris = run("apt-get", "indextargets", "--format", "$(REPO_URI)", "Created-By: Packages",
               "Component: main").splitlines()
    for uri in uris:
        if re.search(r"/debian/?$", uri):
            return uri
    raise Skip("apt knows no mirror of Debian")


def build_server(machine):
    """Builds the server's image from a clean checkout of what is committed."""
    _seed_compiler_cache(machine)
    try:
        build(machine, SERVER, "deploy/Dockerfile",
              arguments={"JOBS": os.environ.get("HELIOGRAPH_DEPLOY_JOBS", ""),
                         "REVISION": run("git", "-C", ROOT, "rev-parse", "HEAD")},
              timeout=3600)
    finally:
        _save_compiler_cache(machine)
    archive = _archive()
    for old in glob.glob(os.path.join(cache_folder(), "heliograph-server-*.tar")):
        os.remove(old)
    machine.docker("save", "--output", archive, SERVER, timeout=300)


def add_server(machine):
    """The same image, built only where no other test has built it of the same files."""
    archive = os.environ.get("HELIOGRAPH_IMAGE_ARCHIVE") or _archive()
    if os.path.exists(archive):
        machine.docker("load", "--input", archive, timeout=300)
    else:
        build_server(machine)


def _archive():
    tree = run("git", "-C", ROOT, "rev-parse", "HEAD^{tree}")
    return os.path.join(cache_folder(), f"heliograph-server-{tree}.tar")


def build(machine, tag, dockerfile, *, folder="", arguments=None, timeout=900):
    """`folder` of the checkout is all that the build sees."""
    options = []
    for name, value in (arguments or {}).items():
        options += ["--build-arg", f"{name}={value}"]
    with tempfile.TemporaryFile() as context:
        subprocess.run(["git", "-C", ROOT, "archive", f"HEAD:{folder}"], stdout=context, check=True)
        context.seek(0)
        machine.docker("build", "--file", dockerfile, "--tag", tag, *options, "-",
                       stdin=context, timeout=timeout)


def add_balancer(machine):
    _add(machine, BALANCER, "deploy/balancer")


def add_prometheus(machine):
    _add(machine, PROMETHEUS, "deploy/prometheus")


def _add(machine, tag, folder):
    """Built once of the same files; then taken from the cache."""
    tree = run("git", "-C", ROOT, "rev-parse", f"HEAD:{folder}")
    archive = os.path.join(cache_folder(), f"{tag.split(':')[0]}-{tree}.tar")
    if os.path.exists(archive):
        machine.docker("load", "--input", archive, timeout=300)
        return
    build(machine, tag, "Dockerfile", folder=folder)
    machine.docker("save", "--output", archive, tag, timeout=300)


def copy_images(source, target, *tags):
    """From one engine to another, as a registry would."""
    with subprocess.Popen([program("docker"), "--host", f"unix://{source.socket}", "save", *tags],
                          stdout=subprocess.PIPE) as saving:
        target.docker("load", stdin=saving.stdout, timeout=300)


_CACHE_MOUNT = "--mount=type=cache,target=/cache,id=heliograph-ccache"


def _seed_compiler_cache(machine):
    saved = os.path.join(cache_folder(), "ccache")
    if os.path.isdir(saved):
        _small_build(machine, f"FROM {BASE}\nRUN {_CACHE_MOUNT} --mount=type=bind,target=/saved "
                     "cp -r /saved/. /cache/\n", saved)


def _save_compiler_cache(machine):
    with tempfile.TemporaryDirectory(dir=cache_folder()) as folder:
        _small_build(machine, f"FROM {BASE} AS copy\nRUN {_CACHE_MOUNT} cp -r /cache /saved\n"
                     "FROM scratch\nCOPY --from=copy /saved /\n", None, "--no-cache", "--output",
                     folder)
        saved = os.path.join(cache_folder(), "ccache")
        shutil.rmtree(saved, ignore_errors=True)
        shutil.copytree(folder, saved)


def _small_build(machine, dockerfile, context, *options):
    with tempfile.TemporaryDirectory() as empty:
        path = os.path.join(empty, "Dockerfile")
        with open(path, "w", encoding="utf-8") as file:
            file.write(dockerfile)
        machine.docker("build", "--file", path, *options, context or empty, timeout=600)
