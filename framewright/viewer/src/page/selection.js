/** The key of what is selected, and the view that is shown. */
const state = { selected: null, view: null, place: null, filter: "", unknown: null };

const has = (key) => models.some((model) => model.byKey.has(key));

/** Selects a part of the Plans, or nothing. Every view marks it and what it is related to. */
function select(key, { reveal = true, record = true } = {}) {
  state.selected = key && has(key) ? key : null;
  if (record) state.unknown = null;
  if (record) writeHash();
  highlight(document);
  showDetails();
  if (reveal && state.selected) VIEWS.find((view) => view.name === state.view)?.reveal?.(state.selected);
}

function relatedKeys() {
  const related = new Set();
  for (const model of models) model.related.get(state.selected)?.forEach((key) => related.add(key));
  return related;
}

/** Marks what is selected, what is related to it, and dims what the filter leaves out. */
function highlight(root) {
  const related = state.selected ? relatedKeys() : new Set();
  const words = state.filter.toLowerCase();
  for (const made of root.querySelectorAll("[data-key]")) {
    const keys = made.dataset.key.split("\u0001");
    made.classList.toggle("selected", keys.includes(state.selected));
    const isStep = state.selected?.startsWith("step:");
    // An edge goes with the work at its ends: others may pass the same image on.
    const isRelated = made.dataset.ends === undefined ? keys.some((key) => related.has(key))
      : made.dataset.ends.split("\u0001").some((key) => key === state.selected || isStep && related.has(key));
    made.classList.toggle("related", isRelated);
    const named = words === "" || keys.some((key) => key.slice(key.indexOf(":") + 1).toLowerCase().includes(words));
    made.classList.toggle("dim", !named && made instanceof SVGElement);
    if (made.hasAttribute("aria-current") || keys.includes(state.selected)) made.setAttribute("aria-current", String(keys.includes(state.selected)));
  }
}

function writeHash() {
  const parts = ["view=" + state.view];
  if (state.selected) {
    const at = state.selected.indexOf(":");
    parts.push(state.selected.slice(0, at) + "=" + encodeURIComponent(state.selected.slice(at + 1)));
  }
  const hash = "#" + parts.join("&");
  // The first address of a page is replaced: Back leads out of it at once. Others are steps back.
  if (location.hash !== hash) history[location.hash === "" ? "replaceState" : "pushState"](null, "", hash);
}

function readHash() {
  let key = null;
  let view = null;
  for (const part of location.hash.slice(1).split("&")) {
    const [name, ...rest] = part.split("=");
    let value = rest.join("=");
    try { value = decodeURIComponent(value); } catch { continue; }
    if (name === "view") view = value;
    else if (name === "step") key = "step:" + (/^\d/.test(value) ? "a" + value : value);
    else if (["pass", "image", "buffer", "note"].includes(name)) key = name + ":" + value;
  }
  const isView = VIEWS.some((known) => known.name === view);
  state.unknown = key && !has(key) ? key.replace(":", " ") : view && !isView ? "view " + view : null;
  showView(isView ? view : state.view || VIEWS[0].name);
  select(key, { record: false });
}

/** What makes a shape select `key`: by the pointer, and by Tab and Enter. */
const picks = (key, act = () => select(key, { reveal: false })) => ({
  "data-key": key, tabindex: 0, role: "button", onclick: act,
  onkeydown: (event) => {
    if (event.key !== "Enter" && event.key !== " ") return;
    event.preventDefault();
    event.stopPropagation();
    act();
  },
});

/** A button that selects. */
function link(key, text) {
  return element("button", { class: "link", type: "button", "data-key": key, onclick: () => select(key, { reveal: true }) }, text);
}

/** A line of a file, as a button that shows it. */
function placeLink(model, place) {
  const split = place && splitPlace(place);
  if (!split) return null;
  const shown = split.file + ":" + split.line;
  if (!model.sources.some((source) => source.name === split.file)) return element("span", { class: "faint" }, shown);
  return element("button", { class: "link place", type: "button", onclick: () => showPlace(model, split) }, shown);
}

/** Text in which names that a Plan has, between backticks, select what they name. */
function withLinks(text) {
  return text.split("`").map((part, at) => {
    if (at % 2 === 0) return part;
    const key = ["pass:", "image:", "buffer:"].map((kind) => kind + part).find(has);
    return key ? link(key, part) : element("code", {}, part);
  });
}

/** A line of the outline, its own place as a link. */
function outlineLine(model, line) {
  const place = line.at && splitPlace(line.at);
  const end = place ? ` (${place.file}:${place.line})` : "";
  const text = end && line.text.endsWith(end) ? line.text.slice(0, -end.length) : line.text;
  return [withLinks(text), place ? [" ", placeLink(model, line.at)] : null];
}

function outlineList(model, lines) {
  if (lines.length === 0) return null;
  return element("ul", { class: "outline" }, lines.map((line) =>
    element("li", line.key ? { "data-key": line.key } : {}, outlineLine(model, line), outlineList(model, line.parts))));
}
