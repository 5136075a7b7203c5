// What rpc.discover tells of a server, as far as clients ask.

import type { JsonObject } from "./json.ts";
import { isObject } from "./settings_tree.ts";

export interface OpenRpc {
  methods: { name: string; params: { name: string; schema: JsonObject }[] }[];
  components?: JsonObject;
}

/** The values that a parameter may take; none where it is not a choice. */
export function choicesOf(document: OpenRpc, method: string, parameter: string): string[] {
  const params = document.methods.find(({ name }) => name === method)?.params ?? [];
  const schema = params.find(({ name }) => name === parameter)?.schema;
  const values = schema && isObject(schema) ? schema.enum : undefined;
  return Array.isArray(values) ? values.map(String) : [];
}
