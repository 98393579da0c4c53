/** The timeline: a lane for each queue, waits and barriers, below them the memory that is alive, and each image over its steps. */
const LANE_HEIGHT = 46;
const LANES_TOP = 22;
const ALIVE_HEIGHT = 70;
const IMAGE_ROW = 18;
const NAME_ROOM = 190;
/** What the width of a step may mean. */
const WIDTHS = [["equal", "equal"], ["bytes", "bytes moved"], ["ms", "milliseconds"]];

/** Where each step begins and ends, from left to right. */
function stepsOver(model, kind) {
  const { steps } = model.plan;
  const weights = steps.map((_, at) => kind === "bytes" ? movedSum(model.moved[at]) : kind === "ms" ? model.msOfStep(at) ?? 0 : 1);
  const sum = weights.reduce((one, other) => one + other, 0) || 1;
  const room = Math.max(760, steps.length * 26);
  // The least width shows that a step is there.
  const widths = weights.map((weight) => kind === "equal" ? Math.max(26, Math.min(90, room / steps.length)) : 6 + weight / sum * room);
  const starts = [0];
  widths.forEach((width) => starts.push(starts.at(-1) + width));
  return starts;
}

function timelineView(model) {
  if (!model.plan) return tooLarge(model);
  const { steps } = model.plan;
  const lanes = [...new Set(steps.map((step) => step.queue))];
  const rows = model.rows();
  const lanesEnd = LANES_TOP + lanes.length * LANE_HEIGHT;
  const aliveEnd = lanesEnd + ALIVE_HEIGHT + 18;
  let kind = model.timed() ? "ms" : "equal";
  let starts = stepsOver(model, kind);
  const x = (at) => NAME_ROOM + starts[at];
  const laneTop = (at) => LANES_TOP + lanes.indexOf(steps[at].queue) * LANE_HEIGHT;
  const extent = () => [x(steps.length) + 16, aliveEnd + rows.length * IMAGE_ROW + 16];
  const cross = element("p", { class: "hint", role: "status" }, "\u00a0");
  let pointed = null;
  const box = scroller(extent(), "Timeline of " + model.name, (svg, left, top, width, height) => {
    svg.setAttribute("viewBox", [0, 0, width, height].join(" "));
    const moving = shape("g", { transform: `translate(${-left} ${-top})` });
    const names = shape("g", { transform: `translate(0 ${-top})` });
    const seen = (at) => x(at + 1) >= left && x(at) <= left + width;
    lanes.forEach((lane, at) => {
      const laneY = LANES_TOP + at * LANE_HEIGHT;
      moving.append(shape("rect", { class: "lane", x: NAME_ROOM, y: laneY, width: starts.at(-1), height: LANE_HEIGHT - 6 }));
      names.append(shape("text", { class: "end", x: NAME_ROOM - 10, y: laneY + 24 }, lane.toLowerCase() + " queue"));
    });
    moving.append(...aliveCurve(model, x, lanesEnd + 16, ALIVE_HEIGHT));
    names.append(shape("text", { class: "end", x: NAME_ROOM - 10, y: lanesEnd + 30 }, "memory alive"), shape("text", { class: "end small", x: NAME_ROOM - 10, y: lanesEnd + 44 }, "peak " + bytes(model.plan.totals.live_peak_bytes)));
    steps.forEach((_, at) => { if (seen(at)) moving.append(stepBox(model, at, [x(at), laneTop(at), x(at + 1) - x(at)])); });
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
  box.addEventListener("pointermove", (event) => {
    pointed = event.clientX - box.getBoundingClientRect().left + box.scrollLeft;
    const at = starts.findIndex((start, index) => pointed >= x(index) && pointed < x(index + 1));
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
    starts = stepsOver(model, kind);
    box.resize(extent());
  } }, WIDTHS.filter(([value]) => value !== "ms" || model.timed()).map(([value, shown]) => element("option", { value, selected: value === kind }, shown))));
  const group = element("div", { class: "fills" }, element("p", { class: "tools" }, choice, element("span", { class: "hint" }, words + " A red edge is a barrier, an arrow a wait.")), box, cross);
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

const waitArrow = (wait, at, [fromX, fromY], [toX, toY]) => shape("path", { class: "wait", d: `M${fromX - 2} ${fromY + 20}C${fromX + 20} ${fromY + 20} ${toX - 20} ${toY + 20} ${toX + 2} ${toY + 20}`, "marker-end": "url(#end)" },
  shape("title", {}, `step ${at} waits in ${wait.stages} for step ${wait.step}`));

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
