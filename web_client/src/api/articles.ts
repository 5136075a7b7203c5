// The articles of the page: methods, notifications, frame header, errors.

import { element } from "../widgets/element.ts";
import {
  type ApiDocument,
  type Method,
  type Notification,
  errorsOf,
  exampleParams,
} from "./document.ts";
import { type ExampleContext, createExample } from "./example.ts";
import { type MemberRow, memberRows, typeText } from "./schema_text.ts";

type Cell = string | Node;

export const code = (text: string): HTMLElement => element("code", {}, text);

/** Text in which names stand between grave accents. */
function prose(text: string): HTMLElement {
  const parts = text.split("`").map((part, index) => (index % 2 === 1 ? code(part) : part));
  return element("span", {}, ...parts);
}

function table(caption: string, columns: string[], rows: Cell[][]): HTMLElement {
  const head = columns.map((column) => element("th", { scope: "col" }, column));
  return element(
    "div",
    { class: "table", tabindex: "0", role: "region", "aria-label": caption },
    element(
      "table",
      {},
      element("caption", {}, caption),
      element("thead", {}, element("tr", {}, ...head)),
      element(
        "tbody",
        {},
        ...rows.map(([first, ...others]) =>
          element(
            "tr",
            {},
            element("th", { scope: "row" }, first),
            ...others.map((cell) => element("td", {}, cell)),
          ),
        ),
      ),
    ),
  );
}

function memberTable(caption: string, rows: MemberRow[]): HTMLElement {
  return table(
    caption,
    ["Name", "Type", "Description"],
    rows.map(({ name, type, required, description }) => [
      element("span", {}, code(name), required ? element("span", { class: "needed" }, "required") : null),
      type,
      prose(description),
    ]),
  );
}

function paramRows(params: Method["params"]): MemberRow[] {
  return params.flatMap(({ name, description, required, schema }) => {
    const row = { name, type: typeText(schema), required: required === true };
    return [{ ...row, description: description ?? "" }, ...memberRows(schema, `${name}.`, 1)];
  });
}

function labels(method: Method): HTMLElement[] {
  return [
    method["x-read-only"] ? "for view tokens, too" : "needs a control token",
    method["x-needs-control"] ? "needs control of the session" : "",
    method["x-may-be-notification"] ? "also without an answer" : "",
  ]
    .filter(Boolean)
    .map((label) => element("li", {}, label));
}

export function createMethod(
  document: ApiDocument,
  method: Method,
  context: ExampleContext,
): HTMLElement {
  const params = paramRows(method.params);
  const result = memberRows(method.result.schema);
  const errors = errorsOf(document, method);
  return element(
    "article",
    { id: method.name, "data-method": method.name },
    element("h3", {}, element("a", { href: `#${method.name}` }, method.name)),
    element("p", {}, prose(method.summary)),
    element("ul", { class: "labels" }, ...labels(method)),
    params.length > 0
      ? memberTable("Parameters", params)
      : element("p", { class: "none" }, "No parameters."),
    result.length > 0
      ? element("details", {}, element("summary", {}, "Result"), memberTable("Members of the result", result))
      : null,
    element(
      "details",
      {},
      element("summary", {}, "Errors"),
      table(
        "Errors of this method",
        ["Code", "Meaning"],
        errors.map(({ code: number, message }) => [code(String(number)), message]),
      ),
    ),
    createExample(context, method.name, exampleParams(method)),
  );
}

export function createNotification({ name, summary, params }: Notification): HTMLElement {
  const rows = paramRows(params);
  return element(
    "article",
    { id: `notification-${name}`, "data-method": name },
    element("h3", {}, element("a", { href: `#notification-${name}` }, name)),
    element("p", {}, summary),
    rows.length > 0
      ? element("details", {}, element("summary", {}, "Members"), memberTable("Members", rows))
      : null,
  );
}

export function createFrameHeader(document: ApiDocument): HTMLElement[] {
  return [
    element(
      "p",
      {},
      "Every binary message of the WebSocket is an encoded frame after this header, little-endian. " +
        "The payload starts at header_bytes; skip fields you do not know.",
    ),
    table(
      "Fields of the frame header",
      ["Field", "Offset", "Bytes", "Meaning"],
      document["x-frame-header"].map(({ name, offset, bytes, description }) => [
        code(name),
        String(offset),
        String(bytes),
        description,
      ]),
    ),
  ];
}

export function createErrors(document: ApiDocument): HTMLElement[] {
  return [
    element(
      "p",
      {},
      "A refused call is answered with a code, a sentence for users in message, and in data the " +
        "parameter (path), what is wrong with it (reason) and what would be valid (limit).",
    ),
    table(
      "Codes of errors",
      ["Code", "Name", "Meaning"],
      Object.entries(document.components.errors)
        .sort(([, a], [, b]) => b.code - a.code)
        .map(([name, { code: number, message }]) => [code(String(number)), name, message]),
    ),
  ];
}
