// Renders thumbnails of scenes that this browser has not shown yet: one after another, each in a
// session of its own, and only while the server is idle.

import type { SceneList } from "heliograph/messages.ts";
import { thumbnailUrl } from "../common/image_files.ts";
import type { Viewer } from "../session/viewer.ts";
import { storeThumbnail, thumbnailOf } from "./thumbnails.ts";

const size = { width: 240, height: 135 };
const samples = 8;
const pollMs = 700;
const createTimeoutMs = 60_000;

/** Larger files take too long to load for a thumbnail. */
const maxFileBytes = 128 * 1024 * 1024;

export class ScenePreviews {
  private readonly viewer: Viewer;
  /** Scenes that could not be rendered; not requested again. */
  private readonly failed = new Set<string>();
  private active = false;
  private running = false;
  private interruption: AbortController | null = null;

  constructor(viewer: Viewer) {
    this.viewer = viewer;
    viewer.frame.watch((frame) => {
      if (frame && !frame.final) this.interruption?.abort();
    });
  }

  /** Renders the missing thumbnails until `stop`. */
  start(): void {
    this.active = true;
    if (!this.running) void this.run();
  }

  stop(): void {
    this.active = false;
    this.interruption?.abort();
  }

  private async run(): Promise<void> {
    this.running = true;
    for (let scene = this.next(); this.active && scene; scene = this.next()) {
      if (await this.serverIsIdle()) await this.renderPreview(scene);
      else await new Promise((resolve) => setTimeout(resolve, pollMs));
    }
    this.running = false;
  }

  private next(): string | undefined {
    const { scenes }: SceneList = this.viewer.scenes.value;
    return scenes.find(
      ({ name, bytes }) => bytes <= maxFileBytes && !this.failed.has(name) && !thumbnailOf(name),
    )?.name;
  }

  /** Nothing moves in this session, and no other session has viewers. */
  private async serverIsIdle(): Promise<boolean> {
    const { viewer } = this;
    const busy = viewer.loading.current.value || viewer.restoring.value || viewer.animation.value?.playing;
    if (document.hidden || !viewer.hello || busy || !viewer.frame.value?.final) return false;
    if (
      !viewer.capabilities.has("session.create") ||
      viewer.controlState.value.kind === "read_only"
    ) {
      this.active = false;
      return false;
    }
    try {
      const { sessions } = await viewer.rpc.request("session.list");
      const own = viewer.hello?.session;
      return sessions.every(({ name, viewers }) => name === own || viewers.length === 0);
    } catch {
      return false; // the connection is lost; the next one tries again
    }
  }

  private async renderPreview(scene: string): Promise<void> {
    const interruption = new AbortController();
    this.interruption = interruption;
    let session: string | null = null;
    try {
      const settings = { accumulation: { max_samples: samples } };
      const params = { scene, settings, idle_timeout: 30, ...size };
      const { rpc } = this.viewer;
      session = (await rpc.request("session.create", params, createTimeoutMs)).name;
      const url = this.viewer.connection.address.url(`api/v1/sessions/${session}/frame.jpg`);
      url.searchParams.set("samples", String(samples));
      const { signal } = interruption;
      const response = await fetch(url, { signal });
      if (!response.ok) throw new Error(await response.text());
      storeThumbnail(scene, await thumbnailUrl(await response.blob(), size.width));
    } catch {
      // Interrupted previews are rendered later; scenes that fail stay without one.
      if (!interruption.signal.aborted) this.failed.add(scene);
    } finally {
      this.interruption = null;
      if (session) await this.close(session);
    }
  }

  private async close(session: string): Promise<void> {
    // If this fails, the session ends by its idle timeout.
    await this.viewer.rpc.request("session.close", { session }).catch(() => {});
  }
}
