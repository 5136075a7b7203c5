"""Compatibility of older clients with newer servers."""

from harness.raw_socket import RawSocket
from harness.server import ServerTestCase
from harness.viewer import Viewer


class Versions(ServerTestCase):
    def test_members_of_later_versions_are_ignored(self):
        plain = self.server.call("camera.get")
        for method, params in (("camera.get", {"frame_of_reference": "moon"}),
                               ("camera.set", {"lens": {"blades": 7}}),
                               ("frame.capture", {"samples": 1, "hdr_gain_map": True}),
                               ("hello", {"client": "later", "features": ["smell"]}),
                               ("lights.list", {"filter": "red"})):
            self.assertIn("result", self.server.ask(method, params), method)
        self.assertEqual(self.server.call("camera.get")["eye"], plain["eye"])

    def test_unknown_members_of_a_patch_are_refused(self):
        answer = self.server.ask("settings.patch", {"patch": {"smell": {"enabled": True}}})
        self.assert_error(answer, -32602, path="smell")

    def test_methods_of_later_versions_are_refused_by_name(self):
        answer = self.server.ask("camera.orbits")
        self.assert_error(answer, -32601)
        self.assertIn("camera.orbit", answer["error"]["message"])

    def test_members_of_the_call_itself_are_ignored(self):
        _, answer = self.server.post_rpc({"jsonrpc": "2.0", "id": 1, "method": "camera.get",
                                          "traceparent": "00-1-2-3"})
        self.assertIn("result", answer)

    def test_another_protocol_version_is_refused_with_a_message(self):
        for offered in ("heliograph.v2", "heliograph.v0, heliograph.v2"):
            with RawSocket(self.server) as raw:
                status, text = raw.upgrade(Sec_WebSocket_Protocol=offered)
            self.assertEqual(status, 400)
            self.assertIn("heliograph.v1", text)
        with RawSocket(self.server) as raw:
            status, text = raw.upgrade(Sec_WebSocket_Protocol="heliograph.v2, heliograph.v1")
        self.assertEqual(status, 101, "a client that speaks both is served in ours")

    async def test_the_frame_header_gives_the_offset_of_the_payload(self):
        async with Viewer(self.server) as viewer:
            frame = await viewer.frames.get()
            self.assertEqual(frame.header["version"], 1)
            self.assertGreaterEqual(frame.header["header_bytes"], 64)
            self.assertEqual(frame.payload[:2], b"\xff\xd8")
