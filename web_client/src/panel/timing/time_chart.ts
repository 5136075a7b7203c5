// The last frames as stacked bars, one colour per stage. Redrawn for each measurement.

import { element } from "../../widgets/element.ts";
import { hues } from "./pass_table.ts";
import type { Stage } from "./stage_times.ts";

const columns = 96;
const height = 72;
const gap = 1;
const headroom = 1.15;

export class TimeChart {
  readonly node: HTMLElement;
  private readonly canvas = element("canvas", { class: "chart" });
  private readonly scale = element("span", { class: "chart-scale" });
  private readonly hueOrder: string[] = [];
  private readonly samples: Stage[][] = [];
  private top = 0;
  private hovered: number | null = null;
  /** Called with the sample under the pointer, and with null when it leaves. */
  private readonly onHover: (stages: Stage[] | null) => void;

  constructor(onHover: (stages: Stage[] | null) => void) {
    this.onHover = onHover;
    this.canvas.setAttribute("role", "img");
    this.canvas.setAttribute("aria-label", "Time of the last frames, by stage");
    this.canvas.addEventListener("pointermove", (event) => {
      const { left, width } = this.canvas.getBoundingClientRect();
      const column = Math.floor(((event.clientX - left) / width) * columns);
      this.hover(column - (columns - this.samples.length));
    });
    this.canvas.addEventListener("pointerleave", () => this.hover(-1));
    matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => this.draw());
    new ResizeObserver(() => this.draw()).observe(this.canvas);
    this.node = element("div", { class: "chart-box" }, this.canvas, this.scale);
  }

  /** The colour of a stage; it never changes. */
  hueOf(stage: string): number {
    let index = this.hueOrder.indexOf(stage);
    if (index < 0) index = this.hueOrder.push(stage) - 1;
    return index % hues;
  }

  add(stages: Stage[]): void {
    this.samples.push(stages);
    if (this.samples.length > columns) this.samples.shift();
    const longest = Math.max(...this.samples.map(total));
    const ceiling = niceCeiling(longest * headroom);
    if (ceiling > this.top || ceiling < this.top * 0.5) this.top = ceiling;
    this.draw();
  }

  private hover(index: number): void {
    const sample = this.samples[index];
    this.hovered = sample ? index : null;
    this.onHover(sample ?? null);
    this.draw();
  }

  private draw(): void {
    const ratio = Math.min(2, devicePixelRatio);
    const width = this.canvas.clientWidth;
    if (width === 0) return; // collapsed
    const [wide, high] = [Math.round(width * ratio), Math.round(height * ratio)];
    if (this.canvas.width !== wide || this.canvas.height !== high) {
      this.canvas.width = wide;
      this.canvas.height = high;
    }
    const context = this.canvas.getContext("2d");
    if (!context) return;
    context.setTransform(ratio, 0, 0, ratio, 0, 0);
    context.clearRect(0, 0, width, height);
    const style = getComputedStyle(this.canvas);
    const colours = Array.from({ length: hues }, (_, i) => style.getPropertyValue(`--hue-${i}`));
    const step = width / columns;
    const first = columns - this.samples.length;
    this.samples.forEach((stages, index) => {
      context.globalAlpha = this.hovered === null || this.hovered === index ? 1 : 0.45;
      let bottom = height;
      for (const { name, ms } of stages) {
        const size = (ms / this.top) * height;
        context.fillStyle = colours[this.hueOf(name)] ?? "";
        context.fillRect((first + index) * step, bottom - size, step - gap, size);
        bottom -= size;
      }
    });
    const shown = this.hovered === null ? null : this.samples[this.hovered];
    this.scale.textContent = shown ? `${total(shown).toFixed(1)} ms` : `${this.top} ms`;
  }
}

function total(stages: Stage[]): number {
  return stages.reduce((sum, { ms }) => sum + ms, 0);
}

/** The next of 1, 2, 5 times a power of ten. */
function niceCeiling(value: number): number {
  if (!(value > 0)) return 1;
  const power = 10 ** Math.floor(Math.log10(value));
  const factor = [1, 2, 5, 10].find((candidate) => candidate * power >= value) ?? 10;
  return Number((factor * power).toPrecision(3));
}
