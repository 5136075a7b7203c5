// The other side of a comparison: a session of its own on the server, which shows what ours shows,
// made in another way. It follows our camera, clip, lights, materials, sky and size of picture.

import type { Hello, JsonObject, StreamSettings } from "heliograph/messages.ts";
import type { ComparisonState, Counterpart } from "./comparison_state.ts";
import { type Edits, editsBetween } from "../session/scene_edits.ts";
import { Connection } from "../stream/connection.ts";
import { SessionAddress } from "../stream/session_address.ts";
import type { Viewer } from "../session/viewer.ts";

/** Settings that both sides share: how a picture is shown, not how it is made. */
const sharedGroups = ["exposure", "tone_map", "environment"];
const measureMs = 1000;

export interface ComparedStart {
  counterpart: Counterpart;
  /** What was changed in the scene that the session was copied from. */
  copied: { lights?: Edits; materials?: Edits };
}

export interface ComparedEvents {
  changed(state: ComparisonState): void;
  /** The session has ended without our doing. */
  gone(): void;
}

export class ComparedSession {
  private readonly shown: ComparisonState;
  private readonly viewer: Viewer;
  private readonly name: string;
  private readonly events: ComparedEvents;
  private readonly connection: Connection;
  private readonly worker = new Worker(new URL("similarity_worker.js", document.baseURI));
  private readonly timer: number;
  private measuring = false;
  private live = false;
  private lights: Edits;
  private materials: Edits;
  /** What was sent last of each kind, to send only what is new. */
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
    this.shown = { counterpart, frame: null, similarity: null };
    this.lights = copied.lights ?? {};
    this.materials = copied.materials ?? {};
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
        undecodable: (_, video) => video && this.beginVideoAnew(),
      },
      new SessionAddress(document.baseURI, viewer.connection.place.route, name),
    );
    this.connection.state.watch(({ kind }) => {
      if (kind !== "live") this.live = false;
    });
    this.connection.open();
    this.worker.onmessage = ({ data }: MessageEvent<{ similarity: number }>) => {
      this.measuring = false;
      this.shown.similarity = data.similarity;
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
    clearInterval(this.timer);
    this.worker.terminate();
    // From inside, since a session that somebody is in cannot be closed by others. What cannot be
    // closed any more ends when it has been idle for long enough.
    void this.connection.rpc
      .request("session.close", { session: this.name })
      .catch(() => {})
      .finally(() => this.connection.dispose());
  }

  private changed(): void {
    this.events.changed({ ...this.shown });
  }

  private async becomeLive(hello: Hello): Promise<void> {
    if (hello.session !== undefined && hello.session !== this.name) {
      this.events.gone(); // and this is another one, which is not ours to change
      return;
    }
    const { rpc } = this.connection;
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
    this.sent.clear();
    this.live = true;
    this.follow();
  }

  /** Pictures of the same size, made by the same codec, and none while nobody looks. */
  followStream(): void {
    const settings = this.viewer.stream.settings.value;
    if (!settings) return;
    const { width, height, codec, quality, max_fps, paused } = settings;
    const change: Partial<StreamSettings> = { width, height, quality, max_fps, paused };
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

  /** Follows the clip: when it starts, stops or jumps, not while it just goes on. */
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

  private send(method: string, params: object): void {
    if (this.isNew(method, params)) this.connection.rpc.notify(method, params);
  }

  private isNew(kind: string, what: object): boolean {
    if (!this.live) return false;
    const text = JSON.stringify(what);
    if (this.sent.get(kind) === text) return false;
    this.sent.set(kind, text);
    return true;
  }

  /** A viewer that comes back gets a key picture first. */
  private beginVideoAnew(): void {
    this.connection.rpc.notify("stream.pause", {});
    if (!this.viewer.stream.settings.value?.paused) {
      this.connection.rpc.notify("stream.resume", {});
    }
  }

  private async measure(): Promise<void> {
    if (this.measuring || !this.shown.frame || this.shown.counterpart.kind === "buffer") return;
    const pictures = await Promise.all([
      this.viewer.connection.copyFrame(),
      this.connection.copyFrame(),
    ]);
    if (pictures[0] && pictures[1] && !this.measuring) {
      this.measuring = true;
      this.worker.postMessage({ id: 0, pictures }, [pictures[0], pictures[1]]);
    } else {
      pictures.forEach((picture) => picture?.close());
    }
  }
}
