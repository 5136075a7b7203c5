// Whether a node has a place on the page.

/** Reports it when it changes: it is not shown while the node, a fold or the page is hidden. */
export function watchShown(node: HTMLElement, report: (shown: boolean) => void): void {
  let before = false;
  const update = (): void => {
    const shown = !document.hidden && node.getClientRects().length > 0;
    if (shown !== before) report(shown);
    before = shown;
  };
  new ResizeObserver(update).observe(node);
  document.addEventListener("visibilitychange", update);
}
