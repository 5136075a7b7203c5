// Small pictures of scenes that this browser has not seen yet. The server makes each in a session
// of its own, one after another, and only while nothing else needs it.

import type { SceneList, SessionInfo } from "heliograph/messages.ts";
import { shrunk } from "../common/image_files.ts";
import { keepThumbnail, thumbnailOf } from "./thumbnails.ts";
import type { Viewer } from "../session/viewer.ts";

const size = { width: 240, height: 135 };
const samples = 8;
const lookAgainMs = 700;
const createTimeoutMs = 60_000;

/** Larger files cost more than a small picture is worth. */
const largestFile = 128 * 1024 * 1024; // bytes

export class ScenePreviews {
  private readonly viewer: Viewer;
  /** Scenes that gave no picture; not asked for again. */
  private readonly refused = new Set<string>();
  private wanted = false;
  private running = false;
  private interruption: AbortController | null = null;

  constructor(viewer: Viewer) {
    this.viewer = viewer;
    viewer.frame.watch((frame) => {
      if (frame && !frame.final) this.interruption?.abort();
    });
  }

  /** Makes what is missing, until `stop`. */
  start(): void {
    this.wanted = true;
    if (!this.running) void this.run();
  }

  stop(): void {
    this.wanted = false;
    this.interruption?.abort();
  }

  private async run(): Promise<void> {
    this.running = true;
    for (let scene = this.next(); this.wanted && scene; scene = this.next()) {
      if (await this.serverIsFree()) await this.portray(scene);
      else await new Promise((resolve) => setTimeout(resolve, lookAgainMs));
    }
    this.running = false;
  }

  private next(): string | undefined {
    const { scenes }: SceneList = this.viewer.scenes.value;
    return scenes.find(
      ({ name, bytes }) => bytes <= largestFile && !this.refused.has(name) && !thumbnailOf(name),
    )?.name;
  }

  /** Nothing moves here, and nobody watches anything else. */
  private async serverIsFree(): Promise<boolean> {
    const { viewer } = this;
    const busy = viewer.loading.value || viewer.restoring.value || viewer.animation.value?.playing;
    if (document.hidden || !viewer.hello || busy || !viewer.frame.value?.final) return false;
    if (!viewer.capabilities.has("session.create") || viewer.controlState.value.kind === "watching") {
      this.wanted = false;
      return false;
    }
    try {
      const { sessions } = await viewer.rpc.request<{ sessions: SessionInfo[] }>("session.list");
      const own = viewer.hello?.session;
      return sessions.every(({ name, viewers }) => name === own || viewers.length === 0);
    } catch {
      return false; // the connection is gone: it is asked again with the next
    }
  }

  private async portray(scene: string): Promise<void> {
    const interruption = new AbortController();
    this.interruption = interruption;
    let session: string | null = null;
    try {
      const settings = { accumulation: { max_samples: samples } };
      const asked = { scene, settings, ...size };
      const { rpc } = this.viewer;
      session = (await rpc.request<SessionInfo>("session.create", asked, createTimeoutMs)).name;
      const address = this.viewer.connection.place.address(`api/v1/sessions/${session}/frame.jpg`);
      address.searchParams.set("samples", String(samples));
      const { signal } = interruption;
      const response = await fetch(address, { signal });
      if (!response.ok) throw new Error(await response.text());
      keepThumbnail(scene, await shrunk(await response.blob(), size.width));
    } catch {
      // What was interrupted is taken up again; what cannot be shown stays without a picture.
      if (!interruption.signal.aborted) this.refused.add(scene);
    } finally {
      this.interruption = null;
      if (session) await this.close(session);
    }
  }

  private async close(session: string): Promise<void> {
    // It ends by itself, later, where it cannot be closed now.
    await this.viewer.rpc.request("session.close", { session }).catch(() => {});
  }
}
