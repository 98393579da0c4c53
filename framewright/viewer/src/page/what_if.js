/** The page of `inspect --what-if`: its pipeline is compiled anew, by the compiler that the page carries. */
const whatIf = { page: null, subject: null, choices: null, view: null, parts: null, worker: null, asked: new Map(), number: 0, timer: null, file: 0, alone: false };

/** An answer may take this many milliseconds, and a text may have this many characters. */
const LONGEST_ANSWER = 20000;
const LONGEST_TEXT = 1000000;

/** What a worker does: it keeps the compiler and the pipeline, and answers one question after the other. Each has memory of its own. */
function compileInWorker() {
  let module = null;
  let subject = "";
  onmessage = async ({ data }) => {
    try {
      if (data.module) {
        subject = data.subject;
        module = WebAssembly.compile(data.module);
        return;
      }
      const { exports: compiler } = await WebAssembly.instantiate(await module, {});
      const question = new TextEncoder().encode(`{"subject":${subject},"choices":${JSON.stringify(data.choices)},"form":"${data.form}"}`);
      const at = compiler.room(question.length) >>> 0;
      new Uint8Array(compiler.memory.buffer, at, question.length).set(question);
      const length = compiler.ask() >>> 0;
      const answer = new Uint8Array(compiler.memory.buffer, compiler.told() >>> 0, length);
      postMessage({ number: data.number, answer: new TextDecoder().decode(answer) });
    } catch (error) {
      postMessage({ number: data.number, failed: String(error) });
    }
  };
}

async function unpacked(text) {
  const packed = Uint8Array.from(atob(text), (c) => c.charCodeAt(0));
  const stream = new Blob([packed]).stream().pipeThrough(new DecompressionStream("deflate"));
  return new Uint8Array(await new Response(stream).arrayBuffer());
}

/** Unpacks what the page carries. Throws where the browser is too old. */
async function unpackWhatIf() {
  if (typeof WebAssembly !== "object" || typeof DecompressionStream !== "function" || typeof Worker !== "function") {
    throw new Error("this browser has no WebAssembly, no workers or no DecompressionStream");
  }
  const { module, subject } = whatIf.page.what_if;
  whatIf.module = await unpacked(module);
  whatIf.text = new TextDecoder().decode(await unpacked(subject));
  whatIf.subject = JSON.parse(whatIf.text);
}

function startWorker() {
  const address = URL.createObjectURL(new Blob([`(${compileInWorker})()`], { type: "text/javascript" }));
  const worker = new Worker(address);
  URL.revokeObjectURL(address);
  worker.onmessage = ({ data }) => told(data);
  worker.onerror = (event) => stopWorker(event.message || "the browser starts no worker from this page");
  worker.postMessage({ module: whatIf.module, subject: whatIf.text });
  return worker;
}

function told({ number, answer, failed }) {
  const done = whatIf.asked.get(number);
  whatIf.asked.delete(number);
  done?.(failed ? stopped(failed) : JSON.parse(answer));
}

/** What a question is told that has no answer. */
const stopped = (why) => ({ wrong: { mistakes: [], message: `The compiler stopped: ${why}` } });

function stopWorker(why) {
  whatIf.worker?.terminate();
  whatIf.worker = null;
  for (const [number, done] of whatIf.asked) {
    whatIf.asked.delete(number);
    done(stopped(why));
  }
}

/** Asks the compiler. The answer has `version`, and `plan`, `view` or `wrong`. */
async function askCompiler(choices, form) {
  if (!whatIf.subject) await unpackWhatIf();
  whatIf.worker ??= startWorker();
  const number = whatIf.number += 1;
  const late = setTimeout(() => stopWorker(`no answer within ${LONGEST_ANSWER / 1000} seconds`), LONGEST_ANSWER);
  const answer = await new Promise((done) => {
    whatIf.asked.set(number, done);
    whatIf.worker.postMessage({ number, choices, form });
  });
  clearTimeout(late);
  return answer;
}

/** The view. It stays while the others are made anew. */
function whatIfView() {
  const status = element("p", { role: "status", id: "what-if-status" }, "unpacking the compiler …");
  const parts = { status, controls: element("div", { class: "controls" }), editor: element("div", { class: "editor" }), result: element("div", { id: "what-if-result" }) };
  whatIf.parts = parts;
  begin().catch((error) => { status.textContent = `Nothing is compiled here: ${error.message ?? error}. Browsers since 2023 do it.`; });
  return element("div", { class: "what-if" },
    element("p", { class: "hint" }, "Change anything: the Plan is made anew, and every view shows it. Shaders aren't compiled here: the page carries what the compiler asks of them, for the choices that were tried when the page was made. Nothing leaves this page."),
    status, element("div", { class: "beside" }, element("div", {}, parts.controls, parts.editor), parts.result));
}

async function begin() {
  await unpackWhatIf();
  whatIf.choices = structuredClone(whatIf.subject.own);
  showChoices();
  showEditor();
  whatIf.parts.status.textContent = "compiling …";
  const own = await askCompiler(whatIf.subject.own, "view");
  if (own.wrong) return showAnswer(own);
  const { version } = whatIf.page.what_if;
  const whole = own.view.plan.whole?.plan;
  if (own.version !== version || JSON.stringify(whole) !== JSON.stringify(whatIf.page.plans[0].whole?.plan)) {
    whatIf.parts.status.textContent = `The compiler in this page (${own.version}) is another one than that of the command which made the page (${version}): it makes another Plan of the same files. Make the page anew.`;
    whatIf.other = true;
    return undefined;
  }
  whatIf.parts.status.textContent = "This is the Plan of the page.";
  return undefined;
}

/** Compiles soon, unless something else is changed before. */
function changed() {
  clearTimeout(whatIf.timer);
  whatIf.timer = setTimeout(compileAnew, 300);
}

async function compileAnew() {
  if (whatIf.other) return;
  const { status } = whatIf.parts;
  // One question at a time: what is changed meanwhile is asked next.
  if (whatIf.busy) {
    whatIf.again = true;
    return;
  }
  if (Object.values(whatIf.choices.texts).some((text) => text.length > LONGEST_TEXT)) {
    status.textContent = `The text is too long: at most ${LONGEST_TEXT} characters are compiled here.`;
    return;
  }
  whatIf.busy = true;
  const begun = performance.now();
  const answer = await askCompiler(whatIf.choices, "view").catch((error) => stopped(error.message));
  whatIf.busy = false;
  showAnswer(answer, performance.now() - begun);
  if (whatIf.again) {
    whatIf.again = false;
    await compileAnew();
  }
}

function isOwn() { return JSON.stringify(whatIf.choices) === JSON.stringify(whatIf.subject.own); }

/** Shows an answer here, and a Plan in all views. */
function showAnswer({ view, wrong }, ms) {
  const { status, result } = whatIf.parts;
  markLines(wrong?.mistakes ?? []);
  if (wrong) {
    status.textContent = wrong.mistakes.length > 0 ? "There is no such Plan: " + count(wrong.mistakes.length, "mistake", "mistakes") + ". The views show the last one." : "There is no such Plan.";
    result.replaceChildren(element("pre", { class: "wrong" }, wrong.message), ...wrong.mistakes.filter((mistake) => mistake.file).map((mistake) =>
      element("button", { type: "button", class: "link place", onclick: () => showLine(mistake) }, `${mistake.file}:${mistake.line}`)).flatMap((place) => [place, " "]));
    return;
  }
  const { page } = whatIf;
  if (isOwn()) showData(page);
  else if (whatIf.alone) showData({ ...page, plans: [view.plan], differences: null, devices: [], captures: [] });
  else showData({ ...page, plans: [page.plans[0], view.plan], differences: view.differences });
  const { differences } = view;
  const number = differences ? differences.totals.filter((figure) => figure.a !== figure.b).length + differences.entries.length : 0;
  status.textContent = (isOwn() ? "This is the Plan of the page" : number === 0 ? "Nothing differs from the Plan of the page" : count(number, "difference", "differences") + " from the Plan of the page") + `; compiled in ${milliseconds(ms)}.`;
  result.replaceChildren(...(number === 0 ? [] : [element("p", { class: "hint" }, "A is the Plan of the page, B what is chosen here."), ...differencesList(models[models.length - 1], differences).flat().filter(Boolean)]));
}

/** A control of a choice: its element, and the text before it. */
const labelled = (text, made, is) => element("label", { class: is ? "chosen" : null }, text + " ", made);

const selectOf = (name, values, shown, send) => element("select", { "data-setting": name, onchange: (event) => send(event.target.value) },
  values.map(([value, text]) => element("option", { value, selected: value === shown }, text ?? value)));

/** Changes the choices, and shows their controls anew: those that are chosen stand out. */
function chooseHere(change) {
  change(whatIf.choices);
  showChoices();
  changed();
}

function showChoices() {
  const { choices, subject, page, parts } = whatIf;
  const { controls, devices, passes } = page.what_if;
  const { own } = subject;
  const focused = document.activeElement?.dataset?.setting;
  const chosen = new Map(choices.set);
  const ofOwn = new Map(own.set);
  const side = (at, name) => element("input", { "data-setting": "@" + name, type: "number", min: 1, max: 16384, value: choices.extent[at], onchange: (event) => chooseHere(({ extent }) => { extent[at] = Number.isSafeInteger(Number(event.target.value)) ? Math.max(0, Math.min(4294967295, Number(event.target.value))) : 0; }) });
  const setting = ({ name, about, value, one_of, between }) => {
    const send = (text) => chooseHere((it) => { it.set = [...it.set.filter(([other]) => other !== name), ...(text === "" ? [] : [[name, text]])]; });
    const shown = chosen.get(name) ?? value;
    const made = one_of ? selectOf(name, one_of.map((one) => [one]), shown, send)
      : element("input", { "data-setting": name, type: "number", min: between[0], max: between[1], step: between[2] ?? "any", value: shown, onchange: (event) => send(event.target.value) });
    if (about) made.title = visible(about);
    return labelled(name, made, chosen.get(name) !== ofOwn.get(name));
  };
  const pass = (name) => element("label", {}, element("input", { type: "checkbox", "data-setting": "@pass " + name, checked: choices.left_out.includes(name), onchange: (event) => chooseHere((it) => { it.left_out = [...it.left_out.filter((other) => other !== name), ...(event.target.checked ? [name] : [])]; }) }), " " + name);
  const open = parts.controls.querySelector("details")?.open ?? false;
  parts.controls.replaceChildren(
    labelled("device", selectOf("@device", devices.map((name) => [name]), choices.device, (name) => chooseHere((it) => { it.device = name; })), choices.device !== own.device),
    element("span", { class: "pair" }, labelled("width", side(0, "width"), choices.extent[0] !== own.extent[0]), " ", labelled("height", side(1, "height"), choices.extent[1] !== own.extent[1])),
    controls.presets.length > 0 ? labelled("preset", selectOf("@preset", [["", "none"], ...controls.presets.map((name) => [name])], choices.preset ?? "", (name) => chooseHere((it) => { it.preset = name || null; })), choices.preset !== own.preset) : "",
    ...controls.settings.map(setting),
    element("details", { class: "left-out", open }, element("summary", {}, choices.left_out.length > 0 ? "Without " + choices.left_out.join(", ") : "Leave passes out"), passes.map(pass)),
    labelled("beside the Plan of the page", element("input", { type: "checkbox", "data-setting": "@beside", checked: !whatIf.alone, onchange: (event) => { whatIf.alone = !event.target.checked; changed(); } })),
    element("button", { type: "button", id: "what-if-begun", disabled: isOwn(), onclick: () => { whatIf.choices = structuredClone(own); showChoices(); showEditor(); changed(); } }, "as begun"));
  if (focused) [...parts.controls.querySelectorAll("[data-setting]")].find((one) => one.dataset.setting === focused)?.focus();
}

/** The text of a file, with the numbers of its lines. */
function showEditor() {
  const { subject, choices, parts } = whatIf;
  const file = subject.files[whatIf.file];
  const lines = element("pre", { class: "lines", "aria-hidden": "true" });
  const text = element("textarea", { id: "what-if-text", spellcheck: "false", wrap: "off", autocapitalize: "off", "aria-label": "The text of " + file.shown });
  text.value = choices.texts[file.path] ?? file.text;
  const number = () => {
    const wanted = text.value.split("\n").length;
    if (lines.childElementCount !== wanted) lines.replaceChildren(...Array.from({ length: Math.min(wanted, 100000) }, (_, at) => element("span", {}, String(at + 1))));
  };
  text.addEventListener("input", () => {
    if (text.value === file.text) delete choices.texts[file.path];
    else choices.texts[file.path] = text.value;
    number();
    document.getElementById("what-if-begun").disabled = isOwn();
    changed();
  });
  text.addEventListener("scroll", () => { lines.scrollTop = text.scrollTop; });
  number();
  whatIf.lines = lines;
  whatIf.area = text;
  parts.editor.replaceChildren(
    element("div", { class: "controls" }, subject.files.length > 1 ? labelled("file", selectOf("@file", subject.files.map(({ shown }, at) => [String(at), shown]), String(whatIf.file), (at) => { whatIf.file = Number(at); showEditor(); markLines(whatIf.wrong ?? []); })) : element("span", { class: "faint" }, file.shown)),
    element("div", { class: "text" }, lines, text));
}

/** Marks the lines in which mistakes are, and says them there. */
function markLines(mistakes) {
  whatIf.wrong = mistakes;
  if (!whatIf.lines) return;
  const { shown } = whatIf.subject.files[whatIf.file];
  for (const line of whatIf.lines.querySelectorAll(".bad")) {
    line.classList.remove("bad");
    line.removeAttribute("title");
  }
  for (const { file, line, message } of mistakes) {
    const made = file === shown ? whatIf.lines.children[line - 1] : null;
    made?.classList.add("bad");
    made?.setAttribute("title", visible(message));
  }
}

/** Puts the cursor into the line of a mistake. */
function showLine({ file, line }) {
  const at = whatIf.subject.files.findIndex((one) => one.shown === file);
  if (at < 0) return;
  if (at !== whatIf.file) {
    whatIf.file = at;
    showEditor();
    markLines(whatIf.wrong);
  }
  const { area } = whatIf;
  const before = area.value.split("\n").slice(0, line - 1).reduce((sum, one) => sum + one.length + 1, 0);
  area.focus();
  area.setSelectionRange(before, before + (area.value.split("\n")[line - 1] ?? "").length);
  area.scrollTop = Math.max(0, (line - 4) * parseFloat(getComputedStyle(area).lineHeight));
}
