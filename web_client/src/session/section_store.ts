// The planes that cut the scene open.

import type { Vector3 } from "heliograph/json.ts";
import type { SceneInfo, Section, SectionPlane } from "heliograph/messages.ts";
import { ChannelClosed, type RpcPeer } from "heliograph/rpc.ts";
import { Signal } from "../common/signal.ts";
import { dot, scale } from "../common/vector.ts";
import type { ServerCapabilities } from "./server_capabilities.ts";
import type { UndoHistory } from "./history/undo_history.ts";

export const maxPlanes = 6;

interface SectionStoreHost {
  rpc: RpcPeer;
  scene: Signal<SceneInfo | null>;
  capabilities: ServerCapabilities;
  history: UndoHistory;
  report(error: unknown): void;
}

export class SectionStore {
  readonly planes = new Signal<readonly SectionPlane[]>([]);
  private capColor: Vector3 | undefined;
  private readonly host: SectionStoreHost;
  private sending = false;
  private waiting = false;

  constructor(host: SectionStoreHost) {
    this.host = host;
    host.scene.watch(() => void this.read());
    host.capabilities.methods.watch(() => void this.read());
  }

  get supported(): boolean {
    return this.host.capabilities.has("section.set");
  }

  /** A plane through the middle of the scene. */
  add(normal: Vector3, name: string): void {
    const range = planeRange(normal, this.host.scene.value);
    const plane = { normal, offset: (range.least + range.most) / 2, enabled: true };
    this.change([...this.planes.value, plane], `section plane ${name} added`);
  }

  remove(index: number): void {
    this.change(
      this.planes.value.filter((_, i) => i !== index),
      "section plane removed",
    );
  }

  patch(index: number, change: Partial<SectionPlane>, label: string): void {
    const planes = this.planes.value.map((plane, i) => (i === index ? { ...plane, ...change } : plane));
    this.change(planes, label, `${label} ${index}`);
  }

  /** Changes the planes without a step of the history, as long as a drag lasts. */
  preview(planes: readonly SectionPlane[]): void {
    this.show(planes);
  }

  /** A step of the history for what was previewed since the planes were `before`. */
  record(before: readonly SectionPlane[], label: string, key: string): void {
    this.remember(before, this.planes.value, label, key);
  }

  /** The other half is cut away. */
  flip(index: number): void {
    const plane = this.planes.value[index];
    if (!plane) return;
    const flipped = { normal: scale(plane.normal, -1), offset: -plane.offset };
    this.patch(index, flipped, "section plane flipped");
  }

  /** Takes a state of the server. */
  take({ planes, cap_color }: Section): void {
    this.capColor = cap_color;
    this.planes.set(planes);
  }

  /** What cuts the scene open; undefined: nothing. */
  state(): Section | undefined {
    const planes = [...this.planes.value];
    return planes.length > 0 ? { planes, cap_color: this.capColor } : undefined;
  }

  /** The state of the server, after a change that is not told in full. */
  async read(): Promise<void> {
    if (!this.host.scene.value || !this.supported) {
      this.planes.set([]);
      return;
    }
    await this.attempt(async () => this.take(await this.host.rpc.request("section.get")));
  }

  private change(planes: readonly SectionPlane[], label: string, key = label): void {
    this.remember(this.planes.value, planes, label, key);
    this.show(planes);
  }

  private remember(
    before: readonly SectionPlane[],
    after: readonly SectionPlane[],
    label: string,
    key: string,
  ): void {
    this.host.history.add({
      label,
      key,
      ofScene: true,
      undo: () => this.show(before),
      redo: () => this.show(after),
    });
  }

  private show(planes: readonly SectionPlane[]): void {
    this.planes.set(planes);
    this.waiting = true;
    if (!this.sending) void this.send();
  }

  /** One request at a time, of the newest planes. */
  private async send(): Promise<void> {
    this.sending = true;
    while (this.waiting) {
      this.waiting = false;
      const request = { planes: [...this.planes.value], cap_color: this.capColor };
      await this.attempt(async () => {
        const answer = await this.host.rpc.request("section.set", request);
        if (!this.waiting) this.take(answer);
      });
    }
    this.sending = false;
  }

  private async attempt(action: () => Promise<void>): Promise<void> {
    try {
      await action();
    } catch (error) {
      if (!(error instanceof ChannelClosed)) this.host.report(error);
    }
  }
}

/** Where planes of this normal meet the scene. */
export function planeRange(
  normal: Vector3,
  scene: Pick<SceneInfo, "bounds"> | null,
): { least: number; most: number } {
  if (!scene) return { least: -1, most: 1 };
  const { min, max } = scene.bounds;
  const corners = Array.from({ length: 8 }, (_, corner): Vector3 => {
    const side = (axis: 0 | 1 | 2): number => ((corner >> axis) & 1 ? max[axis] : min[axis]);
    return [side(0), side(1), side(2)];
  });
  const offsets = corners.map((corner) => dot(normal, corner));
  const [least, most] = [Math.min(...offsets), Math.max(...offsets)];
  return most > least ? { least, most } : { least: least - 1, most: most + 1 };
}

/** "X", "−Y", or "Free" for a plane along no axis. */
export function planeName(normal: Vector3): string {
  const axis = normal.findIndex((component) => Math.abs(component) > 0.9999);
  if (axis < 0) return "Free";
  return `${(normal[axis] as number) < 0 ? "−" : ""}${"XYZ"[axis]}`;
}
