import assert from "node:assert/strict";
import test from "node:test";
import { editsOf, patchesTowards } from "../src/session/scene_edits.ts";
import { linkTo, viewIn } from "../src/session/view_link.ts";
import type { ViewState } from "../src/session/view_state.ts";

const state: ViewState = {
  scene: "Café & co.glb",
  environment: null,
  lights: { sun: { direction: [0, -1, 0], enabled: false } },
  materials: { paint: { roughness: 0.3 } },
  textures: [{ material: "paint", slot: "base_color", image: "moss" }],
  settings: { tone_map: { curve: "agx" } },
  clip: { clip: "walk", seconds: 1.5, rate: 1, playing: true },
  camera: { eye: [1, 2, 3], target: [0, 0.5, 0], up: [0, 1, 0], vertical_fov: 45, name: null },
};

test("a view is unchanged after a round trip through a URL", () => {
  const { href: link, shortened } = linkTo("http://host:8080/?token=x#old", state);
  assert.equal(shortened, false);
  assert.match(link, /^http:\/\/host:8080\/\?token=x#view=[\w-]+$/);
  assert.deepEqual(viewIn(link), state);
});

test("a URL without a view or with an invalid one gives null", () => {
  for (const hash of ["", "#view=", "#view=%%%", "#view=bm90IGpzb24", "#view=WzFd"]) {
    assert.equal(viewIn(`http://host/${hash}`), null);
  }
});

test("members of the wrong type are dropped", () => {
  const wrong = { scene: 7, camera: { eye: [1, 2], target: "x" }, clip: { clip: 1 } };
  assert.deepEqual(viewIn(linkTo("http://host/", wrong as unknown as ViewState).href), {});
});

test("invalid and too many edits are dropped", () => {
  const many = Object.fromEntries(
    Array.from({ length: 200 }, (_, index) => [`m${index}`, { roughness: 0.5 }]),
  );
  const wrong = { sun: "bright", bulb: { intensity: "1e9" }, moon: { direction: [0, 1, {}] } };
  const textures = [{ material: "paint", slot: 3, image: "moss" }];
  const given = { lights: wrong, materials: many, textures } as unknown as ViewState;
  const seen = viewIn(linkTo("http://host/", given).href);
  assert.deepEqual(seen?.lights, {});
  assert.equal(Object.keys(seen?.materials ?? {}).length, 64);
  assert.equal(seen?.textures, undefined);
});

test("a link has a limited length and reports what was left out", () => {
  const materials = Object.fromEntries(
    Array.from({ length: 60 }, (_, index) => [
      `a long name ${"x".repeat(100)}${index}`,
      { metallic: 1 },
    ]),
  );
  const { href, shortened } = linkTo("http://host/", { ...state, materials });
  assert.ok(href.length <= 8000 && shortened);
  assert.deepEqual(viewIn(href)?.lights, state.lights);
  assert.equal(viewIn(href)?.materials, undefined);
});

test("edits of lights and materials contain only differences from the file", () => {
  const sun = { name: "sun", intensity: 2, enabled: true, changed: ["intensity"] };
  assert.deepEqual(editsOf([sun, { name: "bulb", changed: [] }]), { sun: { intensity: 2 } });
  assert.equal(editsOf([{ name: "sun" }]), undefined, "a server without changed");
  assert.deepEqual(patchesTowards([sun], {}), { sun: { intensity: null } });
  assert.deepEqual(patchesTowards([sun], { sun: { intensity: 2 } }), {});
});
