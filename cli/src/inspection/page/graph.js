/** The graph: work as boxes from top to bottom, and the contents that go between. */
const EDGE = 20;
function graphView(model) {
  const { graph } = model;
  if (!graph) return tooLarge(model);
  const extent = graph.extent.map((size) => size + 2 * EDGE);
  const key = (vertex) => vertex.node === null ? model.resourceKey(vertex.resource) : model.nodes[vertex.node].key;
  let scale = 1;
  const box = scroller(extent, "Graph of " + model.name, (svg, ...pixels) => {
    const [left, top, width, height] = pixels.map((size) => size / scale);
    const inSight = (low, high, start, size) => high >= start && low <= start + size;
    svg.setAttribute("viewBox", [left - EDGE, top - EDGE, width, height].join(" "));
    svg.append(shape("defs", {}, shape("marker", { id: "end", viewBox: "0 0 8 8", refX: 7, refY: 4, markerWidth: 7, markerHeight: 7, orient: "auto" }, shape("path", { class: "arrow", d: "M0 0L8 4L0 8z" }))));
    const seen = [left - EDGE, top - EDGE];
    const labels = [];
    graph.edges.forEach((edge, at) => {
      const points = graph.ways[at];
      const [xs, ys] = [0, 1].map((axis) => points.map((point) => point[axis]));
      if (!inSight(Math.min(...xs), Math.max(...xs), seen[0], width) || !inSight(Math.min(...ys), Math.max(...ys), seen[1], height)) return;
      const keys = edge.resources.map((resource) => model.resourceKey(resource));
      const names = keys.map((one) => one.slice(one.indexOf(":") + 1)).join(", ");
      const way = points.map(([x, y], point) => {
        if (point === 0) return `M${x} ${y}`;
        const [bx, by] = points[point - 1];
        return `C${bx} ${(by + y) / 2} ${x} ${(by + y) / 2} ${x} ${y}`;
      }).join("");
      svg.append(shape("path", { class: "way", d: way, "marker-end": "url(#end)", "data-key": keys.join("\u0001"), onclick: () => select(keys[0], { reveal: false }) }, shape("title", {}, names)));
      if (graph.edges.length <= 80) {
        labels.push(shape("text", { class: "along middle", x: (points[0][0] + points[1][0]) / 2, y: (points[0][1] + points[1][1]) / 2 + 3 }, short(names, 40)));
      }
    });
    svg.append(...labels);
    graph.vertices.forEach((vertex, at) => {
      const [x, y, wide] = graph.places[at];
      if (!inSight(x - wide / 2, x + wide / 2, seen[0], width) || !inSight(y - 20, y + 20, seen[1], height)) return;
      const node = vertex.node === null ? null : model.nodes[vertex.node];
      const choose = () => select(key(vertex), { reveal: false });
      svg.append(shape("g", { class: node ? node.kind : "beside", "data-key": key(vertex), onclick: choose },
        shape("title", {}, vertex.name + (node?.because ? "\n" + node.because : "")),
        shape("rect", { x: x - wide / 2, y: y - 20, width: wide, height: 40, rx: node ? 6 : 18 }),
        shape("text", { class: "middle", x, y: y - 2 }, short(vertex.name, 32)),
        shape("text", { class: "middle small", x, y: y + 13 }, node ? vertex.kind + ", step " + node.step : vertex.kind)));
    });
  });
  box.reveal = (wanted) => {
    const at = graph.vertices.findIndex((vertex) => key(vertex) === wanted);
    if (at >= 0) {
      const [x, y, wide] = graph.places[at];
      box.show((x - wide / 2 + EDGE) * scale, (y - 20 + EDGE) * scale, wide * scale, 40 * scale);
    }
  };
  const zoom = (to) => {
    scale = Math.max(0.1, Math.min(4, to));
    box.zoom(scale);
  };
  const button = (name, title, to) => element("button", { type: "button", title, onclick: () => zoom(to()) }, name);
  const group = element("div", {}, element("p", { class: "tools" }, button("−", "Smaller", () => scale / 1.25), button("+", "Larger", () => scale * 1.25),
    button("Fit", "All of the width", () => Math.min(1, (box.clientWidth - 4) / extent[0])), button("1:1", "Full size", () => 1),
    element("span", { class: "hint" }, "Work from top to bottom, and the images and buffers whose contents go between. Orange boxes are resolves.")), box);
  group.redraw = box.redraw;
  group.reveal = box.reveal;
  return group;
}

function tooLarge(model) {
  return element("p", {}, `This Plan has ${model.summary.steps} steps. Plans of more than ${model.summary.most} passes are summarised: `
    + "the steps that move most, and the first lines of each list. `framewright inspect --format json` has all of it.");
}
