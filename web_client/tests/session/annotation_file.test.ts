import assert from "node:assert/strict";
import test from "node:test";
import type { Annotation, AnnotationsAddParams } from "heliograph/messages.ts";
import { RpcError, type RpcPeer } from "heliograph/rpc.ts";
import { Signal } from "../../src/common/signal.ts";
import {
  describeImport,
  readAnnotations,
  writeAnnotations,
} from "../../src/session/marks/annotation_file.ts";
import { Annotations } from "../../src/session/marks/annotations.ts";
import type { MarksHost } from "../../src/session/marks/mark_store.ts";

function annotation(id: number, text = `text ${id}`, node = 4): Annotation {
  const surface = { node, triangle: 12, barycentrics: [0.25, 0.25, 0.5] as [number, number, number] };
  return { id, text, author: "Ada", surface, position: [0, 0, 0], normal: [0, 0, 1] };
}

const read = (text: string) =>
  readAnnotations({ name: "a.json", size: text.length, text: async () => text });

test("what is saved can be read", async () => {
  const saved = writeAnnotations("atrium", [annotation(1), annotation(7)]);
  const { scene, entries } = await read(await saved.text());
  assert.equal(scene, "atrium");
  const { text, author, surface } = annotation(7);
  assert.deepEqual(entries[1], { text, author, surface });
});

test("mistakes name the entry and its member", async () => {
  const { surface } = annotation(1);
  const entry = (change: object): string =>
    JSON.stringify({ annotations: [annotation(1), { ...annotation(2), ...change }] });
  const cases: [string, RegExp][] = [
    ["{", /^a\.json is no JSON document$/],
    ["[]", /no list "annotations"/],
    ['{"annotations": []}', /contains no annotations/],
    ['{"annotations": [7]}', /annotation 1: is not an object/],
    [entry({ text: "" }), /annotation 2: text must/],
    [entry({ text: "ä".repeat(1001) }), /annotation 2: text is longer than 2000 bytes/],
    [entry({ author: 3 }), /annotation 2: author must/],
    [entry({ author: "x".repeat(65) }), /annotation 2: author is longer/],
    [entry({ surface: undefined }), /annotation 2: surface is missing/],
    [entry({ surface: { ...surface, node: -1 } }), /annotation 2: surface\.node must/],
    [entry({ surface: { ...surface, triangle: 0.5 } }), /annotation 2: surface\.triangle must/],
    [entry({ surface: { ...surface, barycentrics: [0, 2, 0] } }), /2: surface\.barycentrics must/],
    [entry({ surface: { ...surface, barycentrics: [0, 1] } }), /2: surface\.barycentrics must/],
  ];
  for (const [text, expected] of cases) await assert.rejects(read(text), { message: expected });
  const large = { name: "b.json", size: 5e6, text: async () => "" };
  await assert.rejects(readAnnotations(large), { message: "b.json is larger than 4 MB" });
});

/** A session that refuses what is on another node than 4. */
function session(known: Annotation[]) {
  let list = known;
  let lastId = 10;
  const calls: string[] = [];
  const steps: { label: string; undo(): void; redo(): void }[] = [];
  const request = async (method: string, params: AnnotationsAddParams & { id?: number }) => {
    calls.push(method);
    if (method === "annotations.add" && params.surface.node !== 4) {
      throw new RpcError(-32602, "surface.node: is no node with a mesh");
    }
    if (method === "annotations.add") {
      list = [...list, { ...annotation(params.id ?? (lastId += 1)), ...params } as Annotation];
    } else if (method === "annotations.remove") list = list.filter(({ id }) => id !== params.id);
    return { scene: "atrium", annotations: list, changes: 1 };
  };
  const annotations = new Annotations({
    rpc: { request } as unknown as RpcPeer,
    capabilities: { methods: new Signal<ReadonlySet<string>>(new Set()), has: () => true },
    scene: new Signal(null),
    animation: new Signal(null),
    history: { add: (step) => steps.push(step) },
    isRestoring: () => false,
    attempt: async (action) => void (await action()),
  } as MarksHost);
  annotations.take({ scene: "atrium", annotations: known, changes: 0 });
  return { annotations, steps, calls };
}

const requestOf = ({ text, author, surface }: Annotation): AnnotationsAddParams => ({
  text,
  author,
  surface,
});

test("an import is one step; known entries stay, and refused ones are told by number", async () => {
  const { annotations, steps } = session([annotation(1)]);
  const entries = [annotation(1), annotation(2), annotation(3, "elsewhere", 9), annotation(4)];
  const result = await annotations.import(entries.map(requestOf));
  assert.deepEqual(result, {
    added: 2,
    known: 1,
    refused: [{ entry: 3, reason: "surface.node: is no node with a mesh" }],
  });
  const ids = (): number[] => annotations.list.value.map(({ id }) => id);
  assert.deepEqual(ids(), [1, 11, 12]);
  assert.deepEqual(steps.map(({ label }) => label), ["annotations imported"]);
  steps[0]?.undo();
  await new Promise((resolve) => setTimeout(resolve));
  assert.deepEqual(ids(), [1]);
  steps[0]?.redo();
  await new Promise((resolve) => setTimeout(resolve));
  assert.deepEqual(ids(), [1, 11, 12], "with their ids");
  assert.deepEqual((await annotations.import(entries.map(requestOf))).known, 3);
  assert.equal(steps.length, 1, "nothing was added");
});

test("one sentence tells what became of a file", () => {
  const scenes = { from: "atrium", shown: "atrium" };
  const all = { added: 2, known: 0, refused: [] };
  assert.equal(describeImport("a.json", all, scenes), "a.json: 2 annotations added");
  const refused = [1, 2, 3, 5, 6].map((entry) => ({ entry, reason: "no such node" }));
  assert.equal(
    describeImport("a.json", { added: 1, known: 1, refused }, { from: "atrium", shown: "mirror" }),
    "a.json: 1 annotation added; 1 was there already; not added: 1 (no such node), " +
      "2 (no such node), 3 (no such node), 2 more; " +
      "the file was saved in the scene atrium, not in mirror",
  );
});
