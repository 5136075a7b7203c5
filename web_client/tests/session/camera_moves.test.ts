import assert from "node:assert/strict";
import test from "node:test";
import type { CameraPose } from "../../src/common/camera_pose.ts";
import { Signal } from "../../src/common/signal.ts";
import { CameraMoves } from "../../src/session/camera_moves.ts";

type Host = ConstructorParameters<typeof CameraMoves>[0];

function pose(scene_rev?: number): CameraPose {
  const camera: CameraPose = {
    eye: [0, 0, 5],
    target: [0, 0, 0],
    up: [0, 1, 0],
    vertical_fov: 45,
    name: null,
  };
  return scene_rev === undefined ? camera : { ...camera, scene_rev };
}

/** Camera movements of a page, and what they have led to. */
function moves() {
  const sent: unknown[] = [];
  let ended = 0;
  const host = {
    rpc: { notify: (_: string, params: { scene_rev?: number }) => sent.push(params.scene_rev) },
    camera: new Signal<CameraPose | null>(null),
    latency: { inputSent: () => {} },
    records: () => false,
    begins: () => {},
    moved: () => {},
    left: () => {},
  } as unknown as Host;
  const camera = new CameraMoves(host);
  camera.stop = () => void (ended += 1);
  return { camera, sent, ended: () => ended };
}

test("a movement says for which scene it is meant", () => {
  const { camera, sent } = moves();
  camera.moveTo(pose());
  camera.arrived(pose(4));
  camera.moveTo(pose());
  camera.moveTo(pose(2));
  assert.deepEqual(sent, [undefined, 4, 4], "poses of a history may be older than their scene");
});

test("a movement ends where another scene is seen, and only there", () => {
  const { camera, sent, ended } = moves();
  assert.equal(camera.arrived(pose(4)), false, "the first scene that the page shows");
  assert.equal(camera.arrived(pose(4)), false, "another viewer has moved its camera");
  assert.equal(ended(), 0);
  assert.equal(camera.arrived(pose(9)), true);
  assert.equal(ended(), 1);
  camera.moveTo(pose());
  assert.deepEqual(sent, [9]);
});

test("the scene of another session is no other scene", () => {
  const { camera, ended } = moves();
  camera.arrived(pose(4));
  camera.forgetScene();
  assert.equal(camera.arrived(pose(2)), false);
  assert.equal(ended(), 0);
});
