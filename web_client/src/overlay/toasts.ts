// Short messages that come and go in a corner. The same message is not stacked twice.

import { element, icon, setText } from "../widgets/element.ts";

const shownMs = 8000;
const quietMs = 3500;
const mostAtOnce = 4;

export class Toasts {
  private readonly container: HTMLElement;
  private readonly open = new Map<string, { node: HTMLElement; renew: () => void }>();

  constructor(container: HTMLElement) {
    this.container = container;
  }

  /** Something went well or is under way: quieter, and gone sooner. */
  tell(message: string): void {
    this.show(message, true);
  }

  show(message: string, quiet = false): void {
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
      timer = window.setTimeout(close, quiet ? quietMs : shownMs);
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
      quiet ? null : icon("warning"),
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
    if (this.open.size > mostAtOnce) {
      const oldest = this.open.keys().next().value as string;
      this.open.get(oldest)?.node.remove();
      this.open.delete(oldest);
    }
  }
}
