/** Where the picture of a large view stands, and how it is moved. */
const devicePixels = () => window.devicePixelRatio || 1;

/** The picture that a view shows now. */
const pictureShown = (view) => view.second && view.other ? view.other.picture : view.picture;

/** Paints the picture of a view, and its part in full, if there is one. */
function paintView(view) {
  const painted = (picture) => {
    const canvas = document.createElement("canvas");
    // Both pictures of a comparison are drawn between the same numbers.
    paint(canvas, { ...picture, values: decoded(picture), range: view.picture.range }, view.how);
    return { canvas, region: picture.region };
  };
  view.layers = [pictureShown(view), view.second ? null : view.detail].filter(Boolean).map(painted);
}

function drawStage(view) {
  if (!view.layers) return;
  const { stage, scale } = view;
  const pixels = devicePixels();
  [stage.width, stage.height] = [stage.clientWidth * pixels, stage.clientHeight * pixels].map((side) => Math.max(1, Math.round(side)));
  const context = stage.getContext("2d");
  context.imageSmoothingEnabled = false;
  context.clearRect(0, 0, stage.width, stage.height);
  for (const { canvas, region: [left, top, width, height] } of view.layers) {
    context.drawImage(canvas, (left - view.x) * scale, (top - view.y) * scale, width * scale, height * scale);
  }
  askForDetail(view);
}

/** Asks for the part in sight in full, where the picture has fewer texels than are seen. */
function askForDetail(view) {
  clearTimeout(view.detailing);
  const { picture, stage, scale } = view;
  if (!picture || !DATA.live || isWhole(picture) || scale * picture.region[2] / picture.small[0] < 2 || view.other) return;
  view.detailing = setTimeout(() => {
    const [wide, high] = picture.size;
    const [left, top] = [view.x, view.y].map((at, axis) => Math.max(0, Math.min(picture.size[axis] - 1, Math.floor(at))));
    const [width, height] = [Math.min(wide - left, Math.ceil(stage.width / scale) + 1), Math.min(high - top, Math.ceil(stage.height / scale) + 1)];
    const region = [left, top, width, height];
    if (view.detail?.region.join() === region.join()) return;
    askFor(view.capture, { most: 4096, region }).then((detail) => {
      if (view.picture !== picture) return;
      view.detail = detail;
      paintView(view);
      drawStage(view);
    }, () => {});
  }, 200);
}

/** Zooms around a place of the stage. */
function zoomStage(view, factor, at = [view.stage.width / 2, view.stage.height / 2]) {
  const to = Math.max(0.05, Math.min(64 * devicePixels(), view.scale * factor));
  view.x += at[0] / view.scale - at[0] / to;
  view.y += at[1] / view.scale - at[1] / to;
  Object.assign(view, { scale: to, fitted: false });
  drawStage(view);
}

/** Shows all of the picture, or all of the layer that is chosen. */
function fitStage(view) {
  if (!view.picture) return;
  const { stage, picture } = view;
  const columns = view.column && view.column !== "all" ? picture.columns : 1;
  const [width, height] = [picture.size[0] / columns, picture.size[1]];
  const [wide, high] = [stage.clientWidth * devicePixels(), stage.clientHeight * devicePixels()];
  view.scale = Math.max(0.05, Math.min(wide / width, high / height, 64));
  view.x = (columns > 1 ? Number(view.column) * width : 0) - (wide / view.scale - width) / 2;
  view.y = -(high / view.scale - height) / 2;
  view.fitted = true;
  drawStage(view);
}

/** The texel of the image under a pointer. */
function texelUnder(view, event) {
  const box = view.stage.getBoundingClientRect();
  const [x, y] = [(event.clientX - box.left) * view.stage.width / box.width, (event.clientY - box.top) * view.stage.height / box.height];
  return [Math.floor(view.x + x / view.scale), Math.floor(view.y + y / view.scale)];
}

/** Writes the number under the pointer: of the part in full, if it is there. */
function showValue(view, x, y) {
  const shownOne = pictureShown(view);
  const found = (!view.second && view.detail ? texelAt(view.detail, x, y) : null) ?? (shownOne ? texelAt(shownOne, x, y) : null);
  view.at = found ? [x, y] : null;
  view.value.textContent = found ? `${x}, ${y}:  ${found.text}` : "Point at a texel.";
}

/** Moves the picture by dragging, the wheel and keys, and tells what is under the pointer. A press tells the texel's history. */
function moveStage(view) {
  const { stage } = view;
  let held = null;
  stage.addEventListener("wheel", (event) => {
    event.preventDefault();
    const box = stage.getBoundingClientRect();
    zoomStage(view, Math.exp(-event.deltaY * (event.deltaMode === 1 ? 0.05 : 0.002)), [(event.clientX - box.left) * devicePixels(), (event.clientY - box.top) * devicePixels()]);
  }, { passive: false });
  stage.addEventListener("pointerdown", (event) => {
    held = { x: event.clientX, y: event.clientY, moved: false };
    stage.setPointerCapture(event.pointerId);
  });
  stage.addEventListener("pointermove", (event) => {
    if (held && (held.moved || Math.hypot(event.clientX - held.x, event.clientY - held.y) > 4)) {
      view.x -= (event.clientX - held.x) * devicePixels() / view.scale;
      view.y -= (event.clientY - held.y) * devicePixels() / view.scale;
      held = { x: event.clientX, y: event.clientY, moved: true };
      view.fitted = false;
      drawStage(view);
    }
    if (view.picture) showValue(view, ...texelUnder(view, event));
  });
  stage.addEventListener("pointerup", (event) => {
    const pressed = held && !held.moved;
    held = null;
    if (!pressed || !view.picture) return;
    const [x, y] = texelUnder(view, event);
    showValue(view, x, y);
    if (texelAt(view.picture, x, y)) showTexel(view, x, y);
  });
  stage.addEventListener("keydown", (event) => {
    const way = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] }[event.key];
    if (way && view.picture) {
      const [x, y] = view.at ?? middleOf(view);
      const to = [x + way[0], y + way[1]].map((at, axis) => Math.max(0, Math.min(view.picture.size[axis] - 1, at)));
      showValue(view, ...to);
    } else if (event.key === "Enter" && view.at) showTexel(view, ...view.at);
    else if (event.key === "+" || event.key === "=") zoomStage(view, 1.25);
    else if (event.key === "-") zoomStage(view, 0.8);
    else if (event.key === "0") fitStage(view);
    else return;
    event.preventDefault();
  });
}

/** The texel in the middle of a picture, where keys begin. */
const middleOf = (view) => view.picture.size.map((side) => Math.floor(side / 2));
