// JSON Schema as rows of a table: name, type, description.

import type { JsonObject, JsonValue } from "heliograph/json.ts";
import { isObject } from "heliograph/settings_tree.ts";

export interface MemberRow {
  /** "viewers[].name" for members of members. */
  name: string;
  type: string;
  required: boolean;
  description: string;
}

/** Deeper members are described by their type alone. */
const maxDepth = 3;

/** Every number that a double holds exactly, and every one of 32 bits: no limits worth telling. */
const widest = new Set([2 ** 53 - 1, 2 ** 32 - 1, 2 ** 31 - 1]);

/** The members of an object's schema, and theirs. */
export function memberRows(schema: JsonObject, prefix = "", depth = 0): MemberRow[] {
  const properties = isObject(schema.properties) ? schema.properties : {};
  const required = Array.isArray(schema.required) ? schema.required : [];
  return Object.entries(properties).flatMap(([key, member]) => {
    if (!isObject(member)) return [];
    const name = `${prefix}${key}`;
    const row = {
      name,
      type: typeText(member),
      required: required.includes(key),
      description: text(member.description),
    };
    const [inner, suffix] = isObject(member.items) ? [member.items, "[]."] : [member, "."];
    const below = depth + 1 < maxDepth ? memberRows(inner, name + suffix, depth + 1) : [];
    return [row, ...below];
  });
}

/** "number, 1 to 170, degrees" */
export function typeText(schema: JsonObject): string {
  if (Array.isArray(schema.enum)) return schema.enum.map((value) => String(value)).join(" | ");
  const parts = [typeName(schema), limitsText(schema), text(schema["x-unit"])];
  return parts.filter(Boolean).join(", ");
}

function typeName(schema: JsonObject): string {
  const { type } = schema;
  if (Array.isArray(type)) return type.map((one) => String(one)).join(" or ");
  if (type !== "array") return text(type) || "any";
  const length = schema.minItems === schema.maxItems ? ` of ${text(schema.minItems)}` : "";
  const items = isObject(schema.items) ? typeName(schema.items) : "any";
  return `array${length}${length ? "" : " of"} ${plural(items)}`;
}

const plural = (noun: string): string => (noun === "any" ? "values" : `${noun}s`);

function limitsText({ minimum, maximum, minLength, maxLength }: JsonObject): string {
  if (typeof maxLength === "number") return `${text(minLength) || 0} to ${maxLength} characters`;
  const unlimited = typeof maximum === "number" && widest.has(maximum);
  const upper = unlimited ? undefined : maximum;
  if (typeof minimum === "number" && typeof upper === "number") return `${minimum} to ${upper}`;
  if (typeof minimum === "number") return `at least ${minimum}`;
  return typeof upper === "number" ? `at most ${upper}` : "";
}

function text(value: JsonValue | undefined): string {
  return typeof value === "string" || typeof value === "number" ? String(value) : "";
}
