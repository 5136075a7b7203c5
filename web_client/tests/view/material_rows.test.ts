import assert from "node:assert/strict";
import test from "node:test";
import type { MaterialInfo, MaterialPatch } from "heliograph/messages.ts";
import { RpcPeer } from "heliograph/rpc.ts";
import { Signal } from "../../src/common/signal.ts";
import { emissionOf, factors, isOffered, radianceOf } from "../../src/panel/scene/material_rows.ts";
import { UndoHistory } from "../../src/session/history/undo_history.ts";
import { checkedEdits, editsOf } from "../../src/session/scene_edits.ts";
import { SceneParts } from "../../src/session/scene_parts.ts";

/** Every factor that can be changed. */
const patch: Required<MaterialPatch> = {
  base_color: [1, 1, 1],
  roughness: 0.5,
  metallic: 0,
  emissive: [0, 0, 0],
  normal_scale: 1,
  occlusion_strength: 1,
  ior: 1.5,
  specular: 1,
  specular_color: [1, 1, 1],
  clearcoat: 0,
  clearcoat_roughness: 0,
  clearcoat_normal_scale: 1,
  sheen_color: [0, 0, 0],
  sheen_roughness: 0,
  iridescence: 0,
  iridescence_ior: 1.3,
  iridescence_thickness_minimum: 100,
  iridescence_thickness_maximum: 400,
  anisotropy: 0,
  anisotropy_rotation: 0,
  diffuse_transmission: 0,
  diffuse_transmission_color: [1, 1, 1],
  transmission: 1,
  thickness: 0,
  attenuation_distance: 0,
  attenuation_color: [1, 1, 1],
  dispersion: 0,
};

test("every factor of a material has one row", () => {
  const elsewhere = ["base_color", "roughness", "metallic", "emissive"];
  const shown = [...elsewhere, ...factors.map(({ member }) => member)];
  assert.deepEqual(shown.sort(), Object.keys(patch).sort());
});

test("a volume is offered where light passes, straight or scattered", () => {
  const volume = ["thickness", "attenuation_distance", "attenuation_color"];
  const offered = (change: Partial<MaterialInfo>): string[] => {
    const paper = { ...patch, transmission: undefined, name: "paper", textures: [], changed: [] };
    const material = { ...paper, ...change };
    return factors
      .filter((factor) => isOffered(factor, material as MaterialInfo))
      .map(({ member }) => member)
      .filter((member) => volume.includes(member));
  };
  assert.deepEqual(offered({}), []);
  assert.deepEqual(offered({ diffuse_transmission: 0.5 }), volume);
  assert.deepEqual(offered({ transmission: 0 }), volume);
});

test("emission is a colour and a strength, and a dark colour emits as much as a bright one", () => {
  assert.deepEqual(emissionOf([2, 1, 0]), { colour: [1, 0.5, 0], strength: 2 });
  assert.deepEqual(emissionOf([0, 0, 0]), { colour: [1, 1, 1], strength: 0 });
  assert.deepEqual(radianceOf([0.5, 0.25, 0], 4), [4, 2, 0]);
  assert.deepEqual(radianceOf([0, 0, 0], 4), [0, 0, 0]);
});

test("a link holds a material with all of its factors changed", () => {
  const material = { ...patch, name: "glass", changed: Object.keys(patch) };
  const edits = editsOf([material]) ?? {};
  assert.deepEqual(Object.keys(edits.glass ?? {}).sort(), Object.keys(patch).sort());
  assert.deepEqual(checkedEdits(edits), edits);
});

test("undo takes a clear coat back to the file's, redo puts it on again", async () => {
  const sent: unknown[] = [];
  const plain = { name: "paint", textures: [], changed: [] as string[], clearcoat: 0 };
  const rpc: RpcPeer = new RpcPeer(
    (text) => {
      const { id, method, params } = JSON.parse(text);
      const { clearcoat } = params.patch ?? {};
      if (method === "materials.patch") sent.push(params.patch);
      const material = {
        ...plain,
        clearcoat: clearcoat ?? 0,
        changed: clearcoat ? ["clearcoat"] : [],
      };
      const result = { lights: [], materials: [plain], material };
      setTimeout(() => rpc.receive(JSON.stringify({ jsonrpc: "2.0", id, result })), 0);
    },
    () => {},
  );
  rpc.open();
  const history = new UndoHistory();
  const host = {
    rpc,
    history,
    scene: new Signal({ name: "car" }),
    capabilities: { methods: new Signal([]), has: () => true },
    report: (error: unknown) => assert.fail(String(error)),
  };
  const parts = new SceneParts(host as unknown as ConstructorParameters<typeof SceneParts>[0]);
  const settled = (): Promise<void> => new Promise((resolve) => setTimeout(resolve, 20));
  await settled();
  parts.patchMaterial("paint", { clearcoat: 0.5 });
  await settled();
  assert.equal(await history.undo(), "clearcoat of paint");
  await settled();
  assert.equal(parts.materials.value[0]?.clearcoat, 0);
  history.redo();
  await settled();
  assert.deepEqual(sent, [{ clearcoat: 0.5 }, { clearcoat: null }, { clearcoat: 0.5 }]);
});
