// Steps of the history whose undo the server refuses: none of them is told as done.

import assert from "node:assert/strict";
import test from "node:test";
import { Signal } from "../../src/common/signal.ts";
import { UndoHistory } from "../../src/session/history/undo_history.ts";
import { Annotations } from "../../src/session/marks/annotations.ts";
import { NodeStore } from "../../src/session/node_store.ts";
import { SceneParts } from "../../src/session/scene_parts.ts";

const answers: Record<string, unknown> = {
  "lights.list": { lights: [{ name: "sun", changed: [] }] },
  "lights.add": { light: { name: "bulb", changed: [] } },
  "lights.remove": { lights: [] },
  "materials.list": { materials: [] },
  "environment.list": { current: null, environments: [] },
  "environment.set": { current: "sky", environments: [], rev: 2 },
  "edits.get": { edits: { version: 1 } },
  "edits.apply": { edits: { version: 1 }, rev: 2 },
  "nodes.patch": { hidden: [3], isolated: [] },
  "nodes.isolate": { hidden: [], isolated: [3] },
  "annotations.add": { scene: "room", annotations: [{ id: 1, text: "a" }], changes: 1 },
  "annotations.edit": { scene: "room", annotations: [{ id: 1, text: "b" }], changes: 2 },
};

/** The parts of a page whose server takes everything until it is told to refuse. */
function page() {
  let refuses = false;
  const errors: string[] = [];
  const history = new UndoHistory();
  const report = (error: unknown): void => void errors.push((error as Error).message);
  const host = {
    rpc: {
      request: (method: string): Promise<unknown> => {
        const refused = refuses && !method.endsWith(".list");
        return refused ? Promise.reject(new Error(method)) : Promise.resolve(answers[method]);
      },
    },
    scene: new Signal({ name: "room" }),
    animation: new Signal(null),
    capabilities: { methods: new Signal(new Set<string>()), has: () => true },
    history,
    loading: { start: () => {}, takesEffect: () => {}, end: () => {} },
    shows: () => {},
    isRestoring: () => true,
    attempt: (action: () => Promise<unknown>) => action().catch(report),
    report,
  };
  return {
    parts: new SceneParts(host as never),
    nodes: new NodeStore(host as never),
    annotations: new Annotations(host as never),
    history,
    errors,
    refuse: () => (refuses = true),
  };
}

type Page = ReturnType<typeof page>;

const changes: [string, (page: Page) => unknown][] = [
  ["lights.remove", ({ parts }) => parts.addLight({ type: "point" } as never)],
  ["lights.add", ({ parts }) => parts.removeLight("sun")],
  ["edits.apply", ({ parts }) => parts.applyEdits({ version: 1 } as never)],
  ["environment.set", ({ parts }) => parts.chooseEnvironment("sky")],
  ["nodes.patch", ({ nodes }) => nodes.setVisible([3], false)],
  ["nodes.isolate", ({ nodes }) => nodes.isolate([3])],
  ["annotations.remove", ({ annotations }) => annotations.add({ text: "a" } as never)],
  ["annotations.edit", ({ annotations }) => annotations.edit({ id: 1, text: "a" } as never, "b")],
];

test("undo that the server refuses is told as an error, and is the next step again", async () => {
  for (const [method, change] of changes) {
    const one = page();
    await new Promise((resolve) => setTimeout(resolve));
    await change(one);
    await new Promise((resolve) => setTimeout(resolve));
    const { undo } = one.history.next.value;
    assert.ok(undo, method);
    one.refuse();
    assert.equal(await one.history.undo(), null, method);
    assert.deepEqual(one.errors, [method]);
    assert.deepEqual(one.history.next.value, { undo, redo: null }, method);
  }
});
