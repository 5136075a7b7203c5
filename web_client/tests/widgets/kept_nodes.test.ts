import assert from "node:assert/strict";
import test, { before } from "node:test";
import { showNodes, updateEntries } from "../../src/widgets/kept_nodes.ts";
import { FakeNode, page } from "./fake_dom.ts";

before(() => void Object.assign(globalThis, { document: page }));

interface Entry {
  node: HTMLElement;
  bytes: number;
  update(item: { name: string; bytes: number }): void;
}

function listOf(names: string) {
  const parent = new FakeNode();
  const entries = new Map<string, Entry>();
  const show = (shown: string, bytes = 1): void => {
    const items = [...shown].map((name) => ({ name, bytes }));
    updateEntries(entries, items, () => {
      const node = new FakeNode();
      node.append(new FakeNode());
      const entry: Entry = {
        node: node as never,
        bytes: 0,
        update: (item) => void (entry.bytes = item.bytes),
      };
      return entry;
    });
    showNodes(parent as never, [...entries.values()].map((entry) => entry.node));
  };
  show(names);
  const node = (name: string) => entries.get(name)?.node as unknown as FakeNode;
  const shown = (): string =>
    parent.childNodes
      .map((child) => [...entries].find(([, entry]) => entry.node === (child as never))?.[0])
      .join("");
  return { entries, show, shown, node };
}

test("what stays in a list keeps its node, and shows how it is now", () => {
  const { entries, show, shown, node } = listOf("bdf");
  const nodes = [node("b"), node("f")];
  show("abcf", 2);
  assert.equal(shown(), "abcf");
  assert.deepEqual([node("b"), node("f")], nodes);
  assert.equal(entries.get("b")?.bytes, 2);
  assert.equal(entries.has("d"), false);
});

test("the focus stays where it is when others come, go, or are sorted in another way", () => {
  for (const next of ["abdf", "df", "fdb", "dbf", "bfd", "xdy", "d", "fbxd"]) {
    const { show, shown, node } = listOf("bdf");
    const focused = node("d").firstChild;
    page.activeElement = focused;
    show(next);
    assert.equal(shown(), next);
    assert.ok(page.activeElement === focused, `the focus in ${next}`);
  }
});

test("nothing is moved where only one is added or removed", () => {
  const { show, node } = listOf("abc");
  const moved: string[] = [];
  for (const name of "abc") {
    const kept = node(name);
    const remove = kept.remove.bind(kept);
    kept.remove = () => {
      moved.push(name);
      remove();
    };
  }
  show("abcd");
  show("xabcd");
  show("acd");
  assert.deepEqual(moved, ["b"]);
});
