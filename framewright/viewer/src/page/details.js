/** The panel about what is selected. */
function showDetails() {
  const panel = document.querySelector("#details > div");
  forgetWithSelection();
  panel.replaceChildren();
  panel.parentElement.classList.toggle("empty", !state.selected && !state.unknown && models.every((model) => model.plan));
  if (!state.selected) {
    if (state.unknown) panel.append(element("p", { role: "status" }, "The address asks for ", element("code", {}, state.unknown), ", which isn't here."));
    panel.append(element("p", { class: "faint" }, "Select a pass, an image or a step to see why it is there, what it needs and what it costs."));
    return;
  }
  for (const model of models) {
    const found = model.byKey.get(state.selected);
    if (!found) continue;
    if (models.length > 1) panel.append(element("p", { class: "faint" }, model.letter.toUpperCase() + ": " + model.name));
    const about = { pass: aboutPass, image: aboutResource, buffer: aboutResource, step: aboutStep, note: aboutNote }[found.kind];
    panel.append(...about(model, found).flat(9).filter((one) => one !== null && one !== undefined));
  }
  highlight(panel);
}

const heading = (text) => element("h3", {}, text);
const list = (entries) => element("ul", { class: "outline" }, entries.map((entry) => element("li", {}, entry)));

function usesOf(model, node) {
  return list(node.uses.map((use) => {
    const resource = model.resourceOf(use.resource);
    const how = use.reads && use.writes ? "reads and writes" : use.writes ? "writes" : "reads";
    const part = use.range && (resource.mips > 1 || resource.layers > 1) ? `, mips ${use.range.base_mip}+${use.range.mips}, layers ${use.range.base_layer}+${use.range.layers}` : "";
    return [how + " ", link(model.keyOf(resource), resource.name), ` (${use.role.replace("_", " ")}${part})`];
  }));
}

/** The captured pictures that `wanted` picks, small ones in a row: they are drawn when they are in sight. */
function picturesFor(title, wanted) {
  const found = DATA.captures.filter(wanted);
  if (found.length === 0) return null;
  return [heading(title), element("div", { class: "strip small-pictures" }, found.map((capture) => figure(models[0], capture)))];
}

/** What a pass's images held before it, and hold after it. */
function picturesOfPass(model, node) {
  const order = new Map(model.nodes.map((one, at) => [one.name, at]));
  const images = node.uses.filter((use) => "image" in use.resource).map((use) => ({ name: frameName(model.resourceOf(use.resource).name), ...use }));
  const last = (image) => DATA.captures.findLast((capture) => capture.image === image && order.get(capture.pass) < node.at_index);
  const before = new Set(images.filter((use) => use.reads).map((use) => last(use.name)).filter(Boolean));
  return [picturesFor("Before it", (capture) => before.has(capture)), picturesFor("After it", (capture) => capture.pass === node.name)];
}

function aboutPass(model, { node }) {
  const step = model.byKey.get(model.stepKey(node.step));
  const name = (at) => link(model.nodes[at].key, model.nodes[at].name);
  const edges = (pick, other, outside) => [...new Map(model.edges.filter(pick).map((edge) => [JSON.stringify([edge[other], edge.resource]), edge])).values()]
    .map((edge) => [edge[other] === null ? outside : name(edge[other]), " for ", link(model.resourceKey(edge.resource), model.resourceOf(edge.resource).name)]);
  const needs = edges((edge) => edge.to === node.at_index, "from", "what came before the frame");
  const needed = edges((edge) => edge.from === node.at_index, "to", "what comes after the frame");
  const lines = (model.lines.get("pass:" + node.name) || []).map(({ line }) => line);
  const folded = node.kind === "folded_resolve" || node.kind === "resolve";
  const resolves = folded ? (step.step && (model.lines.get(model.stepKey(node.step)) || []).flatMap(({ line }) => [line, ...line.parts]).filter((line) => (line.kind === "resolve" || line.kind === "step" && node.kind === "resolve") && line.at === node.at)) : [];
  return [element("h2", {}, node.name), element("p", {}, node.kind.replace("_", " ") + " in ", link(model.stepKey(node.step), "step " + node.step), " ", placeLink(model, node.at)),
    model.timed() ? [element("p", { class: "time" }, model.timeWords(node)), processorNote(model)] : null,
    node.because ? [heading("Why it is there"), element("p", { class: "because" }, withLinks(node.because))] : null,
    picturesOfPass(model, node),
    lines.length > 0 ? [heading("In the Plan"), outlineList(model, lines)] : null,
    resolves.length > 0 ? [heading("In the Plan"), outlineList(model, resolves)] : null,
    heading("Uses"), usesOf(model, node),
    heading("Needs"), needs.length > 0 ? list(needs) : element("p", {}, "nothing that came before"),
    heading("Is needed by"), needed.length > 0 ? list(needed) : element("p", {}, "nothing"),
    heading("Without it"), without(model, node, step)];
}

/** The savings if a pass weren't there: steps in which it is alone, inserted work that only it needs, and images that nothing else uses. */
function without(model, node, step) {
  const isResolve = node.kind === "resolve" || node.kind === "folded_resolve";
  const writes = (user, resource) => user.uses.some((use) => use.writes && model.resourceOf(use.resource) === resource);
  const readsOnly = (user, resource) => user.uses.some((use) => use.reads && model.resourceOf(use.resource) === resource) && !writes(user, resource);
  const gone = new Set([node]);
  const dropped = new Set(isResolve ? node.uses.filter((use) => use.writes).map((use) => model.resourceOf(use.resource)) : []);
  for (let grown = true; grown;) {
    grown = false;
    for (const resource of model.resources()) {
      if (dropped.has(resource) || !resource.role.transient) continue;
      const users = model.users(model.keyOf(resource)).filter((user) => !gone.has(user));
      const inserted = users.every((user) => user.because !== null && user.uses.every((use) => !use.writes || model.resourceOf(use.resource) === resource));
      // What nothing reads any more isn't needed, and neither is inserted work that made it.
      if (users.length === 0 || inserted && !users.some((user) => readsOnly(user, resource))) {
        dropped.add(resource);
        users.forEach((user) => gone.add(user));
        grown = true;
      }
    }
  }
  const lines = [];
  const wholly = new Set(model.plan.steps.map((_, at) => model.byKey.get(model.stepKey(at))).filter((one) => one.nodes.length > 0 && one.nodes.every((other) => gone.has(other))).map((one) => one.at));
  for (const at of wholly) lines.push(["All of ", link(model.stepKey(at), "step " + at), " goes, and with it the " + bytes(movedSum(model.moved[at])) + " that it moves."]);
  const others = step.nodes.filter((other) => !gone.has(other));
  if (others.length > 0) lines.push(["Its step stays: ", others.map((other, at) => [at > 0 ? ", " : "", link(other.key, other.name)]), others.length === 1 ? " is" : " are", " in it too."]);
  for (const other of gone) if (other !== node) lines.push([link(other.key, other.name), " goes too: nothing else needs it."]);
  for (const resource of dropped) lines.push([link(model.keyOf(resource), resource.name), " goes too: " + bytes(resource.role.transient?.bytes ?? 0) + "."]);
  const moved = model.movedEach.reduce((sum, each, at) => sum + each.reduce((part, [resource, amount]) => part + (wholly.has(at) || dropped.has(model.resourceOf(resource)) ? movedSum(amount) : 0), 0), 0);
  const within = ({ role }, at) => role.transient && role.transient.lifetime[0] <= at && at <= role.transient.lifetime[1];
  const alive = model.alive.map((amount, at) => [...dropped].reduce((left, one) => within(one, at) ? left - one.role.transient.bytes : left, amount));
  const [before, peak] = [model.plan.totals.live_peak_bytes, Math.max(0, ...alive)];
  lines.push(`The frame moves ${bytes(moved)} less. The peak of memory ${peak < before ? `falls from ${bytes(before)} to ${bytes(peak)}` : `stays at ${bytes(before)}`}.`);
  const outputs = [...new Set(model.edges.filter((edge) => edge.from === node.at_index && edge.to === null).map((edge) => model.resourceOf(edge.resource)))];
  for (const one of outputs) lines.push([link(model.keyOf(one), one.name), " outlives the frame: something else would have to write it, which saves less."]);
  const readers = [...new Set(model.edges.filter((edge) => edge.from === node.at_index && edge.to !== null && !gone.has(model.nodes[edge.to])).map((edge) => edge.to))];
  if (readers.length > 0) {
    lines.push([readers.map((at, index) => [index > 0 ? ", " : "", link(model.nodes[at].key, model.nodes[at].name)]), readers.length === 1 ? " needs" : " need",
      isResolve ? " what it writes, and would have to read the samples themselves, or an image that has one sample." : " what it writes, and would have to take something else."]);
  }
  return [list(lines), element("p", { class: "faint" }, "Counted from this Plan. Compiling without it may save more, since other work may move together.")];
}

function aboutResource(model, { image, buffer }) {
  const one = image || buffer;
  const key = model.keyOf(one);
  const place = one.role.transient;
  const users = model.users(key);
  const sharing = place ? model.resources().filter((other) => other !== one && other.role.transient && other.role.transient.heap === place.heap
    && other.role.transient.offset < place.offset + place.bytes && place.offset < other.role.transient.offset + other.role.transient.bytes) : [];
  const lines = model.lines.get(key) || [];
  const own = lines.filter(({ line }) => ["image", "buffer"].includes(line.kind)).map(({ line }) => line);
  const inStep = ({ line, above }) => {
    const { queue } = model.plan.steps[above[1].about.step];
    const where = queue === "GRAPHICS" ? "" : ` on the ${queue.toLowerCase()} queue`;
    return { ...line, text: `step ${above[1].about.step}${where}: ${line.text}` };
  };
  const barriers = lines.filter(({ line }) => line.kind === "barrier").map(inStep);
  return [element("h2", {}, one.name), outlineList(model, own), picturesFor("Pictures", (capture) => capture.image === frameName(one.name)),
    heading("Used by"), list(users.map((node) => {
      const uses = node.uses.filter((use) => model.resourceKey(use.resource) === key);
      const how = uses.some((use) => use.reads) ? (uses.some((use) => use.writes) ? "reads and writes" : "reads") : "writes";
      return [link(node.key, node.name), ` in step ${node.step} ${how} it (${[...new Set(uses.map((use) => use.role.replace("_", " ")))].join(", ")})`];
    })),
    place ? [heading("Memory"), element("p", {}, `${bytes(place.bytes)} at ${bytes(place.offset)} in heap ${place.heap}, alive from step ${place.lifetime[0]} to step ${place.lifetime[1]}.`),
      sharing.length > 0 ? list(sharing.map((other) => ["shares bytes with ", link(model.keyOf(other), other.name), `, alive in steps ${other.role.transient.lifetime.join("–")}`])) : element("p", {}, "Nothing else lies in these bytes.")] : null,
    barriers.length > 0 ? [heading("Barriers"), outlineList(model, barriers)] : null];
}

function aboutStep(model, { at, step, nodes }) {
  const line = model.outline.parts.find((part) => part.key === model.stepKey(at));
  const moved = model.moved[at];
  return [element("h2", {}, "Step " + at), element("p", {}, `on the ${step.queue.toLowerCase()} queue; ${count(step.image_barriers.length + step.memory_barriers.length + step.releases.length, "barrier", "barriers")}; moves ${bytes(movedSum(moved))}; ${bytes(model.alive[at])} alive`),
    model.timed() ? [element("p", { class: "time" }, spreadWords(model.times.steps[at], model.times.frames)), processorNote(model)] : null,
    nodes.length > 0 ? [heading("Work"), list(nodes.map((node) => link(node.key, node.name)))] : null, heading("In the Plan"), line ? outlineList(model, [line]) : null];
}

function aboutNote(model, { note }) {
  return [element("h2", {}, note.subject), element("p", {}, note.kind.replaceAll("_", " ") + ": ", withLinks(note.text)), placeLink(model, note.at)];
}
