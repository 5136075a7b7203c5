// The stream worker: owns the WebSocket, decodes and draws, so that a busy page delays no frame.

import { CanvasPainter } from "./canvas_painter.ts";
import { PredictedView } from "./predicted_view.ts";
import { FramePipeline, type FrameSink, chooseDecoder } from "./frame_pipeline.ts";
import { type FromWorker, type ToWorker, clockMs } from "./worker_messages.ts";

interface WorkerScope {
  postMessage(message: FromWorker, transfer?: Transferable[]): void;
  onmessage: ((event: MessageEvent<ToWorker>) => void) | null;
}
const scope = self as unknown as WorkerScope;

let socket: WebSocket | null = null;
let view: PredictedView | null = null;
let copyFrames = false;

const sink: FrameSink = {
  draw(image, frame, depth) {
    if (!view) {
      scope.postMessage({ kind: "decoded", image, frame }, [image]);
      return;
    }
    void view.show(image, frame, depth).then((shown) => {
      if (!shown) return;
      scope.postMessage({ kind: "drawn", frame });
      if (copyFrames) void postCopy(0);
    });
  },
  acknowledge(frameSeq, decodeUs, presentUs) {
    const params = { frame_seq: frameSeq, decode_us: decodeUs, present_us: presentUs };
    send(JSON.stringify({ jsonrpc: "2.0", method: "stream.ack", params }));
  },
  failed(message, video) {
    scope.postMessage({ kind: "decode_failed", message, video });
  },
};
const pipeline = chooseDecoder().then((decode) => new FramePipeline(sink, decode));

function send(text: string): void {
  if (socket?.readyState === WebSocket.OPEN) socket.send(text);
}

async function postCopy(id: number): Promise<void> {
  const image = (await view?.copy()) ?? null;
  scope.postMessage({ kind: "copied", id, image }, image ? [image] : []);
}

function showOn(canvas: OffscreenCanvas): void {
  view = new PredictedView(new CanvasPainter(canvas), {
    predicted: (seq) => scope.postMessage({ kind: "predicted", seq, drawnAt: clockMs() }),
    unsupported: () => scope.postMessage({ kind: "cannot_predict" }),
  });
}

function close(): void {
  view?.predict(null);
  if (!socket) return;
  socket.onopen = socket.onmessage = socket.onclose = null;
  socket.close(1000);
  socket = null;
}

async function open(url: string, subprotocol: string): Promise<void> {
  const frames = await pipeline;
  close();
  frames.clear();
  let wasOpen = false;
  const opening = new WebSocket(url, subprotocol);
  opening.binaryType = "arraybuffer";
  opening.onopen = () => {
    wasOpen = true;
    scope.postMessage({ kind: "opened", subprotocol: opening.protocol });
  };
  opening.onmessage = (event: MessageEvent<string | ArrayBuffer>) => {
    if (typeof event.data === "string") scope.postMessage({ kind: "text", text: event.data });
    else frames.push(event.data);
  };
  opening.onclose = ({ code, reason }) => {
    socket = null;
    frames.clear();
    view?.predict(null);
    scope.postMessage({ kind: "closed", code, reason, wasOpen });
  };
  socket = opening;
}

scope.onmessage = ({ data }) => {
  switch (data.kind) {
    case "canvas":
      showOn(data.canvas);
      break;
    case "open":
      void open(data.url, data.subprotocol);
      break;
    case "close":
      close();
      break;
    case "copy":
      void postCopy(data.id);
      break;
    case "copy_frames":
      copyFrames = data.enabled;
      break;
    case "predict":
      view?.predict(data.camera);
      break;
    case "hold":
      void pipeline.then((frames) => frames.hold());
      break;
    case "release":
      void pipeline.then((frames) => frames.release(data.required));
      break;
    case "send":
      send(data.text);
      break;
  }
};
