// Camera bookmarks per scene, stored in this browser.

import type { CameraPose } from "../common/camera_pose.ts";
import { preferences } from "../common/preferences.ts";

export interface Bookmark {
  name: string;
  camera: CameraPose;
  /** A data URL. */
  thumbnail?: string | undefined;
}

const maxBookmarks = 24;
const maxNameLength = 60;

function keyOf(scene: string): string {
  return `bookmarks.${scene}`;
}

export function readBookmarks(scene: string): Bookmark[] {
  try {
    const stored: unknown = JSON.parse(preferences.text(keyOf(scene), "[]"));
    return Array.isArray(stored) ? (stored as Bookmark[]) : [];
  } catch {
    return [];
  }
}

/** Adds a bookmark under the first free number. */
export function addBookmark(scene: string, camera: CameraPose, thumbnail?: string): Bookmark[] {
  const existing = readBookmarks(scene);
  let number = 1;
  while (existing.some(({ name }) => name === `View ${number}`)) number += 1;
  const all = [
    ...existing,
    { name: `View ${number}`, camera: { ...camera, name: null }, thumbnail },
  ];
  return store(scene, all.slice(-maxBookmarks));
}

export function removeBookmark(scene: string, name: string): Bookmark[] {
  return store(
    scene,
    readBookmarks(scene).filter((bookmark) => bookmark.name !== name),
  );
}

/** Does nothing where the name is empty or another bookmark has it. */
export function renameBookmark(scene: string, from: string, to: string): Bookmark[] {
  const all = readBookmarks(scene);
  const name = to.trim().slice(0, maxNameLength);
  if (name === "" || all.some((bookmark) => bookmark.name === name)) return all;
  return store(
    scene,
    all.map((bookmark) => (bookmark.name === from ? { ...bookmark, name } : bookmark)),
  );
}

function store(scene: string, bookmarks: Bookmark[]): Bookmark[] {
  preferences.setText(keyOf(scene), JSON.stringify(bookmarks));
  return bookmarks;
}
