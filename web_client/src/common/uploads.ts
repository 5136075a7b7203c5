// What was uploaded to the server: deleted, and listed again when it has changed.

import type { Notifications } from "heliograph/messages.ts";

type UploadKind = Notifications["uploads.changed"]["kind"];

interface Uploads {
  connection: { address: { url(path: string): URL } };
  report(error: unknown): void;
}

interface Lists {
  shown: { readList(): Promise<void> };
  parts: { read(): Promise<void> };
  textures: { read(): Promise<void> };
}

/** Reads the list again in which files of this kind are. */
export function listUploads({ shown, parts, textures }: Lists, kind: UploadKind): Promise<void> {
  if (kind === "scene") return shown.readList();
  return kind === "environment" ? parts.read() : textures.read();
}

/** Whether the file is gone now; where it is not, why is told. It stays where it is shown. */
export async function deleteUpload(
  uploads: Uploads & Lists,
  kind: UploadKind,
  name: string,
): Promise<boolean> {
  try {
    const url = uploads.connection.address.url(`api/v1/${kind}s/${encodeURIComponent(name)}`);
    const response = await fetch(url, { method: "DELETE" }).catch(() => null);
    if (!response) throw new Error(`${name} was not deleted: no connection to the server`);
    // Another viewer may have deleted it before.
    if (!response.ok && response.status !== 404) {
      throw new Error(`${name} was not deleted: ${(await response.text()).trim()}`);
    }
  } catch (error) {
    uploads.report(error);
    return false;
  }
  await listUploads(uploads, kind);
  return true;
}
