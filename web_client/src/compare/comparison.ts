// A second view of the same scene, beside or over the first: another preset, the path traced
// reference, or a buffer.

import type { SceneInfo, SessionInfo } from "heliograph/messages.ts";
import { ComparedSession } from "./compared_session.ts";
import type { ComparisonState, Counterpart } from "./comparison_state.ts";
import { Signal } from "../common/signal.ts";
import type { Viewer } from "../session/viewer.ts";

const createTimeoutMs = 120_000;

export class Comparison {
  readonly state = new Signal<ComparisonState | null>(null);
  private readonly viewer: Viewer;
  private readonly newCanvas: () => HTMLCanvasElement;
  private running: ComparedSession | null = null;
  /** Of starts and stops: what was begun before the last one is not wanted any more. */
  private wanted = 0;
  private scene = "";

  /** `newCanvas` puts a fresh canvas in the place of the last one. */
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

  /** Whether this server and this browser can do it. */
  get possible(): boolean {
    const { capabilities, controlState } = this.viewer;
    const drawsAside = typeof HTMLCanvasElement.prototype.transferControlToOffscreen === "function";
    const mayOpen = controlState.value.kind !== "watching" && capabilities.has("session.create");
    return drawsAside && mayOpen && capabilities.has("session.close");
  }

  async start(counterpart: Counterpart): Promise<void> {
    this.end();
    const wanted = this.wanted;
    const canvas = this.newCanvas();
    this.state.set({ counterpart, frame: null, similarity: null });
    try {
      const { rpc, parts, hello } = this.viewer;
      const model = hello?.session ?? "main";
      const copied = parts.edits();
      const { name } = await rpc.request<SessionInfo>(
        "session.create",
        { copy_of: model },
        createTimeoutMs,
      );
      if (wanted !== this.wanted) {
        rpc.notify("session.close", { session: name });
        return;
      }
      this.running = new ComparedSession(this.viewer, name, { counterpart, copied }, canvas, {
        changed: (state) => {
          if (wanted === this.wanted) this.state.set(state);
        },
        gone: () => {
          if (wanted === this.wanted) this.stop();
        },
      });
    } catch (error) {
      if (wanted !== this.wanted) return;
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
    this.wanted += 1;
    this.running?.end();
    this.running = null;
  }

  /** Another scene is compared in the same way as the last. */
  private sceneChanged(scene: SceneInfo | null): void {
    const key = JSON.stringify(scene && { ...scene, memory: null });
    if (key === this.scene) return;
    this.scene = key;
    const counterpart = this.state.value?.counterpart;
    if (counterpart) void this.start(counterpart);
  }
}
