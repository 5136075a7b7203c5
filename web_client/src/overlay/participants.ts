// Who watches with us and who may change things: a list that opens from the pill.

import type { ViewerInfo } from "heliograph/messages.ts";
import { copyText } from "../common/clipboard.ts";
import { button, element, icon, setText } from "../widgets/element.ts";
import { createTakeControlButton } from "../widgets/take_control_button.ts";
import { participantName, setParticipantName } from "../common/preferences.ts";
import { nameOf } from "../session/control_state.ts";
import type { Viewer } from "../session/viewer.ts";

export function mountParticipants(
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
      setParticipantName(own.value);
      viewer.connection.reintroduce();
    },
  });
  own.value = participantName() ?? "";
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
      ...(one && !taken && viewer.controlState.value.kind !== "watching" ? [takeLine()] : []),
    );
  });
  viewer.controlState.watch(({ kind }) => {
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
  const takeLine = (): HTMLElement => element("li", {}, createTakeControlButton(viewer));
}

/** The page's address as it leads everybody to the session that is watched here. */
async function linkToJoin({ connection, hello }: Viewer): Promise<string> {
  if (!hello) throw new Error("There is no session to join at the moment");
  const place = await connection.place.findShareable(hello);
  const link = place.pageUrl(location.href);
  link.hash = "";
  return link.href;
}
