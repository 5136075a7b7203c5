"""What can be told of services, pods and dashboards from their files alone."""

import json
import os
import re
import shutil
import tempfile
import unittest

from harness.commands import run, succeeds
from harness.files import DEPLOY, documents, files, server_sources, text_of

HERE = os.path.dirname(os.path.abspath(__file__))


class Options(unittest.TestCase):
    def test_every_variable_is_one_that_the_program_reads(self):
        known = set(re.findall(r'"(HELIOGRAPH_[A-Z_]+)"', server_sources()))
        known |= {"HELIOGRAPH_" + option.upper().replace("-", "_")
                  for option in re.findall(r'"--([a-z-]+)"', server_sources())}
        for name in ("Dockerfile", "compose.yaml", "stack.yaml", "kubernetes/deployment.yaml",
                     "systemd/heliograph.service"):
            text = text_of(os.path.join(DEPLOY, name))
            given = set(re.findall(r"^\s*(?:ENV |Environment=|- \{name: |- name: )?"
                                   r"(HELIOGRAPH_[A-Z_]+)[=:,\s]", text, re.M))
            balancers = set(re.findall(r"\{(HELIOGRAPH_[A-Z_]+)", text_of(
                os.path.join(DEPLOY, "balancer/haproxy.cfg"))))
            with self.subTest(name):
                self.assertEqual(sorted(given - known - balancers), [])

    def test_every_measurement_shown_is_one_that_the_program_takes(self):
        known = set(re.findall(r'"(?:heliograph_)?([a-z_]+)"', server_sources()))
        for path in files("*.json", os.path.join(DEPLOY, "grafana")) + files("alerts.yml"):
            shown = set(re.findall(r"\bheliograph_([a-z_]+)", text_of(path)))
            self.assertTrue(shown, path)
            for name in shown:
                with self.subTest(f"{os.path.basename(path)}: {name}"):
                    self.assertTrue(name in known or re.sub("_(sum|count|bucket)$", "", name)
                                    in known)


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

    def test_nodes_believe_nobody_but_the_balancer(self):
        """Where it has a fixed address, that one; else those of the stack's own network."""
        compose, stack = (documents(os.path.join(DEPLOY, name))[0]
                          for name in ("compose.yaml", "stack.yaml"))
        balancer = compose["services"]["balancer"]["networks"]["service"]["ipv4_address"]
        network, = stack["networks"]["service"]["ipam"]["config"]
        for file, believed in ((compose, balancer), (stack, network["subnet"])):
            environment = file["services"]["heliograph"]["environment"]
            self.assertEqual(environment["HELIOGRAPH_TRUST_PROXY"], believed)

    def test_nobody_can_log_in_to_grafana(self):
        grafana = documents(os.path.join(DEPLOY, "compose.yaml"))[0]["services"]["grafana"]
        for name, value in (("AUTH_BASIC_ENABLED", "false"), ("AUTH_DISABLE_LOGIN_FORM", "true"),
                            ("SECURITY_DISABLE_INITIAL_ADMIN_CREATION", "true"),
                            ("AUTH_ANONYMOUS_ORG_ROLE", "Viewer")):
            self.assertEqual(grafana["environment"][f"GF_{name}"], value)
        self.assertRegex(grafana["image"], r":\d+\.\d+\.\d+\}?$")

    def test_allow_the_pixels_that_the_pod_allows(self):
        """Those that the image's tests find room for."""
        deployment = documents(os.path.join(DEPLOY, "kubernetes/deployment.yaml"))[0]
        environment = deployment["spec"]["template"]["spec"]["containers"][0]["env"]
        pixels, = [entry["value"] for entry in environment
                   if entry["name"] == "HELIOGRAPH_MAX_PIXELS"]
        for label, _, service in self.services():
            if label.endswith(": heliograph"):
                with self.subTest(label):
                    self.assertEqual(service["environment"]["HELIOGRAPH_MAX_PIXELS"],
                                     f"${{HELIOGRAPH_MAX_PIXELS:-{pixels}}}")

    def test_open_only_the_balancer_to_others(self):
        published = [port for _, name, service in self.services() if name == "compose.yaml"
                     for port in service.get("ports", [])]
        self.assertEqual([port for port in published if "127.0.0.1" not in port], [])

    def test_compose_reads_its_file(self):
        program = shutil.which("docker-compose")
        if not program:
            self.skipTest("docker-compose is not installed")
        environment = {**os.environ, "HELIOGRAPH_TOKEN": "not-a-secret",
                       "HELIOGRAPH_CERTIFICATE": "/etc/ssl/heliograph.pem"}
        for more in ((), ("--file", os.path.join(DEPLOY, "compose.tls.yaml"))):
            run(program, "--file", os.path.join(DEPLOY, "compose.yaml"), *more, "config",
                env=environment)
        environment.pop("HELIOGRAPH_TOKEN")
        self.assertFalse(succeeds(program, "--file", os.path.join(DEPLOY, "compose.yaml"), "config",
                                  env=environment), "runs without a token")

    def test_dashboards_use_the_source_that_is_provisioned(self):
        source, = documents(os.path.join(DEPLOY, "grafana/provisioning/datasources/"
                                                 "prometheus.yaml"))[0]["datasources"]
        for path in files("*.json", os.path.join(DEPLOY, "grafana")):
            board = json.loads(text_of(path))
            self.assertGreater(len(board["panels"]), 3)
            for panel in board["panels"]:
                if panel["type"] == "row":
                    continue
                with self.subTest(panel["title"]):
                    self.assertEqual(panel["datasource"]["uid"], source["uid"])
                    self.assertTrue(all(target["expr"] for target in panel["targets"]))


class ByTheirOwnPrograms(unittest.TestCase):
    """Where these are installed; the images are checked by theirs while they are built."""

    def check(self, name, *words, **environment):
        found = shutil.which(name, path="/usr/bin:/usr/sbin")
        if not found:
            self.skipTest(f"{name} is not installed")
        return run(found, *words, env={**os.environ, **environment})

    def test_the_balancer_is_right(self):
        release = self.check("haproxy", "-v")
        if int(re.search(r"version (\d+)", release).group(1)) < 3:
            self.skipTest(f"nodes are hashed by their addresses from 3.0 on, not in {release[:20]}")
        self.check("haproxy", "-c", "-f", os.path.join(DEPLOY, "balancer/haproxy.cfg"),
                   HELIOGRAPH_NODES="localhost", HELIOGRAPH_COOKIE_KEY="check")

    def test_measuring_is_right(self):
        self.check("promtool", "check", "config", os.path.join(DEPLOY, "prometheus/prometheus.yml"))

    def test_alerts_come_when_they_should(self):
        with tempfile.TemporaryDirectory() as folder:
            for path in (os.path.join(DEPLOY, "prometheus/alerts.yml"),
                         os.path.join(HERE, "prometheus/alerts_test.yml")):
                shutil.copy(path, folder)
            self.check("promtool", "test", "rules", os.path.join(folder, "alerts_test.yml"))


class Kubernetes(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        folder = os.path.join(DEPLOY, "kubernetes")
        cls.kustomization = documents(os.path.join(folder, "kustomization.yaml"))[0]
        cls.objects = [document for name in cls.kustomization["resources"]
                       for document in documents(os.path.join(folder, name))]
        cls.listed = {os.path.join(folder, name) for name in cls.kustomization["resources"]}
        cls.folder = folder

    def one(self, kind, name="heliograph"):
        found, = [o for o in self.objects if o["kind"] == kind and o["metadata"]["name"] == name]
        return found

    def pod(self):
        return self.one("Deployment")["spec"]["template"]

    def test_every_file_is_applied(self):
        present = set(files("*.yaml", self.folder)) - {
            os.path.join(self.folder, "kustomization.yaml")}
        self.assertEqual(present, self.listed)

    def test_selectors_find_the_pods(self):
        labels = self.pod()["metadata"]["labels"].items()
        selectors = [o["spec"]["selector"].get("matchLabels", o["spec"]["selector"])
                     for o in self.objects if "selector" in o["spec"]]
        selectors.append(self.one("NetworkPolicy")["spec"]["podSelector"]["matchLabels"])
        self.assertEqual(len(selectors), 5)
        for selector in selectors:
            self.assertLessEqual(selector.items(), labels)

    def test_ports_are_those_of_the_container(self):
        container, = self.pod()["spec"]["containers"]
        names = {port["name"]: port["containerPort"] for port in container["ports"]}
        environment = {entry["name"]: entry.get("value") for entry in container["env"]}
        self.assertTrue(environment["HELIOGRAPH_METRICS_LISTEN"].endswith(f":{names['metrics']}"))
        for service in (o for o in self.objects if o["kind"] == "Service"):
            for port in service["spec"]["ports"]:
                self.assertIn(port["targetPort"], names)
        for probe in ("startupProbe", "readinessProbe", "livenessProbe"):
            self.assertIn(container[probe]["httpGet"]["port"], names)

    def test_pods_are_restricted(self):
        """The profile "restricted" of the pod security standards, and a root that never changes."""
        spec = self.pod()["spec"]
        self.assertTrue(spec["securityContext"]["runAsNonRoot"])
        self.assertEqual(spec["securityContext"]["seccompProfile"]["type"], "RuntimeDefault")
        self.assertFalse(spec["automountServiceAccountToken"])
        for container in spec["containers"] + spec["initContainers"]:
            with self.subTest(container["name"]):
                context = container["securityContext"]
                self.assertFalse(context["allowPrivilegeEscalation"])
                self.assertTrue(context["readOnlyRootFilesystem"])
                self.assertEqual(context["capabilities"], {"drop": ["ALL"]})
                self.assertIn("memory", container["resources"]["limits"])
        self.assertLessEqual({tuple(volume)[1] for volume in spec["volumes"]}, {"emptyDir"})

    def test_the_same_user_as_in_the_image(self):
        user = re.search(r"(?m)^USER (\d+):", text_of(os.path.join(DEPLOY, "Dockerfile"))).group(1)
        self.assertEqual(self.pod()["spec"]["securityContext"]["runAsUser"], int(user))

    def test_there_is_time_to_end(self):
        pod = self.pod()["spec"]
        pause = int(pod["containers"][0]["lifecycle"]["preStop"]["exec"]["command"][1])
        self.assertGreaterEqual(pod["terminationGracePeriodSeconds"], pause + 20)

    def test_the_autoscaler_scales_the_deployment(self):
        scaler = self.one("HorizontalPodAutoscaler")["spec"]
        self.assertEqual(scaler["scaleTargetRef"]["name"],
                         self.one("Deployment")["metadata"]["name"])
        self.assertLessEqual(scaler["minReplicas"], self.one("Deployment")["spec"]["replicas"])


if __name__ == "__main__":
    unittest.main()
