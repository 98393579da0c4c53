/** Steps with their barriers, attachments, passes and resolves, each with its cause. A step is filled when it is opened. */
function stepsView(model) {
  const lines = model.outline.parts.filter((line) => line.about && "step" in line.about);
  const made = lines.map((line) => {
    const at = line.about.step;
    const details = element("details", { "data-key": line.key });
    const moved = model.moved[at] ? movedSum(model.moved[at]) : 0;
    details.append(element("summary", {}, outlineLine(model, line), " ", link(line.key, "select"), moved > 0 ? element("span", { class: "faint" }, " moves " + bytes(moved)) : null));
    details.addEventListener("toggle", () => {
      if (details.open && details.children.length === 1) {
        details.append(outlineList(model, line.parts) || element("p", {}, "nothing more"));
        highlight(details);
      }
    });
    return details;
  });
  const all = element("button", { type: "button", onclick: () => made.forEach((one) => { one.open = !made.every((other) => other.open) || one.open === false; }) }, "Open all");
  const box = element("div", {}, made.length <= 300 ? element("p", {}, all) : null, made);
  box.reveal = (wanted) => {
    const model_step = model.byKey.get(wanted);
    const step = model_step?.kind === "pass" ? model_step.node.step : model_step?.at;
    const found = made.find((one) => one.dataset.key === model.stepKey(step));
    if (found) {
      found.open = true;
      found.scrollIntoView({ block: "nearest" });
    }
  };
  return box;
}

/** Queues as lanes, and the waits between them. */
function queuesView(model) {
  if (!model.plan) return tooLarge(model);
  const { steps } = model.plan;
  const lanes = [...new Set(steps.map((step) => step.queue))];
  const wide = 26;
  const x = (at) => 90 + at * wide;
  const y = (at) => 24 + lanes.indexOf(steps[at].queue) * 56;
  const svg = shape("svg", { width: x(steps.length) + 10, height: 24 + lanes.length * 56, role: "group", "aria-label": "Queues" });
  lanes.forEach((lane, at) => svg.append(shape("rect", { class: "lane", x: 84, y: 18 + at * 56, width: steps.length * wide + 8, height: 40 }), shape("text", { x: 4, y: 42 + at * 56 }, lane.toLowerCase())));
  steps.forEach((step, at) => {
    const kind = Object.keys(step.work)[0];
    const key = model.stepKey(at);
    svg.append(shape("g", { class: { render: "draw", custom: "custom" }[kind] || (typeof step.work === "string" ? "beside" : kind), "data-key": key, onclick: () => select(key, { reveal: false }) },
      shape("title", {}, "step " + at + ": " + (model.byKey.get(key).nodes.map((node) => node.name).join(", ") || "barriers alone")),
      shape("rect", { x: x(at) + 1, y: y(at), width: wide - 2, height: 28, rx: 3 }), shape("text", { class: "middle small", x: x(at) + wide / 2, y: y(at) + 18 }, at)));
  });
  let waits = 0;
  steps.forEach((step, at) => step.waits.forEach((wait) => {
    waits += 1;
    if (wait.frames_ago === 0) svg.append(shape("path", { class: "wait", d: `M${x(wait.step) + wide} ${y(wait.step) + 14}L${x(at)} ${y(at) + 14}` }, shape("title", {}, `step ${at} waits in ${wait.stages} for step ${wait.step}`)));
  }));
  const words = lanes.length <= 1 ? `All ${count(steps.length, "step", "steps")} run on one queue.` : `${count(steps.length, "step", "steps")} on ${lanes.length} queues, with ${count(waits, "wait", "waits")} between them.`;
  return element("div", {}, element("p", {}, words), element("div", { class: "scroller", tabindex: "0", role: "region", "aria-label": "Queues" }, svg));
}
