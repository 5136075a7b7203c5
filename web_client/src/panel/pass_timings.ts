// Where the time of a frame goes: one stacked bar and one line per pass. Times are smoothed and
// lines stay where they first appeared, so that the eye can rest on them.

import type { PassTiming } from "../protocol/messages.ts";
import { humanise } from "../protocol/settings_schema.ts";
import { element, setText } from "./element.ts";

export type TimedPass = PassTiming;

interface Line {
  node: HTMLElement;
  segment: HTMLElement;
  bar: HTMLElement;
  value: HTMLElement;
  ms: number;
  seenAt: number;
}

const hues = 10;
const smoothing = 0.35;
const forgetAfterMs = 4000;

export class PassTable {
  readonly node: HTMLElement;
  private readonly stack = element("div", { class: "stack", "aria-hidden": "true" });
  private readonly list = element("ul", { class: "passes", "aria-label": "Time per pass" });
  private readonly lines = new Map<string, Line>();
  private nextHue = 0;

  constructor() {
    const empty = element("p", { class: "facts empty" }, "Timings appear with the first frames.");
    this.node = element("div", { class: "pass-table" }, this.stack, this.list, empty);
  }

  show(passes: TimedPass[]): void {
    const now = performance.now();
    for (const pass of passes) {
      const line = this.lines.get(pass.name) ?? this.addLine(pass);
      line.ms += (pass.ms - line.ms) * (line.seenAt === 0 ? 1 : smoothing);
      line.seenAt = now;
    }
    this.forget(now);
    const all = [...this.lines.values()];
    const total = Math.max(1e-6, sum(all));
    const longest = Math.max(1e-6, ...all.map(({ ms }) => ms));
    for (const line of all) {
      line.segment.style.flexGrow = String(line.ms / total);
      line.bar.style.transform = `scaleX(${line.ms / longest})`;
      setText(line.value, line.ms.toFixed(line.ms < 9.95 ? 2 : 1));
    }
  }

  private addLine({ name, kind }: TimedPass): Line {
    const hue = `hue-${this.nextHue % hues}`;
    this.nextHue += 1;
    const label = humanise(name.replaceAll(".", " · "));
    const place = kind === "host" ? "on the processor" : "on the device";
    const value = element("span", { class: "pass-ms" });
    const bar = element("span", { class: `pass-bar ${hue}` });
    const node = element(
      "li",
      { class: "pass", "data-tip": `${label}, ${place}`, "data-pass": name },
      element("span", { class: "pass-name" }, label),
      element("span", { class: "pass-track" }, bar),
      value,
    );
    const segment = element("div", { class: `segment ${hue}`, "data-tip": label });
    this.list.append(node);
    this.stack.append(segment);
    const line = { node, segment, bar, value, ms: 0, seenAt: 0 };
    this.lines.set(name, line);
    return line;
  }

  private forget(now: number): void {
    for (const [name, line] of this.lines) {
      if (now - line.seenAt < forgetAfterMs) continue;
      line.node.remove();
      line.segment.remove();
      this.lines.delete(name);
    }
  }
}

function sum(lines: Line[]): number {
  return lines.reduce((total, { ms }) => total + ms, 0);
}
