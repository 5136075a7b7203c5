// Short messages in a corner. News disappear after some seconds; errors stay until they are
// dismissed or settled, at most for `errorMs`. Equal messages are not repeated.

import { element, icon } from "../widgets/element.ts";

const errorMs = 45_000;
const leastInfoMs = 4000;
const infoMsPerLetter = 60;
const maxShown = 4;

interface ToastOptions {
  /** A later message of the same topic replaces this one, and `settle` removes it. */
  topic?: string | undefined;
  /** Fine print below the message. */
  detail?: string;
}

interface Toast {
  node: HTMLElement;
  /** Starts its time again. */
  renew(): void;
  close(): void;
}

export class Toasts {
  private readonly container: HTMLElement;
  /** By topic or, without one, by text. */
  private readonly open = new Map<string, Toast & { message: string }>();

  constructor(container: HTMLElement) {
    this.container = container;
  }

  /** A message that is no error: without a warning sign, and for a shorter time. */
  inform(message: string, options: ToastOptions = {}): void {
    this.add(message, false, options);
  }

  show(message: string, options: ToastOptions = {}): void {
    this.add(message, true, options);
  }

  /** What the messages of this topic were about is over. */
  settle(topic: string): void {
    this.open.get(topic)?.close();
  }

  private add(message: string, isError: boolean, { topic, detail }: ToastOptions): void {
    const key = topic ?? message;
    const known = this.open.get(key);
    if (known?.message === message) {
      known.renew();
      return;
    }
    const lastsMs = isError ? errorMs : leastInfoMs + infoMsPerLetter * message.length;
    const toast = createToast({ message, detail, isError, lastsMs }, () => this.open.delete(key));
    if (known) {
      known.node.replaceWith(toast.node);
      known.close();
    } else {
      this.container.append(toast.node);
    }
    this.open.set(key, { ...toast, message });
    toast.renew();
    if (this.open.size > maxShown) this.open.values().next().value?.close();
  }
}

interface ToastContent {
  message: string;
  detail: string | undefined;
  isError: boolean;
  lastsMs: number;
}

function createToast(content: ToastContent, closed: () => void): Toast {
  const { message, detail, isError, lastsMs } = content;
  let timer = 0;
  const close = (): void => {
    clearTimeout(timer);
    node.remove();
    closed();
  };
  const renew = (): void => {
    clearTimeout(timer);
    timer = window.setTimeout(close, lastsMs);
  };
  const stay = (): void => clearTimeout(timer);
  const node = element(
    "div",
    {
      class: "toast",
      role: isError ? "alert" : undefined,
      mouseenter: stay,
      mouseleave: renew,
      focusin: stay,
      focusout: renew,
    },
    isError ? icon("warning") : null,
    element("span", { class: "toast-text" }, message, detail ? element("small", {}, detail) : null),
    element(
      "button",
      { type: "button", class: "icon-button", "aria-label": "Dismiss", click: close },
      icon("close"),
    ),
  );
  return { node, renew, close };
}
