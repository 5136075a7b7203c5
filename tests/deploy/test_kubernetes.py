"""The Kubernetes objects against the API's schema and types, and the pod in a container engine."""

import copy
import json
import os
import shutil
import subprocess
import tempfile
import time
import unittest

import yaml

from harness import images
from harness.commands import Skip, program, succeeds
from harness.kubernetes import objects, one, rendered_overlay
from harness.servers import TOKEN
from harness.site import Site

HERE = os.path.join(os.path.dirname(os.path.abspath(__file__)), "kubernetes")


def pod_of(deployment):
    template = deployment["spec"]["template"]
    return {"apiVersion": "v1", "kind": "Pod",
            "metadata": {"name": "heliograph", "labels": template["metadata"]["labels"]},
            "spec": template["spec"]}


class Schema(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.mkdtemp(prefix="heliograph-kubernetes-", dir="/var/tmp")
        cls.addClassCleanup(shutil.rmtree, cls.folder, ignore_errors=True)
        for name in ("package.json", "package-lock.json", "check.mjs"):
            shutil.copy(os.path.join(HERE, name), cls.folder)
        if not succeeds(program("npm"), "ci", "--no-progress", "--loglevel=error", cwd=cls.folder,
                        timeout=300):
            raise Skip("the packages of the check cannot be had by npm")

    def check(self, checked):
        return subprocess.run([program("node"), os.path.join(self.folder, "check.mjs")],
                              input=json.dumps(checked), text=True, capture_output=True, timeout=300)

    def test_objects_are_valid(self):
        done = self.check(objects())
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)

    def test_the_documented_overlay_is_valid(self):
        with tempfile.TemporaryDirectory() as folder:
            done = self.check(rendered_overlay(folder))
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)

    def test_the_check_detects_errors(self):
        for change in (lambda spec: spec.update(replicas="three"),
                       lambda spec: spec["template"]["spec"].update(runAsUnknown=True),
                       lambda spec: spec["template"]["spec"]["containers"][0].pop("name")):
            deployment = copy.deepcopy(one(objects(), "Deployment"))
            change(deployment["spec"])
            with self.subTest(str(change)):
                self.assertNotEqual(self.check([deployment]).returncode, 0)


class Pod(unittest.TestCase):
    """Podman runs what a node would: init container, volumes, limits and security context. Unlike in
    Kubernetes there are no probes and no service."""

    @classmethod
    def setUpClass(cls):
        program("podman")
        cls.site = cls.enterClassContext(Site())
        cls.machine = cls.site.add_machine()
        images.add_base(cls.machine)
        images.add_server(cls.machine)
        cls.folder = os.path.join(cls.site.folder, "podman")
        os.mkdir(cls.folder)
        with open(os.path.join(cls.folder, "containers.conf"), "w", encoding="utf-8") as file:
            file.write('[containers]\ndefault_ulimits = ["nofile=8192:8192", "nproc=4096:4096"]\n'
                       '[engine]\nruntime = "runc"\ncgroup_manager = "cgroupfs"\n'
                       'events_logger = "file"\n')
        saving = os.path.join(cls.folder, "image.tar")
        cls.machine.docker("save", "--output", saving, images.SERVER, timeout=300)
        cls.podman("load", "--input", saving)
        cls.podman("tag", f"docker.io/library/{images.SERVER}", "localhost/heliograph:latest",
                   check=False)
        os.remove(saving)

    @classmethod
    def podman(cls, *command, **options):
        return cls.machine.inside(
            program("podman"), "--root", f"{cls.folder}/root", "--runroot", f"{cls.folder}/run",
            "--storage-driver", "overlay", *command, timeout=300,
            env={**os.environ, "CONTAINERS_CONF": f"{cls.folder}/containers.conf"}, **options)

    def test_runs_with_its_security_context_and_limits(self):
        pod = pod_of(one(objects(), "Deployment"))
        for container in pod["spec"]["containers"] + pod["spec"]["initContainers"]:
            container["image"] = "localhost/heliograph:latest"
            # In the host's network there are no ports to map, and there are no probes.
            for member in ("ports", "startupProbe", "readinessProbe", "livenessProbe"):
                container.pop(member, None)
        # Podman 4.3 may remove a one-shot init container before it has registered its exit.
        pod["metadata"]["annotations"] = {"io.podman.annotations.init.container.type": "always"}
        # The syntax of secrets depends on podman's version.
        token, = [entry for entry in pod["spec"]["containers"][0]["env"]
                  if entry["name"] == "HELIOGRAPH_TOKEN"]
        token.pop("valueFrom")
        token["value"] = TOKEN
        path = os.path.join(self.folder, "pod.yaml")
        with open(path, "w", encoding="utf-8") as file:
            yaml.safe_dump(pod, file)
        self.addCleanup(self.podman, "play", "kube", "--down", path, check=False)
        started = time.monotonic()
        self.podman("play", "kube", "--network", "host", path)
        address = "http://127.0.0.1:8080/health/ready"
        while not succeeds("nsenter", f"--net=/run/netns/{self.machine.name}", "curl", "--silent",
                           "--fail", address):
            if time.monotonic() - started > 300:
                raise AssertionError(self.podman("logs", "heliograph-heliograph", check=False))
            time.sleep(0.3)
        print(f"pod: ready after {time.monotonic() - started:.1f} s", flush=True)
        state = json.loads(self.podman("inspect", "heliograph-heliograph"))[0]
        self.assertEqual(state["Config"]["User"], "10001:10001")
        self.assertTrue(state["HostConfig"]["ReadonlyRootfs"])
        self.assertEqual(state["HostConfig"]["Memory"], 2 * 2 ** 30)
        self.assertEqual(state["EffectiveCaps"] or [], [])


if __name__ == "__main__":
    unittest.main()
