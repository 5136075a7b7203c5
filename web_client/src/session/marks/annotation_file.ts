// Annotations in a file: written by "Save as JSON", read by "Import".

import type { Annotation, AnnotationsAddParams } from "heliograph/messages.ts";

interface AnnotationFile {
  /** That they were made in; null: the file does not tell. */
  scene: string | null;
  entries: AnnotationsAddParams[];
}

/** A file. */
type NamedText = Pick<File, "name" | "size" | "text">;

/** What became of the entries of a file. */
export interface ImportResult {
  added: number;
  /** Entries that the session had already. */
  known: number;
  /** Why the server has refused the others, by their numbers from 1. */
  refused: { entry: number; reason: string }[];
}

// Limits of annotations.add; lengths in bytes.
const maxText = 2000;
const maxAuthor = 64;
const maxFileBytes = 4 * 1024 * 1024;
/** Reasons that are told one by one. */
const toldReasons = 3;

type Json = Record<string, unknown>;

export function writeAnnotations(scene: string | null, annotations: readonly Annotation[]): Blob {
  const text = JSON.stringify({ scene, annotations }, null, 2);
  return new Blob([`${text}\n`], { type: "application/json" });
}

/** @throws Error with a sentence for the user, which names the entry and its member */
export async function readAnnotations(file: NamedText): Promise<AnnotationFile> {
  if (file.size > maxFileBytes) throw new Error(`${file.name} is larger than 4 MB`);
  return parseAnnotations(file.name, await file.text());
}

/** @throws Error as readAnnotations does */
function parseAnnotations(name: string, text: string): AnnotationFile {
  let document: unknown;
  try {
    document = JSON.parse(text);
  } catch {
    throw new Error(`${name} is no JSON document`);
  }
  const list = isObject(document) ? document.annotations : undefined;
  if (!isObject(document) || !Array.isArray(list)) {
    throw new Error(`${name} has no list "annotations", as files of "Save as JSON" have`);
  }
  if (list.length === 0) throw new Error(`${name} contains no annotations`);
  const entries = list.map((entry: unknown, index) => {
    const wrong = mistakeIn(entry);
    if (wrong) throw new Error(`${name}: annotation ${index + 1}: ${wrong}`);
    return requestOf(entry as Annotation);
  });
  return { scene: typeof document.scene === "string" ? document.scene : null, entries };
}

/** Whether both say the same at the same place. */
export function isSameAnnotation(a: AnnotationsAddParams, b: AnnotationsAddParams): boolean {
  return identity(a) === identity(b);
}

/** One sentence for the user. */
export function describeImport(
  file: string,
  { added, known, refused }: ImportResult,
  scenes: { from: string | null; shown: string },
): string {
  const parts = [`${file}: ${count(added)} added`];
  if (known > 0) parts.push(`${known} ${known === 1 ? "was" : "were"} there already`);
  if (refused.length > 0) {
    const told = refused.slice(0, toldReasons).map(({ entry, reason }) => `${entry} (${reason})`);
    if (refused.length > toldReasons) told.push(`${refused.length - toldReasons} more`);
    parts.push(`not added: ${told.join(", ")}`);
  }
  const other = scenes.from !== null && scenes.from !== scenes.shown;
  if (other) parts.push(`the file was saved in the scene ${scenes.from}, not in ${scenes.shown}`);
  return parts.join("; ");
}

function count(annotations: number): string {
  return `${annotations} ${annotations === 1 ? "annotation" : "annotations"}`;
}

function requestOf({ text, author, surface }: Annotation): AnnotationsAddParams {
  const { node, triangle, barycentrics } = surface;
  return { text, author, surface: { node, triangle, barycentrics } };
}

function identity({ text, author, surface }: AnnotationsAddParams): string {
  const { node, triangle, barycentrics } = surface;
  return JSON.stringify([text, author ?? "", node, triangle, barycentrics.map(Math.fround)]);
}

/** The first member that annotations.add would not take, and why; null: none. */
function mistakeIn(entry: unknown): string | null {
  if (!isObject(entry)) return "is not an object";
  const { text, author, surface } = entry;
  if (typeof text !== "string" || text === "") return "text must be a text that is not empty";
  if (bytesOf(text) > maxText) return `text is longer than ${maxText} bytes`;
  if (author !== undefined && typeof author !== "string") return "author must be a text";
  if (author !== undefined && bytesOf(author) > maxAuthor) {
    return `author is longer than ${maxAuthor} bytes`;
  }
  if (!isObject(surface)) return "surface is missing";
  for (const member of ["node", "triangle"]) {
    if (!isIndex(surface[member])) return `surface.${member} must be an integer from 0`;
  }
  const { barycentrics } = surface;
  const isWeight = (one: unknown): boolean => typeof one === "number" && one >= 0 && one <= 1;
  if (!Array.isArray(barycentrics) || barycentrics.length !== 3 || !barycentrics.every(isWeight)) {
    return "surface.barycentrics must be three numbers from 0 to 1";
  }
  return null;
}

function isObject(value: unknown): value is Json {
  return typeof value === "object" && value !== null && !Array.isArray(value);
}

function isIndex(value: unknown): boolean {
  return Number.isInteger(value) && (value as number) >= 0 && (value as number) < 2 ** 32;
}

function bytesOf(text: string): number {
  return new TextEncoder().encode(text).length;
}
