// Code that shows this viewer in another page.

/** The attribute values of HTML. */
function attribute(text: string): string {
  return text.replaceAll("&", "&amp;").replaceAll('"', "&quot;");
}

/** The address of the page without a fragment and without what leads to a session of its own. */
function serverOf(page: string): string {
  const url = new URL(page);
  url.hash = "";
  return url.href;
}

/**
 * The web component and its script. `model`: the scene's name; `view`: the fragment of a link to a
 * view, which tells more than the model.
 */
export function embedSnippet(page: string, model: string, view: string | null): string {
  const server = serverOf(page);
  const script = new URL("heliograph-viewer.js", server).href;
  const shown = view ? ` view="${attribute(view)}"` : "";
  return [
    `<script type="module" src="${attribute(script)}"></script>`,
    `<heliograph-viewer src="${attribute(server)}" model="${attribute(model)}"${shown}`,
    `  style="width: 960px; height: 540px"></heliograph-viewer>`,
  ].join("\n");
}

/** A frame for pages that run no scripts of other sites. */
export function frameSnippet(link: string, title: string): string {
  return (
    `<iframe src="${attribute(link)}" title="${attribute(title)}" width="960" height="540"\n` +
    `  style="border:0" allow="fullscreen; clipboard-write"></iframe>`
  );
}
