"""Methods and errors, over POST /rpc and over the WebSocket: both give the same results."""

import asyncio
import base64
import json

from harness.images import decode_png
from harness.server import ServerTestCase
from harness.viewer import Viewer


class Methods(ServerTestCase):
    async def test_hello_introduces_server_and_viewer(self):
        async with Viewer(self.server) as viewer:
            hello = viewer.hello
            self.assertEqual(hello["protocol"], "heliograph.v1")
            self.assertEqual((hello["session"], hello["role"]), ("main", "control"))
            self.assertEqual(hello["codecs"], ["jpeg"])
            self.assertEqual(hello["limits"]["ack_window"], 2)
            self.assertTrue(hello["device"]["name"])
            self.assertIn(hello["tracer"], ("embree", "software", "ray_query", "ray_pipeline"))
            async with Viewer(self.server) as other:
                self.assertNotEqual(other.hello["viewer"], hello["viewer"])

    async def test_hello_refuses_unsupported_clients(self):
        async with Viewer(self.server, greet=False) as viewer:
            answer = await viewer.ask("hello", {"session": "elsewhere"})
            self.assert_error(answer, -32004, path="session")
            answer = await viewer.ask("hello", {"codecs": ["av1"]})
            self.assert_error(answer, -32602, path="codecs", limit="jpeg")

    def test_every_declared_method_has_a_handler(self):
        document = self.server.call("rpc.discover")
        names = {method["name"] for method in document["methods"]}
        self.assertIn("frame.capture", names)
        for name in names - {"scene.load"}:
            answer = self.server.ask(name)
            self.assertNotEqual(answer.get("error", {}).get("code"), -32601, name)
            self.assertNotEqual(answer.get("error", {}).get("code"), -32603, name)

    def test_the_schema_is_served_over_http(self):
        status, headers, body = self.server.get("/api/v1/schema")
        self.assertEqual((status, headers["content-type"]), (200, "application/json"))
        document = json.loads(body)
        self.assertEqual(document["openrpc"], self.server.call("rpc.discover"))
        self.assertEqual(document["settings"], self.server.call("settings.schema"))

    def test_the_openrpc_document_has_an_address_of_its_own(self):
        status, headers, body = self.server.get("/openrpc.json")
        self.assertEqual((status, headers["content-type"]), (200, "application/json"))
        self.assertEqual(json.loads(body), self.server.call("rpc.discover"))

    def test_ignored_members_are_told_in_the_result(self):
        before = self.server.call("camera.get")
        answer = self.server.call("camera.orbit", {"yew": 3})
        self.assertEqual(answer["warnings"], ["yew: is not a parameter; did you mean yaw?"])
        for one, other in zip(answer["eye"], before["eye"]):
            self.assertAlmostEqual(one, other, places=4)
        answer = self.server.call("frame.capture", {"sampels": 3, "fromat": "exr", "samples": 1})
        self.assertEqual(len(answer["warnings"]), 2)
        self.assertEqual(answer["format"], "png")
        self.assertNotIn("warnings", self.server.call("camera.orbit", {"yaw": 3}))
        many = {f"member{i}": None for i in range(1000)}
        self.assertEqual(len(self.server.call("camera.get", many)["warnings"]), 8)
        self.assertNotIn("warnings", self.server.call("rpc.discover", {"yew": 3}))

    def test_scene_cameras_are_chosen_by_number_too(self):
        named = self.server.call("camera.set", {"name": "main"})
        numbered = self.server.call("camera.set", {"name": "1"})
        self.assertEqual({**numbered, "rev": 0}, {**named, "rev": 0})
        for name in ("0", "2", "1x"):
            self.assert_error(self.server.ask("camera.set", {"name": name}), -32004, path="name")

    def test_cameras_are_absolute_and_partial(self):
        before = self.server.call("camera.get")
        moved = self.server.call("camera.set", {"eye": [3, 2, 1]})
        self.assertEqual(moved["eye"], [3, 2, 1])
        self.assertEqual(moved["target"], before["target"])
        self.assertGreater(moved["rev"], before["rev"])
        self.assertEqual(self.server.call("camera.get"), moved)

    def test_a_focal_length_gives_the_field_of_view(self):
        camera = self.server.call("camera.set", {"focal_length": 12})
        self.assertAlmostEqual(camera["vertical_fov"], 90, places=3)
        self.server.call("settings.patch", {"patch": {"lens": {"sensor_height": 36}}})
        camera = self.server.call("camera.set", {"focal_length": 18})
        self.assertAlmostEqual(camera["vertical_fov"], 90, places=3)
        for params in ({"focal_length": 50, "vertical_fov": 30}, {"focal_length": 1}):
            self.assert_error(self.server.ask("camera.set", params), -32602, path="focal_length")
        self.assertEqual(self.server.call("camera.get"), camera)
        self.server.call("settings.patch", {"patch": {"lens": None}})

    def test_bad_cameras_are_refused_and_change_nothing(self):
        before = self.server.call("camera.get")
        for params, path in (({"eye": before["target"]}, "eye"),
                             ({"vertical_fov": 171}, "vertical_fov"),
                             ({"vertical_fov": 0}, "vertical_fov"),
                             ({"eye": [1, 2]}, "eye"),
                             ({"eye": [1e10, 0, 0]}, "eye[0]"),
                             ({"eye": ["a", 0, 0]}, "eye[0]"),
                             ({"up": [0, 0, 0]}, "up")):
            self.assert_error(self.server.ask("camera.set", params), -32602, path=path)
        self.assert_error(self.server.ask("camera.set", {"name": "nowhere"}), -32004, path="name")
        self.assertEqual(self.server.call("camera.get"), before)

    def test_settings_patches_are_atomic(self):
        answer = self.server.call("settings.patch", {"patch": {"exposure": {"compensation": 2}}})
        self.assertEqual(answer["applied"], {"exposure": {"compensation": 2}})
        before = self.server.call("settings.get")
        self.assertEqual(before["settings"]["exposure"]["compensation"], 2)
        for patch, path, limit in (
                ({"exposure": {"compensation": 99}}, "exposure.compensation", "16"),
                ({"tone_map": {"curve": "pretty"}}, "tone_map.curve", "aces"),
                ({"tone_map": {"curve": "agx"}, "exposur": {}}, "exposur", ""),
                ({"exposure": {"compensation": 0}, "shadows": {"enabled": "no"}},
                 "shadows.enabled", ""),
                ({"view": {"buffer": "nothing"}}, "view.buffer", "frame.buffers")):
            answer = self.server.ask("settings.patch", {"patch": patch})
            self.assert_error(answer, -32602, path=path, limit=limit)
            self.assertEqual(self.server.call("settings.get"), before)
        reset = self.server.call("settings.patch", {"patch": {"exposure": None}})
        self.assertEqual(reset["applied"]["exposure"]["compensation"], 0)
        self.assertEqual(list(reset["applied"]), ["exposure"])

    async def test_changes_are_notified_to_other_viewers(self):
        async with Viewer(self.server) as causer, Viewer(self.server) as other:
            await causer.call("settings.patch", {"patch": {"exposure": {"compensation": 1}}})
            changed = await other.notification("settings.changed")
            self.assertEqual(changed["patch"], {"exposure": {"compensation": 1}})
            self.assertEqual(changed["by"], causer.hello["viewer"])
            await causer.call("camera.set", {"eye": [4, 4, 4]})
            moved = await other.notification("camera.changed")
            self.assertEqual(moved["camera"]["eye"], [4, 4, 4])
            heard = {message["method"] for message in causer.notifications}
            self.assertFalse(heard & {"settings.changed", "camera.changed"}, "an echo")

    def test_every_buffer_can_be_captured(self):
        self.server.call("stream.configure", {"width": 96, "height": 54})
        buffers = self.server.call("frame.buffers")["buffers"]
        self.assertEqual(buffers[0]["name"], "output")
        images = {}
        for buffer in buffers:
            self.assertTrue(buffer["description"])
            capture = self.server.call("frame.capture", {"buffer": buffer["name"], "samples": 1})
            image = decode_png(base64.b64decode(capture["data"], validate=True))
            half = buffer["name"].startswith("indirect.") and not buffer["name"].startswith(
                ("indirect.radiance", "indirect.upsampled"))
            self.assertEqual((image.width, image.height), (48, 27) if half else (96, 54), buffer)
            images[buffer["name"]] = image
        self.assertGreater(images["output"].deviation(), 5, "the image is nearly blank")
        self.assertGreater(len({image.rgb for image in images.values()}), 3)

    def test_a_capture_waits_for_its_samples(self):
        self.server.call("camera.set", {"eye": [3, 3, 3]})
        few = self.server.call("frame.capture", {"samples": 2})
        self.assertGreaterEqual(few["samples"], 2)
        self.server.call("camera.set", {"eye": [3, 3, 4]})
        self.assertEqual(self.server.call("frame.capture")["samples"], 4)
        self.assertEqual(self.server.call("frame.capture", {"samples": 1000})["samples"], 4)
        self.server.call("settings.patch", {"patch": {"accumulation": {"enabled": False}}})
        self.assertEqual(self.server.call("frame.capture", {"samples": 1000})["samples"], 1)

    async def test_pending_captures_are_limited_and_end_with_their_viewer(self):
        self.server.call("settings.patch", {"patch": {"accumulation": {"max_samples": 65536}}})
        endless = [{"jsonrpc": "2.0", "id": number, "method": "frame.capture",
                    "params": {"samples": 65536}} for number in range(32)]
        async with Viewer(self.server) as viewer:
            self.assertEqual(len(endless), viewer.hello["limits"]["max_pending"])
            self.assertEqual(len(endless), viewer.hello["limits"]["max_batch"])
            await viewer.send(json.dumps(endless))
            await viewer.call("camera.get")
            self.assert_error(await viewer.ask("frame.capture", {"samples": 1}), -32029,
                              limit="32")
            answer = await asyncio.to_thread(self.server.ask, "frame.capture", {"samples": 1})
            self.assert_error(answer, -32029, limit="32")

        def there_is_room():
            return "result" in self.server.ask("frame.capture", {"samples": 1})
        await asyncio.to_thread(self.server.wait_for, there_is_room, "room for another capture")

    def test_captures_of_unknown_buffers_are_refused(self):
        self.assert_error(self.server.ask("frame.capture", {"buffer": "outptu"}), -32602,
                          path="buffer")
        self.assert_error(self.server.ask("frame.capture", {"format": "bmp"}), -32602,
                          path="format")


class Calls(ServerTestCase):
    """JSON-RPC itself."""

    def test_unknown_methods_get_a_suggestion(self):
        answer = self.server.ask("camera.gte")
        self.assert_error(answer, -32601)
        self.assertIn("camera.get", answer["error"]["message"])

    def test_invalid_json_and_invalid_requests(self):
        for body in (b"{", b"", b"\xff\xfe", b"nonsense", b"{} {}"):
            self.assert_error(self.server.post_rpc(body)[1], -32700)
        for value in (1, "text", {}, {"jsonrpc": "1.0", "method": "camera.get", "id": 1},
                      {"jsonrpc": "2.0", "method": 5, "id": 1}, []):
            self.assert_error(self.server.post_rpc(value)[1], -32600)

    def test_wrong_parameters(self):
        self.assert_error(self.server.ask("scene.load"), -32602, path="name")
        answer = self.server.post_rpc(
            {"jsonrpc": "2.0", "id": 1, "method": "camera.get", "params": [1]})[1]
        self.assert_error(answer, -32602, path="params")

    def test_too_deep_and_too_large(self):
        deep = b"[" * 1000 + b"]" * 1000
        self.assert_error(self.server.post_rpc(deep)[1], -32013, limit="64")
        status, _, body = self.server.request("POST", "/rpc", b" " * 70000)
        self.assertEqual(status, 413, body)

    def test_batches_answer_in_order(self):
        batch = [{"jsonrpc": "2.0", "id": "a", "method": "camera.get"},
                 {"jsonrpc": "2.0", "method": "camera.fit"},
                 {"jsonrpc": "2.0", "id": 7, "method": "no.such"},
                 "nonsense",
                 {"jsonrpc": "2.0", "id": None, "method": "settings.get"}]
        status, answers = self.server.post_rpc(batch)
        self.assertEqual(status, 200)
        self.assertEqual([answer["id"] for answer in answers], ["a", 7, None, None])
        self.assert_error(answers[1], -32601)
        self.assert_error(answers[2], -32600)
        self.assertIn("settings", answers[3]["result"])
        call = {"jsonrpc": "2.0", "id": 1, "method": "camera.get"}
        self.assert_error(self.server.post_rpc([call] * 33)[1], -32013, limit="32")

    def test_notifications_get_no_answer(self):
        status, answer = self.server.post_rpc(
            {"jsonrpc": "2.0", "method": "camera.set", "params": {"eye": [1, 7, 1]}})
        self.assertEqual((status, answer), (204, None))
        self.assertEqual(self.server.call("camera.get")["eye"], [1, 7, 1])

    def test_stream_methods_require_a_websocket(self):
        for method, params in (("stream.ack", {"frame_seq": 1}),
                               ("stats.subscribe", {"interval_ms": 100}),
                               ("stream.configure", {"quality": 50})):
            self.assert_error(self.server.ask(method, params), -32050)

    async def test_the_websocket_gives_the_same_answers(self):
        async with Viewer(self.server) as viewer:
            for method, params in (("camera.get", {}), ("settings.get", {}), ("scene.info", {}),
                                   ("camera.gte", {}), ("camera.set", {"vertical_fov": 500})):
                over_http = self.server.ask(method, params)
                over_socket = await viewer.ask(method, params)
                for answer in (over_http, over_socket):
                    answer.pop("id")
                self.assertEqual(over_http, over_socket)
            await viewer.send("{")
            answer = await viewer.unasked.get()
            self.assert_error(answer, -32700)
            await viewer.call("camera.get")

    async def test_call_floods_are_throttled_without_disconnecting(self):
        async with Viewer(self.server) as viewer:
            # Fewer at a time than refusals end a connection: what was refused is heard before more.
            refused = []
            while not refused:
                for _ in range(500):
                    await viewer.notify("camera.set", {"vertical_fov": 45})
                answers = await asyncio.gather(*(viewer.ask("camera.get") for _ in range(20)))
                refused = [answer for answer in answers if "error" in answer]
            for answer in refused:
                self.assert_error(answer, -32002)
            self.assertTrue(viewer.unasked.empty(), "a notification was answered")
            await asyncio.sleep(1)
            await viewer.call("camera.get")
