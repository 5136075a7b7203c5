// A second view of the same scene, beside or over the first: another preset, the path traced
// reference, or a buffer. It is a session of its own on the server, which follows our camera.

import type {
  AnimationState,
  Camera,
  Hello,
  JsonObject,
  SessionInfo,
  StreamSettings,
} from "heliograph/messages.ts";
import { Signal } from "./signal.ts";
import { Connection } from "./stream/connection.ts";
import type { DrawnFrame } from "./stream/worker_messages.ts";
import type { Viewer } from "./viewer.ts";

export type Counterpart =
  | { kind: "reference" }
  | { kind: "preset"; name: string }
  | { kind: "buffer"; name: string };

export interface ComparisonState {
  counterpart: Counterpart;
  /** Its newest picture; null before the first. */
  frame: DrawnFrame | null;
  /** Structural similarity of both pictures; null before the first measurement. */
  similarity: number | null;
}

/** Settings that both sides share: how a picture is shown, not how it is made. */
const sharedGroups = ["exposure", "tone_map", "environment"];
const measureMs = 1000;
const createTimeoutMs = 120_000;

export class Comparison {
  readonly state = new Signal<ComparisonState | null>(null);
  private readonly viewer: Viewer;
  private readonly newCanvas: () => HTMLCanvasElement;
  private running: RunningComparison | null = null;

  /** `newCanvas` puts a fresh canvas in the place of the last one. */
  constructor(viewer: Viewer, newCanvas: () => HTMLCanvasElement) {
    this.viewer = viewer;
    this.newCanvas = newCanvas;
    viewer.camera.watch((camera) => camera && this.running?.follow(camera));
    viewer.settings.tree.watch((tree) => this.running?.share(tree));
    viewer.parts.lights.watch(() => this.running?.light());
    viewer.parts.materials.watch(() => this.running?.light());
    viewer.parts.environment.watch(() => this.running?.light());
    viewer.animation.watch((animation) => animation && this.running?.play(animation));
    viewer.connection.state.watch(({ kind }) => {
      if (kind !== "live") this.stop();
    });
    viewer.scene.watch(() => this.stop());
  }

  /** Whether this server and this browser can do it. */
  get possible(): boolean {
    const { offers, standing } = this.viewer;
    const drawsAside = typeof HTMLCanvasElement.prototype.transferControlToOffscreen === "function";
    const mayOpen = standing.value.kind !== "watching" && offers.has("session.create");
    return drawsAside && mayOpen && offers.has("session.close");
  }

  async start(counterpart: Counterpart): Promise<void> {
    this.stop();
    const session = await this.viewer.rpc.request<SessionInfo>(
      "session.create",
      { copy_of: this.viewer.hello?.session ?? "main" },
      createTimeoutMs,
    );
    const running = new RunningComparison(this.viewer, counterpart, session.name, this.newCanvas());
    this.running = running;
    running.changed = () => {
      if (this.running === running) this.state.set({ ...running.shown });
    };
    running.changed();
  }

  stop(): void {
    if (!this.running) return;
    this.running.end();
    this.running = null;
    this.state.set(null);
  }
}

class RunningComparison {
  readonly shown: ComparisonState;
  changed: () => void = () => {};
  private readonly viewer: Viewer;
  private readonly session: string;
  private readonly connection: Connection;
  private readonly worker = new Worker(new URL("similarity_worker.js", document.baseURI));
  private readonly timer: number;
  private measuring = false;
  private shared = "";
  private lit = "";
  private clip = "";

  constructor(
    viewer: Viewer,
    counterpart: Counterpart,
    session: string,
    canvas: HTMLCanvasElement,
  ) {
    this.viewer = viewer;
    this.session = session;
    this.shown = { counterpart, frame: null, similarity: null };
    this.connection = new Connection(
      document.baseURI,
      canvas.transferControlToOffscreen(),
      {
        live: (hello) => this.becomeLive(hello),
        notification: () => {},
        drawn: (frame) => {
          this.shown.frame = frame;
          this.changed();
        },
        draw: (picture) => picture.close(),
        warning: (message) => viewer.onError(message),
        undecodable: (_, video) => {
          if (!video) return;
          this.connection.rpc.notify("stream.pause", {});
          this.connection.rpc.notify("stream.resume", {});
        },
      },
      session,
    );
    this.connection.open();
    this.worker.onmessage = ({ data }: MessageEvent<{ similarity: number }>) => {
      this.measuring = false;
      this.shown.similarity = data.similarity;
      this.changed();
    };
    this.timer = window.setInterval(() => void this.measure(), measureMs);
  }

  follow({ eye, target, up, vertical_fov }: Camera): void {
    this.connection.rpc.notify("camera.set", { eye, target, up, vertical_fov });
  }

  /** Has the same lights, materials and environment there. */
  light(): void {
    const { parts } = this.viewer;
    const { lights = {}, materials = {} } = parts.edits();
    const environment = parts.environment.value?.current;
    const text = JSON.stringify([lights, materials, environment]);
    if (text === this.lit) return;
    this.lit = text;
    const { rpc } = this.connection;
    for (const [light, patch] of Object.entries(lights)) {
      rpc.notify("lights.patch", { light, patch });
    }
    for (const [material, patch] of Object.entries(materials)) {
      rpc.notify("materials.patch", { material, patch });
    }
    if (environment !== undefined) rpc.notify("environment.set", { name: environment });
  }

  share(tree: JsonObject): void {
    const patch = Object.fromEntries(
      sharedGroups.filter((group) => group in tree).map((group) => [group, tree[group]]),
    );
    const text = JSON.stringify(patch);
    if (text === this.shared) return;
    this.shared = text;
    this.connection.rpc.notify("settings.patch", { patch });
  }

  /** Follows the clip: when it starts, stops or jumps, not while it just goes on. */
  play({ clip, playing, rate, seconds }: AnimationState): void {
    const known = JSON.stringify([clip, playing, rate, playing ? 0 : seconds]);
    if (known === this.clip || !clip) return;
    this.clip = known;
    const { rpc } = this.connection;
    rpc.notify("animation.play", { clip, rate });
    rpc.notify("animation.seek", { seconds });
    if (!playing) rpc.notify("animation.pause", {});
  }

  end(): void {
    clearInterval(this.timer);
    this.worker.terminate();
    // From inside, since a session that somebody is in cannot be closed by others. What cannot be
    // closed any more ends when it has been idle for long enough.
    void this.connection.rpc
      .request("session.close", { session: this.session })
      .catch(() => {})
      .finally(() => this.connection.dispose());
  }

  private async becomeLive(hello: Hello): Promise<void> {
    const { rpc } = this.connection;
    const size = this.viewer.stream.chooseSize(hello);
    await rpc.request<StreamSettings>("stream.configure", { ...size });
    const { counterpart } = this.shown;
    if (counterpart.kind === "preset") {
      await rpc.request("settings.preset", { name: counterpart.name });
    } else {
      const patch =
        counterpart.kind === "reference"
          ? { reference: { use: "always" } }
          : { view: { buffer: counterpart.name } };
      await rpc.request("settings.patch", { patch });
    }
    this.shared = "";
    this.lit = "";
    this.share(this.viewer.settings.tree.value);
    this.light();
    const camera = this.viewer.camera.value;
    if (camera) this.follow(camera);
  }

  private async measure(): Promise<void> {
    if (this.measuring || !this.shown.frame || this.shown.counterpart.kind === "buffer") return;
    const pictures = await Promise.all([
      this.viewer.connection.copyPicture(),
      this.connection.copyPicture(),
    ]);
    if (pictures[0] && pictures[1] && !this.measuring) {
      this.measuring = true;
      this.worker.postMessage({ id: 0, pictures }, [pictures[0], pictures[1]]);
    } else {
      pictures.forEach((picture) => picture?.close());
    }
  }
}
