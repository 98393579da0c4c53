/** A table whose rows are sorted by the heading that is pressed. Cells are text, or `[shown, sorted by]`. */
function table(headings, rows, keys) {
  const body = element("tbody");
  const order = rows.map((_, at) => at);
  const value = (at, column) => Array.isArray(rows[at][column]) ? rows[at][column][1] : rows[at][column];
  let sorted = null;
  const draw = () => body.replaceChildren(...order.map((at) => element("tr", { "data-key": keys[at] }, rows[at].map((cell, column) =>
    element("td", { class: headings[column][1] || null }, Array.isArray(cell) ? cell[0] : cell)))));
  const sort = (column) => {
    const turn = sorted === column ? -1 : 1;
    sorted = sorted === column ? null : column;
    const numeric = headings[column][1] === "number";
    order.sort((one, other) => turn * (numeric ? value(other, column) - value(one, column) : String(value(one, column)).localeCompare(String(value(other, column)))));
    draw();
    highlight(body);
  };
  draw();
  return element("div", { class: "wide" }, element("table", {}, element("thead", {}, element("tr", {}, headings.map(([name, kind], column) =>
    element("th", { class: kind || null, scope: "col" }, element("button", { type: "button", onclick: () => sort(column) }, name))))), body));
}

/** Bytes that each step moves. */
function costView(model) {
  if (!model.plan) return tooLarge(model);
  const kinds = ["loaded", "stored", "resolved", "copied"];
  const most = Math.max(1, ...model.moved.map(movedSum));
  const all = kinds.map((kind) => model.moved.reduce((sum, moved) => sum + moved[kind], 0));
  const stays = model.onChip.reduce((sum, one) => sum + one, 0);
  const images = new Set(model.on_chip.flat().map(([image]) => image));
  const rows = model.moved.map((moved, at) => {
    const bar = kinds.map((kind) => {
      const made = element("span", { class: "bar " + kind, title: kind + " " + bytes(moved[kind]) });
      made.style.width = moved[kind] / most * 160 + "px";
      return made;
    });
    const names = model.byKey.get(model.stepKey(at)).nodes.map((node) => node.name).join(", ");
    return [[link(model.stepKey(at), "step " + at), at], inMiddle(names || "barriers alone", 60), [bar, movedSum(moved)], ...[...kinds.map((kind) => moved[kind]), movedSum(moved), ...(stays > 0 ? [model.onChip[at]] : [])].map((amount) => [bytes(amount), amount]),
      ...(model.timed() ? [[milliseconds(model.msOfStep(at)), model.msOfStep(at)]] : [])];
  });
  return element("div", {},
    element("p", {}, `The frame moves ${bytes(all.reduce((sum, one) => sum + one, 0))}: ` + kinds.map((kind, at) => bytes(all[at]) + " " + kind).join(", ")
      + ". Counted are attachments that are loaded and stored, resolves, copies and fills. What draws and dispatches sample isn't part of it, nor what a device compresses."),
    stays > 0 ? element("p", { class: "stays" }, `The device draws in tiles, and keeps ${bytes(stays)} on the chip: `,
      [...images].map((image, at) => [at > 0 ? ", " : "", link("image:" + model.plan.images[image].name, model.plan.images[image].name)]),
      images.size === 1 ? " is neither loaded nor stored." : " are neither loaded nor stored.") : null,
    table([["step"], ["work"], ["moved", "number"], ...kinds.map((kind) => [kind, "number"]), ["sum", "number"], ...(stays > 0 ? [["on the chip", "number"]] : []), ...(model.timed() ? [["median", "number"]] : [])], rows, model.moved.map((_, at) => model.stepKey(at))));
}

/** Images and buffers with their memory. */
function imagesView(model) {
  if (!model.plan) return tooLarge(model);
  const rows = model.resources().map((one) => {
    const place = one.role.transient;
    const kind = place ? "transient" : Object.keys(one.role)[0];
    const size = one.extent ? one.extent.slice(0, one.extent[2] > 1 ? 3 : 2).join("×") : bytes(one.bytes);
    const more = one.extent ? [one.samples > 1 ? one.samples + " samples" : null, one.mips > 1 ? one.mips + " mips" : null, one.layers > 1 ? one.layers + " layers" : null].filter(Boolean).join(", ") : "";
    return [[link(model.keyOf(one), one.name), one.name], one.format || "buffer", [size, one.extent ? one.extent[0] * one.extent[1] * one.extent[2] : one.bytes], more, kind,
      place ? [bytes(place.bytes), place.bytes] : ["", 0], place ? `heap ${place.heap} at ${bytes(place.offset)}, steps ${place.lifetime.join("–")}` : ""];
  });
  return table([["name"], ["format"], ["size", "number"], ["more"], ["kind"], ["memory", "number"], ["place"]], rows, model.resources().map((one) => model.keyOf(one)));
}

/** What the compiler decided that no step shows: work that was left out, not merged, not folded, and why. */
function notesView(model) {
  const notes = model.plan ? model.plan.notes : [];
  const parts = model.outline.parts.filter((line) => ["setting", "change", "view", "output", "total"].includes(line.kind));
  const kinds = [...new Set(notes.map((note) => note.kind))];
  return element("div", {}, parts.map((line) => [element("h2", {}, withLinks(line.text)), outlineList(model, line.parts)]),
    kinds.length > 0 ? element("h2", {}, "Decisions that no step shows") : null,
    kinds.map((kind) => [element("h3", {}, kind.replaceAll("_", " ")), element("ul", { class: "outline" }, notes.map((note, at) => note.kind === kind
      ? element("li", { "data-key": "note:" + model.letter + at, class: kind === "unneeded" ? "culled" : null }, link("note:" + model.letter + at, note.subject), ": ", withLinks(note.text), " ", placeLink(model, note.at)) : null))]));
}
