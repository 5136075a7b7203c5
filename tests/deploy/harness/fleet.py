"""The services of the compose file on one machine: several servers behind the balancer."""

import os
import time

import yaml

from . import images
from .commands import program
from .files import DEPLOY
from .scenes import make_scenes, service_override
from .servers import TOKEN, get, make_certificate


class Fleet:
    """A context manager. Nodes are containers; the balancer listens on the machine's port 8080."""

    def __init__(self, machine, nodes):
        self.machine, self.count = machine, nodes
        self.url = f"http://{machine.address}:8080/"
        self.secure_url = f"https://{machine.address}:8443/"
        self.certificate = os.path.join(machine.folder, "heliograph.pem")
        self.renew_certificate()
        self.prometheus = f"http://{machine.address}:9090/"
        override = os.path.join(machine.folder, "override.yaml")
        with open(override, "w", encoding="utf-8") as file:
            yaml.safe_dump({"services": {"heliograph": service_override(
                make_scenes(machine.folder))}}, file)
        self._base = ("--file", os.path.join(DEPLOY, "compose.yaml"),
                      "--file", os.path.join(DEPLOY, "compose.tls.yaml"), "--file", override,
                      "--project-name", "fleet")
        self._environment = {"HELIOGRAPH_TOKEN": TOKEN, "HELIOGRAPH_ADDRESS": "0.0.0.0:8080",
                             "HELIOGRAPH_TLS_ADDRESS": "0.0.0.0:8443",
                             "HELIOGRAPH_CERTIFICATE": self.certificate, "HELIOGRAPH_CPUS": "2"}

    def __enter__(self):
        program("docker-compose")
        self.compose("up", "--detach", "--no-build", "--scale", f"heliograph={self.count}",
                     "heliograph", "balancer")
        self.wait_ready(self.count)
        return self

    def __exit__(self, *_):
        self.compose("down", "--volumes", "--timeout", "5")

    def compose(self, *command, **options):
        return self.machine.compose(*self._base, *command, environment=self._environment, **options)

    def renew_balancer(self, **environment):
        """Changes variables of the compose file."""
        self._environment.update(environment)
        self.compose("up", "--detach", "--no-build", "--no-deps", "balancer")
        self.wait_ready(self.count)

    def nodes(self, *, every=False):
        """The names of the servers' containers, oldest first."""
        names = self.machine.docker("ps", *(["--all"] if every else []), "--filter",
                                    "label=com.docker.compose.service=heliograph", "--format",
                                    "{{.Names}}").split()
        return sorted(names, key=lambda name: int(name.rsplit("_", 1)[-1].rsplit("-", 1)[-1]))

    def address(self, node):
        networks = self.machine.inspect(node, "{{json .NetworkSettings.Networks}}")
        return next(iter(networks.values()))["IPAddress"]

    def states(self):
        """The nodes whose addresses the balancer knows: {address: state}."""
        return {row["addr"].rsplit(":", 1)[0]: row["status"] for row in self._rows()}

    def node_of(self, viewer):
        """The container that the balancer's cookie names."""
        value = viewer.node.split("=", 1)[1]
        addresses = {row["addr"].rsplit(":", 1)[0] for row in self._rows() if row["cookie"] == value}
        found = [node for node in self.nodes() if self.address(node) in addresses]
        if len(found) != 1:
            raise AssertionError(f"cookie {value} leads to {addresses}, nodes {found}")
        return found[0]

    def _rows(self):
        url = f"http://{self.address(self.balancer())}:8404/;csv;norefresh"
        page = self.machine.inside("curl", "--silent", "--fail", url).splitlines()
        names = page[0].lstrip("# ").split(",")
        rows = [dict(zip(names, line.split(","))) for line in page[1:]]
        return [row for row in rows if row["pxname"] == "by_viewer"
                and row["svname"].startswith("node") and row["addr"]]

    def balancer(self):
        """The container's name, which depends on the version of Compose."""
        name, = self.machine.docker("ps", "--filter", "label=com.docker.compose.service=balancer",
                                    "--format", "{{.Names}}").split()
        return name

    def wait_ready(self, count, timeout=600):
        """Waits until this many nodes are ready for viewers."""
        deadline = time.monotonic() + timeout
        while True:
            states = self.states()
            if sum(state == "UP" for state in states.values()) >= count:
                return
            if time.monotonic() > deadline:
                raise AssertionError(f"{count} nodes are not up in {timeout} s: {states}\n" +
                                     self.compose("logs", "--tail", "15"))
            time.sleep(0.2)

    def renew_certificate(self):
        """Rewrites the file in place: the container mounts the file, not its folder."""
        make_certificate(self.certificate, self.machine.address)

    def ask(self, path, **options):
        return get(self.url + path, **options)

    def ask_securely(self, path, **options):
        return get(self.secure_url + path, certificate=self.certificate, **options)


def add_images(machine, *, prometheus=False):
    images.add_base(machine)
    images.add_server(machine)
    images.add_balancer(machine)
    if prometheus:
        images.add_prometheus(machine)
