"use strict";

/** How many elements were made: tests hold views to it. */
let elementsMade = 0;

/** Text with every invisible or direction-turning character written out. Line breaks and tabs stay. */
function visible(text) {
  return String(text).replace(/[\p{Cc}\p{Cf}\p{Co}\u2028\u2029]/gu, (c) =>
    c === "\n" || c === "\t" ? c : "\\u{" + c.codePointAt(0).toString(16) + "}");
}

function fill(made, attributes, children) {
  elementsMade += 1;
  for (const [name, value] of Object.entries(attributes)) {
    if (name.startsWith("on")) made.addEventListener(name.slice(2), value);
    // Those are compared or sent, and never seen.
    else if (["data-key", "data-ends", "data-file", "data-setting", "value"].includes(name) && value) made.setAttribute(name, value);
    else if (value !== null && value !== undefined && value !== false) made.setAttribute(name, visible(value === true ? "" : value));
  }
  for (const child of children.flat(9)) {
    if (child !== null && child !== undefined) made.append(child instanceof Node ? child : document.createTextNode(visible(child)));
  }
  return made;
}

/** An HTML element. Children are elements or text, or lists of them. */
const element = (tag, attributes = {}, ...children) => fill(document.createElement(tag), attributes, children);

/** An SVG element. */
const shape = (tag, attributes = {}, ...children) => fill(document.createElementNS("http://www.w3.org/2000/svg", tag), attributes, children);

function bytes(amount) {
  if (amount < 1024) return amount + " B";
  const units = ["KiB", "MiB", "GiB", "TiB"];
  let unit = 0;
  amount /= 1024;
  while (amount >= 1024 && unit < 3) { amount /= 1024; unit += 1; }
  // Halves go to the even digit, as they do everywhere else in the program.
  const tenths = amount * 10;
  const rounded = tenths % 1 === 0.5 ? 2 * Math.round(tenths / 2) : Math.round(tenths);
  return (rounded / 10).toFixed(1) + " " + units[unit];
}

const count = (number, one, many) => number + " " + (number === 1 ? one : many);

/** A text of at most so many letters: cut in its middle, since long names are alike in their beginnings. */
function inMiddle(text, letters) {
  const all = [...text];
  if (all.length <= letters) return text;
  const end = Math.floor((letters - 1) / 2);
  return all.slice(0, letters - 1 - end).join("") + "…" + all.slice(all.length - end).join("");
}

/** A time with three digits. */
const milliseconds = (ms) => (ms >= 100 ? ms.toFixed(0) : ms >= 10 ? ms.toFixed(1) : ms.toFixed(2)) + " ms";

/** A time with how far it spreads. */
const spreadWords = ({ median, low, high }, frames) => milliseconds(median) + (frames > 1 ? ` (${milliseconds(low)} to ${milliseconds(high)} in ${frames} frames)` : " in one frame");

/** The name in a key, behind its kind. */
const nameOf = (key) => key.slice(key.indexOf(":") + 1);

/** A scroller whose drawing holds only what is in sight: `draw(svg, left, top, width, height)` is called at each change. */
function scroller(whole, label, draw) {
  let extent;
  const view = shape("svg", { class: "view", role: "group", "aria-label": label });
  const room = element("div", { class: "room", "aria-hidden": "true" });
  const box = element("div", { class: "scroller", tabindex: "0", role: "region", "aria-label": label }, view, room);
  let waiting = false;
  const redraw = () => {
    waiting = false;
    const size = printing ? extent : [Math.min(box.clientWidth, extent[0]), Math.min(box.clientHeight || extent[1], extent[1])];
    view.setAttribute("width", size[0]);
    view.setAttribute("height", size[1]);
    view.style.marginRight = -size[0] + "px";
    view.replaceChildren();
    draw(view, box.scrollLeft, box.scrollTop, size[0], size[1]);
    highlight(view);
  };
  const ask = () => {
    if (!waiting) {
      waiting = true;
      requestAnimationFrame(redraw);
    }
  };
  box.addEventListener("scroll", ask);
  new ResizeObserver(ask).observe(box);
  box.resize = (size) => {
    extent = size.map(Math.ceil);
    room.style.width = extent[0] + "px";
    room.style.height = extent[1] + "px";
    redraw();
  };
  box.resize(whole);
  box.redraw = redraw;
  box.show = (left, top, width, height) => {
    if (left < box.scrollLeft || left + width > box.scrollLeft + box.clientWidth) box.scrollLeft = left - box.clientWidth / 2;
    if (top < box.scrollTop || top + height > box.scrollTop + box.clientHeight) box.scrollTop = top - box.clientHeight / 2;
  };
  return box;
}

/** Whether everything is drawn, for paper. */
let printing = false;
