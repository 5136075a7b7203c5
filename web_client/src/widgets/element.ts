// Helpers to build DOM trees.

type Attributes = Record<string, string | boolean | ((event: never) => void) | undefined>;
type Child = Node | string | null | undefined;

/** Creates an element. Functions become listeners, true an empty attribute, false no attribute. */
export function element<Name extends keyof HTMLElementTagNameMap>(
  name: Name,
  attributes: Attributes = {},
  ...children: Child[]
): HTMLElementTagNameMap[Name] {
  const node = document.createElement(name);
  for (const [key, value] of Object.entries(attributes)) {
    if (typeof value === "function") node.addEventListener(key, value as EventListener);
    else if (value === true) node.setAttribute(key, "");
    else if (typeof value === "string") node.setAttribute(key, value);
  }
  node.append(...children.filter((child): child is Node | string => child != null));
  return node;
}

/** One of the symbols defined in index.html. */
export function icon(name: string): SVGSVGElement {
  const namespace = "http://www.w3.org/2000/svg";
  const svg = document.createElementNS(namespace, "svg");
  svg.setAttribute("class", "icon");
  svg.setAttribute("aria-hidden", "true");
  const use = document.createElementNS(namespace, "use");
  use.setAttribute("href", `#icon-${name}`);
  svg.append(use);
  return svg;
}

export function button(
  label: string,
  iconName: string,
  action: (event: MouseEvent) => void,
): HTMLButtonElement {
  return element(
    "button",
    { type: "button", class: "icon-button", "aria-label": label, "data-tip": label, click: action },
    icon(iconName),
  );
}

/** Replaces text only if it differs, so that unchanged text causes no layout. */
export function setText(node: Element, text: string): void {
  if (node.textContent !== text) node.textContent = text;
}

let lastId = 0;
export function uniqueId(prefix: string): string {
  lastId += 1;
  return `${prefix}-${lastId}`;
}

/** Sets the options of a select and keeps its value; does nothing if they are unchanged. */
export function setOptions(
  select: HTMLSelectElement,
  options: { value: string; label: string; disabled?: boolean }[],
): void {
  const signature = JSON.stringify(options);
  if (select.dataset.options === signature) return;
  select.dataset.options = signature;
  const current = select.value;
  select.replaceChildren(
    ...options.map(({ value, label, disabled }) =>
      element("option", { value, disabled: disabled === true }, label),
    ),
  );
  select.value = current;
}
