/** The memory map: steps from left to right, offsets from bottom to top, and over it the bytes that are alive. */
const MAP_HEIGHT = 260;
const CURVE = 90;
function memoryView(model) {
  if (!model.plan) return tooLarge(model);
  const { plan } = model;
  const steps = plan.steps.length;
  const wide = Math.max(14, Math.min(120, Math.floor(880 / Math.max(1, steps))));
  const width = steps * wide;
  const { live_peak_bytes: peak, placed_bytes: placed, transient_bytes: transient, kept_bytes: kept } = plan.totals;
  const atPeak = model.aliveAt(model.peak);
  const words = [element("p", {}, `Transient images and buffers take ${bytes(transient)} in all, ${bytes(placed)} in memory that they share. `
    + `The peak is ${bytes(peak)}, alive at once; no placement can take less. ${bytes(kept)} outlive the frame.`)];
  if (atPeak.length > 0) {
    words.push(element("h3", {}, "The peak, at ", link(model.stepKey(model.peak), "step " + model.peak)),
      element("ul", { class: "peak-images" }, atPeak.slice(0, 12).map((one) => element("li", {}, link(model.keyOf(one), one.name), ": " + bytes(one.role.transient.bytes)))),
      atPeak.length > 12 ? element("p", { class: "faint" }, `and ${atPeak.length - 12} smaller ones`) : null);
  }
  const top = Math.max(1, placed, peak);
  const level = (amount) => CURVE - amount / top * (CURVE - 16);
  const curve = shape("svg", { width: width + 60, height: CURVE + 4, role: "img", "aria-label": "Bytes alive at each step" },
    shape("path", { class: "alive", d: "M0 " + CURVE + model.alive.map((amount, at) => `L${at * wide} ${level(amount)}L${(at + 1) * wide} ${level(amount)}`).join("") + `L${width} ${CURVE}Z` }),
    shape("path", { class: "peak", d: `M0 ${level(peak)}H${width}` }), shape("text", { class: "small", x: 2, y: level(peak) - 3 }, "lower bound " + bytes(peak)),
    shape("path", { class: "axis", d: `M0 ${level(placed)}H${width}M0 ${CURVE}H${width}` }));
  const maps = plan.heaps.map((heap, at) => {
    const inside = model.resources().filter(({ role }) => role.transient && role.transient.heap === at);
    const scale = MAP_HEIGHT / Math.max(1, heap.bytes);
    const svg = shape("svg", { width: width + 60, height: MAP_HEIGHT + 24, role: "group", "aria-label": "Heap " + at });
    svg.append(shape("rect", { class: "lane", x: 0, y: 0, width, height: MAP_HEIGHT }));
    for (const one of inside) {
      const { offset, bytes: taken, lifetime: [first, last] } = one.role.transient;
      const key = model.keyOf(one);
      const place = { x: first * wide + 1, y: MAP_HEIGHT - (offset + taken) * scale, width: (last - first + 1) * wide - 2, height: Math.max(1, taken * scale) };
      svg.append(shape("rect", { class: "block", ...place, "data-key": key, onclick: () => select(key, { reveal: false }) },
        shape("title", {}, `${one.name}: ${bytes(taken)} at ${bytes(offset)}, steps ${first}–${last}`)));
      if (place.height > 13 && place.width > 40) svg.append(shape("text", { class: "small", x: place.x + 4, y: place.y + 12, "pointer-events": "none" }, inMiddle(one.name, Math.floor(place.width / 6))));
    }
    for (let step = 0; step < steps; step += Math.ceil(28 / wide)) svg.append(shape("text", { class: "small", x: step * wide + 2, y: MAP_HEIGHT + 14 }, step));
    return [element("h3", {}, `Heap ${at}: ${bytes(heap.bytes)}${heap.lazily_allocated ? ", lazily allocated" : ""}, ${count(inside.length, "image or buffer", "images and buffers")}`),
      element("div", { class: "scroller", tabindex: "0", role: "region", "aria-label": "Heap " + at }, svg)];
  });
  return element("div", {}, words, element("h3", {}, "Alive at each step"), element("div", { class: "scroller", tabindex: "0", role: "region", "aria-label": "Bytes alive" }, curve), maps);
}
