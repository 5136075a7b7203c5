import assert from "node:assert/strict";
import test from "node:test";
import { linkTo, viewIn } from "../src/link_state.ts";
import type { ViewState } from "../src/view_state.ts";

const state: ViewState = {
  scene: "Café & co.glb",
  settings: { tone_map: { curve: "agx" } },
  clip: { clip: "walk", seconds: 1.5, rate: 1, playing: true },
  camera: { eye: [1, 2, 3], target: [0, 0.5, 0], up: [0, 1, 0], vertical_fov: 45, name: null },
};

test("a view survives the way through an address", () => {
  const link = linkTo("http://host:8080/?token=x#old", state);
  assert.match(link, /^http:\/\/host:8080\/\?token=x#view=[\w-]+$/);
  assert.deepEqual(viewIn(link), state);
});

test("an address without a view or with a damaged one gives none", () => {
  for (const hash of ["", "#view=", "#view=%%%", "#view=bm90IGpzb24", "#view=WzFd"]) {
    assert.equal(viewIn(`http://host/${hash}`), null);
  }
});

test("members of the wrong kind do not pass", () => {
  const wrong = { scene: 7, camera: { eye: [1, 2], target: "x" }, clip: { clip: 1 } };
  assert.deepEqual(viewIn(linkTo("http://host/", wrong as unknown as ViewState)), {});
});
