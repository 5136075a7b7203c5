// The viewers of the session and who controls it: a card that opens from a button beside the pill.

import type { SessionInfo, ViewerInfo } from "heliograph/messages.ts";
import { copyText } from "../common/clipboard.ts";
import { participantName, setParticipantName } from "../common/preferences.ts";
import type { Companion } from "../session/company/company.ts";
import { viewerName } from "../session/control_state.ts";
import type { Viewer } from "../session/viewer.ts";
import { button, element, icon, setText } from "../widgets/element.ts";
import { field } from "../widgets/field.ts";
import { createTakeControlButton } from "../widgets/take_control_button.ts";
import { colourOfViewer, nameOfViewer } from "./viewer_identity.ts";

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
  const pointer = pointerField(viewer);
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
    pointer,
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
    if (shown) void viewer.company.read();
  };
  addEventListener("pointerdown", (event) => {
    if (!root.contains(event.target as Node)) open(false);
  });
  root.addEventListener("keydown", (event) => {
    if (event.key !== "Escape" || card.hidden) return;
    event.preventDefault();
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
    const elsewhere = viewer.company.elsewhere.value;
    const all = session.viewers.length + elsewhere.length;
    setText(count, String(all));
    opener.setAttribute("aria-label", `Participants: ${all}`);
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
    invite.hidden = own.hidden = looksAround;
    list.hidden = looksAround && elsewhere.length === 0;
    pointer.hidden = !viewer.capabilities.has("pointer.set");
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
      ...elsewhere.map(companionLine),
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
      colourDot(participant.viewer),
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
  /** A viewer with another camera, which can be followed. */
  const companionLine = ({ viewer: id, looksAround }: Companion): HTMLElement => {
    const { membership, capabilities } = viewer;
    const name = nameOfViewer(viewer, id);
    const isFollowed = membership.following.value?.viewer === id;
    const canFollow =
      looksAround && capabilities.has("viewer.follow") && capabilities.has("session.detach");
    const toggle = (): void => {
      open(false);
      opener.focus();
      if (isFollowed) membership.stopFollowing();
      else void membership.follow({ viewer: id, name });
    };
    const label = isFollowed ? `Stop following ${name}` : `Follow ${name}`;
    return element(
      "li",
      { "data-viewer": id },
      colourDot(id),
      element(
        "span",
        { class: "participant" },
        name,
        element("span", { class: "deed" }, looksAround ? "looks around" : ""),
      ),
      canFollow ? button(label, isFollowed ? "close" : "eye", toggle) : null,
    );
  };
  const takeLine = (): HTMLElement => element("li", {}, createTakeControlButton(viewer));
  viewer.membership.session.watch(update);
  viewer.own.shared.watch(update);
  viewer.company.elsewhere.watch(update);
  viewer.membership.following.watch(update);
  viewer.capabilities.methods.watch(update);
  viewer.activity.watch((activity) => {
    if (!activity) return;
    deeds.set(activity.viewer, activity.deed);
    const shown = list.querySelector(`[data-viewer="${activity.viewer}"] .deed`);
    if (shown) setText(shown, activity.deed);
  });
}

/** Whether others see this page's pointer. */
function pointerField({ company: { pointers } }: Viewer): HTMLElement {
  const box = element("input", {
    type: "checkbox",
    role: "switch",
    class: "switch",
    name: "pointer",
    change: () => pointers.share(box.checked),
  });
  pointers.shared.watch((shared) => (box.checked = shared));
  return field("Show my pointer", box);
}

function colourDot(viewer: string): HTMLElement {
  const dot = element("span", { class: "viewer-colour", "aria-hidden": "true" });
  dot.style.background = colourOfViewer(viewer);
  return dot;
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
