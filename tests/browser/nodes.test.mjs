// The tree of objects: selection by click and by keys, visibility, focus.

import assert from "node:assert/strict";
import { eventually, openTab, screenshot } from "./harness/browser.mjs";
import { Stage } from "./harness/stage.mjs";

const stage = new Stage({
  resolution: "half",
  view: { viewport: { width: 1000, height: 900 } },
  prepare: async (page) => {
    await openTab(page, "scene");
    await page.locator('[data-section="objects"] summary').click();
    await page.getByRole("treeitem").first().waitFor();
  },
});
const call = (...parameters) => stage.server.call(...parameters);
const selection = async () => (await call("selection.get")).nodes;
const hidden = async () =>
  (await call("nodes.list")).nodes.filter(({ visible }) => !visible).map(({ id }) => id);

stage.test("a click in the view selects an object, which the tree and its properties show", async (t) => {
  if (await stage.lacks(t, "nodes.list")) return;
  const { page } = await stage.sharedViewer();
  const point = { x: 0.3, y: 600 / 900 };
  const { node } = await call("scene.pick", point);
  await page.mouse.click(point.x * 1000, point.y * 900);
  await eventually(async () => String(await selection()) === String([node]), "the node selected");
  const { names, triangles } = await call("nodes.info", { nodes: [node] });
  const row = page.locator('[role=treeitem][aria-selected="true"]');
  assert.equal(await row.getAttribute("aria-label"), names[0] || `Node ${node}`);
  const shown = page.locator('[data-property="triangles"]');
  await eventually(
    async () => (await shown.textContent()) === triangles.toLocaleString("en"),
    "its triangles",
  );
  await screenshot(page, "selection");
  const before = await call("camera.get");
  await page.getByRole("button", { name: "Focus on the selection" }).click();
  await eventually(async () => (await call("camera.get")).rev > before.rev, "another camera");
});

stage.test("keys select, hide and show objects; undo takes it back", async (t) => {
  if (await stage.lacks(t, "nodes.list")) return;
  const { page } = await stage.sharedViewer();
  await page.getByRole("tree").focus();
  await page.keyboard.press("Home");
  await page.keyboard.press("Enter");
  const { id: first } = (await call("nodes.list", { count: 1 })).nodes[0];
  await eventually(async () => String(await selection()) === String([first]), "the first row");
  await page.keyboard.press("Shift+ArrowDown");
  await eventually(async () => (await selection()).length === 2, "two rows selected");
  await page.keyboard.press("Home");
  await page.keyboard.press("v");
  await eventually(async () => String(await hidden()) === String([first]), "the first node hidden");
  const row = page.getByRole("treeitem").first();
  await eventually(
    async () => (await row.getAttribute("aria-label")).endsWith(", hidden"),
    "its state in the tree",
  );
  await screenshot(page, "hidden_node");
  await page.keyboard.press("Control+z");
  await eventually(async () => (await hidden()).length === 0, "the node shown again");
  await page.getByRole("button", { name: "Show only the selection" }).click();
  await eventually(async () => (await call("nodes.list")).isolated.length === 2, "two isolated");
  await page.getByRole("button", { name: "Show everything" }).click();
  await eventually(async () => (await call("nodes.list")).isolated.length === 0, "all shown");
});

stage.test("another viewer's selection and a search change the rows", async (t) => {
  if (await stage.lacks(t, "nodes.list")) return;
  const { page } = await stage.sharedViewer();
  const { nodes } = await call("nodes.list");
  const named = nodes.find(({ name, meshes }) => name !== "" && meshes > 0);
  await call("selection.set", { nodes: [named.id] });
  const label = page.locator('[role=treeitem][aria-selected="true"]');
  await eventually(
    async () => (await label.count()) === 1 && (await label.getAttribute("aria-label")) === named.name,
    "the row that another client selected",
  );
  const { total } = await call("nodes.list", { search: named.name });
  await page.getByRole("searchbox", { name: "Search objects" }).fill(named.name);
  const rows = page.getByRole("treeitem", { name: named.name });
  await eventually(async () => (await rows.count()) >= Math.min(total, 5), "what was found");
  await page.getByRole("searchbox", { name: "Search objects" }).fill("");
});
