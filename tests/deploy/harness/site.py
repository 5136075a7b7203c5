"""Machines made of network namespaces, each with its own container engine, on one bridge with address
translation to the outside. Everything is removed at the end."""

import atexit
import json
import os
import shutil
import signal
import socket
import subprocess
import sys
import tempfile
import time

from .commands import Skip, program, run, succeeds

SUBNET = "10.213.7"
GATEWAY = f"{SUBNET}.254"
BRIDGE = "hgbridge"


def check_machine():
    """Raises Skip if no engine can run."""
    if os.geteuid() != 0:
        raise Skip("container tests need root")
    if not succeeds("unshare", "--mount", "--net", "true"):
        raise Skip("new namespaces are forbidden here (unshare --mount --net failed)")
    for name in ("dockerd", "docker", "iptables", "ip", "nsenter"):
        program(name)


class Site:
    """The bridge, a context manager; `add_machine` adds machines."""

    def __init__(self):
        check_machine()
        self.folder = tempfile.mkdtemp(prefix="heliograph-site-", dir="/var/tmp")
        self.machines = []
        self._rules = [
            ("nat", "POSTROUTING", "-s", f"{SUBNET}.0/24", "!", "-o", BRIDGE, "-j", "MASQUERADE"),
            ("filter", "FORWARD", "-i", BRIDGE, "-j", "ACCEPT"),
            ("filter", "FORWARD", "-o", BRIDGE, "-j", "ACCEPT")]
        self._forwarding = None

    def __enter__(self):
        if os.path.exists(f"/sys/class/net/{BRIDGE}"):
            raise RuntimeError(f"{BRIDGE} exists: another run of these tests is under way")
        # Clean up however this program ends, except by SIGKILL.
        atexit.register(self.__exit__)
        signal.signal(signal.SIGTERM, lambda *_: sys.exit(1))
        try:
            run("ip", "link", "add", BRIDGE, "type", "bridge")
            run("ip", "addr", "add", f"{GATEWAY}/24", "dev", BRIDGE)
            run("ip", "link", "set", BRIDGE, "up")
            for table, chain, *rule in self._rules:
                run("iptables", "-t", table, "-I", chain, *rule)
            with open("/proc/sys/net/ipv4/ip_forward", "r+", encoding="ascii") as file:
                self._forwarding = file.read()
                file.write("1")
        except Exception:
            self.__exit__()
            raise
        return self

    def __exit__(self, *_):
        atexit.unregister(self.__exit__)
        while self.machines:
            self.machines.pop().remove()
        for table, chain, *rule in self._rules:
            while succeeds("iptables", "-t", table, "-D", chain, *rule):
                pass
        succeeds("ip", "link", "del", BRIDGE)
        if self._forwarding is not None:
            with open("/proc/sys/net/ipv4/ip_forward", "w", encoding="ascii") as file:
                file.write(self._forwarding)
        with open("/proc/mounts", encoding="utf-8") as file:
            mounts = [line.split()[1] for line in file]
        for mount in reversed([path for path in mounts if path.startswith(f"{self.folder}/")]):
            succeeds("umount", "--lazy", mount)
        shutil.rmtree(self.folder, ignore_errors=True)

    def add_machine(self):
        machine = Machine(self, len(self.machines) + 1)
        self.machines.append(machine)
        machine.start()
        return machine


class Machine:
    """A network namespace with an address on the bridge and an engine in it."""

    def __init__(self, site, number):
        self.name = f"hg{number}"
        self.address = f"{SUBNET}.{number}"
        self.folder = os.path.join(site.folder, self.name)
        self.socket = os.path.join(self.folder, "docker.sock")
        self._bridge_end = f"hgbridge{number}"
        self._engine = None

    def start(self):
        os.mkdir(self.folder)
        os.chmod(os.path.dirname(self.folder), 0o755)
        run("ip", "netns", "add", self.name)
        run("ip", "link", "add", self._bridge_end, "type", "veth", "peer", "name", "eth0", "netns",
            self.name)
        run("ip", "link", "set", self._bridge_end, "master", BRIDGE, "up")
        self.inside("ip", "link", "set", "lo", "up")
        self.inside("ip", "addr", "add", f"{self.address}/24", "dev", "eth0")
        self.inside("ip", "link", "set", "eth0", "up")
        self.inside("ip", "route", "add", "default", "via", GATEWAY)
        self._start_engine()

    def _start_engine(self):
        # Its mounts are private to it. `ip netns exec` would hide the control groups.
        log = open(os.path.join(self.folder, "dockerd.log"), "w", encoding="utf-8")
        script = f"hostname {self.name}; exec {program('dockerd')} \"$@\""
        self._engine = subprocess.Popen(
            ["nsenter", f"--net=/run/netns/{self.name}", "unshare", "--mount", "--uts", "sh", "-c",
             script, "sh", "--data-root", f"{self.folder}/data", "--exec-root",
             f"{self.folder}/exec", "--pidfile", f"{self.folder}/pid", "--host",
             f"unix://{self.socket}", "--mtu", str(_smallest_mtu())],
            stdin=subprocess.DEVNULL, stdout=log, stderr=log, start_new_session=True)
        log.close()
        deadline = time.monotonic() + 180
        while not succeeds(program("docker"), "--host", f"unix://{self.socket}", "info"):
            if self._engine.poll() is not None or time.monotonic() > deadline:
                with open(log.name, encoding="utf-8") as file:
                    lines = [line for line in file if "level=info" not in line]
                raise Skip("dockerd does not start: " + "".join(lines[-3:]).strip())
            time.sleep(0.1)

    def inside(self, *command, **options):
        """Runs a program in the machine's network."""
        return run("nsenter", f"--net=/run/netns/{self.name}", *command, **options)

    def docker(self, *command, timeout=300, **options):
        environment = {**os.environ, "DOCKER_BUILDKIT": "1", **options.pop("environment", {})}
        return run(program("docker"), "--host", f"unix://{self.socket}", *command, timeout=timeout,
                   env=environment, **options)

    def compose(self, *command, environment=None, timeout=600):
        return run(program("docker-compose"), *command, timeout=timeout,
                   env={**os.environ, "DOCKER_HOST": f"unix://{self.socket}",
                        **(environment or {})})

    def inspect(self, container, template="{{json .}}"):
        return json.loads(self.docker("inspect", "--format", template, container))

    def unplug(self):
        run("ip", "link", "set", self._bridge_end, "down")

    def plug(self):
        run("ip", "link", "set", self._bridge_end, "up")

    def remove(self):
        """Ends every container, the engine and the namespace, however slow the machine is."""
        if self._engine and self._engine.poll() is None:
            docker = (program("docker"), "--host", f"unix://{self.socket}")
            # A swarm would recreate removed containers.
            succeeds(*docker, "swarm", "leave", "--force")
            succeeds("sh", "-c", '"$@" ps --all --quiet | xargs --no-run-if-empty "$@" rm --force '
                     "--volumes", "sh", *docker)
            self._engine.send_signal(signal.SIGTERM)
            try:
                self._engine.wait(timeout=60)
            except subprocess.TimeoutExpired:
                self._engine.kill()
                self._engine.wait()
        self._end_what_is_left()
        succeeds("ip", "link", "del", self._bridge_end)
        succeeds("ip", "netns", "del", self.name)

    def _end_what_is_left(self):
        """Processes whose command line names this machine's folder (containerd and its shims), and
        processes whose root lies in it: orphaned containers."""
        mark = f"{self.folder}/".encode()
        for entry in os.listdir("/proc"):
            if not entry.isdigit() or int(entry) == os.getpid():
                continue
            try:
                if mark in _contents(f"/proc/{entry}/cmdline") or mark in _root_mount(entry):
                    os.kill(int(entry), signal.SIGKILL)
            except OSError:
                continue


def _contents(path):
    with open(path, "rb") as file:
        return file.read()


def _root_mount(process):
    """The kernel's mountinfo line of the root of the process."""
    lines = _contents(f"/proc/{process}/mountinfo").splitlines()
    return b"".join(line for line in lines if line.split()[4] == b"/")


def _smallest_mtu():
    """The smallest MTU of the outgoing interfaces: packets of containers must fit through all."""
    sizes = [1500]
    for _, name in socket.if_nameindex():
        if name != "lo":
            with open(f"/sys/class/net/{name}/mtu", encoding="ascii") as file:
                sizes.append(int(file.read()))
    return min(sizes)
