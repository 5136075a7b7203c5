// Camera bookmarks per scene, stored in this browser.

import type { CameraPose } from "../common/camera_pose.ts";
import { preferences } from "../common/preferences.ts";

interface Bookmark {
  name: string;
  camera: CameraPose;
}

const maxBookmarks = 24;

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
export function addBookmark(scene: string, camera: CameraPose): Bookmark[] {
  const existing = readBookmarks(scene);
  let number = 1;
  while (existing.some(({ name }) => name === `View ${number}`)) number += 1;
  const all = [...existing, { name: `View ${number}`, camera: { ...camera, name: null } }];
  return store(scene, all.slice(-maxBookmarks));
}

export function removeBookmark(scene: string, name: string): Bookmark[] {
  return store(
    scene,
    readBookmarks(scene).filter((bookmark) => bookmark.name !== name),
  );
}

function store(scene: string, bookmarks: Bookmark[]): Bookmark[] {
  preferences.setText(keyOf(scene), JSON.stringify(bookmarks));
  return bookmarks;
}
