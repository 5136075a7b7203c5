import assert from "node:assert/strict";
import test, { before } from "node:test";
import { confirmButton } from "../../src/widgets/confirm_button.ts";
import { type FakeNode, page } from "./fake_dom.ts";

before(() => void Object.assign(globalThis, { document: page }));

function create() {
  let acted = 0;
  const node = confirmButton("Delete box", "close", () => (acted += 1)) as unknown as FakeNode;
  return { node, label: () => node.attributes.get("aria-label"), acted: () => acted };
}

test("a second click confirms, and leaving the button takes the question back", () => {
  const { node, label, acted } = create();
  node.dispatch("click", 1);
  assert.equal(label(), "Confirm: delete box");
  node.dispatch("blur");
  assert.equal(label(), "Delete box");
  node.dispatch("click", 1);
  assert.equal(acted(), 0);
  node.dispatch("click", 1);
  assert.equal(acted(), 1);
  assert.equal(label(), "Delete box");
});

test("the second click of a double click asks on, a key confirms", () => {
  const { node, label, acted } = create();
  node.dispatch("click", 1);
  for (const count of [2, 3]) node.dispatch("click", count);
  assert.equal(label(), "Confirm: delete box");
  assert.equal(acted(), 0);
  node.dispatch("click", 0);
  assert.equal(acted(), 1);
});
