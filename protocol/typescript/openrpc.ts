// Reads the document of rpc.discover.

import type { JsonObject } from "./json.ts";
import { isObject } from "./settings_tree.ts";

export interface OpenRpc {
  methods: { name: string; params: { name: string; schema: JsonObject }[] }[];
  components?: JsonObject;
}

/** The values of an enumerated parameter; empty for all others. */
export function choicesOf(document: OpenRpc, method: string, parameter: string): string[] {
  const params = document.methods.find(({ name }) => name === method)?.params ?? [];
  const schema = params.find(({ name }) => name === parameter)?.schema;
  const values = schema && isObject(schema) ? schema.enum : undefined;
  return Array.isArray(values) ? values.map(String) : [];
}
