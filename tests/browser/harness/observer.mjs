// Records the messages between the page and its stream worker, so that tests wait for states
// instead of fixed times. Runs in the page before its own script.

/** Updates `window.seen`; serialised into the page. */
function observe() {
  const seen = {
    /** The newest frame on the canvas, and the number of frames of each codec. */
    frame: null,
    drawn: {},
    /** Number of images that were reprojected from the newest frame, the camera.set that the last
     * of them shows, and the number of all images: those and frames as they are. */
    predicted: 0,
    predictedSeq: 0,
    shown: 0,
    firstDrawnAt: null,
    /** Milliseconds from each frame's arrival to the canvas. */
    delays: [],
    /** Number of poses sent, the last of them, and the newest camera of another viewer. */
    poses: 0,
    pose: null,
    camera: null,
    /** Number of calls that choose a camera and have no answer yet. */
    cameraCalls: 0,
    /** Number of calls sent and notifications received, by method. */
    sent: {},
    received: {},
    /** Number of answers to calls, by method. */
    answered: {},
  };
  window.seen = seen;
  const count = (table, name) => (table[name] = (table[name] ?? 0) + 1);
  let stream = null; // the first worker; others belong to comparisons
  const calls = new Map(); // methods of calls without an answer, by id

  const countCameraCalls = () => {
    const all = [...calls.values()];
    seen.cameraCalls = all.filter((method) => /^camera\.(set|fit)$/.test(method)).length;
  };
  const sent = (text) => {
    const { id, method, params } = JSON.parse(text);
    count(seen.sent, method);
    if (id !== undefined) {
      calls.set(id, method);
      countCameraCalls();
    }
    if (method === "camera.set" && params.eye) {
      seen.poses += 1;
      seen.pose = params;
    } else if (method === "camera.set" || method === "camera.fit") {
      seen.pose = null;
    }
  };
  const received = (text) => {
    const start = text.slice(0, 60); // a result may be large
    if (!/"method"/.test(start)) {
      const id = Number(/"id":(\d+)/.exec(start)?.[1]);
      if (calls.has(id)) count(seen.answered, calls.get(id));
      calls.delete(id);
      countCameraCalls();
      return;
    }
    const { method, params } = JSON.parse(text);
    count(seen.received, method);
    if (method !== "camera.changed") return;
    seen.camera = params.camera;
    seen.pose = null;
  };
  let native = Worker.prototype; // a test may have replaced the class
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
        const { kind, frame, text, seq } = event.data;
        if (kind === "text") received(text);
        if (kind === "predicted") {
          seen.predicted += 1;
          seen.predictedSeq = seq;
          seen.shown += 1;
        }
        if (kind !== "drawn" && kind !== "decoded") return;
        seen.frame = frame;
        if (frame.inputSeqEcho >= seen.predictedSeq) seen.shown += 1;
        seen.firstDrawnAt ??= frame.drawnAt;
        seen.delays.push(frame.drawnAt - frame.receivedAt);
        count(seen.drawn, frame.codec);
      });
    },
  });
}

export const observer = `(${observe})()`;
