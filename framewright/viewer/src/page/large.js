/** A picture in its full size: zoom, the number under the pointer, histogram, and what else there is of the same image. */
const large = { open: null, kept: [] };
/** So many pictures are kept to compare later ones with. */
const MOST_KEPT = 4;

/** A number with as many digits as tell it from its neighbours. */
function exactNumber(value, numbers) {
  if (!Number.isFinite(value) || Number.isInteger(value)) return String(value);
  if (numbers === "u8" || numbers === "srgb") return String(Number(value.toPrecision(4)));
  for (let digits = 3; digits < 10; digits += 1) {
    const shorter = Number(value.toPrecision(digits));
    if (Math.fround(shorter) === Math.fround(value)) return String(shorter);
  }
  return String(value);
}

/** The texel of a picture at a place of the whole image, in words; null beside it. */
function texelAt(picture, x, y) {
  const [left, top, width, height] = picture.region;
  if (x < left || y < top || x >= left + width || y >= top + height) return null;
  const [column, row] = [Math.floor((x - left) * picture.small[0] / width), Math.floor((y - top) * picture.small[1] / height)];
  const values = decoded(picture);
  const at = (row * picture.small[0] + column) * picture.channels;
  const own = Array.from(values.slice(at, at + picture.channels));
  const raw = (channel) => picture.raw ? ` = ${picture.raw[at + channel]}/255` : "";
  const exact = isWhole(picture);
  const texels = exact ? "" : picture.light ? ` (mean of about ${Math.round(width / picture.small[0])}×${Math.round(height / picture.small[1])})` : " (one of those around it)";
  return { exact, values: own, text: channelNames(picture).map((name, channel) => `${name} ${exactNumber(own[channel], picture.numbers)}${exact ? raw(channel) : ""}`).join("  ") + texels };
}

/** Whether a picture has every texel of its part. */
const isWhole = (picture) => picture.small[0] === picture.region[2] && picture.small[1] === picture.region[3];

/** All captures that show the same part of the same image, in the order of their passes. */
const writesOf = (capture) => DATA.captures.filter((one) => one.image === capture.image && partKey(one) === partKey(capture));

/** A capture in the words of a list. */
const partWords = (capture) => capture.part || "all";

function openLarge(capture) {
  large.open?.close();
  const how = { ...shown, range: null };
  const view = { capture, picture: null, detail: null, how, x: 0, y: 0, scale: 1, other: null, blinking: null, second: false };
  const stage = element("canvas", { class: "stage", tabindex: 0, role: "img", "aria-label": `${capture.image} after ${capture.pass}, magnified` });
  const value = element("output", { class: "texel", "aria-live": "off" }, "Point at a texel.");
  const title = element("h2", {});
  const status = element("p", { role: "status", class: "faint" });
  const side = element("div", { class: "side" });
  const tools = element("p", { class: "tools" });
  const dialog = element("dialog", { class: "large", "aria-label": "The whole picture" }, element("div", { class: "head" }, title, element("button", { type: "button", class: "close", onclick: () => dialog.close() }, "Close")),
    tools, element("div", { class: "halves" }, element("div", { class: "stage-box" }, stage, value), side), status);
  Object.assign(view, { dialog, stage, value, title, status, side, tools });
  large.open = dialog;
  dialog.view = view;
  dialog.addEventListener("close", () => {
    clearInterval(view.blinking);
    resized.disconnect();
    dialog.remove();
    if (large.open === dialog) large.open = null;
  });
  // Keys of the page behind it stay there.
  dialog.addEventListener("keydown", (event) => {
    event.stopPropagation();
    if (event.key === "Escape") dialog.close();
  });
  document.body.append(dialog);
  dialog.showModal();
  const resized = new ResizeObserver(() => {
    if (view.fitted) fitStage(view);
    else drawStage(view);
  });
  resized.observe(stage);
  moveStage(view);
  showLarge(view, capture);
}

/** Says in an open view that the page shows a newer frame than its picture. */
function largeIsOld() {
  const view = large.open?.view;
  if (view?.picture) view.status.textContent = "The page shows a newer frame than this picture. Again draws it anew.";
}

/** Shows a capture in a large view that is open: another pass, or another part. */
function showLarge(view, capture) {
  const isOther = !view.picture || capture.image !== view.capture.image || partKey(capture) !== partKey(view.capture);
  view.capture = capture;
  view.title.textContent = visible(`${capture.image} after ${capture.pass}`);
  view.status.textContent = capture.data ? "" : "drawing …";
  askFor(capture, { most: 4096 }).then((picture) => {
    if (view.capture !== capture || !view.dialog.isConnected) return;
    Object.assign(view, { picture, detail: null, layers: null });
    if (isOther) view.how.range = null;
    view.status.textContent = "";
    makeTools(view);
    makeSide(view);
    paintView(view);
    if (isOther) fitStage(view);
    else drawStage(view);
  }, (problem) => {
    if (view.capture !== capture || !view.dialog.isConnected) return;
    // A picture of another pass would stand below this one's name.
    clearInterval(view.blinking);
    Object.assign(view, { picture: null, detail: null, layers: null, other: null, second: false });
    view.stage.width = 1;
    view.side.replaceChildren();
    view.status.textContent = visible(problem.message);
    makeTools(view);
  });
}

/** Choosers of passes and parts, and how the picture is drawn. */
function makeTools(view) {
  const { capture, picture } = view;
  const chooser = (label, options, words, chosen) => options.length < 2 ? null : element("label", {}, label + " ",
    element("select", { onchange: (event) => chosen(options[Number(event.target.value)]) }, options.map((one, at) => element("option", { value: String(at), selected: one === view.column || (one.image && isSameCapture(one, capture)) }, words(one)))));
  const passes = writesOf(capture);
  const parts = DATA.captures.filter((one) => one.image === capture.image && one.pass === capture.pass);
  const columns = picture && picture.columns > 1 ? ["all", ...Array.from({ length: picture.columns }, (_, at) => String(at))] : [];
  const button = (name, title, act) => element("button", { type: "button", title, onclick: act }, name);
  view.column ??= "all";
  view.tools.replaceChildren(...[chooser("After", passes, (one) => one.pass, (one) => showLarge(view, one)), chooser("Part", parts, partWords, (one) => showLarge(view, one)),
    chooser("Layer", columns, (one) => one, (one) => { view.column = one; fitStage(view); }),
    drawingControls(view.how, () => { paintView(view); drawStage(view); }), button("Fit", "All of it", () => fitStage(view)), button("1:1", "A texel for a pixel", () => zoomStage(view, devicePixels() / view.scale)),
    DATA.live ? button("Again", "Draw it anew", () => { forgetPictures(); showLarge(view, capture); }) : null].flat(2).filter(Boolean));
}

/** What stands beside the picture: what it is, its histogram, what it is compared with, and the history of a texel. */
function makeSide(view) {
  const { picture, capture } = view;
  stopBlinking(view);
  const samples = models[0]?.byKey.get("image:" + capture.image)?.image?.samples ?? 1;
  view.texels = element("div", { class: "texels" });
  view.side.replaceChildren(
    element("p", { class: "faint" }, pictureWords(picture), samples > 1 ? `; ${samples} samples, resolved` : "", notFinite(picture), isWhole(picture) ? "." : `. Shown with ${picture.small.join("×")} texels.`,
      capture.file ? [" The whole picture: ", element("a", { href: encodeURI(capture.file) }, capture.file), "."] : null),
    heading("Histogram"), histogram(picture, (range) => { view.how.range = range; paintView(view); drawStage(view); }),
    heading("Compare"), compareTools(view),
    heading("A texel after each pass"), element("p", { class: "hint" }, "Press a texel: what it held after each pass that wrote this image."), view.texels);
}

/** What a picture can be compared with: after other passes, and pictures that were kept. */
function compareTools(view) {
  const { capture, picture } = view;
  const label = `${capture.image} after ${capture.pass}`;
  const others = [...writesOf(capture).filter((one) => !isSameCapture(one, capture)).map((one) => ({ words: "after " + one.pass, of: one })), ...large.kept.map((one) => ({ words: "kept: " + one.words, picture: one.picture }))];
  const chosen = element("select", { "aria-label": "Compare with" }, element("option", { value: "" }, "nothing"), others.map((one, at) => element("option", { value: String(at) }, one.words)));
  chosen.addEventListener("change", () => {
    const other = others[Number(chosen.value)];
    stopBlinking(view);
    if (chosen.value === "") return;
    Promise.resolve(other.picture ?? askFor(other.of, { most: 4096 })).then((found) => {
      // Something else may be chosen by now, or the view closed.
      if (chosen.isConnected && others[Number(chosen.value)] === other) startBlinking(view, found, other.words);
    }, (problem) => { view.status.textContent = visible(problem.message); });
  });
  const keep = element("button", { type: "button", title: "Keeps this picture to compare later ones with: of other passes, settings or frames", onclick: () => {
    large.kept.unshift({ words: `${label}, ${large.kept.length === 0 ? "first" : "at " + new Date().toLocaleTimeString()}`, picture });
    large.kept.length = Math.min(large.kept.length, MOST_KEPT);
    makeSide(view);
  } }, "Keep");
  view.compared = element("p", { class: "faint" });
  return element("div", { class: "tools compare" }, element("label", {}, "With ", chosen), keep, view.compared);
}

/** Shows two pictures in turn, each once a second. */
function startBlinking(view, picture, words) {
  clearInterval(view.blinking);
  view.other = { picture, words };
  view.blinking = setInterval(() => blink(view), 500);
  blink(view);
}

function blink(view, second = !view.second) {
  view.second = second;
  paintView(view);
  drawStage(view);
  view.compared.textContent = visible(view.second ? "Shown: " + view.other.words : "Shown: this one") + differenceWords(view.picture, view.other.picture);
}

function stopBlinking(view) {
  clearInterval(view.blinking);
  Object.assign(view, { blinking: null, other: null, second: false });
  if (view.compared) view.compared.textContent = "";
  paintView(view);
  drawStage(view);
}

/** How many texels of two pictures differ. */
function differenceWords(one, other) {
  if (one.small.join() !== other.small.join() || one.channels !== other.channels) return ". They have other sizes.";
  const [a, b] = [decoded(one), decoded(other)];
  const differ = new Set();
  for (let at = 0; at < a.length; at += 1) if (!Object.is(a[at], b[at])) differ.add(Math.floor(at / one.channels));
  return `. ${count(differ.size, "texel differs", "texels differ")}.`;
}

/** Lists what a texel held after each pass that wrote it. */
function showTexel(view, x, y) {
  const { texels } = view;
  const line = element("ol", { class: "outline" });
  texels.replaceChildren(element("p", {}, `Texel ${x}, ${y}`), line);
  for (const capture of writesOf(view.capture)) {
    const told = element("span", {}, "…");
    line.append(element("li", {}, link("pass:" + capture.pass, capture.pass), ": ", told));
    askFor(capture, { most: 1, region: [x, y, 1, 1] }).then((picture) => {
      const found = texelAt(picture, x, y);
      const swatch = element("canvas", { class: "swatch", "aria-hidden": "true" });
      if (DATA.live) paint(swatch, picture, view.how);
      told.replaceChildren(DATA.live ? swatch : "", " " + (found?.text ?? "not in its picture"));
      const colors = (found?.values ?? [1]).slice(0, 3);
      told.parentElement.classList.toggle("black", colors.every((one) => one === 0));
      told.parentElement.classList.toggle("removed", colors.some((one) => !Number.isFinite(one)));
    }, (problem) => told.replaceChildren(visible(problem.message)));
  }
}
