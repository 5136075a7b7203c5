// What the page and its stream worker say to each other, noted for tests: they wait for what the
// page knows and shows instead of for a time. Runs in the page before its own script.

/** Keeps `window.seen` up to date; serialised into the page. */
function observe() {
  const seen = {
    /** The newest picture on the canvas, and how many there were of each codec. */
    frame: null,
    drawn: {},
    firstDrawnAt: null,
    /** Milliseconds from each picture's arrival to the canvas. */
    delays: [],
    /** Poses sent, the last of them, and the newest camera that somebody else chose. */
    poses: 0,
    pose: null,
    camera: null,
    /** Methods of what was sent and of what came, with their counts. */
    sent: {},
    heard: {},
  };
  window.seen = seen;
  const count = (table, name) => (table[name] = (table[name] ?? 0) + 1);
  let stream = null; // the first worker is the page's own; others belong to comparisons

  const sent = (text) => {
    const { method, params } = JSON.parse(text);
    count(seen.sent, method);
    if (method === "camera.set" && params.eye) {
      seen.poses += 1;
      seen.pose = params;
    } else if (method === "camera.set" || method === "camera.fit") {
      seen.pose = null;
    }
  };
  const heard = (text) => {
    if (!/"method"/.test(text.slice(0, 60))) return; // an answer, which may be large
    const { method, params } = JSON.parse(text);
    count(seen.heard, method);
    if (method !== "camera.changed") return;
    seen.camera = params.camera;
    seen.pose = null;
  };
  let native = Worker.prototype; // a test may have put a class of its own before it
  while (!Object.hasOwn(native, "onmessage")) native = Object.getPrototypeOf(native);
  const post = native.postMessage;
  native.postMessage = function (message, ...rest) {
    if (this === stream && message.kind === "send") sent(message.text);
    return post.call(this, message, ...rest);
  };
  const handler = Object.getOwnPropertyDescriptor(native, "onmessage");
  Object.defineProperty(native, "onmessage", {
    set(listener) {
      stream ??= this;
      handler.set.call(this, (event) => {
        listener(event);
        if (this !== stream) return;
        const { kind, frame, text } = event.data;
        if (kind === "text") heard(text);
        if (kind !== "drawn" && kind !== "picture") return;
        seen.frame = frame;
        seen.firstDrawnAt ??= frame.drawnAt;
        seen.delays.push(frame.drawnAt - frame.receivedAt);
        count(seen.drawn, frame.codec);
      });
    },
  });
}

export const observer = `(${observe})()`;
