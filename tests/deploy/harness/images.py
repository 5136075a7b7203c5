"""The images under test, built as documented, without a registry: the base image is made from Debian
packages."""

import glob
import os
import re
import shutil
import subprocess
import tempfile
import time

from .checkout import Checkout, clone
from .commands import Skip, program, run
from .files import ROOT

BASE = "debian:trixie-slim"
SERVER = "heliograph:latest"
BALANCER = "heliograph-balancer:latest"
PROMETHEUS = "heliograph-prometheus:latest"


def cache_folder():
    """The folder that keeps the base image and the compiler cache between test runs."""
    folder = os.environ.get("HELIOGRAPH_DEPLOY_CACHE") or os.path.expanduser(
        "~/.cache/heliograph-deploy")
    os.makedirs(folder, exist_ok=True)
    return folder


def add_base(machine, suite="trixie"):
    machine.docker("import", "--change", 'CMD ["bash"]', base_archive(suite),
                   f"debian:{suite}-slim")


def base_archive(suite, mirror=None):
    """Debian's essential packages, as small as the registry's slim image, with this machine's
    certificate authorities. Made once."""
    target = os.path.join(cache_folder(), f"debian-{suite}-slim.tar")
    if not os.path.exists(target):
        _bootstrap(suite, target, mirror or debian_mirror())
    return target


def _bootstrap(suite, target, mirror):
    partial = target + ".partial"
    excluded = ["/usr/share/man/*", "/usr/share/doc/*", "/usr/share/locale/*"]
    options = [f"--dpkgopt=path-exclude={pattern}" for pattern in excluded]
    options += ["--dpkgopt=path-include=/usr/share/doc/*/copyright", "--dpkgopt=force-unsafe-io",
                # As in the registry's images.
                '--customize-hook=echo force-unsafe-io >"$1"/etc/dpkg/dpkg.cfg.d/docker-apt-speedup']
    trusted = glob.glob("/usr/local/share/ca-certificates/*.crt")
    if trusted:
        options += [f"--customize-hook=copy-in {' '.join(trusted)} /usr/local/share/ca-certificates",
                    '--customize-hook=chroot "$1" update-ca-certificates']
    options.append('--customize-hook=rm -rf "$1"/var/lib/apt/lists/* "$1"/etc/resolv.conf '
                   '"$1"/etc/hostname')
    try:
        run(program("mmdebstrap"), "--quiet", "--format=tar", "--variant=minbase", "--mode=root",
            "--include=ca-certificates", *options, suite, partial, mirror, timeout=600)
    except RuntimeError as failure:
        raise Skip(f"{suite} cannot be bootstrapped: {failure}") from failure
    os.rename(partial, target)


def debian_mirror():
    """The mirror of this machine's apt."""
    uris = run("apt-get", "indextargets", "--format", "$(REPO_URI)", "Created-By: Packages",
               "Component: main").splitlines()
    for uri in uris:
        if re.search(r"/debian/?$", uri):
            return uri
    raise Skip("apt knows no mirror of Debian")


def build_server(machine):
    """Builds the server's image from a clean checkout of the committed files, and keeps its Debian
    package."""
    with tempfile.TemporaryDirectory(dir=cache_folder()) as folder:
        checkout = os.path.join(folder, "checkout")
        clone(checkout)
        build = ("build", "--file", os.path.join(checkout, "deploy/Dockerfile"),
                 "--build-arg", f"JOBS={os.environ.get('HELIOGRAPH_DEPLOY_JOBS', '')}",
                 "--build-arg", f"REVISION={run('git', '-C', ROOT, 'rev-parse', 'HEAD')}")
        _seed_compiler_cache(machine)
        try:
            machine.docker(*build, "--tag", SERVER, checkout, timeout=3600)
        finally:
            _save_compiler_cache(machine)
        for old in glob.glob(os.path.join(cache_folder(), "heliograph-server-*")):
            os.remove(old)
        machine.docker("save", "--output", _archive(), SERVER, timeout=300)
        machine.docker(*build, "--target", "package", "--output", folder, checkout, timeout=3600)
        os.rename(os.path.join(folder, "heliograph.deb"), package_path())


def add_server(machine):
    """The same image, built only if no other test has built it from the same files."""
    archive = os.environ.get("HELIOGRAPH_IMAGE_ARCHIVE") or _archive()
    if os.path.exists(archive):
        machine.docker("load", "--input", archive, timeout=300)
    else:
        build_server(machine)


def package_path():
    """The path of the image's Debian package, after the image was built from these files."""
    return _of_these_files("deb")


def _archive():
    return _of_these_files("tar")


def _of_these_files(form):
    return os.path.join(cache_folder(), f"heliograph-server-{Checkout().key()}.{form}")


def add_balancer(machine):
    _add(machine, BALANCER, "deploy/balancer")


def add_prometheus(machine):
    _add(machine, PROMETHEUS, "deploy/prometheus")


def _add(machine, tag, folder):
    """Built once from the same files, then taken from the cache."""
    archive = os.path.join(cache_folder(), f"{tag.split(':')[0]}-{Checkout(folder).key()}.tar")
    if os.path.exists(archive):
        machine.docker("load", "--input", archive, timeout=300)
        return
    for old in glob.glob(os.path.join(cache_folder(), f"{tag.split(':')[0]}-*.tar")):
        os.remove(old)
    with tempfile.TemporaryFile() as context:
        Checkout(folder).write(context)
        context.seek(0)
        machine.docker("build", "--file", "Dockerfile", "--tag", tag, "-", stdin=context,
                       timeout=900)
    machine.docker("save", "--output", archive, tag, timeout=300)


def copy_images(source, target, *tags):
    """Copies an image from one engine to another, as a registry would."""
    with subprocess.Popen([program("docker"), "--host", f"unix://{source.socket}", "save", *tags],
                          stdout=subprocess.PIPE) as saving:
        target.docker("load", stdin=saving.stdout, timeout=300)


_CACHE_MOUNT = "--mount=type=cache,target=/cache,id=heliograph-ccache"


def compiler_cache():
    """The ccache folder of the image's distribution."""
    folder = os.path.join(cache_folder(), "ccache")
    os.makedirs(folder, exist_ok=True)
    return folder


def _seed_compiler_cache(machine):
    saved = compiler_cache()
    if os.listdir(saved):
        _small_build(machine, f"FROM {BASE}\nRUN {_CACHE_MOUNT} --mount=type=bind,target=/saved "
                     "cp -r /saved/. /cache/\n", saved)


def _save_compiler_cache(machine):
    with tempfile.TemporaryDirectory(dir=cache_folder()) as folder:
        # An argument makes the step run each time; with --no-cache the mount would be empty.
        _small_build(machine, f"FROM {BASE} AS copy\nARG TIME\n"
                     f"RUN {_CACHE_MOUNT} cp -r /cache /saved\n"
                     "FROM scratch\nCOPY --from=copy /saved /\n", None, "--build-arg",
                     f"TIME={time.time()}", "--output", folder)
        if os.listdir(folder):
            shutil.rmtree(compiler_cache())
            shutil.copytree(folder, compiler_cache(), dirs_exist_ok=True)


def _small_build(machine, dockerfile, context, *options):
    with tempfile.TemporaryDirectory() as empty:
        path = os.path.join(empty, "Dockerfile")
        with open(path, "w", encoding="utf-8") as file:
            file.write(dockerfile)
        machine.docker("build", "--file", path, *options, context or empty, timeout=600)
