// The viewers of the session and who controls it: a card that opens from a button beside the pill.

import type { SessionInfo, ViewerInfo } from "heliograph/messages.ts";
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
  const change = element("button", { type: "button", class: "button quiet" });
  const camera = element("button", { type: "button", class: "button quiet" });
  const explanation = element("p", { class: "facts" });
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
    explanation,
    list,
    own,
    invite,
    camera,
    mode,
    change,
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
    const exclusive = viewer.membership.session.value?.control === "exclusive";
    void viewer.membership.setControl({ mode: exclusive ? "shared" : "exclusive" });
  });
  camera.addEventListener("click", () => {
    open(false);
    opener.focus();
    const { membership } = viewer;
    void (membership.looksAround ? membership.followAgain() : membership.lookAround());
  });
  change.addEventListener("click", () => {
    open(false);
    if (viewer.own.shared.value === null) viewer.own.openCopy();
    else viewer.own.joinShared();
  });
  // Without a connection the list is out of date.
  const updateVisibility = (): void => {
    const { kind } = viewer.connection.state.value;
    root.hidden = viewer.membership.session.value === null || (kind !== "live" && kind !== "connecting");
  };
  viewer.connection.state.watch(updateVisibility);
  const update = (): void => {
    updateVisibility();
    const session = viewer.membership.session.value;
    if (!session) return;
    const me = session.viewers.find(({ you }) => you);
    setText(count, String(session.viewers.length));
    opener.setAttribute("aria-label", `Participants: ${session.viewers.length}`);
    const isOwn = viewer.own.shared.value !== null;
    const others = session.viewers.length - 1;
    const { looksAround } = viewer.membership;
    setText(sessionName, nameOfSession(session, isOwn));
    setText(
      explanation,
      looksAround
        ? "Only you see this camera. Everything else follows the shared session."
        : describeSession(isOwn, others),
    );
    invite.hidden = own.hidden = list.hidden = looksAround;
    setText(camera, looksAround ? "Follow again" : "Look around on my own");
    const alone = isOwn && others === 0;
    camera.hidden = !looksAround && (alone || !viewer.capabilities.has("session.detach"));
    setText(change, isOwn ? "Join the shared session" : "Open a copy of your own");
    change.hidden = looksAround || (!isOwn && !viewer.mayCreateSessions);
    const exclusive = session.control === "exclusive";
    setText(mode, exclusive ? "Share control with all viewers" : "Take exclusive control");
    mode.hidden = looksAround || !me?.control;
    const claimed = session.viewers.some(({ control }) => control);
    list.replaceChildren(
      ...session.viewers.map((participant, index) => participantLine(participant, index)),
      ...(exclusive && !claimed && viewer.membership.controlState.value.kind !== "read_only"
        ? [takeLine()]
        : []),
    );
  };
  /** What each viewer did last, by its id. */
  const deeds = new Map<string, string>();
  viewer.membership.controlState.watch(({ kind }) => {
    opener.classList.toggle("without-control", kind !== "may_change");
  });

  const participantLine = (participant: ViewerInfo, index: number): HTMLElement => {
    const session = viewer.membership.session.value;
    const me = session?.viewers.find(({ you }) => you);
    const name = viewerName(participant, index);
    const inControl = session?.control === "exclusive" && participant.control;
    const canHandOver = session?.control === "exclusive" && me?.control && !participant.you;
    return element(
      "li",
      { "data-viewer": participant.viewer },
      element(
        "span",
        { class: "participant" },
        participant.you ? `${name} (you)` : name,
        element("span", { class: "deed" }, deeds.get(participant.viewer)),
      ),
      inControl ? element("span", { class: "in-control" }, "in control") : null,
      canHandOver
        ? button(
            `Hand over to ${name}`,
            "target",
            () => void viewer.membership.setControl({ action: "give", viewer: participant.viewer }),
          )
        : null,
    );
  };
  const takeLine = (): HTMLElement => element("li", {}, createTakeControlButton(viewer));
  viewer.membership.session.watch(update);
  viewer.own.shared.watch(update);
  viewer.capabilities.methods.watch(update);
  viewer.activity.watch((activity) => {
    if (!activity) return;
    deeds.set(activity.viewer, activity.deed);
    const shown = list.querySelector(`[data-viewer="${activity.viewer}"] .deed`);
    if (shown) setText(shown, activity.deed);
  });
}

function nameOfSession({ name, follows }: SessionInfo, isOwn: boolean): string {
  if (follows !== undefined) return `Your own view of the session ${follows}`;
  return isOwn ? "Your own session" : `Shared session ${name}`;
}

function describeSession(isOwn: boolean, others: number): string {
  if (others > 0)
    return `${others === 1 ? "Another viewer sees" : `${others} others see`} your changes.`;
  return isOwn ? "Only you see what you change." : "Viewers who join see your changes.";
}

/** A URL of the page that leads other browsers to this session. */
async function linkToJoin({ connection, hello }: Viewer): Promise<string> {
  if (!hello) throw new Error("There is no connection to the server");
  const address = await connection.address.findShareable(hello);
  const link = address.pageUrl(location.href);
  link.hash = "";
  return link.href;
}
