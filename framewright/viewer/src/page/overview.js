/** The first view: what the frame is in five figures, its picture, what is dearest, and what might be made better. */
const DEAREST = 5;

/** Five figures, each with what it is made of. */
function figuresOf(model) {
  const { totals } = model.plan;
  const sum = (kind) => model.moved.reduce((all, moved) => all + moved[kind], 0);
  const [loaded, stored, resolved, copied] = ["loaded", "stored", "resolved", "copied"].map(sum);
  const parts = [[loaded, "loaded"], [stored, "stored"], [resolved, "resolved"], [copied, "copied"]].filter(([amount]) => amount > 0).map(([amount, word]) => bytes(amount) + " " + word);
  const time = model.times
    ? [milliseconds(model.times.frame.median), "of the device", `${milliseconds(model.times.frame.low)} to ${milliseconds(model.times.frame.high)} in ${count(model.times.frames, "frame", "frames")}`]
    : [String(totals.resolves), totals.resolves === 1 ? "resolve" : "resolves", `${totals.folded_resolves} folded; ${count(totals.copies, "copy", "copies")}; ${count(totals.inserted_passes, "pass was", "passes were")} inserted`];
  return [
    [String(totals.passes), totals.passes === 1 ? "pass" : "passes", `in ${count(totals.scopes, "rendering scope", "rendering scopes")} and ${count(model.plan.steps.length, "step", "steps")}`],
    [bytes(totals.placed_bytes), "of shared memory", `${bytes(totals.transient_bytes)} if nothing shared; ${bytes(totals.kept_bytes)} outlive the frame`],
    [bytes(loaded + stored + resolved + copied), "moved", parts.join(", ")],
    [String(totals.barrier_calls), totals.barrier_calls === 1 ? "barrier call" : "barrier calls", `${totals.image_barriers} of images, ${totals.memory_barriers} of memory; ${count(totals.waits, "wait", "waits")} between queues`],
    time,
  ];
}

/** A list with a bar for each entry: `[name, amount, shown]`. */
function bars(entries) {
  const most = Math.max(1e-9, ...entries.map(([, amount]) => amount));
  return element("ul", { class: "bars" }, entries.map(([name, amount, words]) => {
    const bar = element("span", { class: "bar" });
    bar.style.width = Math.max(1, amount / most * 100) + "%";
    return element("li", {}, element("span", { class: "name" }, name), element("span", { class: "amount" }, words), bar);
  }));
}

function dearestSteps(model) {
  const timed = model.timed();
  const amount = (at) => timed ? model.msOfStep(at) ?? 0 : movedSum(model.moved[at]);
  const order = model.plan.steps.map((_, at) => at).filter((at) => amount(at) > 0).sort((one, other) => amount(other) - amount(one)).slice(0, DEAREST);
  return bars(order.map((at) => {
    const { nodes } = model.byKey.get(model.stepKey(at));
    const name = nodes.length > 0 ? nodes.slice(0, 3).map((node, index) => [index > 0 ? ", " : "", link(node.key, node.name)]) : link(model.stepKey(at), "step " + at);
    return [[name, nodes.length > 3 ? " and " + (nodes.length - 3) + " more" : ""], amount(at), timed ? milliseconds(amount(at)) : bytes(amount(at))];
  }));
}

function dearestImages(model) {
  const size = ({ role }) => role.transient?.bytes ?? 0;
  const order = model.resources().filter((one) => size(one) > 0).sort((one, other) => size(other) - size(one)).slice(0, DEAREST);
  return bars(order.map((one) => [[link(model.keyOf(one), one.name), element("span", { class: "faint" }, " " + sizeOf(one))], size(one), bytes(size(one))]));
}

/** The picture of an output: of the server's last frame, or captured. */
function pictureOf(model) {
  const output = (live.state ?? DATA.saved)?.outputs[0];
  if (output) return element("img", { src: output.picture, alt: output.name, loading: "lazy" });
  const outputs = new Set(model.plan.images.filter(({ role }) => !role.transient).map((image) => image.name));
  const drawn = DATA.captures.filter((one) => one.data);
  const capture = drawn.findLast((one) => outputs.has(one.image)) ?? drawn.at(-1);
  if (!capture) return element("p", { class: "faint" }, "There is no picture: ", element("code", {}, "framewright inspect --capture"), " makes some.");
  const canvas = element("canvas", { role: "img", "aria-label": capture.image + " after " + capture.pass });
  paint(canvas, capture);
  return canvas;
}

function overviewView(model) {
  if (!model.plan) {
    const totals = model.outline.parts.filter((line) => line.kind === "total").flatMap((line) => line.parts);
    return element("div", { class: "overview" }, tooLarge(model), element("ul", {}, totals.map((line) => element("li", {}, withLinks(line.text)))),
      element("p", {}, element("button", { type: "button", class: "link", onclick: () => { showView("steps"); writeHash(); } }, "The steps that move most")));
  }
  const box = element("div", { class: "overview" });
  // Times and pictures of a running program change.
  box.redraw = () => {
    box.replaceChildren(...overviewParts(model));
    highlight(box);
  };
  box.redraw();
  return box;
}

function overviewParts(model) {
  const figures = figuresOf(model).map(([figure, unit, parts]) => element("div", { class: "figure card" }, element("p", { class: "large" }, figure), element("p", { class: "unit" }, unit), element("p", { class: "faint" }, parts)));
  const hints = model.hints.length === 0 ? element("p", { class: "faint" }, "Nothing stands out.") : element("ul", { class: "hints" }, model.hints.map((hint) =>
    element("li", {}, element("code", { class: "faint" }, hint.code), " ", withLinks(hint.text), hint.at ? [" ", placeLink(model, hint.at)] : null)));
  const card = (title, inside, kind) => element("section", { class: "card" + (kind ? " " + kind : "") }, element("h2", {}, title), inside);
  const { device, extent, settings } = model.plan;
  const chosen = settings.map((setting) => `${setting.name}=${setting.value}`).join(", ");
  return [
    element("p", {}, `${extent.join("×")} texels on ${device.name}`, chosen ? element("span", { class: "faint" }, "; " + chosen) : null),
    element("div", { class: "figures" }, figures),
    timesNote(model),
    element("div", { class: "cards" },
      card("Picture", element("div", { class: "picture" }, pictureOf(model))),
      card(model.timed() ? "Slowest steps" : "Steps that move most", dearestSteps(model)),
      card("Largest images and buffers", dearestImages(model)),
      card("What stands out", hints, "standing")),
  ].filter(Boolean);
}
