// Thumbnails of the server's scenes, which it renders while it has nothing else to do.

import { thumbnailUrl } from "../common/image_files.ts";
import type { Viewer } from "../session/viewer.ts";
import { forgetThumbnail, storeThumbnail } from "./thumbnails.ts";

const width = 240;
const pollMs = 1500;
const later = 202;

export class ScenePreviews {
  private readonly viewer: Viewer;
  /** Scenes whose thumbnail this page has, or that have none. */
  private readonly settled = new Set<string>();
  private active = false;
  private running = false;

  constructor(viewer: Viewer) {
    this.viewer = viewer;
    // One that is deleted and uploaded again has another thumbnail.
    viewer.scenes.watch(({ scenes }) => {
      const names = new Set(scenes.map(({ name }) => name));
      for (const name of this.settled) if (!names.has(name)) this.settled.delete(name);
      this.resume();
    });
    viewer.uploads.changed.watch((change) => {
      if (change?.kind !== "scene") return;
      this.settled.delete(change.name);
      forgetThumbnail(change.name);
      if (!change.deleted) this.resume();
    });
  }

  /** Fetches thumbnails as they come, until `stop`. */
  start(): void {
    this.active = true;
    this.resume();
  }

  stop(): void {
    this.active = false;
  }

  private resume(): void {
    if (this.active && !this.running) void this.run();
  }

  private async run(): Promise<void> {
    this.running = true;
    while (this.active && this.missing().length > 0) {
      for (const scene of this.missing()) {
        if (this.active && (await this.fetchOne(scene))) this.settled.add(scene);
      }
      if (this.missing().length > 0) await new Promise((next) => setTimeout(next, pollMs));
    }
    this.running = false;
  }

  private missing(): string[] {
    const { scenes } = this.viewer.scenes.value;
    return scenes.map(({ name }) => name).filter((name) => !this.settled.has(name));
  }

  /** False: it comes later. */
  private async fetchOne(scene: string): Promise<boolean> {
    if (document.hidden || !this.viewer.hello) return false;
    const path = scene.split("/").map(encodeURIComponent).join("/");
    const changes = (): number => this.viewer.uploads.changesOf("scene", scene);
    const before = changes();
    try {
      const url = this.viewer.connection.address.url(`api/v1/scenes/${path}/thumbnail.jpg`);
      // A scene that was uploaded again has another image at the same address.
      const response = await fetch(url, { cache: "no-cache" });
      if (response.status === later) return false;
      const image = response.ok ? await thumbnailUrl(await response.blob(), width) : null;
      if (changes() !== before) return false; // it may be of the file before
      if (image) storeThumbnail(scene, image);
      return true;
    } catch {
      return false; // the connection is lost; a later one tries again
    }
  }
}
