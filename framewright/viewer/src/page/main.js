/** The views, in the order of their tabs. Each is made when it is first shown. */
let VIEWS = [];

function viewsOf(data) {
  const alone = (name, title, make) => ({ name, title, make, once: true });
  return [
    data.live ? alone("live", "Live", liveView) : null,
    data.saved ? alone("saved", "Frame", savedView) : null,
    data.live && past.states.length > 0 ? alone("history", "History", historyView) : null,
    data.differences ? alone("differences", "Differences", comparedView) : null,
    { name: "overview", title: "Overview", make: overviewView },
    // It stays itself while other Plans are shown.
    data.what_if ? whatIf.view ??= alone("what-if", "What if", whatIfView) : null,
    { name: "graph", title: "Graph", make: graphView },
    { name: "timeline", title: "Timeline", make: timelineView },
    { name: "grid", title: "Passes × images", make: gridView },
    data.captures.length > 0 ? alone("pictures", "Pictures", picturesView) : null,
    { name: "memory", title: "Memory", make: memoryView },
    { name: "steps", title: "Steps", make: stepsView },
    { name: "cost", title: "Cost", make: costView },
    { name: "images", title: "Images", make: imagesView },
    { name: "notes", title: "Decisions", make: notesView },
    data.plans.length > 0 ? { name: "source", title: "Source", make: sourceView } : alone("source", "Source", () => sourceView({ sources: data.texts })),
    data.devices.length > 0 ? { name: "devices", title: "Other devices", make: devicesView } : null,
  ].filter((view) => view && (data.plans.length > 0 || view.name === "live" || (view.name === "source" && data.texts?.length > 0)));
}

function makeView(view) {
  if (view.made) return;
  const shown = view.once ? [models[0] ?? null] : models;
  view.parts = shown.map((model) => view.make(model));
  view.made = element("div", { class: "plans" }, shown.map((model, at) => element("section", { "aria-label": model ? view.title + " of " + model.name : view.title },
    models.length > 1 && !view.once ? element("h2", {}, model.letter.toUpperCase() + ": " + (DATA.differences ? sideWords(DATA.differences[model.letter], DATA.differences["ba"[model.index]]) : model.name)) : null, view.parts[at])));
  view.panel.append(view.made);
  view.reveal = (key) => view.parts.forEach((part) => part.reveal?.(key));
}

function showView(name) {
  if (!VIEWS.some((view) => view.name === name)) return;
  state.view = name;
  for (const view of VIEWS) {
    const is = view.name === name;
    view.panel.hidden = !is;
    view.tab.setAttribute("aria-selected", String(is));
    view.tab.tabIndex = is ? 0 : -1;
    if (is) {
      makeView(view);
      view.parts.forEach((part) => part.redraw?.());
    }
  }
  highlight(document.getElementById("views"));
  const view = VIEWS.find((one) => one.name === name);
  if (state.selected) view.reveal(state.selected);
}

function showPlace(model, place) {
  showView("source");
  writeHash();
  VIEWS.find((view) => view.name === "source").parts[model.index].showPlace?.(place);
}

/** Steps through the passes of the first Plan. */
function go(by) {
  const nodes = models[0]?.nodes ?? [];
  if (nodes.length === 0) return;
  const at = nodes.findIndex((node) => node.key === state.selected);
  const next = at < 0 ? (by > 0 ? 0 : nodes.length - 1) : Math.max(0, Math.min(nodes.length - 1, at + by));
  select(nodes[next].key);
}

function find(words) {
  state.filter = words;
  highlight(document.getElementById("views"));
  const found = document.getElementById("found");
  const wanted = words.toLowerCase();
  const keys = new Set();
  if (wanted !== "") {
    for (const model of models) {
      for (const [key, { note, node }] of model.byKey) {
        const text = [key.slice(key.indexOf(":") + 1), note?.text, node?.because].filter(Boolean).join(" ").toLowerCase();
        if (text.includes(wanted) && keys.size < 50) keys.add(key);
      }
    }
  }
  const name = (key) => key.startsWith("note:") ? "note: " + models.map((model) => model.byKey.get(key)?.note.subject).find(Boolean) : key.replace(":", " ").replace(/^step ([ab])/, models.length > 1 ? "step $1" : "step ");
  found.replaceChildren(...(keys.size > 0 ? [...keys].map((key) => element("li", {}, link(key, name(key)))) : [element("li", { class: "faint" }, "nothing by that name")]));
  found.hidden = wanted === "";
  return [...keys];
}

function keyPressed(event) {
  const input = document.getElementById("find");
  if (event.ctrlKey || event.metaKey || event.altKey || event.target.closest?.("textarea")) return;
  if (event.key === "Escape") {
    input.value = "";
    find("");
    input.blur();
    select(null);
  } else if (event.target === input) {
    if (event.key === "Enter") {
      const [first] = find(input.value);
      if (first) select(first);
    } else if (event.key === "ArrowDown") {
      event.preventDefault();
      document.querySelector("#found button")?.focus();
    }
  } else if (event.target.closest?.("#found")) {
    const way = { ArrowDown: 1, ArrowUp: -1 }[event.key];
    if (!way) return;
    event.preventDefault();
    const all = [...document.querySelectorAll("#found button")];
    (all[all.indexOf(event.target) + way] ?? (way < 0 ? input : null))?.focus();
  } else if (event.key === "/") {
    event.preventDefault();
    input.focus();
  } else if (event.key === "ArrowRight" || event.key === "ArrowLeft") {
    if (event.target.closest?.(".scroller, .canvas, select, input")) return;
    event.preventDefault();
    const by = event.key === "ArrowRight" ? 1 : -1;
    if (event.target.closest?.("#tabs")) {
      const at = VIEWS.findIndex((view) => view.name === state.view);
      const next = VIEWS[(at + by + VIEWS.length) % VIEWS.length];
      showView(next.name);
      next.tab.focus();
      writeHash();
    } else go(by);
  } else if (/^[1-9]$/.test(event.key) && !event.target.closest?.(".controls, select, input") && VIEWS[Number(event.key) - 1]) {
    showView(VIEWS[Number(event.key) - 1].name);
    writeHash();
  }
}

/** Shows Plans in place of those that are shown. The view, the selection and the places in lists stay. */
function showData(data) {
  const places = models.length === 0 ? [] : [...document.querySelectorAll("main, .view-panel:not([hidden]) .scroller")].map((box) => [box.scrollLeft, box.scrollTop]);
  DATA = data;
  models = data.plans.map((plan, index) => new Model(plan, index));
  VIEWS = viewsOf(data);
  document.title = models.map((model) => model.name).join(" | ");
  const names = data.differences ? [sideWords(data.differences.a, data.differences.b), sideWords(data.differences.b, data.differences.a)]
    : models.map((model) => model.name + (model.plan ? " on " + model.plan.device.name : ""));
  document.getElementById("title").replaceChildren(visible(names.join("  |  ")));
  for (const view of VIEWS) {
    view.tab = element("button", { type: "button", role: "tab", id: "tab-" + view.name, "aria-controls": "view-" + view.name, onclick: () => { showView(view.name); writeHash(); } }, view.title);
    view.panel ??= element("div", { role: "tabpanel", id: "view-" + view.name, class: "view-panel", "aria-labelledby": "tab-" + view.name, hidden: true });
  }
  document.getElementById("tabs").replaceChildren(...VIEWS.map((view) => view.tab));
  const room = document.getElementById("views");
  [...room.children].filter((panel) => !VIEWS.some((view) => view.panel === panel)).forEach((panel) => panel.remove());
  room.append(...VIEWS.map((view) => view.panel).filter((panel) => !panel.isConnected));
  readHash();
  document.querySelectorAll("main, .view-panel:not([hidden]) .scroller").forEach((box, at) => { if (places[at]) [box.scrollLeft, box.scrollTop] = places[at]; });
}

function start() {
  document.getElementById("find").addEventListener("input", (event) => find(event.target.value));
  document.addEventListener("click", (event) => { if (!event.target.closest(".find") || event.target.closest("#found")) document.getElementById("found").hidden = true; });
  document.addEventListener("keydown", keyPressed);
  addEventListener("popstate", readHash);
  addEventListener("beforeprint", () => { printing = true; VIEWS.forEach((view) => { makeView(view); view.parts.forEach((part) => part.redraw?.()); }); });
  addEventListener("afterprint", () => { printing = false; showView(state.view); });
  whatIf.page = DATA;
  if (DATA.saved) addSavedBar(DATA.saved);
  showData(DATA);
  // The first address names its view, so that Back leads to it.
  if (location.hash === "") writeHash();
  if (DATA.live) follow();
}

start();
