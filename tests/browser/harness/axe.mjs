// What axe-core has against a page.

import { readFileSync } from "node:fs";
import { createRequire } from "node:module";

const axe = readFileSync(createRequire(import.meta.url).resolve("axe-core/axe.min.js"), "utf8");

/** What takes no part in serious findings, and takes half of the time. */
const options = {
  resultTypes: ["violations"],
  rules: { region: { enabled: false } }, // of impact moderate
  preload: false, // of style sheets and media of other origins
};

/** Waits until nothing fades in: a half transparent text has less contrast. */
function animationsEnded(page) {
  return page.evaluate(() => {
    const ending = document
      .getAnimations()
      .filter(({ effect }) => Number.isFinite(effect.getComputedTiming().endTime));
    return Promise.allSettled(ending.map(({ finished }) => finished)).then(() => {});
  });
}

/** Findings of axe with impact serious or critical, one line each. */
export async function seriousFindings(page) {
  await animationsEnded(page);
  if (!(await page.evaluate(() => "axe" in window))) await page.evaluate(axe);
  const { violations } = await page.evaluate((chosen) => window.axe.run(chosen), options);
  return violations
    .filter(({ impact }) => impact === "serious" || impact === "critical")
    .flatMap(({ id, nodes }) =>
      nodes.map(
        ({ target, failureSummary }) =>
          `${id}: ${target.join(" ")}: ${failureSummary.split("\n").at(-1).trim()}`,
      ),
    );
}
