// A second session with the same scene, shown beside or over the first: another preset, the path
// traced reference, or a buffer.

import type { SceneInfo } from "heliograph/messages.ts";
import { Signal } from "../common/signal.ts";
import type { Viewer } from "../session/viewer.ts";
import { ComparedSession } from "./compared_session.ts";
import type { ComparisonState, Counterpart } from "./comparison_state.ts";

const createTimeoutMs = 120_000;

export class Comparison {
  readonly state = new Signal<ComparisonState | null>(null);
  private readonly viewer: Viewer;
  private readonly newCanvas: () => HTMLCanvasElement;
  private running: ComparedSession | null = null;
  /** Counts starts and stops: an operation of an older generation is cancelled. */
  private generation = 0;
  private scene = "";

  /** `newCanvas` replaces the last canvas by a new one. */
  constructor(viewer: Viewer, newCanvas: () => HTMLCanvasElement) {
    this.viewer = viewer;
    this.newCanvas = newCanvas;
    viewer.camera.watch(() => this.running?.followCamera());
    viewer.animation.watch(() => this.running?.followClip());
    viewer.settings.tree.watch(() => this.running?.followSettings());
    for (const part of [viewer.parts.lights, viewer.parts.materials, viewer.parts.environment]) {
      part.watch(() => this.running?.followScene());
    }
    viewer.stream.settings.watch(() => this.running?.followStream());
    viewer.connection.state.watch(({ kind }) => {
      if (kind !== "live") this.stop();
    });
    viewer.scene.watch((scene) => this.sceneChanged(scene));
  }

  /** Whether server and browser support comparisons. */
  get possible(): boolean {
    const { capabilities, controlState } = this.viewer;
    const hasOffscreenCanvas =
      typeof HTMLCanvasElement.prototype.transferControlToOffscreen === "function";
    const mayCreate = controlState.value.kind !== "read_only" && capabilities.has("session.create");
    return hasOffscreenCanvas && mayCreate && capabilities.has("session.close");
  }

  async start(counterpart: Counterpart): Promise<void> {
    this.end();
    const generation = this.generation;
    const canvas = this.newCanvas();
    this.state.set({ counterpart, samples: null, similarity: null });
    try {
      const { rpc, parts, hello } = this.viewer;
      const source = hello?.session ?? "main";
      const copied = parts.edits();
      const { name } = await rpc.request(
        "session.create",
        { copy_of: source, idle_timeout: 30 },
        createTimeoutMs,
      );
      if (generation !== this.generation) {
        rpc.notify("session.close", { session: name });
        return;
      }
      this.running = new ComparedSession(this.viewer, name, { counterpart, copied }, canvas, {
        changed: (state) => {
          if (generation === this.generation) this.state.set(state);
        },
        closed: () => {
          if (generation === this.generation) this.stop();
        },
      });
    } catch (error) {
      if (generation !== this.generation) return;
      this.stop();
      this.viewer.report(error);
    }
  }

  stop(): void {
    if (!this.state.value) return;
    this.end();
    this.state.set(null);
  }

  private end(): void {
    this.generation += 1;
    this.running?.end();
    this.running = null;
  }

  /** Restarts the comparison with another scene. */
  private sceneChanged(scene: SceneInfo | null): void {
    const key = JSON.stringify(scene && { ...scene, memory: null });
    if (key === this.scene) return;
    this.scene = key;
    const counterpart = this.state.value?.counterpart;
    if (counterpart) void this.start(counterpart);
  }
}
