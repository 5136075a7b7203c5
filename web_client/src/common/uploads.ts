// What was uploaded to the server: deleted, and listed again when it has changed.

import type { Notifications } from "heliograph/messages.ts";
import { Signal } from "./signal.ts";

type Change = Notifications["uploads.changed"];
type UploadKind = Change["kind"];

/** A list is read no more often than that, however many files come and go. */
const leastMs = 300;

interface Lists {
  shown: { readList(): Promise<void> };
  parts: { readEnvironments(): Promise<void> };
  textures: { readImages(): Promise<void> };
}

/** The lists that uploads are in: read again after changes, where they are shown. */
export class UploadLists {
  /** What anyone has uploaded or deleted last. */
  readonly changed = new Signal<Change | null>(null);
  private readonly lists: Lists;
  /** Kinds whose list has not been read since a change. */
  private readonly stale = new Set<UploadKind>();
  /** Kinds that are looked at when their time has come. */
  private readonly due = new Set<UploadKind>();
  private readonly needs: { kind: UploadKind; isShown: () => boolean }[] = [];
  private readonly changes = new Map<string, number>();

  constructor(lists: Lists) {
    this.lists = lists;
  }

  /** Has the list kept up to date while `isShown`; what becomes shown calls `refresh`. */
  keep(kind: UploadKind, isShown: () => boolean): void {
    this.needs.push({ kind, isShown });
  }

  /** How often the file of this name was uploaded or deleted while the page was connected. */
  changesOf(kind: UploadKind, name: string): number {
    return this.changes.get(`${kind} ${name}`) ?? 0;
  }

  /** Takes a change by anyone. */
  notified(change: Change): void {
    const { kind, name } = change;
    this.changes.set(`${kind} ${name}`, this.changesOf(kind, name) + 1);
    this.stale.add(kind);
    this.changed.set(change);
    if (this.due.has(kind)) return;
    this.due.add(kind);
    setTimeout(() => {
      this.due.delete(kind);
      if (this.needs.some((need) => need.kind === kind && need.isShown())) void this.refresh(kind);
    }, leastMs);
  }

  /** Reads the list, if it has changed since it was read. */
  async refresh(kind: UploadKind): Promise<void> {
    if (this.stale.has(kind)) await this.read(kind);
  }

  read(kind: UploadKind): Promise<void> {
    this.stale.delete(kind);
    if (kind === "scene") return this.lists.shown.readList();
    const { parts, textures } = this.lists;
    return kind === "environment" ? parts.readEnvironments() : textures.readImages();
  }
}

interface Page {
  connection: { address: { url(path: string): URL } };
  uploads: Pick<UploadLists, "read">;
  report(error: unknown): void;
}

/** Whether the file is gone now; where it is not, why is told. It stays where it is shown. */
export async function deleteUpload(page: Page, kind: UploadKind, name: string): Promise<boolean> {
  try {
    const url = page.connection.address.url(`api/v1/${kind}s/${encodeURIComponent(name)}`);
    const response = await fetch(url, { method: "DELETE" }).catch(() => null);
    if (!response) throw new Error(`${name} was not deleted: no connection to the server`);
    // Another viewer may have deleted it before.
    if (!response.ok && response.status !== 404) {
      throw new Error(`${name} was not deleted: ${(await response.text()).trim()}`);
    }
  } catch (error) {
    page.report(error);
    return false;
  }
  await page.uploads.read(kind);
  return true;
}
