// The viewers of the session and who controls it: a card that opens from a button beside the pill.

import type { ViewerInfo } from "heliograph/messages.ts";
import { copyText } from "../common/clipboard.ts";
import { participantName, setParticipantName } from "../common/preferences.ts";
import { viewerName } from "../session/control_state.ts";
import type { Viewer } from "../session/viewer.ts";
import { button, element, icon, setText } from "../widgets/element.ts";
import { createTakeControlButton } from "../widgets/take_control_button.ts";

export function mountParticipants(
  viewer: Viewer,
  root: HTMLElement,
  inform: (message: string) => void,
): void {
  const count = element("span", { class: "participants-count" });
  const list = element("ul", { class: "participants-list", "aria-label": "Participants" });
  const sessionName = element("p", { class: "facts" });
  const own = element("input", {
    type: "text",
    name: "participant",
    "aria-label": "Your name",
    placeholder: "Your name",
    maxlength: "64",
    change: () => {
      setParticipantName(own.value);
      viewer.connection.updateName();
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
          .then(() => inform("Link to join copied to the clipboard"))
          .catch((error: unknown) => viewer.report(error));
      },
    },
    "Copy link to join",
  );
  const card = element(
    "div",
    { class: "participants-card", id: "participants-card", hidden: true },
    sessionName,
    list,
    own,
    invite,
    mode,
  );
  const opener = element(
    "button",
    {
      type: "button",
      class: "participants-button",
      "aria-expanded": "false",
      "aria-controls": card.id,
      "aria-label": "Participants",
      "data-tip": "Participants and control of the session",
      click: () => open(card.hidden),
    },
    icon("participants"),
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
    const exclusive = viewer.session.value?.control === "exclusive";
    void viewer.setControl({ mode: exclusive ? "shared" : "exclusive" });
  });
  // Without a connection the list is out of date.
  const updateVisibility = (): void => {
    const { kind } = viewer.connection.state.value;
    root.hidden = viewer.session.value === null || (kind !== "live" && kind !== "connecting");
  };
  viewer.connection.state.watch(updateVisibility);
  viewer.session.watch((session) => {
    updateVisibility();
    if (!session) return;
    const me = session.viewers.find(({ you }) => you);
    setText(count, String(session.viewers.length));
    opener.setAttribute("aria-label", `Participants: ${session.viewers.length}`);
    setText(sessionName, `Session ${session.name}`);
    const exclusive = session.control === "exclusive";
    setText(mode, exclusive ? "Share control with all viewers" : "Take exclusive control");
    mode.hidden = !me?.control;
    const claimed = session.viewers.some(({ control }) => control);
    list.replaceChildren(
      ...session.viewers.map((participant, index) => participantLine(participant, index)),
      ...(exclusive && !claimed && viewer.controlState.value.kind !== "read_only"
        ? [takeLine()]
        : []),
    );
  });
  viewer.controlState.watch(({ kind }) => {
    opener.classList.toggle("without-control", kind !== "may_change");
  });

  const participantLine = (participant: ViewerInfo, index: number): HTMLElement => {
    const session = viewer.session.value;
    const me = session?.viewers.find(({ you }) => you);
    const name = viewerName(participant, index);
    const inControl = session?.control === "exclusive" && participant.control;
    const canHandOver = session?.control === "exclusive" && me?.control && !participant.you;
    return element(
      "li",
      {},
      element("span", { class: "participant" }, participant.you ? `${name} (you)` : name),
      inControl ? element("span", { class: "in-control" }, "in control") : null,
      canHandOver
        ? button(
            `Hand over to ${name}`,
            "target",
            () => void viewer.setControl({ action: "give", viewer: participant.viewer }),
          )
        : null,
    );
  };
  const takeLine = (): HTMLElement => element("li", {}, createTakeControlButton(viewer));
}

/** A URL of the page that leads other browsers to this session. */
async function linkToJoin({ connection, hello }: Viewer): Promise<string> {
  if (!hello) throw new Error("There is no connection to the server");
  const address = await connection.address.findShareable(hello);
  const link = address.pageUrl(location.href);
  link.hash = "";
  return link.href;
}
