// Short messages in a corner, which disappear after some seconds. Equal messages are not repeated.

import { element, icon, setText } from "../widgets/element.ts";

const errorMs = 8000;
const infoMs = 3500;
const maxShown = 4;

export class Toasts {
  private readonly container: HTMLElement;
  private readonly open = new Map<string, { node: HTMLElement; renew: () => void }>();

  constructor(container: HTMLElement) {
    this.container = container;
  }

  /** A message that is no error: without a warning sign, and for a shorter time. */
  inform(message: string): void {
    this.show(message, false);
  }

  show(message: string, isError = true): void {
    const known = this.open.get(message);
    if (known) {
      known.renew();
      return;
    }
    let timer = 0;
    const close = (): void => {
      clearTimeout(timer);
      node.remove();
      this.open.delete(message);
    };
    const renew = (): void => {
      clearTimeout(timer);
      timer = window.setTimeout(close, isError ? errorMs : infoMs);
    };
    const text = element("span", { class: "toast-text" });
    setText(text, message);
    const node = element(
      "div",
      {
        class: "toast",
        mouseenter: () => clearTimeout(timer),
        mouseleave: renew,
      },
      isError ? icon("warning") : null,
      text,
      element(
        "button",
        { type: "button", class: "icon-button", "aria-label": "Dismiss", click: close },
        icon("close"),
      ),
    );
    this.open.set(message, { node, renew });
    this.container.append(node);
    renew();
    if (this.open.size > maxShown) {
      const oldest = this.open.keys().next().value as string;
      this.open.get(oldest)?.node.remove();
      this.open.delete(oldest);
    }
  }
}
