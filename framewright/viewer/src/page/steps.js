/** Steps with their barriers, attachments, passes and resolves, each with its cause. A step is filled when it is opened. */
function stepsView(model) {
  const lines = model.outline.parts.filter((line) => line.about && "step" in line.about);
  const made = lines.map((line) => {
    const at = line.about.step;
    const details = element("details", { "data-key": line.key });
    const moved = model.moved[at] ? movedSum(model.moved[at]) : 0;
    details.append(element("summary", {}, visible(line.text.replaceAll("`", "")), " ", element("span", { class: "names" }, model.byKey.get(line.key)?.nodes.map((node) => node.name).join(", ")), model.timed() ? element("span", { class: "faint" }, " " + milliseconds(model.msOfStep(at))) : null, moved > 0 ? element("span", { class: "faint" }, " moves " + bytes(moved)) : null));
    details.addEventListener("toggle", () => {
      if (details.open && details.children.length === 1) {
        // Whatever can be pressed lies outside of the summary, which is pressed itself.
        details.append(element("p", {}, link(line.key, "Select"), ": ", outlineLine(model, line)), outlineList(model, line.parts) || element("p", {}, "nothing more"));
        highlight(details);
      }
    });
    return details;
  });
  const all = element("button", { type: "button", onclick: () => made.forEach((one) => { one.open = !made.every((other) => other.open) || one.open === false; }) }, "Open all");
  const box = element("div", {}, timesNote(model), made.length <= 300 ? element("p", {}, all) : null, made);
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
