// Names of favourite scenes, stored in this browser.

import { preferences } from "./preferences.ts";
import { Signal } from "./signal.ts";

const key = "favourites";

export const favourites = new Signal<ReadonlySet<string>>(read());

export function setFavourite(scene: string, chosen: boolean): void {
  const names = new Set(favourites.value);
  if (chosen) names.add(scene);
  else names.delete(scene);
  preferences.setText(key, JSON.stringify([...names]));
  favourites.set(names);
}

/** Favourites first, otherwise in the given order. */
export function favouritesFirst<Item extends { name: string }>(scenes: Item[]): Item[] {
  const { value } = favourites;
  const rank = ({ name }: Item): number => (value.has(name) ? 0 : 1);
  return [...scenes].sort((a, b) => rank(a) - rank(b));
}

function read(): ReadonlySet<string> {
  try {
    const stored: unknown = JSON.parse(preferences.text(key, "[]"));
    return new Set(Array.isArray(stored) ? stored.map(String) : []);
  } catch {
    return new Set();
  }
}
