// The tree of objects: selection by click and by keys, visibility, focus. Measuring and annotating:
// with the pointer and with keys, over the view and in lists.

import assert from "node:assert/strict";
import { eventually, openTab, screenshot } from "../harness/browser.mjs";
import { downloaded } from "../harness/downloads.mjs";
import { Stage } from "../harness/stage.mjs";

let start; // the camera that the scene begins with
const stage = new Stage({
  resolution: "half",
  view: { viewport: { width: 1000, height: 900 } },
  prepare: async (page) => {
    const { eye, target, up, vertical_fov } = await call("camera.get");
    start = { eye, target, up, vertical_fov };
    await openTab(page, "scene");
    await page.locator('[data-section="objects"] summary').click();
    await page.getByRole("treeitem").first().waitFor();
  },
});
const call = (...parameters) => stage.server.call(...parameters);
const selection = async () => (await call("selection.get")).nodes;
const hidden = async () =>
  (await call("nodes.list")).nodes.filter(({ visible }) => !visible).map(({ id }) => id);
const measured = async () => (await call("measurements.list")).measurements;
const clickAt = (page, x, y) => page.mouse.click(x * 1000, y * 900);

stage.test("a click in the view selects an object, which the tree and its properties show", async () => {
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

stage.test("keys select, hide and show objects; undo takes it back", async () => {
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

stage.test("another viewer's selection and a search change the rows", async () => {
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

stage.test("two clicks measure a distance between exact points, which undo removes", async () => {
  const { page } = await stage.sharedViewer();
  await openTab(page, "inspect");
  await call("camera.set", start);
  await page.getByRole("button", { name: "Distance", exact: true }).click();
  await clickAt(page, 0.3, 0.85);
  await eventually(
    async () => (await page.locator(".measure [role=status]").textContent()).includes("second"),
    "the first point placed",
  );
  await page.mouse.move(500, 740);
  await page.locator("#marks .marker").first().waitFor({ state: "attached" });
  await screenshot(page, "measuring");
  await clickAt(page, 0.5, 0.83);
  const [one] = await eventually(async () => (await measured()).length === 1 && measured(), "one");
  const points = one.points.map(({ position }) => position);
  assert.ok(Math.abs(Math.hypot(...points[0].map((v, i) => v - points[1][i])) - one.value) < 1e-5);
  assert.ok(one.points.every(({ surface }) => surface), "the points lie on surfaces");
  const label = page.locator(".measure-label");
  await eventually(async () => (await label.textContent()) === one.text, "its label");
  assert.equal(await page.locator(".measurement-value").textContent(), one.text);

  // The label is where the middle of the line is, also after the camera has moved.
  await call("camera.orbit", { yaw: 20 });
  const { eye, target, up, vertical_fov } = await call("camera.get");
  const middle = points[0].map((v, i) => (v + points[1][i]) / 2);
  const expected = project({ eye, target, up, vertical_fov }, middle, 1000, 900);
  await eventually(async () => {
    const box = await label.boundingBox(); // null while it is drawn again
    if (!box) return false;
    const { x, y, width, height } = box;
    return Math.hypot(x + width / 2 - expected[0], y + height / 2 - expected[1]) < 3;
  }, "the label at the projected middle");
  await page.keyboard.press("Escape");
  await page.keyboard.press("Control+z");
  await eventually(async () => (await measured()).length === 0, "the measurement undone");
  await page.keyboard.press("Control+Shift+z");
  await eventually(async () => (await measured())[0]?.id === one.id, "the measurement again");
});

stage.test("keys alone measure, and another client's unit and size are shown", async () => {
  const { page } = await stage.sharedViewer();
  await openTab(page, "inspect");
  await call("measurements.clear");
  await page.locator("#view").focus();
  await page.keyboard.press("m");
  await page.keyboard.press("p");
  await eventually(
    async () => (await page.locator(".measure [role=status]").textContent()).includes("second"),
    "the point in the middle",
  );
  await call("camera.orbit", { yaw: 15, pitch: 5 });
  await page.keyboard.press("p");
  await eventually(async () => (await measured()).length === 1, "the distance");
  await page.keyboard.press("Escape");
  const { nodes } = await call("nodes.list");
  const solid = nodes.find(({ meshes }) => meshes > 0);
  await call("measurements.add", { kind: "size", nodes: [solid.id] });
  const { measurements } = await call("measurements.unit", { unit: "cm" });
  const texts = measurements.map(({ text }) => text);
  const shown = page.locator(".measurement-value");
  await eventually(async () => String(await shown.allTextContents()) === String(texts), "the list");
  assert.ok(texts[1].endsWith(" cm"));
  await screenshot(page, "measurements");
  await page.emulateMedia({ colorScheme: "light" });
  await screenshot(page, "measurements_light");
  await page.emulateMedia({ colorScheme: "dark" });
  await page.getByRole("button", { name: `Remove size ${texts[1]}` }).press("Enter");
  await eventually(async () => (await measured()).length === 1, "the size removed");
});

stage.test("an annotation is written, shared, and faint behind a surface", async () => {
  const { page } = await stage.sharedViewer();
  await openTab(page, "inspect");
  await call("measurements.clear");
  await call("camera.fit");
  await page.locator("#view").focus();
  await page.keyboard.press("n");
  await page.keyboard.press("p");
  const entry = page.getByRole("textbox", { name: "Text of the annotation" });
  await eventually(() => entry.evaluate((node) => node === document.activeElement), "its field");
  await page.keyboard.type("Scratched here");
  await page.keyboard.press("Control+Enter");
  const listed = async () => (await call("annotations.list")).annotations;
  const [one] = await eventually(async () => (await listed()).length === 1 && listed(), "it");
  assert.equal(one.text, "Scratched here");
  const label = page.locator(".note-label");
  await eventually(async () => (await label.textContent()).includes(one.text), "its label");
  await screenshot(page, "annotation");
  await call("annotations.edit", { id: one.id, text: "Dented here" });
  await eventually(async () => (await label.textContent()).includes("Dented"), "another text");

  const camera = await call("camera.get");
  const eye = camera.target.map((at, i) => (i === 1 ? camera.eye[1] : 2 * at - camera.eye[i]));
  await call("camera.set", { eye });
  const { hidden } = await call("annotations.hidden");
  const faint = page.locator(".note-label.hidden-mark");
  await eventually(async () => (await faint.count()) === hidden.length, "as the server sees it");
  await page.emulateMedia({ colorScheme: "light" });
  await screenshot(page, "annotation_light");
  await page.emulateMedia({ colorScheme: "dark" });
  const saved = await downloaded(page, () =>
    page.getByRole("button", { name: "Save as JSON" }).click(),
  );
  assert.equal(saved.name, "annotations.json");
  await page.getByRole("button", { name: "Remove Dented here" }).click();
  await eventually(async () => (await listed()).length === 0, "it removed");
  await page.locator("#view").focus();
  await page.keyboard.press("Control+z");
  await eventually(async () => (await listed())[0]?.id === one.id, "it again");

  // The saved file brings it back, once; what is wrong with another file is told.
  const choose = (file) => page.locator("input[name=annotations_file]").setInputFiles(file);
  const told = (text) => page.locator(".toast", { hasText: text }).waitFor();
  await choose(saved.path);
  await told("0 annotations added; 1 was there already");
  await call("annotations.clear");
  await choose(saved.path);
  await told("annotations.json: 1 annotation added");
  const [back] = await listed();
  assert.deepEqual([back.text, back.author, back.surface], ["Dented here", one.author, one.surface]);
  await page.locator("#view").focus();
  await page.keyboard.press("Control+z");
  await eventually(async () => (await listed()).length === 0, "the import undone");
  const refused = { text: "Here", surface: { ...one.surface, triangle: 1e8 } };
  const file = (name, content) => ({
    name,
    mimeType: "application/json",
    buffer: Buffer.from(JSON.stringify(content)),
  });
  await choose(file("other.json", { scene: "elsewhere", annotations: [refused] }));
  await told("the file was saved in the scene elsewhere");
  await told("not added: 1 (");
  await choose(file("wrong.json", { annotations: [{ ...refused, text: 3 }] }));
  await told("wrong.json: annotation 1: text must be a text");

  // Dropped on the page.
  const transfer = await page.evaluateHandle((text) => {
    const transferred = new DataTransfer();
    transferred.items.add(new File([text], "dropped.json", { type: "application/json" }));
    return transferred;
  }, JSON.stringify({ annotations: [{ text: "Dropped", surface: one.surface }] }));
  await page.dispatchEvent("body", "dragenter", { dataTransfer: transfer });
  await page.getByText("Drop annotations (.json) to add them").waitFor();
  await page.dispatchEvent("body", "drop", { dataTransfer: transfer });
  await eventually(async () => (await listed())[0]?.text === "Dropped", "the dropped annotation");
  await call("annotations.clear");
});

/** CSS pixels of a point in a view that shows all of the frame's height. */
function project({ eye, target, up, vertical_fov }, point, width, height) {
  const subtract = (a, b) => a.map((v, i) => v - b[i]);
  const dot = (a, b) => a.reduce((sum, v, i) => sum + v * b[i], 0);
  const cross = (a, b) => [
    a[1] * b[2] - a[2] * b[1],
    a[2] * b[0] - a[0] * b[2],
    a[0] * b[1] - a[1] * b[0],
  ];
  const unit = (a) => a.map((v) => v / Math.hypot(...a));
  const forward = unit(subtract(target, eye));
  const right = unit(cross(forward, up));
  const offset = subtract(point, eye);
  const scale = height / 2 / Math.tan((vertical_fov * Math.PI) / 360) / dot(offset, forward);
  return [
    width / 2 + dot(offset, right) * scale,
    height / 2 - dot(offset, cross(right, forward)) * scale,
  ];
}
