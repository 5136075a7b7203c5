// A viewer with the library ws: hello, calls, pings, one frame, close. Prints what it received
// as one line of JSON.
import WebSocket from "ws";

const socket = new WebSocket(process.argv[2], ["heliograph.v1"], { perMessageDeflate: true });
const saw = { frames: 0 };

function call(id, method, params = {}) {
  socket.send(JSON.stringify({ jsonrpc: "2.0", id, method, params }));
}

/** In whatever order it all came. */
function closeWhenAllIsSeen() {
  if (saw.frames > 0 && saw.methods && saw.hello && saw.pong) socket.close(1000, "enough");
}

const failure = setTimeout(() => {
  console.log(JSON.stringify({ ...saw, error: "timed out" }));
  process.exit(1);
}, 30000);

socket.on("upgrade", (response) => {
  saw.status = response.statusCode;
});
socket.on("open", () => {
  saw.protocol = socket.protocol;
  saw.extensions = socket.extensions;
  call(1, "hello", { client: "ws" });
  call(2, "rpc.discover");
  socket.ping("are you there?");
});
socket.on("pong", (data) => {
  saw.pong = data.toString();
  closeWhenAllIsSeen();
});
socket.on("message", (data, isBinary) => {
  if (isBinary) {
    saw.frames += 1;
    saw.magic = data.toString("latin1", 0, 4);
    const frame_seq = data.readUInt32LE(12);
    socket.send(JSON.stringify({ jsonrpc: "2.0", method: "stream.ack", params: { frame_seq } }));
  } else {
    const message = JSON.parse(data.toString());
    if (message.id === 1) saw.hello = message.result.protocol;
    if (message.id === 2) saw.methods = message.result.methods.length;
  }
  closeWhenAllIsSeen();
});
socket.on("close", (code) => {
  clearTimeout(failure);
  console.log(JSON.stringify({ ...saw, code }));
});
socket.on("error", (error) => {
  console.log(JSON.stringify({ ...saw, error: error.message }));
  process.exit(1);
});
