// Calls of the examples: against this server, and as text for other programs.

import type { JsonValue } from "heliograph/json.ts";

export interface Answer {
  /** Null where the server answers with an error. */
  result: JsonValue | null;
  error: { code: number; message: string } | null;
  milliseconds: number;
}

/** The session of the examples, as in the addresses of other clients. */
function rpcAddress(base: string, session: string): URL {
  const url = new URL("rpc", base);
  if (session && session !== "main") url.searchParams.set("session", session);
  return url;
}

/** @throws TypeError where no server answers, Error for an answer that is no JSON-RPC */
export async function call(
  base: string,
  session: string,
  method: string,
  params: JsonValue,
): Promise<Answer> {
  const started = performance.now();
  const response = await fetch(rpcAddress(base, session), {
    method: "POST",
    headers: { "content-type": "application/json" },
    body: JSON.stringify({ jsonrpc: "2.0", id: 1, method, params }),
  });
  const body = await response.text();
  const milliseconds = performance.now() - started;
  if (!response.headers.get("content-type")?.includes("json")) {
    throw new Error(body.trim() || `The server answered with HTTP ${response.status}`);
  }
  const answer = JSON.parse(body) as Partial<Answer>;
  return { result: answer.result ?? null, error: answer.error ?? null, milliseconds };
}

/** A command for a shell. */
export function curlCommand(base: string, session: string, method: string, params: JsonValue) {
  const message = JSON.stringify({ jsonrpc: "2.0", id: 1, method, params });
  const quoted = `'${message.replaceAll("'", `'\\''`)}'`;
  return `curl -H 'Content-Type: application/json' -d ${quoted} '${rpcAddress(base, session).href}'`;
}

/** A program for the package heliograph. */
export function pythonProgram(base: string, session: string, method: string, params: JsonValue) {
  const { origin } = new URL(base);
  const joins = session && session !== "main" ? `, session=${JSON.stringify(session)}` : "";
  const values = Object.entries(params as Record<string, JsonValue>)
    .map(([name, value]) => `${name}=${pythonValue(value)}`)
    .join(", ");
  return [
    "import heliograph",
    "",
    `with heliograph.connect("${origin}"${joins}) as view:`,
    `    print(view.${method}(${values}))`,
  ].join("\n");
}

function pythonValue(value: JsonValue): string {
  if (value === null) return "None";
  if (typeof value === "boolean") return value ? "True" : "False";
  if (Array.isArray(value)) return `[${value.map(pythonValue).join(", ")}]`;
  if (typeof value !== "object") return JSON.stringify(value);
  const members = Object.entries(value).filter(([, member]) => member !== undefined);
  return `{${members.map(([key, member]) => `${JSON.stringify(key)}: ${pythonValue(member as JsonValue)}`).join(", ")}}`;
}
