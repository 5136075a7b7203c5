import assert from "node:assert/strict";
import test from "node:test";
import type { SessionInfo, ViewerInfo } from "heliograph/messages.ts";
import { controlStateOf, describeControl } from "../src/session/control_state.ts";

function viewer(viewerId: string, name: string | null, control: boolean, you = false): ViewerInfo {
  return { viewer: viewerId, name, control, you };
}

function session(control: SessionInfo["control"], ...viewers: ViewerInfo[]): SessionInfo {
  const size = { width: 640, height: 360 };
  const idle = { idle_seconds: 0, device: 0 };
  return { name: "main", scene: null, viewers, control, rev: 1, ...idle, ...size };
}

test("a viewer with control may change the session, also without session info", () => {
  const alone = session("shared", viewer("v1", null, true, true));
  assert.equal(controlStateOf(alone, undefined).kind, "may_change");
  assert.equal(controlStateOf(null, "control").kind, "may_change");
  assert.equal(describeControl(controlStateOf(alone, undefined)), "");
});

test("viewers without control see the name or number of the one in control", () => {
  const me = viewer("v2", null, false, true);
  const named = controlStateOf(session("exclusive", viewer("v1", "Ada", true), me), "control");
  assert.match(describeControl(named), /^Ada is in control/);
  const nameless = controlStateOf(session("exclusive", viewer("v1", null, true), me), "control");
  assert.match(describeControl(nameless), /^Viewer 1 is in control/);
  assert.equal(controlStateOf(session("exclusive", me), "control").kind, "unclaimed");
});

test("a viewer is read-only by its role, or without control in shared mode", () => {
  const me = viewer("v1", null, false, true);
  assert.equal(controlStateOf(session("shared", me), undefined).kind, "read_only");
  assert.equal(controlStateOf(session("exclusive", me), "view").kind, "read_only");
});
