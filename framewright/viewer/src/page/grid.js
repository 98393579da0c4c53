/** The grid: work from left to right, images and buffers from top to bottom, and a mark where one uses the other. */
const CELL = 22;
const NAMES = 230;
const SUMS = 96;
const HEADS = 150;
/** How high rows with pictures are. */
const PICTURED = 56;
/** Room above the heads for the milliseconds of steps. */
const TIMES = 14;
/** What a row may be, for the filter. */
const ROW_KINDS = [["all", "all"], ["related", "related to the selection"], ["attachment", "attachments"], ["sampled", "sampled images"], ["storage", "storage"], ["kept", "what outlives the frame"]];

/** The columns: work, then what was left out. */
function gridColumns(model) {
  const columns = model.nodes.map((node) => ({ node, key: node.key, title: node.name }));
  model.plan.notes.forEach((note, at) => {
    if (note.kind === "unneeded") columns.push({ key: "note:" + model.letter + at, title: note.subject, culled: note.text });
  });
  return columns;
}

const isOfKind = (row, kind) => ({
  all: true,
  related: state.selected === null || row.key === state.selected || relatedKeys().has(row.key),
  attachment: ["color", "depth", "resolve", "stencil"].some((role) => row.roles.has(role)),
  sampled: row.roles.has("sampled"),
  storage: row.roles.has("storage") || row.roles.has("buffer"),
  kept: !row.resource.role.transient,
})[kind];

function gridView(model) {
  if (!model.plan) return tooLarge(model);
  const columns = gridColumns(model);
  const all = model.rows();
  let kind = "all";
  let rows = all;
  let tall = CELL;
  const x = (column) => NAMES + SUMS + column * CELL;
  const headsHeight = HEADS + (model.timed() ? TIMES : 0);
  const y = (row) => headsHeight + row * tall;
  const extent = () => [x(columns.length) + 12, y(rows.length) + 12];
  const box = scroller(extent(), "Passes and images of " + model.name, (svg, left, top, width, height) => {
    svg.setAttribute("viewBox", [0, 0, width, height].join(" "));
    const from = [Math.max(0, Math.floor(left / CELL)), Math.max(0, Math.floor(top / tall))];
    const to = [Math.min(columns.length, Math.ceil((left + width - NAMES - SUMS) / CELL) + 1), Math.min(rows.length, Math.ceil((top + height - headsHeight) / tall) + 1)];
    const body = shape("g", { transform: `translate(${-left} ${-top})` });
    const heads = shape("g", { transform: `translate(${-left} 0)` });
    const names = shape("g", { transform: `translate(0 ${-top})` });
    for (let column = from[0]; column < to[0]; column += 1) drawColumn(model, columns, column, [x(column), headsHeight], rows.length * tall, body, heads);
    for (let row = from[1]; row < to[1]; row += 1) {
      drawRow(rows[row], columns, [from[0], to[0]], x, y(row) + (tall - CELL) / 2, body, names, tall > CELL ? 16 : 30);
      const capture = tall > CELL ? captureOf(rows[row].resource.name) : null;
      if (capture) names.append(tinyPicture(capture, "grid:" + rows[row].key, [4, y(row) + 3, 92, tall - 6]));
    }
    const cover = (attributes) => shape("rect", { fill: "var(--ground)", ...attributes });
    svg.append(...[body, cover({ x: 0, y: 0, width, height: headsHeight }), heads, cover({ x: 0, y: 0, width: NAMES + SUMS, height }), names, cover({ x: 0, y: 0, width: NAMES + SUMS, height: headsHeight }),
      model.timed() ? shape("text", { class: "small end", x: NAMES + SUMS - 8, y: 23 }, "ms of the step, " + milliseconds(model.times.frame.median) + " in all") : null,
      shape("text", { class: "small end", x: NAMES + SUMS - 8, y: 10 }, "step"), shape("text", { class: "small", x: 8, y: headsHeight - 8 }, count(rows.length, "image or buffer", "images and buffers")),
      shape("text", { class: "small end", x: NAMES + SUMS - 8, y: headsHeight - 8 }, "moved")].filter(Boolean));
  });
  const filtered = () => {
    rows = all.filter((row) => isOfKind(row, kind));
    box.resize(extent());
  };
  box.reveal = (wanted) => {
    if (kind === "related") filtered();
    const column = columns.findIndex((one) => one.key === wanted);
    const row = rows.findIndex((one) => one.key === wanted);
    if (column >= 0) box.show(column * CELL, box.scrollTop, CELL + NAMES + SUMS, 1);
    if (row >= 0) box.show(box.scrollLeft, row * tall, 1, tall + headsHeight);
  };
  const choice = element("label", {}, "Rows: ", element("select", { onchange: (event) => { kind = event.target.value; filtered(); } }, ROW_KINDS.map(([value, words]) => element("option", { value }, words))));
  const switched = picturesSwitch((on) => {
    tall = on ? PICTURED : CELL;
    box.resize(extent());
  });
  const legend = element("p", { class: "tools" }, choice, switched, element("span", { class: "hint" }, "R reads · W writes · B reads and writes · red edge: barrier before · dot above: loaded · dot below: stored · bar: lifetime, faint if it outlives the frame · grey: left out, nothing needs it"));
  const group = element("div", { class: "fills" }, legend, box);
  group.redraw = box.redraw;
  group.reveal = box.reveal;
  return group;
}

function drawColumn(model, columns, column, [left, bottom], below, body, heads) {
  const { node, key, title, culled } = columns[column];
  const begins = node && (column === 0 || columns[column - 1].node?.step !== node.step);
  if (node && node.step % 2 === 0) body.append(shape("rect", { class: "stripe", x: left, y: bottom, width: CELL, height: below }));
  if (begins) heads.append(shape("text", { class: "small", x: left + 2, y: 10, "data-key": model.stepKey(node.step), onclick: () => select(model.stepKey(node.step), { reveal: false }) }, node.step));
  if (begins && model.timed()) heads.append(shape("text", { class: "small ms", x: left + 1, y: 23 }, shortTime(model.msOfStep(node.step) ?? 0)));
  const time = node ? model.timeWords(node) : null;
  heads.append(shape("g", { class: (node ? node.kind : "") + (culled ? " culled" : ""), ...picks(key) },
    shape("title", {}, culled ? title + ": " + culled : time ? title + ": " + time : title),
    shape("rect", { x: left + 1, y: bottom - HEADS + 14, width: CELL - 2, height: HEADS - 16, rx: 3, fill: "none" }),
    shape("text", { transform: `translate(${left + 15} ${bottom - 6}) rotate(-90)` }, inMiddle(title, 19))));
}

function drawRow({ key, resource, first, last, marks, moved }, columns, [from, to], x, top, body, names, letters) {
  const lives = resource.role.transient;
  const choose = () => select(key, { reveal: false });
  body.append(shape("rect", { class: lives ? "life" : "outside", x: x(lives ? first : 0), y: top + 4, width: (lives ? last - first + 1 : columns.length) * CELL, height: CELL - 8, rx: 4 }));
  names.append(shape("g", picks(key), shape("title", {}, resource.name + ", " + sizeOf(resource)), shape("rect", { x: letters < 30 ? 100 : 0, y: top, width: NAMES - 4 - (letters < 30 ? 100 : 0), height: CELL, fill: "none" }),
    shape("text", { class: "end", x: NAMES - 8, y: top + 15 }, inMiddle(resource.name, letters))),
  shape("text", { class: "small end", x: NAMES + SUMS - 8, y: top + 15 }, moved > 0 ? bytes(moved) : ""));
  for (const [at, mark] of marks) {
    if (at < from || at >= to) continue;
    const how = mark.reads && mark.writes ? "both" : mark.writes ? "writes" : "reads";
    const { barrier, loads, stores } = mark;
    const more = [barrier ? "after a barrier" : null, loads ? "loaded" : null, stores ? "stored" : null].filter(Boolean).map((word) => ", " + word).join("");
    body.append(shape("g", { class: "mark", "data-key": key + "\u0001" + columns[at].key, onclick: choose },
      shape("title", {}, `${columns[at].title}: ${resource.name}, ${how === "both" ? "reads and writes" : how} (${[...mark.roles].join(", ")})${more}`),
      shape("rect", { class: how, x: x(at) + 3, y: top + 3, width: CELL - 6, height: CELL - 6, rx: how === "reads" ? 8 : 2 }),
      barrier ? shape("path", { class: "barrier", d: `M${x(at) + 1} ${top + 2}v${CELL - 4}` }) : null,
      loads ? shape("circle", { class: "dot", cx: x(at) + CELL - 4, cy: top + 4, r: 2.5 }) : null,
      stores ? shape("circle", { class: "dot", cx: x(at) + CELL - 4, cy: top + CELL - 4, r: 2.5 }) : null,
      shape("text", { class: "glyph", x: x(at) + CELL / 2, y: top + 15 }, { reads: "R", writes: "W", both: "B" }[how])));
  }
}
