// Who watches with us and who may change things: a list that opens from the pill.

import type { ViewerInfo } from "heliograph/messages.ts";
import { copyText } from "../output.ts";
import { button, element, icon, setText } from "../panel/element.ts";
import { preferences } from "../preferences.ts";
import { nameOf } from "../standing.ts";
import type { Viewer } from "../viewer.ts";

const nameKey = "name";

export function mountPeople(
  viewer: Viewer,
  root: HTMLElement,
  tell: (message: string) => void,
): void {
  const count = element("span", { class: "people-count" });
  const list = element("ul", { class: "people-list", "aria-label": "Who is here" });
  const room = element("p", { class: "facts" });
  const own = element("input", {
    type: "text",
    name: "person",
    "aria-label": "Your name",
    placeholder: "Your name",
    maxlength: "64",
    change: () => {
      preferences.setText(nameKey, own.value.trim());
      viewer.connection.reintroduce();
    },
  });
  own.value = preferences.text(nameKey, "");
  const mode = element("button", { type: "button", class: "button quiet" });
  const invite = element(
    "button",
    {
      type: "button",
      class: "button",
      click: () => {
        void linkToJoin(viewer)
          .then(copyText)
          .then(() => tell("The link to join is in the clipboard"))
          .catch((error: unknown) => viewer.report(error));
      },
    },
    "Copy link to join",
  );
  const card = element(
    "div",
    { class: "people-card", id: "people-card", hidden: true },
    room,
    list,
    own,
    invite,
    mode,
  );
  const opener = element(
    "button",
    {
      type: "button",
      class: "people-button",
      "aria-expanded": "false",
      "aria-controls": card.id,
      "aria-label": "Who is here",
      "data-tip": "Who is here, and who may change things",
      click: () => open(card.hidden),
    },
    icon("people"),
    count,
  );
  const open = (shown: boolean): void => {
    card.hidden = !shown;
    opener.setAttribute("aria-expanded", String(shown));
  };
  addEventListener("pointerdown", (event) => {
    if (!root.contains(event.target as Node)) open(false);
  });
  root.addEventListener("keydown", (event) => {
    if (event.key !== "Escape" || card.hidden) return;
    open(false);
    opener.focus();
  });
  root.append(opener, card);

  mode.addEventListener("click", () => {
    const one = viewer.session.value?.control === "one";
    void viewer.control({ mode: one ? "everyone" : "one" });
  });
  // Who was here last means nothing to who is not here.
  const appear = (): void => {
    const { kind } = viewer.connection.state.value;
    root.hidden = viewer.session.value === null || (kind !== "live" && kind !== "connecting");
  };
  viewer.connection.state.watch(appear);
  viewer.session.watch((session) => {
    appear();
    if (!session) return;
    const me = session.viewers.find(({ you }) => you);
    setText(count, String(session.viewers.length));
    opener.setAttribute("aria-label", `Who is here: ${session.viewers.length}`);
    setText(room, `Session ${session.name}`);
    const one = session.control === "one";
    setText(mode, one ? "Let everyone change things" : "Only I change things");
    mode.hidden = !me?.control;
    const taken = session.viewers.some((person) => person.control);
    list.replaceChildren(
      ...session.viewers.map((person, index) => personLine(person, index)),
      ...(one && !taken && viewer.standing.value.kind !== "watching" ? [takeLine()] : []),
    );
  });
  viewer.standing.watch(({ kind }) => {
    opener.classList.toggle("without-control", kind !== "may_change");
  });

  const personLine = (person: ViewerInfo, index: number): HTMLElement => {
    const session = viewer.session.value;
    const me = session?.viewers.find(({ you }) => you);
    const name = nameOf(person, index);
    const inControl = session?.control === "one" && person.control;
    const givable = session?.control === "one" && me?.control && !person.you;
    return element(
      "li",
      {},
      element("span", { class: "person" }, person.you ? `${name} (you)` : name),
      inControl ? element("span", { class: "in-control" }, "in control") : null,
      givable
        ? button(`Hand over to ${name}`, "target", () =>
            void viewer.control({ action: "give", viewer: person.viewer }),
          )
        : null,
    );
  };
  const takeLine = (): HTMLElement => element("li", {}, takeButton(viewer));
}

/** Takes the place that nobody has. */
export function takeButton(viewer: Viewer): HTMLButtonElement {
  return element(
    "button",
    {
      type: "button",
      class: "button quiet",
      click: () => void viewer.control({ action: "take" }),
    },
    "Take control",
  );
}

/** What this person is called, as far as they said. */
export function ownName(): string | undefined {
  return preferences.text(nameKey, "") || undefined;
}

/** The page's address as it leads everybody to the session that is watched here. */
async function linkToJoin({ connection, hello }: Viewer): Promise<string> {
  if (!hello) throw new Error("There is no session to join at the moment");
  const place = await connection.place.shareable(hello);
  const link = place.addressOfPage(location.href);
  link.hash = "";
  return link.href;
}
