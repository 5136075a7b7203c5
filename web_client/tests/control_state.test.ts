import assert from "node:assert/strict";
import test from "node:test";
import type { SessionInfo, ViewerInfo } from "heliograph/messages.ts";
import { explained, controlStateOf } from "../src/session/control_state.ts";

function viewer(viewerId: string, name: string | null, control: boolean, you = false): ViewerInfo {
  return { viewer: viewerId, name, control, you };
}

function session(control: "everyone" | "one", ...viewers: ViewerInfo[]): SessionInfo {
  return { name: "main", scene: null, viewers, control, rev: 1, idle_seconds: 0 };
}

test("whoever has control may change things, with or without a session to tell of it", () => {
  const alone = session("everyone", viewer("v1", null, true, true));
  assert.equal(controlStateOf(alone, undefined).kind, "may_change");
  assert.equal(controlStateOf(null, "control").kind, "may_change");
  assert.equal(explained(controlStateOf(alone, undefined)), "");
});

test("others are told who has control, by name or by number", () => {
  const me = viewer("v2", null, false, true);
  const named = controlStateOf(session("one", viewer("v1", "Ada", true), me), "control");
  assert.match(explained(named), /^Ada is in control/);
  const nameless = controlStateOf(session("one", viewer("v1", null, true), me), "control");
  assert.match(explained(nameless), /^Viewer 1 is in control/);
  assert.equal(controlStateOf(session("one", me), "control").kind, "nobody");
});

test("who may only watch is told so, by the greeting or by having no control among everyone", () => {
  const me = viewer("v1", null, false, true);
  assert.equal(controlStateOf(session("everyone", me), undefined).kind, "watching");
  assert.equal(controlStateOf(session("one", me), "view").kind, "watching");
});
