// <heliograph-viewer src="https://server/" model="helmet">: the viewer of a Heliograph server in
// another page. Needs nothing but this file; what is inside the element is shown until the viewer
// has a frame, and if it gets none.
//
//   src    address of the server
//   model  name of the scene to show, in a session of the viewer's own
//   view   the fragment of a copied link: scene, camera, settings and materials
//   label  name of the frame for screen readers
//
// Events: "ready" when the first frame is shown, "failed" when the server does not answer or does
// not allow this page (its option --frame-ancestors).

const answerTimeoutMs = 15_000;

const style = `
  :host { display: block; position: relative; width: 100%; aspect-ratio: 16 / 9; overflow: hidden; }
  :host([hidden]) { display: none; }
  iframe { position: absolute; inset: 0; width: 100%; height: 100%; border: 0; }
  iframe:not(.ready) { visibility: hidden; }
  .waiting { display: grid; place-items: center; width: 100%; height: 100%; }
  p { margin: 1rem; font: 14px/1.4 system-ui, sans-serif; text-align: center; }
`;

class HeliographViewer extends HTMLElement {
  static readonly observedAttributes = ["src", "model", "view", "label"];

  private readonly frame = document.createElement("iframe");
  private readonly message = document.createElement("p");
  private timer = 0;

  constructor() {
    super();
    const root = this.attachShadow({ mode: "open" });
    // A constructed sheet, because the page's policy may forbid style elements.
    const sheet = new CSSStyleSheet();
    sheet.replaceSync(style);
    root.adoptedStyleSheets = [sheet];
    this.frame.allow = "fullscreen; clipboard-write";
    this.message.hidden = true;
    this.message.setAttribute("role", "alert");
    const waiting = document.createElement("div");
    waiting.className = "waiting";
    waiting.append(document.createElement("slot"), this.message);
    root.append(waiting, this.frame);
  }

  connectedCallback(): void {
    addEventListener("message", this.received);
    this.show();
  }

  disconnectedCallback(): void {
    removeEventListener("message", this.received);
    clearTimeout(this.timer);
  }

  attributeChangedCallback(): void {
    if (this.isConnected) this.show();
  }

  /** Loads the viewer; where only the view differs, it goes there without being loaded again. */
  private show(): void {
    this.frame.title = this.getAttribute("label") ?? this.getAttribute("model") ?? "Heliograph";
    const address = this.address();
    if (!address) return this.fail("src is not the address of a Heliograph server.");
    if (this.frame.src === address) return;
    const [page] = address.split("#");
    const sameServer = this.frame.src.split("#")[0] === page;
    this.frame.src = address;
    if (sameServer && this.frame.classList.contains("ready")) return;
    this.frame.classList.remove("ready");
    this.message.hidden = true;
    clearTimeout(this.timer);
    const { origin } = new URL(address);
    this.timer = window.setTimeout(() => {
      this.fail(`${origin} does not answer, or does not allow this page to show it.`);
    }, answerTimeoutMs);
  }

  private address(): string | null {
    try {
      const url = new URL(this.getAttribute("src") ?? "", document.baseURI);
      if (!this.hasAttribute("src") || !url.protocol.startsWith("http")) return null;
      const view = this.getAttribute("view")?.replace(/^#/, "");
      const model = this.getAttribute("model");
      if (view) url.hash = view;
      else if (model) url.hash = new URLSearchParams({ model }).toString();
      return url.href;
    } catch {
      return null;
    }
  }

  private fail(sentence: string): void {
    clearTimeout(this.timer);
    this.message.textContent = sentence;
    this.message.hidden = false;
    this.dispatchEvent(new CustomEvent("failed", { detail: sentence }));
  }

  private readonly received = ({ source, data }: MessageEvent): void => {
    if (source !== this.frame.contentWindow) return;
    const { heliograph } = (data ?? {}) as { heliograph?: string };
    if (heliograph === "connected") {
      clearTimeout(this.timer);
    } else if (heliograph === "ready" && !this.frame.classList.contains("ready")) {
      clearTimeout(this.timer);
      this.message.hidden = true;
      this.frame.classList.add("ready");
      this.dispatchEvent(new CustomEvent("ready"));
    }
  };
}

customElements.define("heliograph-viewer", HeliographViewer);
