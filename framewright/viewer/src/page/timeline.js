/**
 * The timeline: a lane for the host that records and one for each queue, waits and barriers as arrows, below them the memory that is alive,
 * and each image over its steps. A line through all of it follows the pointer.
 */
const LANE_HEIGHT = 46;
const LANES_TOP = 22;
const RECORDING_HEIGHT = 26;
const ALIVE_HEIGHT = 70;
const IMAGE_ROW = 18;
const NAME_ROOM = 190;
/** What the width of a step may mean. */
const WIDTHS = [["equal", "equal"], ["bytes", "bytes moved"], ["ms", "milliseconds"]];

/** Where each step begins and ends, from left to right; and how wide a millisecond is, if widths are milliseconds. */
function stepsOver(model, kind) {
  const { steps } = model.plan;
  const weights = steps.map((_, at) => kind === "bytes" ? movedSum(model.moved[at]) : kind === "ms" ? model.msOfStep(at) ?? 0 : 1);
  const sum = weights.reduce((one, other) => one + other, 0) || 1;
  const room = Math.max(760, steps.length * 26);
  // The least width shows that a step is there.
  const widths = weights.map((weight) => kind === "equal" ? Math.max(26, Math.min(90, room / steps.length)) : 6 + weight / sum * room);
  const starts = [0];
  widths.forEach((width) => starts.push(starts.at(-1) + width));
  return { starts, perMs: kind === "ms" ? room / sum : null };
}

/**
 * The work that barriers of steps wait for: `[from, to, words]`. The other side of an image's barrier is the step before that used the image, and
 * where memory changes hands the last step of what had it before.
 */
function hazards(model) {
  const found = new Map();
  const rows = new Map(model.rows().map((row) => [row.key, [...row.steps.keys()].sort((one, other) => one - other)]));
  model.plan.steps.forEach((step, to) => {
    for (const { image } of step.image_barriers) {
      const key = model.resourceKey({ image });
      const from = (rows.get(key) ?? []).findLast((at) => at < to);
      if (from === undefined) continue;
      const arrow = from + " " + to;
      if (!found.has(arrow)) found.set(arrow, { from, to, names: [] });
      found.get(arrow).names.push(nameOf(key));
    }
  });
  return [...found.values()];
}

function timelineView(model) {
  if (!model.plan) return tooLarge(model);
  const { steps } = model.plan;
  const lanes = [...new Set(steps.map((step) => step.queue))];
  const rows = model.rows();
  const lanesTop = LANES_TOP + (model.timed() ? RECORDING_HEIGHT : 0);
  const lanesEnd = lanesTop + lanes.length * LANE_HEIGHT;
  const arrows = hazards(model);
  const aliveEnd = lanesEnd + ALIVE_HEIGHT + 18;
  let kind = model.timed() ? "ms" : "equal";
  let { starts, perMs } = stepsOver(model, kind);
  const x = (at) => NAME_ROOM + starts[at];
  const laneTop = (at) => lanesTop + lanes.indexOf(steps[at].queue) * LANE_HEIGHT;
  const recording = () => !model.timed() ? 0 : perMs === null ? starts.at(-1) : Math.max(2, model.times.recording.median * perMs);
  const extent = () => [NAME_ROOM + Math.max(starts.at(-1), recording()) + 16, aliveEnd + rows.length * IMAGE_ROW + 16];
  const cross = element("p", { class: "hint", role: "status" }, "\u00a0");
  let pointed = null;
  const box = scroller(extent(), "Timeline of " + model.name, (svg, left, top, width, height) => {
    svg.setAttribute("viewBox", [0, 0, width, height].join(" "));
    const marker = { viewBox: "0 0 8 8", refX: 7, refY: 4, markerWidth: 7, markerHeight: 7, markerUnits: "userSpaceOnUse", orient: "auto" };
    svg.append(shape("defs", {}, ["wait", "hazard"].map((kind) => shape("marker", { id: "end-of-" + kind, ...marker }, shape("path", { class: "head of-" + kind, d: "M0 0L8 4L0 8z" })))));
    const moving = shape("g", { transform: `translate(${-left} ${-top})` });
    const names = shape("g", { transform: `translate(0 ${-top})` });
    const seen = (at) => x(at + 1) >= left && x(at) <= left + width;
    lanes.forEach((lane, at) => {
      const laneY = lanesTop + at * LANE_HEIGHT;
      moving.append(shape("rect", { class: "lane", x: NAME_ROOM, y: laneY, width: starts.at(-1), height: LANE_HEIGHT - 6 }));
      names.append(shape("text", { class: "end", x: NAME_ROOM - 10, y: laneY + 24 }, lane.toLowerCase() + " queue"));
    });
    if (model.timed()) {
      const words = "the host records " + milliseconds(model.times.recording.median) + (perMs === null ? ", beside all of it" : "");
      moving.append(shape("g", { class: "recording" }, shape("title", {}, words + " (" + spreadWords(model.times.recording, model.times.frames) + ")"), shape("rect", { x: NAME_ROOM, y: LANES_TOP + 2, width: recording(), height: RECORDING_HEIGHT - 8, rx: 3 })),
        shape("text", { class: "small", x: NAME_ROOM + 6 + (recording() < 200 ? recording() : 0), y: LANES_TOP + 14 }, words));
      names.append(shape("text", { class: "end", x: NAME_ROOM - 10, y: LANES_TOP + 15 }, "recording"));
    }
    moving.append(...aliveCurve(model, x, lanesEnd + 16, ALIVE_HEIGHT));
    names.append(shape("text", { class: "end", x: NAME_ROOM - 10, y: lanesEnd + 30 }, "memory alive"), shape("text", { class: "end small", x: NAME_ROOM - 10, y: lanesEnd + 44 }, "peak " + bytes(model.plan.totals.live_peak_bytes)));
    steps.forEach((_, at) => { if (seen(at)) moving.append(stepBox(model, at, [x(at), laneTop(at), x(at + 1) - x(at)])); });
    const here = pointed === null ? -1 : stepAt(pointed);
    arrows.forEach((arrow) => { if (seen(arrow.from) || seen(arrow.to)) moving.append(hazardArrow(arrow, [x(arrow.from + 1), laneTop(arrow.from)], [x(arrow.to), laneTop(arrow.to)], arrow.to === here || arrow.from === here)); });
    steps.forEach((step, at) => step.waits.forEach((wait) => { if (wait.frames_ago === 0) moving.append(waitArrow(wait, at, [x(wait.step + 1), laneTop(wait.step)], [x(at), laneTop(at)])); }));
    rows.forEach((row, at) => {
      const rowY = aliveEnd + at * IMAGE_ROW;
      if (rowY + IMAGE_ROW < top || rowY > top + height) return;
      names.append(shape("text", { class: "end", x: NAME_ROOM - 10, y: rowY + 13, ...picks(row.key) }, shape("title", {}, nameOf(row.key)), inMiddle(nameOf(row.key), 26)));
      moving.append(...imageRow(model, row, rowY, x, seen));
    });
    if (pointed !== null) moving.append(shape("path", { class: "cross", d: `M${pointed} 0V${extent()[1]}` }));
    const cover = shape("rect", { fill: "var(--ground)", x: 0, y: 0, width: NAME_ROOM - 4, height });
    svg.append(moving, cover, names);
  });
  const stepAt = (place) => starts.findIndex((start, index) => index < steps.length && place >= x(index) && place < x(index + 1));
  box.addEventListener("pointermove", (event) => {
    pointed = event.clientX - box.getBoundingClientRect().left + box.scrollLeft;
    const at = stepAt(pointed);
    cross.textContent = visible(at < 0 ? "\u00a0" : stepWords(model, at));
    box.redraw();
  });
  box.addEventListener("pointerleave", () => { pointed = null; box.redraw(); });
  box.reveal = (wanted) => {
    const found = model.byKey.get(wanted);
    const at = found?.kind === "pass" ? found.node.step : found?.kind === "step" ? found.at : null;
    if (at !== null) box.show(starts[at], box.scrollTop, x(at + 1) - x(at) + NAME_ROOM, 1);
    const row = rows.findIndex((one) => one.key === wanted);
    if (row >= 0) box.show(box.scrollLeft, aliveEnd + row * IMAGE_ROW, 1, IMAGE_ROW);
  };
  const waits = steps.reduce((sum, step) => sum + step.waits.length, 0);
  const words = lanes.length <= 1 ? `All ${count(steps.length, "step", "steps")} run on one queue.` : `${count(steps.length, "step", "steps")} on ${lanes.length} queues, with ${count(waits, "wait", "waits")} between them.`;
  const choice = element("label", {}, "Width: ", element("select", { onchange: (event) => {
    kind = event.target.value;
    ({ starts, perMs } = stepsOver(model, kind));
    box.resize(extent());
  } }, WIDTHS.filter(([value]) => value !== "ms" || model.timed()).map(([value, shown]) => element("option", { value, selected: value === kind }, shown))));
  const group = element("div", { class: "fills" }, element("p", { class: "tools" }, choice, element("span", { class: "hint" }, words + " A red edge is a barrier, with an arrow from the step that it waits for; a thick arrow is a wait between queues.")), timesNote(model), box, cross);
  group.redraw = box.redraw;
  group.reveal = box.reveal;
  return group;
}

function stepWords(model, at) {
  const names = model.byKey.get(model.stepKey(at)).nodes.map((node) => node.name).join(", ") || "barriers alone";
  const ms = model.msOfStep(at);
  return `step ${at}: ${names}; ${ms === null ? "" : milliseconds(ms) + ", "}moves ${bytes(movedSum(model.moved[at]))}, ${bytes(model.alive[at])} alive`;
}

function stepBox(model, at, [left, top, width]) {
  const step = model.plan.steps[at];
  const key = model.stepKey(at);
  const kind = typeof step.work === "string" ? "beside" : { render: "draw" }[Object.keys(step.work)[0]] ?? Object.keys(step.work)[0];
  const nodes = model.byKey.get(key).nodes;
  const barriers = step.image_barriers.length + step.memory_barriers.length;
  return shape("g", { class: kind, ...picks(key) },
    shape("title", {}, stepWords(model, at)),
    shape("rect", { x: left + 1, y: top + 4, width: Math.max(2, width - 2), height: LANE_HEIGHT - 14, rx: 3 }),
    barriers > 0 ? shape("path", { class: "barrier", d: `M${left + 1} ${top + 4}v${LANE_HEIGHT - 14}` }, shape("title", {}, count(barriers, "barrier", "barriers") + " before step " + at)) : null,
    width > 16 ? shape("text", { class: "middle small", x: left + width / 2, y: top + 17 }, at) : null,
    width > 40 ? shape("text", { class: "middle small", x: left + width / 2, y: top + 29 }, inMiddle(nodes[0]?.name ?? "", Math.floor(width / 6.5))) : null);
}

const waitArrow = (wait, at, [fromX, fromY], [toX, toY]) => shape("path", { class: "wait", d: `M${fromX - 2} ${fromY + 20}C${fromX + 20} ${fromY + 20} ${toX - 20} ${toY + 20} ${toX + 2} ${toY + 20}`, "marker-end": "url(#end-of-wait)" },
  shape("title", {}, `step ${at} waits in ${wait.stages} for step ${wait.step}`));

/** From the end of a step to the beginning of a later one that a barrier makes wait for it, below their boxes. */
const hazardArrow = ({ from, to, names }, [fromX, fromY], [toX, toY], near) => {
  const [fromEdge, toEdge] = [fromY, toY].map((top) => top + LANE_HEIGHT - 12);
  const low = Math.max(fromEdge, toEdge) + 7;
  return shape("path", { class: near ? "hazard near" : "hazard", d: `M${fromX - 4} ${fromEdge}C${fromX + 4} ${low} ${toX - 8} ${low} ${toX + 2} ${toEdge}`, "marker-end": "url(#end-of-hazard)" },
    shape("title", {}, `a barrier before step ${to} waits for step ${from}: ${names.join(", ")}`));
};

/** The bytes that are alive over the steps, with the least that any placement takes. */
function aliveCurve(model, x, top, height) {
  const { live_peak_bytes: peak, placed_bytes: placed } = model.plan.totals;
  const level = (amount) => top + height - amount / Math.max(1, placed, peak) * (height - 6);
  const points = model.alive.map((amount, at) => `L${x(at)} ${level(amount)}L${x(at + 1)} ${level(amount)}`).join("");
  return [shape("path", { class: "alive", d: `M${x(0)} ${top + height}${points}L${x(model.alive.length)} ${top + height}Z` }),
    shape("path", { class: "peak", d: `M${x(0)} ${level(peak)}H${x(model.alive.length)}` })];
}

function imageRow(model, row, top, x, seen) {
  const used = [...row.steps.keys()];
  const lives = row.resource.role.transient?.lifetime ?? [Math.min(...used), Math.max(...used)];
  const made = [shape("rect", { class: row.resource.role.transient ? "life" : "outside", x: x(lives[0]), y: top + 3, width: x(lives[1] + 1) - x(lives[0]), height: IMAGE_ROW - 6, rx: 3, "data-key": row.key, onclick: () => select(row.key, { reveal: false }) })];
  for (const [at, mark] of row.steps) {
    if (!seen(at)) continue;
    const how = mark.reads && mark.writes ? "both" : mark.writes ? "writes" : "reads";
    made.push(shape("rect", { class: how, x: x(at) + 2, y: top + 5, width: Math.max(2, x(at + 1) - x(at) - 4), height: IMAGE_ROW - 10, rx: how === "reads" ? 4 : 1, "data-key": row.key + "\u0001" + model.stepKey(at), onclick: () => select(row.key, { reveal: false }) },
      shape("title", {}, `step ${at} ${how === "both" ? "reads and writes" : how} ${nameOf(row.key)}`)));
  }
  return made;
}
