// GPU and CPU time of a frame: one line per stage, which expands into its passes. Times are
// smoothed and lines keep their order, so that the table is readable.

import { humanise } from "heliograph/settings_schema.ts";
import { element, icon, setText } from "../../widgets/element.ts";
import type { Stage } from "./stage_times.ts";

interface Line {
  node: HTMLElement;
  bar: HTMLElement;
  value: HTMLElement;
  ms: number;
  seenAt: number;
}

interface StageLine extends Line {
  passes: HTMLElement;
  lines: Map<string, Line>;
}

export const hues = 10;
const smoothing = 0.35;
const removeAfterMs = 4000;

export class PassTable {
  readonly node: HTMLElement;
  private readonly list = element("ul", { class: "passes", "aria-label": "Time per stage" });
  private readonly stages = new Map<string, StageLine>();
  private readonly hueOf: (stage: string) => number;

  /** `hueOf` gives the colour of a stage in the chart. */
  constructor(hueOf: (stage: string) => number) {
    this.hueOf = hueOf;
    const empty = element("p", { class: "facts empty" }, "Timings appear with the first frames.");
    this.node = element("div", { class: "pass-table" }, this.list, empty);
  }

  /** `exact` shows the values of one frame, otherwise they are smoothed. */
  show(stages: Stage[], exact = false): void {
    const now = performance.now();
    const longest = Math.max(1e-6, ...stages.map(({ ms }) => ms));
    for (const stage of stages) {
      const line = this.stages.get(stage.name) ?? this.addStage(stage.name);
      update(line, stage.ms, longest, now, exact);
      for (const pass of stage.passes) {
        const inner = line.lines.get(pass.name) ?? this.addPass(line, stage.name, pass.name);
        update(inner, pass.ms, longest, now, exact);
      }
      removeStale(line.lines, now);
      line.node.classList.toggle("single", stage.passes.length < 2);
    }
    removeStale(this.stages, now);
  }

  private addStage(name: string): StageLine {
    const passes = element("ul", { class: "passes inner" });
    const line = createLine(humanise(name), this.hueOf(name));
    line.node.prepend(icon("chevron"));
    const fold = element("details", {}, element("summary", {}, line.node), passes);
    this.list.append(element("li", { "data-stage": name }, fold));
    const stage = { ...line, passes, lines: new Map<string, Line>() };
    this.stages.set(name, stage);
    return stage;
  }

  private addPass(stage: StageLine, stageName: string, name: string): Line {
    const shortName = name.slice(stageName.length + 1) || name;
    const line = createLine(humanise(shortName.replaceAll(".", " · ")), this.hueOf(stageName));
    stage.passes.append(element("li", { "data-pass": name }, line.node));
    stage.lines.set(name, line);
    return line;
  }
}

function createLine(label: string, hue: number): Line {
  const value = element("span", { class: "pass-ms" });
  const bar = element("span", { class: `pass-bar hue-${hue}` });
  const node = element(
    "div",
    { class: "pass" },
    element("span", { class: "pass-name" }, label),
    element("span", { class: "pass-track" }, bar),
    value,
  );
  return { node, bar, value, ms: 0, seenAt: 0 };
}

function update(line: Line, ms: number, longest: number, now: number, exact: boolean): void {
  line.ms += (ms - line.ms) * (exact || line.seenAt === 0 ? 1 : smoothing);
  line.seenAt = now;
  line.bar.style.transform = `scaleX(${Math.min(1, line.ms / longest)})`;
  setText(line.value, line.ms.toFixed(line.ms < 9.95 ? 2 : line.ms < 999.5 ? 1 : 0));
}

function removeStale(lines: Map<string, Line>, now: number): void {
  for (const [name, line] of lines) {
    if (now - line.seenAt < removeAfterMs) continue;
    line.node.closest("li")?.remove();
    lines.delete(name);
  }
}
