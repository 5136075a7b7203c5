// Places points on surfaces by clicks or, with P, in the middle of the view.

import type { Snap } from "heliograph/messages.ts";
import { Signal } from "../common/signal.ts";
import type { PointPicker } from "./picker.ts";

interface PointToolHost {
  canvas: HTMLElement;
  picker: PointPicker;
  /** The point of a surface at a point of the view, in fractions; null: there is none. */
  snap(x: number, y: number, free: boolean): Promise<Snap | null>;
}

/** What is to be done with points. */
export interface PointTask {
  /** Distinguishes it from others. */
  name: string;
  /** How many points it takes. */
  count: number;
  /** Whether it begins again with the next point. */
  repeats: boolean;
  /** Whether vertices and edges attract its points. */
  snaps: boolean;
  done(points: Snap[]): void;
}

export class PointTool {
  readonly task = new Signal<PointTask | null>(null);
  /** Those of an unfinished task. */
  readonly points = new Signal<readonly Snap[]>([]);
  /** What a click would choose. */
  readonly preview = new Signal<Snap | null>(null);
  private readonly host: PointToolHost;
  private asking = false;
  private next: { x: number; y: number; free: boolean } | null = null;

  constructor(host: PointToolHost) {
    this.host = host;
    const { canvas } = host;
    canvas.addEventListener("pointermove", (event) => {
      if (this.task.value && event.buttons === 0) this.askFor(event);
    });
    canvas.addEventListener("pointerleave", () => this.clearPreview());
  }

  start(task: PointTask): void {
    this.points.set([]);
    this.clearPreview();
    this.task.set(task);
    this.host.picker.onClick((x, y, event) => {
      event.preventDefault(); // it selects nothing
      void this.place(x, y, event.altKey);
    });
  }

  /** Drops the points of an unfinished task; without any, ends it. */
  cancel(): void {
    if (this.points.value.length > 0) this.points.set([]);
    else this.stop();
  }

  stop(): void {
    if (!this.task.value) return;
    this.host.picker.onClick(null);
    this.task.set(null);
    this.points.set([]);
    this.clearPreview();
  }

  /** At a point of the view, in fractions. `free`: nothing attracts it. */
  async place(x: number, y: number, free: boolean): Promise<void> {
    const task = this.task.value;
    if (!task) return;
    const point = await this.host.snap(x, y, free || !task.snaps);
    if (!point || task !== this.task.value) return;
    const points = [...this.points.value, point];
    if (points.length < task.count) {
      this.points.set(points);
      return;
    }
    this.points.set([]);
    if (!task.repeats) this.stop();
    task.done(points);
  }

  /** One question at a time, the newest next. */
  private askFor({ clientX, clientY, altKey }: PointerEvent): void {
    const { left, top, width, height } = this.host.canvas.getBoundingClientRect();
    this.next = { x: (clientX - left) / width, y: (clientY - top) / height, free: altKey };
    if (!this.asking) void this.ask();
  }

  private async ask(): Promise<void> {
    this.asking = true;
    for (let at = this.next; at; at = this.next) {
      this.next = null;
      const task = this.task.value;
      if (!task) break;
      const point = await this.host.snap(at.x, at.y, at.free || !task.snaps);
      if (task === this.task.value) this.preview.set(point);
    }
    this.asking = false;
  }

  private clearPreview(): void {
    this.next = null;
    if (this.preview.value) this.preview.set(null);
  }
}
