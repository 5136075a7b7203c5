// What axe-core has against a page.

import { readFileSync } from "node:fs";
import { createRequire } from "node:module";

const axe = readFileSync(createRequire(import.meta.url).resolve("axe-core/axe.min.js"), "utf8");

/** The rules that depend on colours: by far the slowest. */
export const colorRules = ["color-contrast"];

/**
 * Findings of axe with impact serious or critical, one line each: of the element `within`, of all
 * rules or those in `only`, but not those in `without`.
 */
export async function seriousFindings(page, { within = "html", only, without = [] } = {}) {
  if (!(await page.evaluate(() => "axe" in window))) await page.evaluate(axe);
  const options = {
    resultTypes: ["violations"],
    preload: false, // of style sheets, which no rule that is used needs
    rules: Object.fromEntries(without.map((rule) => [rule, { enabled: false }])),
    ...(only ? { runOnly: { type: "rule", values: only } } : {}),
  };
  const { violations } = await page.evaluate(
    ([selector, chosen]) => window.axe.run(selector, chosen),
    [within, options],
  );
  return violations
    .filter(({ impact }) => impact === "serious" || impact === "critical")
    .flatMap(({ id, nodes }) =>
      nodes.map(
        ({ target, failureSummary }) =>
          `${id}: ${target.join(" ")}: ${failureSummary.split("\n").at(-1).trim()}`,
      ),
    );
}
