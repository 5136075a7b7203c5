// The second session of a comparison. It follows the camera, clip, lights, materials, environment
// and frame size of the page's session, and renders them in another way.

import type { JsonObject } from "heliograph/json.ts";
import type { Hello, Methods, StreamConfigureParams } from "heliograph/messages.ts";
import { type Edits, editsBetween } from "../session/scene_edits.ts";
import type { Viewer } from "../session/viewer.ts";
import { Connection } from "../stream/connection.ts";
import { SessionAddress } from "../stream/session_address.ts";
import type { DrawnFrame } from "../stream/worker_messages.ts";
import { type ComparisonState, type Counterpart, samplesNeeded } from "./comparison_state.ts";

/** Settings that both sessions share: how a frame is displayed, not how it is rendered. */
const sharedGroups = ["exposure", "tone_map", "environment"];
const measureMs = 1000;
/** After a change, frames of before it may still be on their way. */
const settleMs = 700;
export const maxSamplesSetting = "accumulation.max_samples";

interface ComparedStart {
  counterpart: Counterpart;
  /** Edits in the scene that the session was copied from. */
  copied: { lights?: Edits; materials?: Edits };
}

interface ComparedEvents {
  changed(state: ComparisonState): void;
  /** The session was closed by the server or another client. */
  closed(): void;
}

export class ComparedSession {
  private readonly state: ComparisonState;
  private readonly viewer: Viewer;
  private readonly name: string;
  private readonly events: ComparedEvents;
  private readonly connection: Connection;
  private readonly worker = new Worker(new URL("similarity_worker.js", document.baseURI));
  private readonly timer: number;
  private measuring = false;
  private live = false;
  private frame: DrawnFrame | null = null;
  /** The revision from which on frames are rendered in the other way. */
  private firstRev = Infinity;
  private changedAt = 0;
  private ended = false;
  private lights: Edits;
  private materials: Edits;
  /** The last message of each kind, so that only changes are sent. */
  private readonly sent = new Map<string, string>();

  constructor(
    viewer: Viewer,
    name: string,
    { counterpart, copied }: ComparedStart,
    canvas: HTMLCanvasElement,
    events: ComparedEvents,
  ) {
    this.viewer = viewer;
    this.name = name;
    this.events = events;
    this.state = { counterpart, samples: null, similarity: null };
    this.lights = copied.lights ?? {};
    this.materials = copied.materials ?? {};
    this.connection = new Connection(
      document.baseURI,
      canvas.transferControlToOffscreen(),
      {
        live: (hello) => this.becomeLive(hello),
        notification: () => {},
        drawn: (frame) => {
          this.frame = frame;
          this.update();
        },
        draw: (image) => image.close(),
        warning: (message) => viewer.onError(message),
        decodeFailed: (_, video) => video && this.restartVideo(),
      },
      new SessionAddress(document.baseURI, viewer.connection.address.route, name),
    );
    this.connection.state.watch(({ kind }) => {
      if (kind !== "live") this.live = false;
    });
    viewer.frame.watch(() => this.update());
    this.connection.open();
    this.worker.onmessage = ({ data }: MessageEvent<{ similarity: number }>) => {
      this.measuring = false;
      if (this.hasEnoughSamples()) this.state.similarity = data.similarity;
      this.changed();
    };
    this.timer = window.setInterval(() => void this.measure(), measureMs);
    this.changed();
  }

  private follow(): void {
    this.followStream();
    this.followSettings();
    this.followScene();
    this.followClip();
    this.followCamera();
  }

  end(): void {
    this.ended = true;
    clearInterval(this.timer);
    this.worker.terminate();
    // Other viewers cannot close a session that has viewers. If this fails, it ends by its idle
    // timeout.
    void this.connection.rpc
      .request("session.close", { session: this.name })
      .catch(() => {})
      .finally(() => this.connection.dispose());
  }

  /** Counts the samples that both frames have. */
  private update(): void {
    if (this.ended) return;
    const own = this.viewer.frame.value;
    const { frame } = this;
    const same = own !== null && frame !== null && frame.stateRev >= this.firstRev;
    this.state.samples = same ? Math.min(own.samples, frame.samples) : null;
    if (!this.hasEnoughSamples()) this.state.similarity = null;
    this.changed();
  }

  private hasEnoughSamples(): boolean {
    const most = Number(this.viewer.settings.value(maxSamplesSetting) ?? 1);
    const needed = samplesNeeded(this.state.counterpart, most);
    const settled = performance.now() - this.changedAt >= settleMs;
    return settled && this.state.samples !== null && this.state.samples >= needed;
  }

  private changed(): void {
    this.events.changed({ ...this.state });
  }

  private async becomeLive(hello: Hello): Promise<void> {
    if (hello.session !== undefined && hello.session !== this.name) {
      this.events.closed(); // the reconnect led to another session, which must not be changed
      return;
    }
    const { rpc } = this.connection;
    const { counterpart } = this.state;
    if (counterpart.kind === "preset") {
      this.firstRev = (await rpc.request("settings.preset", { name: counterpart.name })).rev;
    } else {
      const patch: JsonObject =
        counterpart.kind === "reference"
          ? { reference: { use: "always" } }
          : { view: { buffer: counterpart.name } };
      this.firstRev = (await rpc.request("settings.patch", { patch })).rev;
    }
    this.sent.clear();
    this.live = true;
    this.follow();
  }

  /** Copies size, quality, codec and pause of the stream. */
  followStream(): void {
    const settings = this.viewer.stream.settings.value;
    if (!settings) return;
    const { width, height, codec, quality, max_fps, paused } = settings;
    const change: StreamConfigureParams = { width, height, quality, max_fps, paused };
    this.send("stream.configure", codec ? { ...change, codec } : change);
  }

  followSettings(): void {
    const tree = this.viewer.settings.tree.value;
    const shared = sharedGroups.filter((group) => group in tree);
    this.send("settings.patch", {
      patch: Object.fromEntries(shared.map((group) => [group, tree[group]])) as JsonObject,
    });
  }

  followScene(): void {
    if (!this.live) return;
    const { parts } = this.viewer;
    const { rpc } = this.connection;
    const { lights, materials } = parts.edits();
    for (const [light, patch] of Object.entries(editsBetween(this.lights, lights ?? {}))) {
      rpc.notify("lights.patch", { light, patch });
    }
    for (const [material, patch] of Object.entries(editsBetween(this.materials, materials ?? {}))) {
      rpc.notify("materials.patch", { material, patch });
    }
    this.lights = lights ?? {};
    this.materials = materials ?? {};
    const environment = parts.environment.value?.current;
    if (environment !== undefined) this.send("environment.set", { name: environment });
  }

  /** Follows the clip when it starts, stops or seeks. */
  followClip(): void {
    const animation = this.viewer.animation.value;
    if (!animation?.clip) return;
    const { clip, playing, rate, seconds } = animation;
    if (!this.isNew("clip", [clip, playing, rate, playing ? 0 : seconds])) return;
    const { rpc } = this.connection;
    rpc.notify("animation.play", { clip, rate });
    rpc.notify("animation.seek", { seconds });
    if (!playing) rpc.notify("animation.pause", {});
  }

  followCamera(): void {
    const camera = this.viewer.camera.value;
    if (!camera) return;
    const { eye, target, up, vertical_fov } = camera;
    this.send("camera.set", { eye, target, up, vertical_fov });
  }

  private send<Name extends keyof Methods>(method: Name, params: Methods[Name]["params"]): void {
    if (this.isNew(method, params)) this.connection.rpc.notify(method, params);
  }

  private isNew(kind: string, message: object): boolean {
    if (!this.live) return false;
    const text = JSON.stringify(message);
    if (this.sent.get(kind) === text) return false;
    this.changedAt = performance.now();
    this.sent.set(kind, text);
    return true;
  }

  /** A stream that resumes starts with a key frame. */
  private restartVideo(): void {
    this.connection.rpc.notify("stream.pause", {});
    if (!this.viewer.stream.settings.value?.paused) {
      this.connection.rpc.notify("stream.resume", {});
    }
  }

  private async measure(): Promise<void> {
    if (this.measuring || this.state.counterpart.kind === "buffer") return;
    if (!this.hasEnoughSamples()) return;
    const frames = await Promise.all([
      this.viewer.connection.copyFrame(),
      this.connection.copyFrame(),
    ]);
    if (frames[0] && frames[1] && !this.measuring) {
      this.measuring = true;
      this.worker.postMessage({ id: 0, frames }, [frames[0], frames[1]]);
    } else {
      frames.forEach((frame) => frame?.close());
    }
  }
}
