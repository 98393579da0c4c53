/** Images after the passes that wrote them, drawn with the exposure, the channels and the colours that are chosen. */
const shown = { channels: "rgb", stops: 0, colors: "auto" };

/** The numbers of a picture's texels, channel by channel; `raw` are those of its file, if they are others. */
function decoded(picture) {
  if (picture.values) return picture.values;
  const raw = Uint8Array.from(atob(picture.data), (c) => c.charCodeAt(0));
  const view = new DataView(raw.buffer);
  const half = (bits) => {
    const [sign, exponent, mantissa] = [bits >> 15 ? -1 : 1, (bits >> 10) & 31, bits & 1023];
    if (exponent === 31) return mantissa ? NaN : sign * Infinity;
    return sign * (exponent ? 2 ** (exponent - 15) * (1 + mantissa / 1024) : 2 ** -14 * (mantissa / 1024));
  };
  const size = { u8: 1, srgb: 1, f16: 2 }[picture.numbers] ?? 4;
  const light = (share) => share <= 0.04045 ? share / 12.92 : ((share + 0.055) / 1.055) ** 2.4;
  const alpha = (at) => at % picture.channels === 3;
  const read = {
    u8: (at) => raw[at] / 255, srgb: (at) => alpha(at) ? raw[at] / 255 : light(raw[at] / 255), f16: (at) => half(view.getUint16(at, true)),
    f32: (at) => view.getFloat32(at, true), u32: (at) => view.getUint32(at, true), i32: (at) => view.getInt32(at, true),
  }[picture.numbers];
  picture.raw = size === 1 ? raw : null;
  picture.values = Float64Array.from({ length: raw.length / size }, (_, at) => read(at * size));
  return picture.values;
}

const srgb = (linear) => linear <= 0.0031308 ? 12.92 * linear : 1.055 * linear ** (1 / 2.4) - 0.055;
const byte = (share) => Math.round(255 * Math.max(0, Math.min(1, share)));

/** A colour for a share from 0 to 1: dark blue, green, yellow. */
function ramp(share) {
  const at = Math.max(0, Math.min(1, share));
  return [byte(at < 0.5 ? 0.27 - 0.3 * at : 0.12 + 1.74 * (at - 0.5)), byte(0.05 + 0.86 * at), byte(0.33 + 0.5 * at - 0.9 * at * at)];
}

/** Negative numbers blue, positive ones red, 0 black. */
const signed = (value, most) => value < 0 ? [0, byte(0.5 * -value / most), byte(-value / most)] : [byte(value / most), byte(0.4 * value / most), 0];

/** The way in which a capture is drawn: as light, by false colours, or by signs. */
function wayOf(capture, how) {
  if (how.colors !== "auto") return how.colors;
  const [low, high] = capture.range ?? [0, 0];
  if (!capture.light) return "false";
  return low < 0 && high > low ? "signed" : "light";
}

/** Draws a picture as `how` says. Numbers from the first to the second of `how.range` become dark to bright, if it is there. */
function paint(canvas, picture, how = shown) {
  const [width, height] = picture.small;
  canvas.width = width;
  canvas.height = height;
  const values = decoded(picture);
  const { channels } = picture;
  const [low, high] = how.range ?? picture.range ?? [0, 1];
  const most = Math.max(Math.abs(low), Math.abs(high)) || 1;
  const gain = 2 ** how.stops;
  const way = wayOf(picture, how);
  const single = "rgba".indexOf(how.channels);
  const light = (value) => how.range ? (value - low) / (high - low || 1) : value;
  const pixels = new ImageData(width, height);
  for (let at = 0; at < width * height; at += 1) {
    const texel = [0, 1, 2, 3].map((channel) => channel < channels ? values[at * channels + channel] : channel === 3 ? 1 : channels === 1 ? values[at * channels] : 0);
    const seen = single >= 0 && how.channels.length === 1 ? [texel[single]] : texel.slice(0, 3);
    let color;
    if (seen.some(Number.isNaN)) color = [255, 0, 255];
    else if (!seen.every(Number.isFinite)) color = [0, 255, 255];
    else if (way === "false") color = ramp((seen[0] - low) / (high - low || 1) * gain);
    else if (way === "signed") color = seen.length === 1 || channels === 1 ? signed(seen[0] * gain, most) : seen.map((value) => byte(0.5 + 0.5 * value * gain / most));
    else color = (seen.length === 1 ? [seen[0], seen[0], seen[0]] : seen).map((value) => byte(srgb(Math.max(0, light(value) * gain))));
    pixels.data.set([...color, 255], at * 4);
  }
  canvas.getContext("2d").putImageData(pixels, 0, 0);
}

/** The format, size and part of a picture, and its smallest and largest number. */
const pictureWords = (picture) => `${picture.format.replace(/_/g, " ")}, ${picture.size.join("×")}${picture.part ? ", " + picture.part : ""}`
  + (picture.range ? `, ${Number(picture.range[0].toPrecision(4))} to ${Number(picture.range[1].toPrecision(4))}` : "");

const notFinite = ({ not_finite: [nan, infinite] }) => nan + infinite > 0 ? element("strong", { class: "removed" }, ` ${count(nan, "texel is", "texels are")} NaN, ${infinite} infinite`) : null;

/** A capture as a small picture, which is asked for when it is in sight. It opens in its full size. */
function figure(model, capture, most = 128) {
  const canvas = element("canvas", { role: "img", "aria-label": capture.image + " after " + capture.pass });
  const key = "pass:" + capture.pass;
  const about = element("span", { class: "faint" }, capture.part);
  const made = element("figure", { "data-key": [key, "image:" + capture.image].join("\u0001") },
    element("button", { type: "button", class: "zoom", title: "The whole picture", onclick: () => openLarge(capture) }, canvas),
    element("figcaption", {}, link("image:" + capture.image, capture.image), " after ", link(key, capture.pass), element("br"), about));
  const show = (picture) => {
    made.picture = picture;
    paint(canvas, picture);
    about.replaceChildren(pictureWords(picture), notFinite(picture) ?? "");
  };
  made.repaint = () => { if (made.picture) paint(canvas, made.picture); };
  const drawn = drawnPicture(capture, { most });
  if (drawn) show(drawn);
  else whenSeen(made, () => askFor(capture, { most }).then(show, (problem) => about.replaceChildren(visible(problem.message))));
  return made;
}

/** What a view draws captures with: channels, colours, exposure. `again` is called at each change. */
function drawingControls(how, again) {
  const choice = (name, title, values) => element("label", {}, title + " ", element("select", { "data-setting": name, onchange: (event) => { how[name] = event.target.value; again(); } },
    values.map(([value, words]) => element("option", { value, selected: how[name] === value }, words))));
  const stops = element("output", {}, String(how.stops));
  return [choice("channels", "Channels", [["rgb", "colour"], ["r", "red"], ["g", "green"], ["b", "blue"], ["a", "alpha"]]),
    choice("colors", "Colours", [["auto", "as fits"], ["light", "light"], ["false", "false, from the smallest to the largest"], ["signed", "by sign"]]),
    element("label", {}, "Exposure ", element("input", { type: "range", min: -10, max: 10, step: 0.5, value: how.stops, oninput: (event) => { how.stops = Number(event.target.value); stops.textContent = event.target.value; again(); } }), " ", stops, " stops")];
}

function picturesView(model) {
  const figures = DATA.captures.map((capture) => figure(model, capture));
  const again = () => figures.forEach((one) => one.repaint());
  const byImage = [...new Set(DATA.captures.map((capture) => capture.image))];
  return element("div", { class: "pictures" },
    element("p", { class: "tools" }, drawingControls(shown, again)),
    element("p", { class: "hint" }, "NaN is magenta, infinity cyan. Depth and integers have false colours, from their smallest to their largest number. A picture opens in its full size."),
    byImage.map((image) => [element("h3", {}, link("image:" + image, image)), element("div", { class: "strip" }, figures.filter((_, at) => DATA.captures[at].image === image))]));
}
