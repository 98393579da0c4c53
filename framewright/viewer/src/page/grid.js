/** The grid: work from left to right, images and buffers from top to bottom, and a mark where one uses the other. */
const CELL = 22;
const NAMES = 210;
const HEADS = 150;
function gridView(model) {
  if (!model.plan) return tooLarge(model);
  const columns = model.nodes.map((node) => ({ node, key: node.key, title: node.name }));
  model.plan.notes.forEach((note, at) => {
    if (note.kind === "unneeded") columns.push({ key: "note:" + model.letter + at, title: note.subject, culled: note.text });
  });
  const used = new Map();
  model.nodes.forEach((node, at) => node.uses.forEach((use) => {
    const key = model.resourceKey(use.resource);
    if (!used.has(key)) used.set(key, { key, resource: model.resourceOf(use.resource), first: at, last: at, marks: new Map() });
    const row = used.get(key);
    row.last = at;
    const mark = row.marks.get(at) || { reads: false, writes: false, roles: new Set() };
    mark.reads ||= use.reads;
    mark.writes ||= use.writes;
    mark.roles.add(use.role.replace("_", " "));
    row.marks.set(at, mark);
  }));
  const rows = [...used.values()];
  const x = (column) => NAMES + column * CELL;
  const y = (row) => HEADS + row * CELL;
  const extent = [x(columns.length) + 12, y(rows.length) + 12];
  const box = scroller(extent, "Passes and images of " + model.name, (svg, left, top, width, height) => {
    svg.setAttribute("viewBox", [0, 0, width, height].join(" "));
    const from = [Math.max(0, Math.floor(left / CELL)), Math.max(0, Math.floor(top / CELL))];
    const to = [Math.min(columns.length, Math.ceil((left + width - NAMES) / CELL) + 1), Math.min(rows.length, Math.ceil((top + height - HEADS) / CELL) + 1)];
    const body = shape("g", { transform: `translate(${-left} ${-top})` });
    const heads = shape("g", { transform: `translate(${-left} 0)` });
    const names = shape("g", { transform: `translate(0 ${-top})` });
    for (let column = from[0]; column < to[0]; column += 1) {
      const { node, key, title, culled } = columns[column];
      const begins = node && (column === 0 || columns[column - 1].node?.step !== node.step);
      if (node && node.step % 2 === 0) body.append(shape("rect", { class: "stripe", x: x(column), y: HEADS, width: CELL, height: rows.length * CELL }));
      if (begins) heads.append(shape("text", { class: "small", x: x(column) + 2, y: 10, "data-key": model.stepKey(node.step), onclick: () => select(model.stepKey(node.step), { reveal: false }) }, node.step));
      heads.append(shape("g", { class: (node ? node.kind : "") + (culled ? " culled" : ""), "data-key": key, onclick: () => select(key, { reveal: false }) },
        shape("title", {}, culled ? title + ": " + culled : title),
        shape("rect", { x: x(column) + 1, y: 14, width: CELL - 2, height: HEADS - 16, rx: 3, fill: "none" }),
        shape("text", { transform: `translate(${x(column) + 15} ${HEADS - 6}) rotate(-90)` }, inMiddle(title, 20))));
    }
    for (let row = from[1]; row < to[1]; row += 1) {
      const { key, resource, first, last, marks } = rows[row];
      const lives = resource.role.transient;
      const choose = () => select(key, { reveal: false });
      body.append(shape("rect", { class: lives ? "life" : "outside", x: lives ? x(first) : NAMES, y: y(row) + 4, width: (lives ? last - first + 1 : columns.length) * CELL, height: CELL - 8, rx: 4 }));
      names.append(shape("g", { "data-key": key, onclick: choose }, shape("title", {}, resource.name), shape("rect", { x: 0, y: y(row), width: NAMES - 4, height: CELL, fill: "none" }),
        shape("text", { class: "end", x: NAMES - 8, y: y(row) + 15 }, inMiddle(resource.name, 28))));
      for (const [at, mark] of marks) {
        if (at < from[0] || at >= to[0]) continue;
        const how = mark.reads && mark.writes ? "both" : mark.writes ? "writes" : "reads";
        body.append(shape("g", { class: "mark", "data-key": key + "\u0001" + columns[at].key, onclick: choose },
          shape("title", {}, `${columns[at].title}: ${resource.name}, ${how === "both" ? "reads and writes" : how} (${[...mark.roles].join(", ")})`),
          shape("rect", { class: how, x: x(at) + 3, y: y(row) + 3, width: CELL - 6, height: CELL - 6, rx: how === "reads" ? 8 : 2 }),
          shape("text", { class: "glyph", x: x(at) + CELL / 2, y: y(row) + 15 }, { reads: "R", writes: "W", both: "B" }[how])));
      }
    }
    const cover = (attributes) => shape("rect", { fill: "var(--ground)", ...attributes });
    svg.append(body, cover({ x: 0, y: 0, width, height: HEADS }), heads, cover({ x: 0, y: 0, width: NAMES, height }), names, cover({ x: 0, y: 0, width: NAMES, height: HEADS }),
      shape("text", { class: "small", x: 8, y: 14 }, "step"), shape("text", { class: "small", x: 8, y: HEADS - 8 }, count(rows.length, "image or buffer", "images and buffers")));
  });
  box.reveal = (wanted) => {
    const column = columns.findIndex((one) => one.key === wanted);
    const row = rows.findIndex((one) => one.key === wanted);
    if (column >= 0) box.show(column * CELL, box.scrollTop, CELL + NAMES, 1);
    if (row >= 0) box.show(box.scrollLeft, row * CELL, 1, CELL + HEADS);
  };
  const legend = element("p", { class: "hint" }, "R reads · W writes · B reads and writes, or draws over what is there · a bar is the lifetime of transient memory, "
    + "a faint one the whole frame · columns of one step have one shade · grey columns were left out: nothing needs them");
  const group = element("div", {}, legend, box);
  group.redraw = box.redraw;
  group.reveal = box.reveal;
  return group;
}
