/** The last states of `serve`: what changed from one to the next. Any two are compared, and the settings of one can be taken again. */
const past = { states: [], compared: null, newest: null, view: null, shown: null, a: null, b: null };

/** The settings and the preset that a state was drawn with, as text. */
const choiceOf = ({ chosen, preset }) => JSON.stringify([preset ?? null, Object.entries(chosen).sort()]);

const choiceWords = ({ chosen, preset }) => [preset ? "preset " + preset : null, ...Object.entries(chosen).map(([name, value]) => `${name}=${value}`)].filter(Boolean).join(", ") || "as begun";

/** The list of states. It stays while the other views are made anew. */
function historyView() {
  if (!past.view) past.view = element("div", { class: "past" });
  return past.view;
}

/** Takes the states of a server; another form of the page lists none. */
function showHistory(states) {
  past.states = states ?? [];
  const known = (version) => past.states.some((state) => state.version === version);
  // The last one and the one before are compared, as long as nobody chose others.
  if (!past.held || !known(past.a) || !known(past.b)) {
    past.held = false;
    [past.a, past.b] = [past.states.at(-2)?.version ?? null, past.states.at(-1)?.version ?? null];
  }
  const text = JSON.stringify([past.states, past.a, past.b, live.state?.chosen, live.state?.preset]);
  if (text === past.shown) return;
  past.shown = text;
  drawHistory();
}

function drawHistory() {
  const box = historyView();
  const last = past.states.at(-1);
  const now = last && choiceOf({ chosen: live.state?.chosen ?? last.chosen, preset: live.state ? live.state.preset : last.preset });
  const before = past.states.findLast((state) => choiceOf(state) !== now);
  const focused = document.activeElement?.dataset?.setting;
  const pick = (side, version) => element("input", { type: "radio", name: "side-" + side, "data-setting": `${side}${version}`, "aria-label": `state ${version} as ${side.toUpperCase()}`, checked: past[side] === version, onchange: () => {
    past[side] = version;
    past.held = true;
    past.shown = null;
    showHistory(past.states);
  } });
  const rows = [...past.states].reverse().map((state) => element("tr", {}, element("td", {}, pick("a", state.version)), element("td", {}, pick("b", state.version)),
    element("td", { class: "number" }, state.version), element("td", { class: "time" }, new Date(state.drawn_at).toLocaleTimeString()),
    element("td", {}, state.changed.map((what) => element("div", {}, what))),
    element("td", { class: "number" }, state.milliseconds === null ? "" : milliseconds(state.milliseconds)),
    element("td", {}, state.pictures.length > 0 ? element("img", { src: state.pictures[0], alt: "picture of state " + state.version }) : ""),
    element("td", {}, choiceWords(state), choiceOf(state) === now ? "" : [" ", element("button", { type: "button", "data-setting": "take" + state.version, onclick: () => take(state) }, "take again")])));
  const comparable = past.a !== null && past.b !== null && past.a !== past.b;
  box.replaceChildren(
    element("p", { class: "tools" }, element("button", { type: "button", id: "compare", "data-setting": "compare", disabled: !comparable, onclick: compare }, "Compare A and B"),
      element("button", { type: "button", id: "undo", "data-setting": "undo", disabled: !before, onclick: () => take(before) }, "Undo settings"),
      element("span", { class: "hint" }, "The last twenty frames that were drawn, the newest first. Fewer are kept where their pictures and Plans take more than 128 MiB.")),
    element("div", { class: "wide" }, element("table", {}, element("thead", {}, element("tr", {}, ["A", "B", "state", "at", "what changed", "device", "picture", "settings"].map((name) => element("th", { scope: "col" }, name)))), element("tbody", {}, rows))));
  if (focused) [...box.querySelectorAll("[data-setting]")].find((one) => one.dataset.setting === focused)?.focus();
}

/** Chooses the settings of an earlier state. */
function take(state) {
  return choose({ exactly: { preset: state.preset, set: state.chosen } });
}

/** Shows two states side by side, in every view. */
async function compare() {
  const versions = [past.a, past.b];
  try {
    const answer = await fetch("compare/" + versions.join("/"));
    if (!answer.ok) throw new Error(await answer.text());
    const data = await answer.json();
    past.compared = versions;
    showData({ ...data, live: true });
    showView("differences");
    writeHash();
    showComparedBar();
  } catch (problem) {
    live.bar.status.textContent = "They can't be compared: " + (problem.message || "the server doesn't answer") + ".";
  }
}

/** Goes back to the newest state. */
function leaveComparison() {
  past.compared = null;
  showComparedBar();
  if (past.newest) showData(past.newest);
  if (live.state?.times && models[0]) showTimes(live.state.times);
  showView("history");
  writeHash();
}

function showComparedBar() {
  document.getElementById("compared")?.remove();
  if (!past.compared) return;
  live.bar.status.after(element("p", { id: "compared", role: "status" }, `States ${past.compared.join(" and ")} stand in every view. Newer frames are still drawn.`,
    element("button", { type: "button", id: "newest", onclick: leaveComparison }, "Back to the newest")));
}

/** The pictures and times of the two states that are compared, side by side. */
function comparedStates([a, b]) {
  const time = (state) => state.milliseconds === null ? "no times" : milliseconds(state.milliseconds) + " of the device, " + milliseconds(state.recording) + " to record";
  const change = a.milliseconds > 0 && b.milliseconds > 0 ? element("p", {}, `B takes ${(b.milliseconds / a.milliseconds * 100).toFixed(0)} % of A's time on the device.`) : null;
  return [change, element("div", { class: "sides" }, [["A", a], ["B", b]].map(([letter, state]) => element("figure", {}, state.pictures.length > 0 ? element("img", { src: state.pictures[0], alt: `picture of ${letter}` }) : null,
    element("figcaption", {}, element("strong", {}, `${letter}: state ${state.version}`), `, ${choiceWords(state)}; ${time(state)}`, element("div", { class: "faint" }, state.took)))))];
}
