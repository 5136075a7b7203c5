"""Servers behind the balancer: affinity, failover, updates, and isolation between nodes."""

import asyncio
import json
import math
import os
import shutil
import signal
import time
import unittest
import urllib.parse

import websockets

from harness import images
from harness.files import DEPLOY
from harness.fleet import Fleet, add_images
from harness.image_comparison import decode_jpeg, difference
from harness.replaying_viewer import ReplayingViewer, ViewState
from harness.scenes import NAMES
from harness.servers import TOKEN, call
from harness.site import GATEWAY, Site

MOST_SECONDS_AWAY = 5.0
# Upper bound of the gap between two frames of a viewer whose node stays up while another is killed:
# the machine also loads a scene for the viewer that reconnects.
MOST_SECONDS_OF_NOTICE = 0.8
NODES = 4  # one more than viewers, so that a viewer that loses its node finds a free one


def view_states(count):
    """Distinguishable views: scene, camera and a setting that is not the default."""
    return [ViewState(NAMES[i % 2], eye=(0.5 * i, 2.0, 8.0 - 0.5 * i),
                 settings={"exposure": {"compensation": 0.125 * (i + 1)}}) for i in range(count)]


class FleetTest(unittest.IsolatedAsyncioTestCase):
    @classmethod
    def setUpClass(cls):
        cls.site = cls.enterClassContext(Site())
        cls.machine = cls.site.add_machine()
        add_images(cls.machine, prometheus=True)
        started = time.monotonic()
        cls.fleet = cls.enterClassContext(Fleet(cls.machine, NODES))
        print(f"fleet: {NODES} nodes take viewers after {time.monotonic() - started:.1f} s",
              flush=True)

    async def asyncTearDown(self):
        """Every test begins with all nodes ready for viewers."""
        await self.scale(NODES)

    async def scale(self, count):
        await self.compose("up", "--detach", "--no-build", "--no-recreate", "--scale",
                           f"heliograph={count}", "heliograph")
        await asyncio.to_thread(self.fleet.wait_ready, count)

    async def compose(self, *command):
        return await asyncio.to_thread(self.fleet.compose, *command)

    async def docker(self, *command):
        return await asyncio.to_thread(self.machine.docker, *command)

    async def viewers(self, count):
        """This many viewers, each with its view restored and a frame received."""
        found = []
        for view in view_states(count):
            viewer = ReplayingViewer(self.fleet.url, TOKEN, view)
            await viewer.__aenter__()
            self.addAsyncCleanup(viewer.__aexit__)
            found.append(viewer)
        return found

    async def nodes_of(self, viewers):
        return [await asyncio.to_thread(self.fleet.node_of, viewer) for viewer in viewers]

    async def at_rest(self, viewer):
        """The final frame."""
        deadline = time.monotonic() + 60
        while True:
            seen = viewer.frames
            await asyncio.sleep(1.5)
            if viewer.frames == seen:
                return decode_jpeg(viewer.last_image)
            self.assertLess(time.monotonic(), deadline, "the view never converges")

    async def move(self, viewers, seconds):
        """Moves the cameras of all viewers."""
        started = time.monotonic()
        while time.monotonic() - started < seconds:
            for viewer in viewers:
                if viewer.connected.is_set():
                    x, y, z = viewer.view.eye
                    try:
                        await viewer.look((x + 0.01, y, z))
                    except (OSError, websockets.WebSocketException, asyncio.CancelledError):
                        continue  # it is being disconnected
            await asyncio.sleep(0.1)

    async def assert_view_restored(self, viewer):
        """Scene, camera and settings are the viewer's own, on whichever node it is."""
        view = viewer.view
        self.assertEqual((await viewer.call("scene.list"))["current"], view.scene)
        camera = await viewer.call("camera.get")
        for name, value in (("eye", view.eye), ("target", view.target)):
            for a, b in zip(camera[name], value):
                self.assertAlmostEqual(a, b, places=4)
        settings = (await viewer.call("settings.get"))["settings"]
        self.assertEqual(settings["exposure"]["compensation"],
                         view.settings["exposure"]["compensation"])

    async def test_viewers_spread_and_reconnect_to_their_node(self):
        viewers = await self.viewers(3)
        nodes = await self.nodes_of(viewers)
        self.assertEqual(len(set(nodes)), 3, nodes)
        for viewer in viewers:
            await viewer.drop()
            await viewer.whole()
        self.assertEqual(await self.nodes_of(viewers), nodes)
        # Ordinary requests with the cookie go there too.
        for viewer in viewers:
            status, headers, _ = await asyncio.to_thread(
                self.fleet.ask, "api/v1/schema", headers={"Cookie": viewer.node})
            self.assertEqual(status, 200)
            self.assertNotIn("Set-Cookie", headers)

    async def test_viewers_of_a_named_session_share_a_node(self):
        """Without a cookie only the name decides."""
        for name in ("one", "two", "three", "four"):
            served = {await self.served_by(f"?session={name}") for _ in range(4)}
            self.assertEqual(len(served), 1, name)

    async def test_a_path_with_a_session_is_routed_to_its_node(self):
        for name in ("one", "two", "three", "four"):
            node = await self.served_by(f"?session={name}")
            self.assertEqual(await self.served_by(f"api/v1/sessions/{name}/frame.jpg"), node, name)
        # A viewer's own session is on the viewer's node, whatever its name hashes to.
        for viewer in await self.viewers(3):
            status, headers, _ = await asyncio.to_thread(
                self.fleet.ask, f"api/v1/sessions/{viewer.session}/frame.jpg",
                headers={"Cookie": f"other=1; {viewer.node}"})
            self.assertEqual(status, 200)
            node = await asyncio.to_thread(self.fleet.node_of, viewer)
            self.assertEqual(headers["X-Heliograph-Node"], self.fleet.address(node))
            # A viewer that opens a named session goes to its node, and stays there.
            _, headers, _ = await asyncio.to_thread(self.fleet.ask, "?session=one",
                                                    headers={"Cookie": viewer.node})
            self.assertEqual(headers["X-Heliograph-Node"], await self.served_by("?session=one"))
            given = headers["Set-Cookie"].split(";")[0]
            self.assertEqual(await self.served_by("api/v1/sessions/own/frame.jpg", Cookie=given),
                             headers["X-Heliograph-Node"])

    async def served_by(self, path, **headers):
        return (await asyncio.to_thread(self.fleet.ask, path, headers=headers))[1][
            "X-Heliograph-Node"]

    async def test_clients_cannot_forge_their_address(self):
        """Wrong tokens are limited by address. A forged address in the headers of each request
        does not circumvent that."""
        node = "api/v1/schema?session=guessed"
        self.assertIn(429, [await self.guess(node, f"198.51.100.{number}")
                            for number in range(100)])
        # Other clients are not locked out, as they would be if all had the balancer's address.
        self.assertEqual("200", await asyncio.to_thread(
            self.machine.inside, "curl", "--silent", "--output", "/dev/null", "--write-out",
            "%{http_code}", "--header", f"Authorization: Bearer {TOKEN}", self.fleet.url + node))

        async def forgiven():
            return (await asyncio.to_thread(self.fleet.ask, node))[0] == 200

        await self.eventually(forgiven, "the right token is never listened to again")
        await self.viewers(1)
        lines = await self.compose("logs", "--no-color", "--tail", "50", "heliograph")
        self.assertIn(f'"client":"{GATEWAY}"', lines.replace(": ", ":"))
        self.assertNotIn("198.51.100.", lines)

    async def guess(self, path, address):
        """A request with a wrong token and a claimed address."""
        status, _, _ = await asyncio.to_thread(
            self.fleet.ask, path, headers={"X-Forwarded-For": address, "X-Forwarded-Proto": "https"},
            token=f"wrong-token-of-{address}")
        return status

    async def test_an_outer_proxy_is_trusted_if_it_is_configured(self):
        await asyncio.to_thread(self.fleet.renew_balancer, HELIOGRAPH_OUTER_PROXIES=GATEWAY)
        self.addAsyncCleanup(asyncio.to_thread, self.fleet.renew_balancer,
                             HELIOGRAPH_OUTER_PROXIES="")
        node = "api/v1/schema?session=behind"
        # The last element, which the proxy appended, is the address.
        self.assertEqual({await self.guess(node, f"203.0.113.9, 198.51.100.{number}")
                          for number in range(100)}, {401})
        self.assertIn(429, [await self.guess(node, "198.51.100.7") for _ in range(100)])
        claimed = {"X-Forwarded-For": "198.51.100.8", "X-Forwarded-Proto": "https"}
        _, headers, _ = await asyncio.to_thread(
            self.fleet.ask, f"?session=behind&token={TOKEN}", headers=claimed)
        self.assertRegex(headers["Set-Cookie"], "heliograph_token=.*; Secure")
        # Other proxies are not trusted.
        seen = await asyncio.to_thread(
            self.machine.inside, "curl", "--silent", "--output", "/dev/null", "--dump-header", "-",
            *(word for name, value in claimed.items() for word in ("--header", f"{name}: {value}")),
            f"{self.fleet.url}?session=behind&token={TOKEN}")
        self.assertIn("heliograph_token=", seen)
        self.assertNotRegex(seen, "heliograph_token=.*; Secure")

    async def test_the_balancer_terminates_tls_and_informs_nodes(self):
        path = f"?token={TOKEN}"
        for ask, secure in ((self.fleet.ask_securely, True), (self.fleet.ask, False)):
            _, headers, _ = await asyncio.to_thread(
                ask, path, headers={"X-Forwarded-Proto": "http" if secure else "https"})
            cookies = [line for line in headers["Set-Cookie"].splitlines()
                       if line.startswith("heliograph_token=")]
            self.assertEqual(len(cookies), 1, headers)
            self.assertEqual("; Secure" in cookies[0], secure, cookies)

    async def test_a_new_certificate_disconnects_no_viewer(self):
        viewer, = await self.viewers(1)
        await asyncio.to_thread(self.fleet.renew_certificate)
        await self.compose("exec", "-T", "balancer", "sh", "-c", "kill -HUP 1")

        async def is_used():
            try:
                return (await asyncio.to_thread(self.fleet.ask_securely, "health/live"))[0] == 200
            except OSError:
                return False  # the old certificate, which the new authority has not signed

        await self.eventually(is_used, "the balancer keeps its certificate")
        await viewer.look((1.0, 2.0, 8.0))
        await viewer.wait_frames(1)
        self.assertEqual(viewer.losses, [])
        await self.assert_restarted_when_it_dies(viewer)

    async def assert_restarted_when_it_dies(self, viewer):
        """Engines do not restart a container that was stopped by a command."""
        name = await asyncio.to_thread(self.fleet.balancer)
        first = await asyncio.to_thread(self.machine.inspect, name, "{{.State.Pid}}")
        os.kill(first, signal.SIGKILL)

        async def is_back():
            state = await asyncio.to_thread(self.machine.inspect, name, "{{json .State}}")
            return viewer.losses and state["Running"] and state["Pid"] not in (0, first)

        await self.eventually(is_back, "the balancer that died is not restarted")
        await viewer.whole()

    async def test_viewers_of_a_killed_node_reconnect_and_others_are_not_affected(self):
        viewers = await self.viewers(3)
        nodes = await self.nodes_of(viewers)
        victim, others = viewers[0], viewers[1:]
        before = await self.at_rest(victim)
        self.assertGreater(before.deviation(), 5, "nothing to be seen")
        for viewer in viewers:
            viewer.forget_gaps()
        await self.move(others, 6)
        quiet = [viewer.longest_gap for viewer in others]
        for viewer in viewers:
            viewer.forget_gaps()
        await self.docker("kill", nodes[0])
        await asyncio.gather(self.move(others, 6), victim.whole())
        loss, = victim.losses
        print(f"fleet: killed node, viewer restored after {loss.seconds:.2f} s", flush=True)
        self.assertLess(loss.seconds, MOST_SECONDS_AWAY)
        await self.assert_view_restored(victim)
        self.assertNotEqual((await self.nodes_of([victim]))[0], nodes[0])
        after = await self.at_rest(victim)
        self.assertLess(difference(before, after), 3.0)
        for viewer, before in zip(others, quiet):
            self.assertEqual(viewer.losses, [])
            print(f"fleet: longest gap of another viewer {viewer.longest_gap:.2f} s, {before:.2f} "
                  "before", flush=True)
            self.assertLess(viewer.longest_gap, before + MOST_SECONDS_OF_NOTICE)

    async def test_a_hanging_node_is_disconnected(self):
        """Its connections stay open without data: only the balancer can detect it."""
        viewers = await self.viewers(3)
        nodes = await self.nodes_of(viewers)
        started = time.monotonic()
        await self.docker("pause", nodes[0])
        try:
            deadline = started + 20
            while not viewers[0].losses and time.monotonic() < deadline:
                await asyncio.sleep(0.05)
            noticed = viewers[0].losses[0].at - started
            await viewers[0].whole()
            away = viewers[0].losses[0].back_at - started
            print(f"fleet: hung node, disconnected after {noticed:.2f} s, "
                  f"viewer restored after {away:.2f} s", flush=True)
            self.assertLess(away, 2 * MOST_SECONDS_AWAY)
            await self.assert_view_restored(viewers[0])
            self.assertEqual([viewer.losses for viewer in viewers[1:]], [[], []])
        finally:
            await self.docker("unpause", nodes[0])

    async def test_a_rolling_update_fails_no_request(self):
        """New nodes start before old ones stop, under continuous requests and new viewers."""
        viewers = await self.viewers(2)
        old = await self.nodes_of(viewers)
        answers, calls, greetings = [], [], []
        stop = asyncio.Event()

        async def request():
            while not stop.is_set():
                try:
                    status, _, body = await asyncio.to_thread(
                        self.fleet.ask, "api/v1/sessions/main/frame.jpg?samples=1", timeout=30)
                    answers.append(status if status == 200 else (status, body[:80]))
                except OSError as failure:
                    answers.append(repr(failure))
                await asyncio.sleep(0.1)

        async def change():
            """A call that must not be executed twice. It is retried only if it was not executed. A
            node that has just started can execute it too: it needs no scene."""
            patch = {"patch": view_states(1)[0].settings}
            while not stop.is_set():
                try:
                    await asyncio.to_thread(call, self.fleet.url, "settings.patch", patch, timeout=30)
                    calls.append(None)
                except (OSError, ValueError, AssertionError) as failure:
                    calls.append(repr(failure))
                await asyncio.sleep(0.05)

        async def greet():
            while not stop.is_set():
                greetings.append(await greeting(self.fleet.url))
                await asyncio.sleep(0.2)

        load = [asyncio.create_task(work()) for work in (request, change, greet)]
        for node in old:
            await self.scale(NODES + 1)
            await self.docker("stop", "--time", "20", node)
            await self.docker("rm", node)
            await asyncio.sleep(1)
        stop.set()
        await asyncio.gather(*load)
        # The balancer logs the requests that it could not serve.
        lines = (await self.compose("logs", "--no-color", "balancer")).splitlines()
        refused = "\n".join(line for line in lines if "HTTP/1" in line)
        print(f"fleet: rolling update, {len(answers)} requests, {len(calls)} calls and "
              f"{len(greetings)} new viewers", flush=True)
        self.assertEqual([answer for answer in answers if answer != 200], [], refused)
        self.assertEqual([failed for failed in calls + greetings if failed], [], refused)
        for viewer in viewers:
            await viewer.whole()
            self.assertTrue(viewer.losses, "its node was replaced")
            self.assertEqual({loss.code for loss in viewer.losses}, {1001})
            print("fleet: rolling update, viewer away for "
                  f"{[round(loss.seconds, 2) for loss in viewer.losses]} s", flush=True)
            await self.assert_view_restored(viewer)

    async def query(self, expression):
        """The current result of a query: a list of series."""
        words = urllib.parse.urlencode({"query": expression})
        body = await asyncio.to_thread(self.machine.inside, "curl", "--silent", "--fail",
                                       f"http://127.0.0.1:9090/api/v1/query?{words}")
        return json.loads(body)["data"]["result"]

    async def eventually(self, condition, what, timeout=90):
        deadline = time.monotonic() + timeout
        while True:
            try:
                if await condition():
                    return
            except RuntimeError:
                pass  # Prometheus is still starting
            self.assertLess(time.monotonic(), deadline, what)
            await asyncio.sleep(1)

    async def test_prometheus_has_data_for_every_panel(self):
        """The provisioned configuration in Debian's Prometheus, while cameras move: it scrapes
        every node, every panel has data and every alert can be evaluated."""
        await self.compose("up", "--detach", "--no-build", "prometheus")

        async def every_node():
            rows = await self.query("heliograph_ready")
            return [row["value"][1] for row in rows] == ["1"] * NODES

        await self.eventually(every_node, "Prometheus does not see every node")
        viewers = await self.viewers(2)
        looking = asyncio.create_task(self.move(viewers, 3600))
        try:
            for title, expression in panels():
                async def has_numbers(expression=expression):
                    rows = await self.query(expression)
                    return any(math.isfinite(float(row["value"][1])) for row in rows)

                await self.eventually(has_numbers, f"{title}: no numbers for {expression}")
        finally:
            looking.cancel()
            await asyncio.gather(looking, return_exceptions=True)
        print(f"fleet: {len(list(panels()))} expressions of the dashboard have numbers", flush=True)
        found = []

        async def judged():
            found[:] = await self.rules()
            return len(found) > 4 and all(rule["health"] != "unknown" for rule in found)

        await self.eventually(judged, "the alerts are not judged")
        self.assertEqual([(rule["name"], rule["health"], rule.get("lastError", ""))
                          for rule in found if rule["health"] != "ok"], [])

    async def rules(self):
        answer = json.loads(await asyncio.to_thread(
            self.machine.inside, "curl", "--silent", "http://127.0.0.1:9090/api/v1/rules"))
        return [rule for group in answer["data"]["groups"] for rule in group["rules"]]

    async def test_alerts_fire_when_they_should(self):
        """With promtool of Debian's Prometheus."""
        folder = os.path.join(self.site.folder, "alerts")
        shutil.copytree(os.path.join(DEPLOY, "prometheus"), folder)
        shutil.copy(os.path.join(os.path.dirname(__file__), "prometheus/alerts_test.yml"), folder)
        said = await self.docker("run", "--rm", "--network", "none",
                                 "--volume", f"{folder}:/alerts:ro", "--workdir", "/alerts",
                                 "--entrypoint", "promtool", images.PROMETHEUS, "test", "rules",
                                 "alerts_test.yml")
        self.assertIn("SUCCESS", said)


def panels():
    """Title and expression of every panel of the dashboard."""
    with open(os.path.join(DEPLOY, "grafana/dashboards/heliograph.json"), encoding="utf-8") as file:
        for panel in json.load(file)["panels"]:
            for target in panel["targets"]:
                yield panel["title"], target["expr"]


async def greeting(url):
    """One viewer that connects, calls hello and disconnects. Returns None or the failure."""
    viewer = ReplayingViewer(url, TOKEN, ViewState(NAMES[0]))
    try:
        return await viewer.greet_once()
    except Exception as failure:  # every failure is reported
        return repr(failure)


if __name__ == "__main__":
    unittest.main()
