// One tooltip for all elements with data-tip: after a delay under the mouse, at once for the
// keyboard.

import { element, setText } from "./element.ts";

const delayMs = 450;
const margin = 8;
/** How soon a tip goes when what it explains does, without a movement of the pointer. */
const checkMs = 200;

export function mountTooltips(): void {
  const text = element("p");
  const facts = element("p", { class: "tip-facts" });
  const path = element("code");
  const tip = element("div", { class: "tooltip", role: "tooltip", id: "tooltip", hidden: true });
  tip.append(text, facts, path);
  document.body.append(tip);
  let timer = 0;
  let check = 0;
  let owner: HTMLElement | null = null;

  const hide = (): void => {
    clearTimeout(timer);
    clearInterval(check);
    owner?.querySelector("[aria-describedby=tooltip]")?.removeAttribute("aria-describedby");
    owner = null;
    tip.hidden = true;
  };
  const show = (target: HTMLElement, focused: Element | null): void => {
    hide();
    owner = target;
    setText(text, target.dataset.tip ?? "");
    setText(facts, target.dataset.tipFacts ?? "");
    setText(path, target.dataset.tipPath ?? "");
    facts.hidden = !facts.textContent;
    path.hidden = !path.textContent;
    tip.hidden = false;
    place(tip, target);
    check = window.setInterval(() => {
      if (target.getClientRects().length === 0) hide();
    }, checkMs);
    if (focused && focused !== target) focused.setAttribute("aria-describedby", "tooltip");
  };
  const ownerOf = (event: Event): HTMLElement | null =>
    event.target instanceof Element ? event.target.closest<HTMLElement>("[data-tip]") : null;

  document.addEventListener("pointerover", (event) => {
    if (event.pointerType !== "mouse") return;
    const target = ownerOf(event);
    if (target === owner) return;
    hide();
    if (target && event.buttons === 0) {
      timer = window.setTimeout(() => show(target, null), delayMs);
    }
  });
  document.addEventListener("focusin", (event) => {
    const target = ownerOf(event);
    const focused = event.target as Element;
    if (target && focused.matches(":focus-visible")) show(target, focused);
    else hide();
  });
  document.addEventListener("focusout", hide);
  document.addEventListener("pointerdown", hide);
  document.addEventListener("scroll", hide, true);
  document.documentElement.addEventListener("pointerleave", hide);
  addEventListener("blur", hide);
  document.addEventListener("keydown", hide);
}

/** Left of the target where there is room (the panel is at the right), otherwise above or below. */
function place(tip: HTMLElement, target: HTMLElement): void {
  const at = target.getBoundingClientRect();
  const size = tip.getBoundingClientRect();
  let left = at.left - size.width - margin;
  let top = at.top + at.height / 2 - size.height / 2;
  if (left < margin) {
    left = at.left + at.width / 2 - size.width / 2;
    top = at.top - size.height - margin;
    if (top < margin) top = at.bottom + margin;
  }
  const within = (value: number, limit: number): number =>
    Math.max(margin, Math.min(limit - margin, value));
  tip.style.left = `${within(left, innerWidth - size.width)}px`;
  tip.style.top = `${within(top, innerHeight - size.height)}px`;
}
