// Views that a person keeps, per scene, in this browser.

import type { Camera } from "heliograph/messages.ts";
import { preferences } from "../common/preferences.ts";

export interface Bookmark {
  name: string;
  camera: Camera;
}

const most = 24;

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

/** Adds a view under the first free number. */
export function addBookmark(scene: string, camera: Camera): Bookmark[] {
  const kept = readBookmarks(scene);
  let number = 1;
  while (kept.some(({ name }) => name === `View ${number}`)) number += 1;
  const all = [...kept, { name: `View ${number}`, camera: { ...camera, name: null } }];
  return store(scene, all.slice(-most));
}

export function removeBookmark(scene: string, name: string): Bookmark[] {
  return store(scene, readBookmarks(scene).filter((bookmark) => bookmark.name !== name));
}

function store(scene: string, bookmarks: Bookmark[]): Bookmark[] {
  preferences.setText(keyOf(scene), JSON.stringify(bookmarks));
  return bookmarks;
}
