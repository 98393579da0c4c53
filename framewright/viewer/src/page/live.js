/** The page of `framewright serve`, or of a program: it asks its server for the state, shows it, and asks for the next. */
const live = { format: DATA.live, server: "none", version: 0, frame: 0, state: null, bar: null, view: null };

/** What is going on, and what is wrong: above all views. */
function addLiveBar() {
  const bar = { status: element("p", { role: "status", id: "live-status" }), tools: element("div", { class: "controls", id: "live-tools" }), wrong: element("div", { role: "alert", id: "live-wrong" }) };
  document.getElementById("body").before(element("section", { id: "live", "aria-label": "Live" }, bar.tools, bar.status, bar.wrong));
  live.bar = bar;
}

/** Settings, and pictures of the outputs. It stays while the other views are made anew. */
function liveView() {
  if (!live.view) {
    const view = { controls: element("div", { class: "controls" }), findings: element("div", {}), outputs: element("div", { class: "outputs" }) };
    view.box = element("div", {}, view.controls, view.findings, view.outputs);
    live.view = view;
  }
  return live.view.box;
}

/** Sends what was chosen. The state that follows shows it. */
async function post(address, what) {
  try {
    const answer = await fetch(address, { method: "POST", headers: { "content-type": "application/json" }, body: JSON.stringify(what) });
    if (!answer.ok) live.bar.status.textContent = await answer.text();
  } catch {
    live.bar.status.textContent = "The server doesn't answer: the choice is lost.";
  }
}

/** Settings, or a preset. */
const choose = (choice) => post("choose", choice);

/** A renderer of the program; whether its frame stays; the next one. */
const look = (change) => post("look", change);

/** Which renderer is shown, whether its frame stays, and ways to keep it. */
function showTools(state) {
  const { program } = state;
  const shown = JSON.stringify([program?.renderers, program?.renderer, program?.held, live.frame > 0]);
  if (shown === live.tools) return;
  live.tools = shown;
  const focused = document.activeElement?.id;
  const button = (id, title, words, change) => element("button", { type: "button", id, title, onclick: () => look(change) }, words);
  const saved = (address, title, words) => element("a", { href: address, title, download: "frame.html" }, words);
  live.bar.tools.replaceChildren(...[
    program?.renderers.length > 1 ? element("label", {}, "Renderer ", element("select", { id: "renderer", onchange: (event) => look({ renderer: Number(event.target.value) }) },
      program.renderers.map(({ id, name }) => element("option", { value: String(id), selected: id === program.renderer }, name)))) : null,
    program ? button("hold", "The page keeps the frame that it shows; the program goes on", program.held ? "Go on" : "Hold", { hold: !program.held }) : null,
    program ? button("step", "Shows the next frame, and keeps it", "Step", "step") : null,
    live.frame > 0 ? saved("frame.html", "The frame as a page of one file", "Save") : null,
    live.frame > 0 ? saved("frame.html?sources=no", "The same without the texts of files, to send it to others", "Save without sources") : null,
  ].filter(Boolean));
  if (focused) document.getElementById(focused)?.focus();
}

/** What the validation layer found, each with the step and pass that it was found at. */
function findingsOf(findings) {
  if (findings.length === 0) return [];
  const place = (at) => {
    const step = /^step (\d+)/.exec(at)?.[1];
    const key = step && models[0] ? models[0].stepKey(Number(step)) : null;
    return key && has(key) ? link(key, at) : element("code", {}, at);
  };
  return [element("h2", {}, count(findings.length, "finding", "findings") + " of validation"),
    element("ul", { class: "findings" }, findings.map(({ rule, text, at, times }) => element("li", {}, at ? [place(at), ": "] : null, element("code", {}, rule), times > 1 ? ` (${times} times)` : null, element("pre", {}, text))))];
}

function showFindings(state) {
  const shown = JSON.stringify([state.program?.findings ?? [], live.frame]);
  if (shown === live.findings) return;
  live.findings = shown;
  live.view.findings.replaceChildren(...findingsOf(state.program?.findings ?? []));
}

/** The control of a setting. */
function control(setting, shown) {
  const send = (value) => choose({ set: { [setting.name]: String(value) } });
  const about = { title: setting.about, "data-setting": setting.name };
  let input;
  if (setting.one_of) {
    input = element("select", { ...about, onchange: (event) => send(event.target.value) }, setting.one_of.map((value) => element("option", { value, selected: value === shown }, value)));
  } else {
    const [min, max, step] = setting.between;
    const slides = Number.isFinite(max - min) && max - min <= 1e6;
    input = element("input", { ...about, type: slides ? "range" : "number", min, max, step: step ?? (slides ? (max - min) / 200 : "any"), value: shown });
    const text = element("output", {}, shown);
    input.addEventListener("input", () => {
      text.textContent = input.value;
      live.turned = input;
    });
    input.addEventListener("change", () => {
      live.turned = null;
      send(input.value);
    });
    input.addEventListener("blur", () => {
      live.turned = null;
      showControls(live.state);
    });
    return [input, " ", slides ? text : null];
  }
  return input;
}

/** Controls of all settings. They stay as they are while a number is typed or a slider is pulled. */
function showControls(state) {
  const { controls } = live.view;
  const values = JSON.stringify([state.settings, state.presets, state.chosen, state.preset]);
  if (values === live.controls || (live.turned && live.turned === document.activeElement)) return;
  live.controls = values;
  const focused = document.activeElement?.dataset?.setting;
  // Names of settings may be those of members that every object has.
  const chosen = new Map(Object.entries(state.chosen));
  controls.replaceChildren(
    state.presets.length > 0 ? element("label", {}, "preset ", element("select", { "data-setting": "@preset", onchange: (event) => choose({ preset: event.target.value || null }) },
      ["", ...state.presets].map((value) => element("option", { value, selected: value === (state.preset ?? "") }, value || "as begun")))) : "",
    ...state.settings.map((setting) => element("label", { class: chosen.has(setting.name) ? "chosen" : null }, setting.name + " ", control(setting, chosen.get(setting.name) ?? setting.value))),
    chosen.size > 0 || state.preset ? element("button", { type: "button", id: "as-begun", onclick: () => choose({ preset: null }) }, "as begun") : "");
  if (focused) [...controls.querySelectorAll("[data-setting]")].find((one) => one.dataset.setting === focused)?.focus();
}

/** The mistakes, each with its place, and below its line in the source. They stay while they are the same: a screen reader reads them once. */
function showWrong(state) {
  const { wrong } = live.bar;
  const shown = JSON.stringify([state.mistakes, state.message, live.frame > 0]);
  if (shown === live.wrong) return;
  live.wrong = shown;
  wrong.replaceChildren();
  if (state.mistakes.length === 0) return;
  wrong.append(element("p", {}, element("strong", {}, live.frame > 0 ? "The last good frame is shown: " : "There is no frame yet: "), count(state.mistakes.length, "mistake", "mistakes")),
    element("pre", {}, state.message));
  for (const mistake of state.mistakes) {
    if (!mistake.file) continue;
    wrong.append(element("button", { type: "button", class: "link place", onclick: () => { showView("source"); writeHash(); showMistake(mistake); } }, `${mistake.file}:${mistake.line}`), " ");
  }
}

/** The text of each file: those that mistakes are in, and the others as the last good frame had them. */
function sourcesOf(state, page) {
  const wrong = new Set(state.sources.map((one) => one.name));
  return [...state.sources, ...(page?.plans[0]?.sources ?? []).filter((one) => !wrong.has(one.name))];
}

/** Puts every mistake of the state below its line in the source. */
function markMistakes(root) {
  root.querySelectorAll(".mistake").forEach((one) => one.remove());
  for (const mistake of live.state?.mistakes ?? []) {
    const line = lineOf(mistake, root);
    line?.append(element("p", { class: "mistake removed" }, mistake.message, mistake.help ? element("span", { class: "faint" }, " " + mistake.help) : null));
  }
}

/** The line of the source that a mistake is in. */
function lineOf({ file, line }, root) {
  const source = live.state.sources.find((one) => one.shown === file);
  const found = source && [...root.querySelectorAll("[data-file]")].find((one) => one.dataset.file === source.name);
  return found?.querySelectorAll("ol.source > li")[line - 1] ?? null;
}

function showMistake(mistake) {
  const line = lineOf(mistake, document);
  document.querySelectorAll("#view-source .here").forEach((one) => one.classList.remove("here"));
  line?.classList.add("here");
  line?.scrollIntoView({ block: "center" });
}

function showStatus() {
  const { state } = live;
  const { program } = state ?? {};
  const found = program?.findings.length > 0 ? "; validation has " + count(program.findings.length, "finding", "findings") : "";
  live.bar.status.textContent = !state ? "" : state.busy ? "drawing …" : program?.held ? `Frame ${program.frame} is held${found}` : state.mistakes.length > 0 ? "" : state.took + found;
}

/** Shows a state. Views are made anew only for another frame, or other texts. */
function showState(state, page) {
  live.state = state;
  const focused = document.activeElement;
  const texts = JSON.stringify(sourcesOf(state, page));
  if (state.frame !== live.frame || texts !== live.texts) {
    live.frame = state.frame;
    live.texts = texts;
    const data = page ?? { plans: [], differences: null, devices: [], captures: [], texts: state.sources };
    if (data.plans[0]) data.plans[0].sources = sourcesOf(state, page);
    past.newest = { ...data, live: live.format };
    if (!past.compared) showData(past.newest);
    // Controls and the history stay, in panels that are made anew.
    if (focused?.isConnected && document.activeElement !== focused) focused.focus({ preventScroll: true });
    largeIsOld();
  }
  if (state.times && models[0] && !past.compared) showTimes(state.times);
  showStatus();
  liveView();
  showTools(state);
  showFindings(state);
  showWrong(state);
  showControls(state);
  const outputs = JSON.stringify(state.outputs);
  if (outputs !== live.outputs) live.view.outputs.replaceChildren(...state.outputs.map(({ name, picture }) => element("figure", {}, element("img", { src: picture, alt: name, loading: "lazy" }), element("figcaption", {}, name))));
  live.outputs = outputs;
  markMistakes(document);
}

/** Times of a running program: they change while its Plan stays. */
function showTimes(times) {
  const first = !models[0].times;
  models[0].times = times;
  const view = VIEWS.find((one) => one.name === state.view);
  if (first && view?.made) {
    // Views that were made without times have no room for them.
    for (const one of VIEWS) {
      one.made?.remove();
      one.made = null;
    }
    showView(state.view);
  } else view?.parts?.forEach((part) => part.redraw?.());
  if (state.selected) showDetails();
}

/** Asks for states for ever. A server that is gone may come back. */
async function follow() {
  addLiveBar();
  for (;;) {
    let told = null;
    try {
      const answer = await fetch("state/" + live.server + "/" + live.version);
      if (answer.status === 200) told = await answer.json();
      else if (answer.status !== 204) throw new Error(answer.statusText);
    } catch {
      live.bar.status.textContent = "The server doesn't answer: it is asked again every second.";
      await new Promise((done) => setTimeout(done, 1000));
      continue;
    }
    if (told && told.live.format_version !== live.format) {
      live.bar.status.replaceChildren("Another version of Framewright answers: ", element("button", { type: "button", class: "link", id: "load-again", onclick: () => location.reload() }, "load its page"));
      return;
    }
    if (told) {
      // Another server counts anew.
      if (told.live.server !== live.server) {
        Object.assign(live, { server: told.live.server, frame: 0, outputs: null });
        past.compared = null;
        showComparedBar();
      }
      live.version = told.live.version;
      past.states = told.history ?? [];
      showState(told.live, told.page);
      showHistory(told.history);
    } else if (!live.state || live.state.program && !live.state.program.held) live.bar.status.textContent = live.state ? "The program has ended no frame for a while." : "The program has ended no frame yet.";
    else showStatus();
  }
}
