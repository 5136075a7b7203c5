"""Static checks of Compose, Swarm, the balancer and Grafana."""

import json
import os
import re
import shutil
import subprocess
import unittest

from harness.commands import run, succeeds
from harness.files import DEPLOY, documents, server_sources, text_of


class Options(unittest.TestCase):
    def test_every_variable_is_read_by_the_program(self):
        known = set(re.findall(r'"(HELIOGRAPH_[A-Z_]+)"', server_sources()))
        known |= {"HELIOGRAPH_" + option.upper().replace("-", "_")
                  for option in re.findall(r'"--([a-z-]+)"', server_sources())}
        for name in ("Dockerfile", "compose.yaml", "stack.yaml", "kubernetes/deployment.yaml",
                     "compose.gpu.yaml", "stack.gpu.yaml", "kubernetes/gpu/deployment.yaml",
                     "kubernetes/ingress/trusted-proxy.yaml", "systemd/heliograph.service"):
            text = text_of(os.path.join(DEPLOY, name))
            given = set(re.findall(r"^\s*(?:ENV |Environment=|- \{name: |- name: )?"
                                   r"(HELIOGRAPH_[A-Z_]+)[=:,\s]", text, re.M))
            balancers = set(re.findall(r"\{(HELIOGRAPH_[A-Z_]+)", text_of(
                os.path.join(DEPLOY, "balancer/haproxy.cfg"))))
            with self.subTest(name):
                self.assertEqual(sorted(given - known - balancers), [])


class Containers(unittest.TestCase):
    def services(self):
        for name in ("compose.yaml", "stack.yaml"):
            for service, value in documents(os.path.join(DEPLOY, name))[0]["services"].items():
                yield f"{name}: {service}", name, value

    def test_are_hardened_and_limited(self):
        for label, name, service in self.services():
            with self.subTest(label):
                self.assertIs(service["read_only"], True)
                self.assertEqual(service["cap_drop"], ["ALL"])
                self.assertNotIn("privileged", service)
                if name == "compose.yaml":
                    self.assertIn("no-new-privileges:true", service["security_opt"])
                    self.assertIn("mem_limit", service)
                    self.assertIn("pids_limit", service)
                else:
                    self.assertLessEqual({"memory", "pids"},
                                         service["deploy"]["resources"]["limits"].keys())

    def test_the_balancer_may_run_the_threads_of_two_processes(self):
        """After a reload the old process stays for its viewers. A third one supervises both."""
        threads = int(re.search(r"(?m)^  nbthread (\d+)$", text_of(
            os.path.join(DEPLOY, "balancer/haproxy.cfg"))).group(1))
        compose, stack = (documents(os.path.join(DEPLOY, name))[0]["services"]["balancer"]
                          for name in ("compose.yaml", "stack.yaml"))
        for limit in (compose["pids_limit"], stack["deploy"]["resources"]["limits"]["pids"]):
            self.assertLess(1 + 2 * threads, limit)

    def test_the_number_of_nodes_is_consistent_and_documented(self):
        known = re.findall(r"(?m)^  server-template node (\d+-\d+) ", text_of(
            os.path.join(DEPLOY, "balancer/haproxy.cfg")))
        self.assertEqual(len(known), 3)
        self.assertEqual(len(set(known)), 1)
        self.assertIn(f"`server-template node {known[0]}`",
                      text_of(os.path.join(DEPLOY, "README.md")))

    def test_nodes_trust_the_balancer_only(self):
        """Its fixed address in Compose, the stack's own network in a swarm."""
        compose, stack = (documents(os.path.join(DEPLOY, name))[0]
                          for name in ("compose.yaml", "stack.yaml"))
        balancer = compose["services"]["balancer"]["networks"]["service"]["ipv4_address"]
        network, = stack["networks"]["service"]["ipam"]["config"]
        for file, trusted in ((compose, balancer), (stack, network["subnet"])):
            environment = file["services"]["heliograph"]["environment"]
            self.assertEqual(environment["HELIOGRAPH_TRUST_PROXY"], trusted)

    def test_grafana_login_is_disabled(self):
        grafana = documents(os.path.join(DEPLOY, "compose.yaml"))[0]["services"]["grafana"]
        for name, value in (("AUTH_BASIC_ENABLED", "false"), ("AUTH_DISABLE_LOGIN_FORM", "true"),
                            ("SECURITY_DISABLE_INITIAL_ADMIN_CREATION", "true"),
                            ("AUTH_ANONYMOUS_ORG_ROLE", "Viewer")):
            self.assertEqual(grafana["environment"][f"GF_{name}"], value)
        self.assertRegex(grafana["image"], r":\d+\.\d+\.\d+\}?$")

    def test_allow_as_many_pixels_as_the_pod(self):
        """The image's tests check that this number fits."""
        deployment = documents(os.path.join(DEPLOY, "kubernetes/deployment.yaml"))[0]
        environment = deployment["spec"]["template"]["spec"]["containers"][0]["env"]
        pixels, = [entry["value"] for entry in environment
                   if entry["name"] == "HELIOGRAPH_MAX_PIXELS"]
        for label, _, service in self.services():
            if label.endswith(": heliograph"):
                with self.subTest(label):
                    self.assertEqual(service["environment"]["HELIOGRAPH_MAX_PIXELS"],
                                     f"${{HELIOGRAPH_MAX_PIXELS:-{pixels}}}")

    def test_publish_only_the_balancer_beyond_loopback(self):
        published = [port for _, name, service in self.services() if name == "compose.yaml"
                     for port in service.get("ports", [])]
        self.assertEqual([port for port in published if "127.0.0.1" not in port], [])

    def test_compose_accepts_its_file(self):
        program = shutil.which("docker-compose")
        if not program:
            self.skipTest("docker-compose is not installed")
        environment = {**os.environ, "HELIOGRAPH_TOKEN": "not-a-secret",
                       "HELIOGRAPH_CERTIFICATE": "/etc/ssl/heliograph.pem"}
        for more in ((), ("compose.tls.yaml",), ("compose.gpu.yaml",),
                     ("compose.tls.yaml", "compose.gpu.yaml")):
            names = (word for name in ("compose.yaml", *more)
                     for word in ("--file", os.path.join(DEPLOY, name)))
            run(program, *names, "config", env=environment)
        environment.pop("HELIOGRAPH_TOKEN")
        self.assertFalse(succeeds(program, "--file", os.path.join(DEPLOY, "compose.yaml"), "config",
                                  env=environment), "runs without a token")


class RenderJob(unittest.TestCase):
    """The job of a swarm that renders a manifest in shards."""

    FILE = os.path.join(DEPLOY, "stack.render.yaml")

    def setUp(self):
        self.service = documents(self.FILE)[0]["services"]["render"]

    def shard_of(self, slot, status=0):
        """What the task of a slot would run, and its status if the program ended with another."""
        command, = self.service["command"]
        program = f'heliograph() {{ echo "$@"; return {status}; }}; '
        ran = subprocess.run(["sh", "-c", program + command.replace("$$", "$")], check=False,
                             stdout=subprocess.PIPE, text=True, env={**os.environ, "SLOT": slot})
        return re.search(r"--shard (\S+) --resume --report (\S+)", ran.stdout).groups(), ran.returncode

    def test_every_shard_has_a_task(self):
        """Slots count from 0; the first one has the id of its node in place of a number."""
        deploy = self.service["deploy"]
        self.assertEqual(deploy["mode"], "replicated-job")
        slots = ["7zq2k0x1m3", *map(str, range(1, deploy["replicas"]))]
        shards = [self.shard_of(slot)[0] for slot in slots]
        self.assertEqual(shards, [(f"{index + 1}/{len(slots)}", f"report_{index}.json")
                                  for index in range(len(slots))])

    def test_failed_entries_are_not_tried_again(self):
        self.assertEqual([self.shard_of("1", status)[1] for status in (0, 3, 1)], [0, 0, 1])

    def test_is_hardened_and_limited(self):
        self.assertIs(self.service["read_only"], True)
        self.assertEqual(self.service["cap_drop"], ["ALL"])
        self.assertLessEqual({"memory", "pids"}, self.service["deploy"]["resources"]["limits"].keys())


class Graphics(unittest.TestCase):
    """Environment of nodes with an NVIDIA GPU, for every orchestrator."""

    def nodes(self):
        """The environment of the servers in each file."""
        for name in ("compose.gpu.yaml", "stack.gpu.yaml"):
            yield name, documents(os.path.join(DEPLOY, name))[0]["services"]["heliograph"][
                "environment"]
        name = "kubernetes/gpu/deployment.yaml"
        container, = documents(os.path.join(DEPLOY, name))[0]["spec"]["template"]["spec"][
            "containers"]
        yield name, {entry["name"]: entry["value"] for entry in container["env"]}
        command = re.search(r"(?ms)^docker run \S+ --gpus all .*?heliograph$",
                            text_of(os.path.join(DEPLOY, "README.md"))).group()
        yield "README.md", dict(re.findall(r"-e (\w+)=(\S+)", command))

    def test_see_only_the_installed_driver_file(self):
        """A missing GPU is then an error; the software device is not used instead."""
        installed = re.search(r"install\(FILES (\S+) DESTINATION \$\{CMAKE_INSTALL_DATADIR\}"
                              r"/(\S+)\)", text_of(os.path.join(DEPLOY, "CMakeLists.txt")))
        path = f"/usr/share/{installed[2]}/{installed[1]}"
        for label, environment in self.nodes():
            with self.subTest(label):
                self.assertEqual(environment["VK_DRIVER_FILES"], path)

    def test_the_driver_file_names_the_library_without_x11(self):
        with open(os.path.join(DEPLOY, "nvidia_icd.json"), encoding="utf-8") as file:
            self.assertEqual(json.load(file), {
                "file_format_version": "1.0.1",
                "ICD": {"library_path": "libEGL_nvidia.so.0", "api_version": "1.3"}})

    def test_have_the_driver_capabilities_to_create_a_device(self):
        given = re.search(r"NVIDIA_DRIVER_CAPABILITIES=(\S+)", text_of(
            os.path.join(DEPLOY, "Dockerfile")))[1].split(",")
        self.assertLessEqual({"compute", "graphics"}, set(given))

    def test_allow_full_resolution(self):
        for label, environment in self.nodes():
            with self.subTest(label):
                pixels = re.search(r"\d+", environment["HELIOGRAPH_MAX_PIXELS"]).group()
                self.assertGreaterEqual(int(pixels), 8 * 1920 * 1080)

    def test_a_swarm_update_needs_no_spare_gpu(self):
        deploy = documents(os.path.join(DEPLOY, "stack.gpu.yaml"))[0]["services"]["heliograph"][
            "deploy"]
        for change in ("update_config", "rollback_config"):
            self.assertEqual(deploy[change]["order"], "stop-first")

    def test_the_engine_accepts_the_stack(self):
        program = shutil.which("docker")
        if not program or "  config " not in run(program, "stack", "--help"):
            self.skipTest("docker with \"stack config\" (23) is not installed")
        files_of = [word for name in ("stack.yaml", "stack.gpu.yaml")
                    for word in ("--compose-file", os.path.join(DEPLOY, name))]
        self.assertIn("kind: NVIDIA-GPU", run(program, "stack", "config", *files_of))
        self.assertIn("mode: replicated-job", run(program, "stack", "config", "--compose-file",
                                                  RenderJob.FILE))


class Haproxy(unittest.TestCase):
    """If HAProxy is installed; the image checks its configuration while it is built."""

    def check(self, name, *words, **environment):
        found = shutil.which(name, path="/usr/bin:/usr/sbin")
        if not found:
            self.skipTest(f"{name} is not installed")
        return run(found, *words, env={**os.environ, **environment})

    def test_the_configuration_is_valid(self):
        release = self.check("haproxy", "-v")
        if int(re.search(r"version (\d+)", release).group(1)) < 3:
            self.skipTest(f"hashing by address needs HAProxy 3.0; this is {release[:20]}")
        self.check("haproxy", "-c", "-f", os.path.join(DEPLOY, "balancer/haproxy.cfg"),
                   HELIOGRAPH_NODES="localhost", HELIOGRAPH_COOKIE_KEY="check")


if __name__ == "__main__":
    unittest.main()
