// The bookmarks of the scene: named cameras in the session, which all of its viewers share.

import type { Bookmark, BookmarkList, SceneInfo } from "heliograph/messages.ts";
import type { RpcPeer } from "heliograph/rpc.ts";
import type { CameraPose } from "../common/camera_pose.ts";
import { Signal } from "../common/signal.ts";
import type { ServerCapabilities } from "./server_capabilities.ts";

export const maxNameLength = 60;

interface BookmarksHost {
  rpc: RpcPeer;
  capabilities: ServerCapabilities;
  scene: Signal<SceneInfo | null>;
  /** Whether what the page showed is still to be restored in another session. */
  isRestoring(): boolean;
  attempt(action: () => Promise<unknown>): Promise<void>;
}

export class Bookmarks {
  readonly list = new Signal<Bookmark[]>([]);
  private readonly host: BookmarksHost;
  /** That `list` belongs to. */
  private scene: string | null = null;

  constructor(host: BookmarksHost) {
    this.host = host;
    host.scene.watch((scene) => {
      if (scene?.name !== this.scene && scene) void this.read();
    });
    // The first scene may arrive before the list of methods.
    host.capabilities.methods.watch(() => {
      if (host.capabilities.has("bookmarks.list") && !host.isRestoring()) void this.read();
    });
  }

  take({ scene, bookmarks }: BookmarkList): void {
    this.scene = scene;
    this.list.set(bookmarks);
  }

  /** Of the session that the page is in now. */
  async read(): Promise<void> {
    if (!this.host.capabilities.has("bookmarks.list")) return;
    await this.host.attempt(async () => {
      this.take(await this.host.rpc.request("bookmarks.list"));
    });
  }

  /** Adds those that this page knows to another session that shows the same scene and has none. */
  async restore(): Promise<void> {
    const { list, scene, host } = this;
    const known = list.value;
    await this.read();
    if (known.length === 0 || list.value.length > 0 || scene !== this.scene) return;
    await host.attempt(async () => {
      for (const bookmark of known) this.take(await host.rpc.request("bookmarks.add", bookmark));
    });
  }

  /** Under the first free number. @returns its name; null where the server refuses it */
  async add(camera: CameraPose, thumbnail?: string): Promise<string | null> {
    const { eye, target, up, vertical_fov } = camera;
    let name: string | null = null;
    await this.host.attempt(async () => {
      const request = { eye, target, up, vertical_fov, thumbnail };
      const added = await this.host.rpc.request("bookmarks.add", request);
      this.take(added);
      name = added.bookmarks.at(-1)?.name ?? null;
    });
    return name;
  }

  /** Does nothing where the name is empty or stays. */
  async rename(name: string, entered: string): Promise<void> {
    const to = entered.trim().slice(0, maxNameLength);
    if (to === "" || to === name) return;
    await this.host.attempt(async () => {
      this.take(await this.host.rpc.request("bookmarks.rename", { name, to }));
    });
  }

  async remove(name: string): Promise<void> {
    await this.host.attempt(async () => {
      this.take(await this.host.rpc.request("bookmarks.remove", { name }));
    });
  }
}
