// What this page asks of its stream: size, quality, codec, and a fresh start where video broke.

import type { Hello, StreamSettings } from "heliograph/messages.ts";
import type { RpcPeer } from "heliograph/rpc.ts";
import { preferences } from "../common/preferences.ts";
import { Signal } from "../common/signal.ts";

export interface FrameSize {
  width: number;
  height: number;
}

/** Video that breaks this often, with fewer good pictures between, is given up. */
const mostBreaks = 3;
const goodPictures = 60;

export interface StreamHost {
  /** Whether the size, which all viewers share, is this page's to choose. */
  mayResize(): boolean;
  report(error: unknown): void;
  tell(sentence: string): void;
}

export class StreamRequests {
  /** What is in effect, as the server said last. */
  readonly settings = new Signal<StreamSettings | null>(null);
  /** The size of picture that suits the view and this server. */
  chooseSize: (hello: Hello) => FrameSize = () => ({ width: 640, height: 360 });
  private readonly rpc: RpcPeer;
  private readonly host: StreamHost;
  private hello: Hello | null = null;
  private asked: FrameSize | null = null;
  private wanted: Partial<StreamSettings> = {};
  private breaks = 0;
  private goodSince = 0;
  /** The server sends from its hello on, so that a video can break before anything can be asked. */
  private brokeEarly = false;

  constructor(rpc: RpcPeer, host: StreamHost) {
    this.rpc = rpc;
    this.host = host;
  }

  /** Asks for everything on a new connection; `unseen` holds the pictures back at first. */
  async begin(hello: Hello, unseen: boolean): Promise<void> {
    this.hello = hello;
    this.asked = null;
    const anew = this.brokeEarly;
    this.brokeEarly = false;
    const codec = preferences.text("codec", isLocal() ? "jpeg" : "h264");
    const coded = hello.codecs.length > 1 && hello.codecs.includes(codec) ? { codec } : {};
    const paused = unseen || anew ? { paused: true } : {};
    await this.configure({ ...this.wanted, ...this.size(), ...coded, ...paused });
    if (anew && !unseen) await this.show();
  }

  end(): void {
    this.hello = null;
    this.breaks = 0;
    this.brokeEarly = false;
  }

  /** Lets pictures come that `begin` held back, unless nobody looks at the page. */
  async show(): Promise<void> {
    await this.configure({ paused: this.wanted.paused ?? false });
  }

  /** Changes the stream; remembered for the next connection. */
  request(change: Partial<StreamSettings>): void {
    this.wanted = { ...this.wanted, ...change };
    void this.configure(change);
  }

  /** Asks for pictures of another size if the view, the screen or the choice has changed. */
  updateSize(): void {
    void this.configure(this.size());
  }

  /** The pictures have this size now; another viewer may have chosen it. */
  sizeTold({ width, height }: Partial<FrameSize>): void {
    const now = this.settings.value;
    if (!now || width === undefined || height === undefined) return;
    if (now.width !== width || now.height !== height) this.settings.set({ ...now, width, height });
  }

  /** The size that pictures will have because this page asked for it; undefined if it did not. */
  get askedSize(): FrameSize | undefined {
    const now = this.settings.value;
    return this.asked && now ? { width: now.width, height: now.height } : undefined;
  }

  /** A picture of a video was lost: the next ones are useless until it starts anew. */
  videoBroke(): void {
    if (this.wanted.paused) return;
    this.breaks = this.goodSince >= goodPictures ? 1 : this.breaks + 1;
    this.goodSince = 0;
    if (this.breaks > mostBreaks) {
      this.breaks = 0;
      this.host.tell("The video breaks too often; single pictures come instead");
      this.request({ codec: "jpeg" });
    } else if (!this.hello) {
      this.brokeEarly = true;
    } else {
      // A viewer that comes back gets a key picture first.
      void this.configure({ paused: true }).then(() => this.show());
    }
  }

  /** A picture of a video is on the screen. */
  videoWorked(): void {
    this.goodSince += 1;
  }

  /** The size to ask for; nothing where it is known already or for others to choose. */
  private size(): Partial<FrameSize> {
    if (!this.hello) return {};
    if (!this.host.mayResize()) {
      this.asked = null; // others may choose another one meanwhile
      return {};
    }
    const size = this.chooseSize(this.hello);
    const before = this.asked;
    if (before && before.width === size.width && before.height === size.height) return {};
    this.asked = size;
    return size;
  }

  private async configure(change: Partial<StreamSettings>): Promise<void> {
    if (Object.keys(change).length === 0 || !this.hello) return;
    try {
      this.settings.set(await this.rpc.request<StreamSettings>("stream.configure", change));
    } catch (error) {
      this.host.report(error);
    }
  }
}

/** JPEG is the sharper picture in motion; away from this machine bandwidth counts for more. */
function isLocal(): boolean {
  return ["localhost", "127.0.0.1", "[::1]"].includes(location.hostname);
}
