// Accessibility: no serious findings of axe, complete keyboard control, no overflow on a phone,
// readable on a large screen.

import assert from "node:assert/strict";
import { seriousFindings } from "./harness/axe.mjs";
import { eventually, openTab, screenshot, unfoldAll } from "./harness/browser.mjs";
import { Stage } from "./harness/stage.mjs";

const tabs = ["scene", "settings", "inspect", "timing"];
const stage = new Stage({ view: { viewport: { width: 1280, height: 800 } } });

for (const colorScheme of ["dark", "light"]) {
  stage.test(`no serious findings of axe, ${colorScheme}`, async () => {
    const { page } = await stage.watch({ colorScheme });
    await unfoldAll(page);
    for (const tab of tabs) {
      await openTab(page, tab);
      await page.mouse.move(10, 300);
      await screenshot(page, `${colorScheme}_${tab}`);
      assert.deepEqual(await seriousFindings(page), [], `${tab}, ${colorScheme}`);
    }
    await page.getByRole("button", { name: "Save and share" }).click();
    await screenshot(page, `${colorScheme}_menu`);
    assert.deepEqual(await seriousFindings(page), [], "the menu");
    await page.keyboard.press("Escape");
    await page.keyboard.press("?");
    await screenshot(page, `${colorScheme}_help`);
    assert.deepEqual(await seriousFindings(page), [], "the help");
  });
}

stage.test(
  "the keyboard reaches view, tabs, menu and settings, and the focus is visible",
  async () => {
    const { page } = await stage.watch();
    const seen = new Set();
    for (let i = 0; i < 40; i += 1) {
      await page.keyboard.press("Tab");
      const focus = await page.evaluate(() => {
        const { activeElement: node } = document;
        if (node === document.body) return null; // between the last element and the first
        const style = getComputedStyle(node);
        const ring = style.outlineStyle !== "none" || node.matches("input[type=range]");
        const name = node.id || node.getAttribute("aria-label") || node.name || node.textContent;
        return { name, ring };
      });
      if (!focus) continue;
      assert.ok(focus.ring, `${focus.name} has the focus without a focus ring`);
      seen.add(focus.name);
    }
    for (const name of ["view", "tab-scene", "Save and share", "Fullscreen", "Play"]) {
      assert.ok(
        seen.has(name),
        `the keyboard does not reach ${name}, only ${[...seen].join(", ")}`,
      );
    }
    await page.locator("#tab-scene").focus();
    await page.keyboard.press("ArrowRight");
    assert.equal(await page.evaluate(() => document.activeElement.id), "tab-settings");
    assert.ok(await page.locator("#page-settings").isVisible());
    await page.getByRole("button", { name: "Save and share" }).focus();
    await page.keyboard.press("Enter");
    await page.keyboard.press("ArrowDown");
    assert.equal(
      await page.evaluate(() => document.activeElement.getAttribute("role")),
      "menuitem",
    );
    await page.keyboard.press("Escape");
    const back = await page.evaluate(() => document.activeElement.getAttribute("aria-label"));
    assert.equal(back, "Save and share");
  },
);

stage.test("reduced motion disables inertia and progress animations", async () => {
  const { page } = await stage.watch({ reducedMotion: "reduce" });
  const moving = await page.evaluate(() => {
    const animations = document.getAnimations().filter(({ playState }) => playState === "running");
    return animations.map(({ animationName }) => animationName).filter((name) => name === "sweep");
  });
  assert.deepEqual(moving, []);
});

stage.test("on a 4K screen the panel is readable and the view fills the window", async () => {
  const { page } = await stage.watch({ viewport: { width: 3840, height: 2160 } });
  const canvas = await page.locator("#view").boundingBox();
  assert.deepEqual([canvas.width, canvas.height], [3840, 2160]);
  const panel = await page.locator("#panel").boundingBox();
  assert.ok(panel.width > 450, `a panel of ${panel.width} px is too small to read here`);
});

stage.test("at 360 px no tab overflows and axe has no serious findings", async () => {
  const { page } = await stage.watch({
    viewport: { width: 360, height: 740 },
    colorScheme: "light",
    deviceScaleFactor: 2,
    hasTouch: true,
    isMobile: true,
  });
  await page.getByRole("button", { name: "Show panel" }).tap();
  await unfoldAll(page);
  for (const tab of tabs) {
    await page.locator(`#tab-${tab}`).tap();
    await eventually(() => page.locator(`#page-${tab}`).isVisible(), `the tab ${tab}`);
    await screenshot(page, `phone_${tab}`);
    const widest = await page.evaluate(() =>
      Math.max(
        document.documentElement.scrollWidth,
        ...[...document.querySelectorAll("#panel *, #transport *, #top-left *")]
          .map((node) => node.getBoundingClientRect())
          .filter(({ width }) => width > 0)
          .map(({ right }) => right),
      ),
    );
    assert.ok(widest <= 360, `${tab} is ${widest} px wide`);
    assert.deepEqual(await seriousFindings(page), [], tab);
  }
});
