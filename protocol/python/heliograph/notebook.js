// The view of a session in a notebook: an ES module as anywidget loads it. The kernel sends frames
// in the trait "frame"; drags, the wheel and keys go back to it as messages.
//
// { kind: "orbit", yaw, pitch } in degrees, { kind: "dolly", factor } of the distance, { kind: "fit" }

const degreesPerPixel = 0.35;
const degreesPerKey = 5;
const factorPerKey = 0.85;
const pixelsPerDoubling = 400;

const keys = {
  ArrowLeft: { kind: "orbit", yaw: -degreesPerKey, pitch: 0 },
  ArrowRight: { kind: "orbit", yaw: degreesPerKey, pitch: 0 },
  ArrowUp: { kind: "orbit", yaw: 0, pitch: degreesPerKey },
  ArrowDown: { kind: "orbit", yaw: 0, pitch: -degreesPerKey },
  "+": { kind: "dolly", factor: factorPerKey },
  "-": { kind: "dolly", factor: 1 / factorPerKey },
  f: { kind: "fit" },
};

/** Sends at most one message per frame of the display: movements in between are summed up. */
function createSender(model) {
  let [yaw, pitch, factor, requested] = [0, 0, 1, 0];
  const send = () => {
    requested = 0;
    if (yaw || pitch) model.send({ kind: "orbit", yaw, pitch });
    if (factor !== 1) model.send({ kind: "dolly", factor });
    [yaw, pitch, factor] = [0, 0, 1];
  };
  return {
    add(turn, tilt, dolly) {
      yaw += turn;
      pitch += tilt;
      factor *= dolly;
      requested ||= requestAnimationFrame(send);
    },
    stop: () => cancelAnimationFrame(requested),
  };
}

function render({ model, el }) {
  const image = document.createElement("img");
  image.alt = `Rendered scene of the session ${model.get("session")}`;
  image.tabIndex = 0;
  image.draggable = false;
  image.title = "Drag or arrow keys: orbit. Wheel, plus and minus: zoom. F: fit the scene into view";
  Object.assign(image.style, {
    display: "block",
    maxWidth: "100%",
    cursor: "grab",
    touchAction: "none",
  });
  el.append(image);
  const sender = createSender(model);
  let shown = "";
  const show = () => {
    const bytes = model.get("frame");
    if (!bytes || bytes.byteLength === 0) return;
    const before = shown;
    shown = URL.createObjectURL(new Blob([bytes]));
    image.src = shown;
    if (before) URL.revokeObjectURL(before);
  };
  model.on("change:frame", show);
  show();
  image.addEventListener("pointerdown", (event) => {
    image.setPointerCapture(event.pointerId);
    image.style.cursor = "grabbing";
  });
  image.addEventListener("pointerup", () => (image.style.cursor = "grab"));
  image.addEventListener("pointermove", (event) => {
    if (!image.hasPointerCapture(event.pointerId)) return;
    sender.add(-event.movementX * degreesPerPixel, event.movementY * degreesPerPixel, 1);
  });
  // Only with the focus, so that a notebook can be scrolled over the image.
  image.addEventListener(
    "wheel",
    (event) => {
      if (document.activeElement !== image && image.getRootNode().activeElement !== image) return;
      event.preventDefault();
      sender.add(0, 0, 2 ** (event.deltaY / pixelsPerDoubling));
    },
    { passive: false },
  );
  image.addEventListener("keydown", (event) => {
    const message = keys[event.key];
    if (!message || event.ctrlKey || event.metaKey || event.altKey) return;
    // The notebook has keys of its own.
    event.preventDefault();
    event.stopPropagation();
    model.send(message);
  });
  return () => {
    model.off("change:frame", show);
    sender.stop();
    if (shown) URL.revokeObjectURL(shown);
  };
}

export default { render };
