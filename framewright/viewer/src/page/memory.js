/** The memory map: steps from left to right, offsets from bottom to top, and over it the bytes that are alive. */
const MAP_HEIGHT = 300;
const CURVE = 90;
const AXIS = 74;
/** Kinds of what lies in memory, by what it is used for; each has a colour. */
const MEMORY_KINDS = [["depth", "depth"], ["colour", "drawn colour"], ["storage", "storage image"], ["buffer", "buffer"], ["other", "other"]];

function memoryKind(one) {
  if (!("format" in one)) return "buffer";
  if (one.usage.includes("DEPTH_STENCIL_ATTACHMENT")) return "depth";
  if (one.usage.includes("STORAGE")) return "storage";
  return one.usage.includes("COLOR_ATTACHMENT") ? "colour" : "other";
}

/** Amounts for an axis up to `most`: a few round ones. */
function ticks(most) {
  const step = 2 ** Math.ceil(Math.log2(Math.max(1, most / 6)));
  return Array.from({ length: Math.floor(most / step) + 1 }, (_, at) => at * step);
}

function memoryView(model) {
  if (!model.plan) return tooLarge(model);
  const { plan } = model;
  const steps = plan.steps.length;
  const room = Math.max(320, document.getElementById("views").clientWidth - AXIS - 50);
  const wide = Math.max(14, Math.min(120, Math.floor(room / Math.max(1, steps))));
  const width = steps * wide;
  const { live_peak_bytes: peak, placed_bytes: placed, transient_bytes: transient, kept_bytes: kept } = plan.totals;
  const atPeak = model.aliveAt(model.peak);
  const words = [element("p", {}, `Transient images and buffers take ${bytes(transient)} in all, ${bytes(placed)} in memory that they share. `
    + `The peak is ${bytes(peak)}, alive at once; no placement can take less. ${bytes(kept)} outlive the frame.`)];
  const kinds = new Set(model.resources().filter(({ role }) => role.transient).map(memoryKind));
  words.push(element("p", { class: "legend hint" }, MEMORY_KINDS.filter(([kind]) => kinds.has(kind)).map(([kind, name]) => [element("span", { class: "swatch memory-" + kind }), " " + name + "  "])));
  if (atPeak.length > 0) {
    words.push(element("h3", {}, "The peak, at ", link(model.stepKey(model.peak), "step " + model.peak)),
      element("ul", { class: "peak-images" }, atPeak.slice(0, 12).map((one) => element("li", {}, link(model.keyOf(one), one.name), ": " + bytes(one.role.transient.bytes)))),
      atPeak.length > 12 ? element("p", { class: "faint" }, `and ${atPeak.length - 12} smaller ones`) : null);
  }
  const top = Math.max(1, placed, peak);
  const level = (amount) => CURVE - amount / top * (CURVE - 16);
  const curve = shape("svg", { width: AXIS + width + 20, height: CURVE + 4, role: "img", "aria-label": "Bytes alive at each step" },
    shape("g", { transform: `translate(${AXIS} 0)` },
      shape("path", { class: "alive", d: "M0 " + CURVE + model.alive.map((amount, at) => `L${at * wide} ${level(amount)}L${(at + 1) * wide} ${level(amount)}`).join("") + `L${width} ${CURVE}Z` }),
      shape("path", { class: "peak", d: `M0 ${level(peak)}H${width}` }), shape("text", { class: "small", x: 2, y: level(peak) - 3 }, "lower bound " + bytes(peak)),
      shape("path", { class: "axis", d: `M0 ${level(placed)}H${width}M0 ${CURVE}H${width}` })));
  const maps = plan.heaps.map((heap, at) => heapMap(model, heap, at, [wide, width]));
  return element("div", {}, words, element("h3", {}, "Alive at each step"), element("div", { class: "scroller", tabindex: "0", role: "region", "aria-label": "Bytes alive" }, curve), maps);
}

/** One heap: what lies where, and in which steps. */
function heapMap(model, heap, at, [wide, width]) {
  const inside = model.resources().filter(({ role }) => role.transient && role.transient.heap === at);
  const scale = MAP_HEIGHT / Math.max(1, heap.bytes);
  const svg = shape("svg", { width: AXIS + width + 20, height: MAP_HEIGHT + 30, role: "group", "aria-label": "Heap " + at });
  const map = shape("g", { transform: `translate(${AXIS} 8)` }, shape("rect", { class: "lane", x: 0, y: 0, width, height: MAP_HEIGHT }));
  for (const amount of ticks(heap.bytes)) {
    const y = MAP_HEIGHT - amount * scale;
    map.append(shape("path", { class: "axis", d: `M-4 ${y}H${width}` }), shape("text", { class: "small end", x: -8, y: y + 4 }, bytes(amount)));
  }
  for (const one of inside) {
    const { offset, bytes: taken, lifetime: [first, last] } = one.role.transient;
    const key = model.keyOf(one);
    const place = { x: first * wide + 1, y: MAP_HEIGHT - (offset + taken) * scale, width: (last - first + 1) * wide - 2, height: Math.max(1, taken * scale) };
    map.append(shape("rect", { class: "block memory-" + memoryKind(one), ...place, ...picks(key) },
      shape("title", {}, `${one.name}: ${bytes(taken)} at ${bytes(offset)}, steps ${first}–${last}`)));
    if (place.height > 13 && place.width > 40) map.append(shape("text", { class: "small", x: place.x + 4, y: place.y + 12, "pointer-events": "none" }, inMiddle(one.name, Math.max(3, Math.floor(place.width / 6)))));
  }
  for (let step = 0; step < model.plan.steps.length; step += Math.ceil(28 / wide)) map.append(shape("text", { class: "small", x: step * wide + 2, y: MAP_HEIGHT + 14 }, step));
  svg.append(map);
  return [element("h3", {}, `Heap ${at}: ${bytes(heap.bytes)}${heap.lazily_allocated ? ", lazily allocated" : ""}, ${count(inside.length, "image or buffer", "images and buffers")}`),
    element("div", { class: "scroller", tabindex: "0", role: "region", "aria-label": "Heap " + at }, svg)];
}
