// A view state in the fragment of a URL, which browsers do not send to the server.

import type { JsonObject, JsonValue, Vector3 } from "heliograph/json.ts";
import type { EditDocumentTextures, Section } from "heliograph/messages.ts";
import { isObject } from "heliograph/settings_tree.ts";
import type { CameraPose } from "../common/camera_pose.ts";
import { checkedEdits, maxEdits } from "./scene_edits.ts";
import { maxPlanes } from "./section_store.ts";
import type { ClipState, NodesShown, ViewState } from "./view_state.ts";

const key = "view";
/** A link to a scene as it is. */
const modelKey = "model";
const digits = 6;

/** Mail programs and messengers truncate longer links. */
const maxLinkLength = 8000;

/** Hidden, isolated and selected nodes of a link. */
const maxNodes = 256;
const maxTextures = 64;

interface Link {
  href: string;
  /** Whether changes of lights, materials or textures were left out. */
  shortened: boolean;
}

/** The page's URL with a view in its fragment, of at most `maxLinkLength` characters. */
export function linkTo(page: string, state: ViewState): Link {
  const [lights, materials] = [state.lights, state.materials];
  if (!fitsIntoLink(state.nodes)) return linkTo(page, { ...state, nodes: undefined });
  if (state.textures && state.textures.length > maxTextures) {
    return { ...linkTo(page, { ...state, textures: undefined }), shortened: true };
  }
  const [full, lit, bare] = [
    state,
    { ...state, materials: undefined },
    { ...state, materials: undefined, textures: undefined, lights: undefined },
  ].map((view) => hrefOf(page, view)) as [string, string, string];
  const href = [full, lit].find(({ length }) => length <= maxLinkLength) ?? bare;
  const largest = Math.max(...[lights, materials].map((edits) => Object.keys(edits ?? {}).length));
  return { href, shortened: href !== full || largest >= maxEdits };
}

function hrefOf(page: string, state: ViewState): string {
  const url = new URL(page);
  url.hash = `${key}=${encode(state)}`;
  return url.href;
}

/** The view in a URL; null without one or with an invalid one. */
export function viewIn(address: string): ViewState | null {
  const parts = new URLSearchParams(new URL(address).hash.slice(1));
  const text = parts.get(key);
  const model = parts.get(modelKey);
  if (!text) return model ? { scene: model } : null;
  try {
    const json = new TextDecoder().decode(bytesOf(text));
    return checked(JSON.parse(json));
  } catch {
    return null;
  }
}

function encode(state: ViewState): string {
  const text = JSON.stringify(state, (_, value: unknown) =>
    typeof value === "number" ? Number(value.toPrecision(digits)) : value,
  );
  const letters = Array.from(new TextEncoder().encode(text), (byte) => String.fromCharCode(byte));
  return btoa(letters.join("")).replaceAll("+", "-").replaceAll("/", "_").replace(/=+$/, "");
}

function bytesOf(text: string): Uint8Array {
  const letters = atob(text.replaceAll("-", "+").replaceAll("_", "/"));
  return Uint8Array.from(letters, (letter) => letter.charCodeAt(0));
}

/** Links are untrusted: only members of the expected type pass. */
function checked(value: unknown): ViewState | null {
  if (!isObject(value)) return null;
  const { scene, part, variant, environment, settings, clip, camera } = value as JsonObject;
  const [lights, materials] = [checkedEdits(value.lights), checkedEdits(value.materials)];
  const state: ViewState = {};
  if (typeof scene === "string") state.scene = scene;
  if (typeof part === "number") state.part = part;
  if (typeof variant === "string") state.variant = variant;
  if (environment === null || typeof environment === "string") state.environment = environment;
  if (lights) state.lights = lights;
  if (materials) state.materials = materials;
  if (isTextures(value.textures)) state.textures = value.textures;
  const nodes = checkedNodes(value.nodes);
  if (nodes) state.nodes = nodes;
  if (isSection(value.section)) state.section = value.section;
  if (isObject(settings)) state.settings = settings;
  if (clip === null || isClip(clip)) state.clip = clip;
  if (isCamera(camera)) state.camera = camera;
  return state;
}

function fitsIntoLink(nodes: NodesShown | undefined): boolean {
  if (!nodes) return true;
  return nodes.hidden.length + nodes.isolated.length + nodes.selected.length <= maxNodes;
}

function checkedNodes(value: JsonValue | undefined): NodesShown | undefined {
  if (!isObject(value)) return undefined;
  const { hidden, isolated, selected } = value;
  if (![hidden, isolated, selected].every(isIdList)) return undefined;
  const nodes = { hidden, isolated, selected } as unknown as NodesShown;
  return fitsIntoLink(nodes) ? nodes : undefined;
}

function isIdList(value: unknown): value is number[] {
  return Array.isArray(value) && value.every((id) => Number.isSafeInteger(id) && id >= 0);
}

function isTextures(value: unknown): value is EditDocumentTextures[] {
  return Array.isArray(value) && value.length <= maxTextures && value.every(isTexture);
}

function isTexture(value: unknown): boolean {
  if (!isObject(value)) return false;
  const { material, slot, image } = value;
  const named = typeof material === "string" && typeof slot === "string";
  return named && (image === null || typeof image === "string");
}

function isSection(value: unknown): value is Section {
  if (!isObject(value) || !Array.isArray(value.planes)) return false;
  const { planes, cap_color } = value;
  if (cap_color !== undefined && !isVector(cap_color)) return false;
  return planes.length <= maxPlanes && planes.every(isPlane);
}

function isPlane(value: unknown): boolean {
  if (!isObject(value)) return false;
  const { normal, offset, enabled } = value;
  return isVector(normal) && Number.isFinite(offset) && typeof enabled === "boolean";
}

function isClip(value: unknown): value is ClipState {
  if (!isObject(value)) return false;
  const { clip, seconds, rate, playing } = value;
  const numbers = typeof seconds === "number" && typeof rate === "number";
  return typeof clip === "string" && numbers && typeof playing === "boolean";
}

function isCamera(value: JsonValue | undefined): value is JsonObject & CameraPose {
  if (!isObject(value)) return false;
  const { eye, target, up, vertical_fov, name } = value;
  const pose = [eye, target, up].every(isVector) && typeof vertical_fov === "number";
  return pose && (name === null || typeof name === "string");
}

function isVector(value: unknown): value is Vector3 {
  return Array.isArray(value) && value.length === 3 && value.every(Number.isFinite);
}
