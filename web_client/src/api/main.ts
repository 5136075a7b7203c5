// Entry point of the page at /api: describes the methods of this server and runs examples.

import { element, setText } from "../widgets/element.ts";
import {
  code,
  createErrors,
  createFrameHeader,
  createMethod,
  createNotification,
} from "./articles.ts";
import { embedSnippet } from "../embed/snippet.ts";
import { type ApiDocument, groupsOf } from "./document.ts";

interface Chapter {
  id: string;
  title: string;
  nodes: HTMLElement[];
  /** Names below the title in the list of contents, and their addresses. */
  entries: { name: string; id: string }[];
}

const base = document.baseURI;

function find<Type extends HTMLElement>(id: string): Type {
  const node = document.getElementById(id);
  if (!node) throw new Error(`The page lacks #${id}`);
  return node as Type;
}

function connectChapter(): Chapter {
  const socket = new URL("ws", base);
  socket.protocol = socket.protocol.replace("http", "ws");
  const snippet = embedSnippet(new URL("./", base).href, "SCENE", null);
  return {
    id: "connect",
    title: "Connect",
    entries: [],
    nodes: [
      element(
        "p",
        {},
        "Calls are JSON-RPC 2.0: one in the body of ",
        code(`POST ${new URL("rpc", base).href}`),
        ", or text messages of a WebSocket at ",
        code(socket.href),
        " with the subprotocol ",
        code("heliograph.v1"),
        ", which sends frames as binary messages.",
      ),
      element(
        "p",
        {},
        "Images without any call: ",
        element("a", { href: "api/v1/sessions/main/frame.jpg" }, "frame.jpg"),
        ", ",
        element("a", { href: "api/v1/sessions/main/frame.png?width=640" }, "frame.png?width=640"),
        ", and as a stream ",
        element("a", { href: "api/v1/sessions/main/stream.mjpg" }, "stream.mjpg"),
        ".",
      ),
      element("p", {}, "In another page, which the server must allow with --frame-ancestors:"),
      element("pre", { tabindex: "0", "aria-label": "Code to embed" }, snippet),
    ],
  };
}

function sessionField(): { node: HTMLElement; value(): string } {
  const wanted = new URL(location.href).searchParams.get("session") ?? "main";
  const input = element("input", {
    id: "session",
    type: "text",
    autocomplete: "off",
    spellcheck: "false",
    value: wanted,
  });
  const node = element(
    "div",
    { class: "session" },
    element("label", { for: "session" }, "Session of the examples"),
    input,
    element(
      "p",
      {},
      "Examples run on this server and change what viewers of this session see. A session of your " +
        "own: ",
      element("a", { href: "#session.create" }, "session.create"),
      ".",
    ),
  );
  return { node, value: () => input.value.trim() };
}

function chaptersOf(api: ApiDocument, session: () => string): Chapter[] {
  const context = { base, session };
  const methods = [...groupsOf(api.methods)].map(([group, members]) => ({
    id: `group-${group || "general"}`,
    title: group || "General",
    entries: members.map(({ name }) => ({ name, id: name })),
    nodes: members.map((method) => createMethod(api, method, context)),
  }));
  const notifications = api["x-notifications"];
  return [
    connectChapter(),
    ...methods,
    {
      id: "notifications",
      title: "Notifications",
      entries: notifications.map(({ name }) => ({ name, id: `notification-${name}` })),
      nodes: notifications.map(createNotification),
    },
    { id: "frame-header", title: "Frame header", entries: [], nodes: createFrameHeader(api) },
    { id: "errors", title: "Errors", entries: [], nodes: createErrors(api) },
  ];
}

function listContents(chapters: Chapter[]): HTMLElement {
  return element(
    "ul",
    {},
    ...chapters.map(({ id, title, entries }) =>
      element(
        "li",
        {},
        element("a", { href: `#${id}` }, title),
        element(
          "ul",
          {},
          ...entries.map(({ name, id: entry }) =>
            element("li", { "data-entry": entry }, element("a", { href: `#${entry}` }, name)),
          ),
        ),
      ),
    ),
  );
}

/** Hides what does not contain all words; says how many methods and notifications do. */
function filter(typed: string): void {
  const words = typed.toLowerCase().split(/\s+/).filter(Boolean);
  let matches = 0;
  for (const section of document.querySelectorAll<HTMLElement>("#content > section")) {
    const articles = [...section.querySelectorAll<HTMLElement>("article")];
    for (const article of articles) {
      const text = `${article.dataset.method} ${article.textContent}`.toLowerCase();
      article.hidden = !words.every((word) => text.includes(word));
      const entry = document.querySelector<HTMLElement>(`[data-entry="${article.id}"]`);
      if (entry) entry.hidden = article.hidden;
      if (!article.hidden) matches += 1;
    }
    const empty = articles.every(({ hidden }) => hidden);
    section.hidden = words.length > 0 && empty;
    const link = document.querySelector(`#contents a[href="#${section.id}"]`);
    if (link?.parentElement) link.parentElement.hidden = section.hidden;
  }
  const none = "Nothing contains these words";
  const found = matches === 1 ? "1 entry" : `${matches} entries`;
  setText(find("found"), words.length === 0 ? "" : matches === 0 ? none : found);
}

async function main(): Promise<void> {
  const content = find("content");
  const response = await fetch(new URL("openrpc.json", base));
  if (!response.ok) throw new Error((await response.text()).trim());
  const api = (await response.json()) as ApiDocument;
  setText(find("version"), `version ${api.info.version}`);
  const session = sessionField();
  const chapters = chaptersOf(api, session.value);
  find("contents").append(listContents(chapters));
  content.append(
    session.node,
    ...chapters.map(({ id, title, nodes }) =>
      element("section", { id }, element("h2", {}, title), ...nodes),
    ),
  );
  const search = find<HTMLInputElement>("search");
  search.addEventListener("input", () => filter(search.value));
  if (location.hash) document.getElementById(location.hash.slice(1))?.scrollIntoView();
}

main().catch((error: Error) => {
  find("content").append(
    element("p", { class: "status bad", role: "alert" }, `The description of the API did not arrive: ${error.message}`),
  );
});
