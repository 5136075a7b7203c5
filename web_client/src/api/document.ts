// The parts of the server's OpenRPC document that the page shows.

import type { JsonObject, JsonValue } from "heliograph/json.ts";

interface ContentDescriptor {
  name: string;
  description?: string;
  required?: boolean;
  schema: JsonObject;
}

interface Example {
  params: { name: string; value: JsonValue }[];
  result: { value: JsonValue };
}

export interface Method {
  name: string;
  summary: string;
  params: ContentDescriptor[];
  result: { schema: JsonObject };
  errors: { $ref: string }[];
  examples: Example[];
  "x-may-be-notification": boolean;
  "x-needs-control": boolean;
  "x-read-only": boolean;
}

export interface Notification {
  name: string;
  summary: string;
  params: ContentDescriptor[];
}

interface ErrorDescription {
  code: number;
  message: string;
}

export interface ApiDocument {
  info: { version: string; description: string };
  methods: Method[];
  "x-notifications": Notification[];
  "x-frame-header": { name: string; offset: number; bytes: number; description: string }[];
  components: { errors: Record<string, ErrorDescription> };
}

/** The values of a method's example, by parameter. */
export function exampleParams(method: Method): JsonObject {
  const params = method.examples[0]?.params ?? [];
  return Object.fromEntries(params.map(({ name, value }) => [name, value]));
}

export function errorsOf(document: ApiDocument, method: Method): ErrorDescription[] {
  return method.errors
    .map(({ $ref }) => document.components.errors[$ref.slice($ref.lastIndexOf("/") + 1)])
    .filter((error) => error !== undefined);
}

/** Methods by the part of their name before the dot, in the order of the document. */
export function groupsOf<Entry extends { name: string }>(entries: Entry[]): Map<string, Entry[]> {
  const groups = new Map<string, Entry[]>();
  for (const entry of entries) {
    const group = entry.name.includes(".") ? entry.name.slice(0, entry.name.indexOf(".")) : "";
    groups.set(group, [...(groups.get(group) ?? []), entry]);
  }
  return groups;
}
