/** The graph: steps as boxes from top to bottom with their passes and what they write, and the contents that go between. */
const ROW = 20;
/** How high pictures in boxes are. */
const BOX_PICTURE = 58;
/** Frames of more passes than this begin with their fragments folded. */
const FOLD_ABOVE = 80;

/** The fragment that a pass comes from: what stands before the last dot of its name. */
const fragmentOf = (name) => {
  const at = name.lastIndexOf(".");
  return at > 0 ? name.slice(0, at) : null;
};

/** The boxes and edges of the graph, with the fragments in `folded` as one box each. */
function graphOf(model, folded) {
  const boxes = [];
  const byName = new Map();
  const box = (name, make) => {
    if (!byName.has(name)) {
      byName.set(name, boxes.length);
      boxes.push({ nodes: [], writes: new Map(), ...make() });
    }
    return byName.get(name);
  };
  const boxOf = model.nodes.map((node) => {
    const fragment = fragmentOf(node.name);
    const at = fragment && folded.has(fragment)
      ? box("fragment:" + fragment, () => ({ kind: "fragment", title: fragment, fragment }))
      : box("step:" + node.step, () => ({ kind: "step", step: node.step, title: "step " + node.step, key: model.stepKey(node.step) }));
    boxes[at].nodes.push(node);
    return at;
  });
  const beside = (resource, before) => {
    const key = model.resourceKey(resource);
    return box((before ? "before:" : "after:") + key, () => ({ kind: "beside", key, title: nameOf(key), before }));
  };
  const joined = new Map();
  for (const edge of model.edges) {
    const from = edge.from === null ? beside(edge.resource, true) : boxOf[edge.from];
    const to = edge.to === null ? beside(edge.resource, false) : boxOf[edge.to];
    const writer = edge.from === null ? null : model.nodes[edge.from];
    if (writer) boxes[from].writes.set(model.resourceKey(edge.resource), edge.resource);
    // A folded fragment may be needed and need: what it reads of later work stays an edge of that work.
    if (from === to) continue;
    const name = from + " " + to;
    if (!joined.has(name)) joined.set(name, { from, to, parts: [] });
    joined.get(name).parts.push({
      key: model.resourceKey(edge.resource),
      ends: [edge.from, edge.to].filter((at) => at !== null).map((at) => model.nodes[at].key),
      text: nameOf(model.resourceKey(edge.resource)) + partOf(model, writer ?? (edge.to === null ? null : model.nodes[edge.to]), edge.resource),
    });
  }
  return inOrder(boxes, [...joined.values()]);
}

/** The part of an image that a pass uses, in words; empty for all of it. */
function partOf(model, node, resource) {
  const image = "image" in resource ? model.plan.images[resource.image] : null;
  const use = image && node?.uses.find((one) => one.resource.image === resource.image);
  if (!use) return "";
  const { base_mip: mip, mips, base_layer: layer, layers } = use.range;
  const span = (word, from, number) => number === 1 ? `${word} ${from}` : `${word}s ${from}–${from + number - 1}`;
  return (mips < image.mips ? ", " + span("mip", mip, mips) : "") + (layers < image.layers ? ", " + span("layer", layer, layers) : "");
}

/** The boxes so that edges lead to later ones. Edges that a folded fragment has in both directions are left out of the layers. */
function inOrder(boxes, edges) {
  const need = boxes.map(() => new Set());
  edges.forEach(({ from, to }) => need[to].add(from));
  const place = boxes.map(() => null);
  const sequence = [];
  const visit = (start) => {
    const stack = [[start, [...need[start]]]];
    place[start] = -1;
    while (stack.length > 0) {
      const [at, rest] = stack.at(-1);
      const next = rest.pop();
      if (next === undefined) {
        place[at] = sequence.length;
        sequence.push(at);
        stack.pop();
      } else if (place[next] === null) {
        place[next] = -1;
        stack.push([next, [...need[next]]]);
      }
    }
  };
  boxes.forEach((_, at) => { if (place[at] === null) visit(at); });
  const turned = edges.map((edge) => ({ ...edge, from: place[edge.from], to: place[edge.to] }));
  return { boxes: sequence.map((at) => boxes[at]), edges: turned.filter(({ from, to }) => from < to) };
}

/** What a box says of itself: below its title its passes, and what it writes for others. */
function measured(model, box, pictured) {
  const passes = new Set(box.nodes.map((node) => node.name));
  const writes = [...box.writes].map(([key, resource]) => ({ key, text: nameOf(key), about: sizeOf(model.resourceOf(resource)), capture: pictured ? captureOf(nameOf(key), passes) : null }));
  const ms = box.nodes.length > 0 ? model.msOf(box) : null;
  const about = box.kind === "fragment" ? count(box.nodes.length, "pass", "passes")
    : box.kind === "step" ? scopeWords(model.plan.steps[box.step]) : box.before ? "from before the frame" : "after the frame";
  const rows = box.kind === "fragment" ? [] : box.nodes;
  const letters = Math.max(box.title.length + about.length + 4, ...rows.map((node) => node.name.length + (node.because ? 4 : 0)), ...writes.map(({ text, about }) => text.length + about.length + 3));
  const width = Math.min(340, Math.max(120, 20 + 6.4 * letters));
  return { ...box, rows, list: writes, about, ms, width, height: ROW + 4 + ROW * (rows.length + writes.length) + BOX_PICTURE * writes.filter(({ capture }) => capture).length + (rows.length + writes.length > 0 ? 6 : 0) };
}

const scopeWords = ({ work }) => typeof work === "string" || !work.render ? (typeof work === "string" ? "" : Object.keys(work)[0])
  : `${work.render.extent.join("×")}${work.render.samples > 1 ? `, ${work.render.samples} samples` : ""}${work.render.layers > 1 ? `, ${work.render.layers} layers` : ""}`;

const sizeOf = (one) => one.extent ? `${one.format.toLowerCase().replaceAll("_", " ")} ${one.extent[0]}×${one.extent[1]}${one.layers > 1 ? "×" + one.layers : ""}` : bytes(one.bytes);

function graphView(model) {
  if (!model.plan) return tooLarge(model);
  const fragments = [...new Set(model.nodes.map((node) => fragmentOf(node.name)).filter(Boolean))];
  const folded = new Set(model.nodes.length > FOLD_ABOVE ? fragments : []);
  let drawn;
  let pictured = false;
  const lay = () => {
    const { boxes, edges } = graphOf(model, folded);
    const sized = boxes.map((box) => measured(model, box, pictured));
    drawn = { boxes: sized, edges, ...layered(sized, edges) };
  };
  lay();
  const box = canvas("Graph of " + model.name, () => drawn.extent, (svg, seen) => {
    const inSight = ([left, top], [width, height]) => left + width >= seen[0] && left <= seen[0] + seen[2] && top + height >= seen[1] && top <= seen[1] + seen[3];
    svg.append(shape("defs", {}, shape("marker", { id: "end", viewBox: "0 0 8 8", refX: 7, refY: 4, markerWidth: 7, markerHeight: 7, markerUnits: "userSpaceOnUse", orient: "auto" }, shape("path", { class: "arrow", d: "M0 0L8 4L0 8z" }))));
    drawn.edges.forEach((edge, at) => {
      const points = drawn.ways[at];
      const [xs, ys] = [0, 1].map((axis) => points.map((point) => point[axis]));
      const corner = [Math.min(...xs), Math.min(...ys)];
      if (!inSight(corner, [Math.max(...xs) - corner[0], Math.max(...ys) - corner[1]])) return;
      const keys = [...new Set(edge.parts.map((part) => part.key))];
      svg.append(shape("path", { class: "way", d: curve(points), "marker-end": "url(#end)", "data-key": keys.join("\u0001"), "data-ends": [...new Set(edge.parts.flatMap((part) => part.ends))].join("\u0001"),
        onclick: () => select(keys[0], { reveal: false }) }, shape("title", {}, [...new Set(edge.parts.map((part) => part.text))].join("\n"))));
    });
    drawn.boxes.forEach((one, at) => { if (inSight(drawn.places[at], [one.width, one.height])) svg.append(drawnBox(model, one, drawn.places[at], unfold)); });
  });
  const again = () => {
    lay();
    box.fit();
    highlight(box);
  };
  const unfold = (fragment) => {
    folded.delete(fragment);
    again();
  };
  box.reveal = (wanted) => {
    const at = drawn.boxes.findIndex((one) => one.key === wanted || one.nodes.some((node) => node.key === wanted) || one.writes.has(wanted));
    if (at >= 0) box.show(...drawn.places[at], drawn.boxes[at].width, drawn.boxes[at].height);
  };
  const foldAll = element("button", { type: "button", title: "Each fragment as one box, or each pass by itself", onclick: () => {
    if (folded.size > 0) folded.clear();
    else fragments.forEach((one) => folded.add(one));
    foldAll.textContent = folded.size > 0 ? "Unfold fragments" : "Fold fragments";
    again();
  } }, folded.size > 0 ? "Unfold fragments" : "Fold fragments");
  const group = element("div", { class: "fills" }, element("p", { class: "tools" }, box.buttons, fragments.length > 0 ? foldAll : null, picturesSwitch((on) => { pictured = on; again(); }),
    element("span", { class: "hint" }, "A box is a step: its passes, and below them what it writes for others. Drag moves, the wheel zooms.")), box);
  group.redraw = box.redraw;
  group.reveal = box.reveal;
  return group;
}

/** A way through points, as a curve that leaves and reaches boxes upright. */
const curve = (points) => points.map(([x, y], at) => {
  if (at === 0) return `M${x} ${y}`;
  const [bx, by] = points[at - 1];
  return bx === x ? `V${y}` : `C${bx} ${(by + y) / 2} ${x} ${(by + y) / 2} ${x} ${y}`;
}).join("");

function drawnBox(model, box, [x, y], unfold) {
  const made = shape("g", { class: "box " + box.kind });
  const choose = (key) => () => select(key, { reveal: false });
  const frame = { x, y, width: box.width, height: box.height, rx: box.kind === "beside" ? 18 : 6 };
  if (box.kind === "beside") {
    made.append(shape("g", { class: "beside", ...picks(box.key) }, shape("title", {}, box.title + ", " + box.about), shape("rect", frame),
      shape("text", { class: "middle", x: x + box.width / 2, y: y + 16 }, inMiddle(box.title, 30))));
    return made;
  }
  const open = box.kind === "fragment" ? () => unfold(box.fragment) : choose(box.key);
  made.append(shape("rect", { class: "frame", ...frame, ...picks(box.key ?? box.nodes.map((node) => node.key).join("\u0001"), open) }, shape("title", {}, box.kind === "fragment" ? "unfold " + box.fragment : box.title)),
    shape("text", { class: "title", x: x + 8, y: y + 16, onclick: open }, box.kind === "fragment" ? "▸ " + inMiddle(box.title, 34) : box.title),
    shape("text", { class: "end small", x: x + box.width - 8, y: y + 16, onclick: open }, [box.about, box.ms === null ? null : milliseconds(box.ms)].filter(Boolean).join(" · ")));
  let top = y + ROW + 4;
  for (const node of box.rows) {
    made.append(shape("g", { class: node.kind, ...picks(node.key) }, shape("title", {}, [node.name, model.timeWords(node), node.because].filter(Boolean).join("\n")),
      shape("rect", { x: x + 4, y: top, width: box.width - 8, height: ROW - 2, rx: 4 }), shape("text", { x: x + 10, y: top + 13 }, inMiddle(node.name, 48))));
    top += ROW;
  }
  for (const { key, text, about, capture } of box.list) {
    made.append(shape("rect", { class: "under", x: x + 4, y: top, width: box.width - 8, height: ROW - 2, ...picks(key) }, shape("title", {}, text + ", " + about)),
      shape("text", { class: "small", x: x + 10, y: top + 13, "data-key": key, onclick: choose(key) }, inMiddle(text, 28)),
      shape("text", { class: "end small", x: x + box.width - 10, y: top + 13, "pointer-events": "none" }, about));
    top += ROW;
    if (!capture) continue;
    made.append(tinyPicture(capture, "graph:" + key, [x + 10, top, box.width - 20, BOX_PICTURE - 6]));
    top += BOX_PICTURE;
  }
  return made;
}

function tooLarge(model) {
  return element("p", {}, `This Plan has ${model.summary.steps} steps. Plans of more than ${model.summary.most} passes are summarised: `
    + "the steps that move most, and the first lines of each list. ", element("code", {}, "framewright inspect --format json"), " has all of it.");
}
