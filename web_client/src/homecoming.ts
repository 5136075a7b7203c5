// A page that comes back to another run of the server, the same one begun anew or another node. The
// server finds the place (see `hello` in the protocol); here the page's state follows, and the
// person hears of it.

import type { Hello } from "heliograph/messages.ts";
import { type Origin, mainSession } from "./stream/place.ts";
import type { ViewState } from "./view_state.ts";
import type { Viewer } from "./viewer.ts";

export class Homecoming {
  private readonly viewer: Viewer;
  /** Where this page has begun to bring its state; it goes on there after a lost connection. */
  private begunAt: string | null = null;

  constructor(viewer: Viewer) {
    this.viewer = viewer;
  }

  /** What the session that greets is to be brought to, where `wish` waited so far. */
  wishAt(hello: Hello, wish: ViewState | null): ViewState | null {
    const { connection, mayChange, scene } = this.viewer;
    const { origin } = connection;
    if (!origin || origin.instance === hello.instance) return wish;
    // A server that does not tell has one session, for whoever comes.
    const brings = hello.bring ?? (hello.bring === undefined && mayChange);
    if (brings) this.begunAt = place(hello);
    this.viewer.onNews(news(hello, origin, this.isBringing(hello)));
    if (this.isBringing(hello)) return wish ?? (scene.value ? this.viewer.viewState() : null);
    scene.set(null); // until it is known what this session shows
    return null;
  }

  /** The page is in step with this session: here it comes back to. */
  arrived({ instance, session }: Hello): void {
    const { connection } = this.viewer;
    const came = connection.origin;
    connection.origin = { instance, session };
    if (came && came.instance !== instance) void connection.keepPlace({ instance, session });
  }

  /** Whether the session was made for the state that this page brings. */
  hasOwn(hello: Hello): boolean {
    return hello.session !== mainSession && this.isBringing(hello);
  }

  private isBringing(hello: Hello): boolean {
    return this.begunAt === place(hello);
  }
}

function place({ instance, session }: Hello): string {
  return `${instance} ${session}`;
}

/** One sentence for the person. */
function news({ bring, role, session }: Hello, from: Origin, brings: boolean): string {
  if (brings && session === from.session) return "The server began anew; your view is brought back";
  if (brings) return `The server is another one; your view goes on in session ${session}`;
  if (role === "view") return `The server is another one; this is its session ${session}`;
  return bring === null || bring === undefined
    ? `The server is another one without room for your session; this is session ${session}`
    : `The server is another one; those who were with you meet in session ${session}`;
}
