"use strict";
const { results, not_finite } = JSON.parse(document.getElementById("data").textContent);
const at = id => document.getElementById(id);

// Elements are made with text alone: nothing of a file is ever read as HTML.
function make(name, attributes = {}, text) {
  const svg = ["svg", "g", "circle", "path", "text", "polyline"].includes(name);
  const element = svg ? document.createElementNS("http://www.w3.org/2000/svg", name) : document.createElement(name);
  for (const [key, value] of Object.entries(attributes)) element.setAttribute(key, value);
  if (text !== undefined) element.textContent = text;
  return element;
}

const cost = figure => measured => figure(measured.cost);
const error = figure => measured => measured.errors && figure(measured.errors);
const MIB = 1024 * 1024;
const AXES = [
  ["GPU ms", cost(it => it.gpu_milliseconds?.median), 1],
  ["GPU ratio", cost(it => it.gpu_ratio?.median), 1],
  ["recording ms", cost(it => it.recording_milliseconds.median), 1],
  ["MiB", cost(it => it.transient_bytes / MIB), 1],
  ["moved MiB", cost(it => it.moved_bytes / MIB), 1],
  ["fragments, 10⁶", cost(it => typeof it.fragment_invocations === "number" ? it.fragment_invocations / 1e6 : null), 1],
  ["FLIP", error(it => it.flip.mean), 1],
  ["FLIP 95 %", error(it => it.flip.percentile_95), 1],
  ["FLIP worst", error(it => it.flip.worst), 1],
  ["RMSE", error(it => it.rmse), 1],
  ["largest error", error(it => it.max_error), 1],
  ["relative MSE", error(it => it.relative_mse), 1],
  ["SSIM", error(it => it.ssim), -1],
  ["flicker", measured => measured.flicker && measured.flicker.mean, 1],
  ["flicker 95 %", measured => measured.flicker && measured.flicker.percentile_95, 1],
  ["flicker worst", measured => measured.flicker && measured.flicker.worst, 1],
  // No difference is an infinite ratio.
  ["PSNR dB", error(it => it.psnr === null ? Infinity : it.psnr), -1],
].map(([name, of, sign]) => ({ name, sign, of: row => row.measured ? of(row.measured) : null }));

const swept = [...new Set(results.rows.flatMap(row => Object.keys(row.choice)))].filter(name => !name.startsWith("@")).sort();
const rows = results.rows.map((row, index) => {
  const [width, height] = row.size;
  const place = `${row.scene} at ${width}x${height}` + (row.stereo === "off" ? "" : `, ${row.stereo}`);
  const value = name => row.settings[name] ?? row.choice[name];
  const name = swept.filter(name => value(name) !== undefined).map(name => `${name}=${value(name)}`).join(" ");
  return { index, row, place, value, name: name || place, measured: row.outcome.measured, failed: row.outcome.failed };
});
const lacking = row => not_finite.includes(row.index);
const shown = value => value === null || value === undefined ? "" : value === Infinity ? "∞"
  : value === 0 ? "0" : Math.abs(value) >= 1e5 || Math.abs(value) < 1e-4 ? value.toExponential(3) : String(Number(value.toPrecision(5)));

let picked = rows.find(row => row.measured) || rows[0];
let sorted = { column: null, up: true };

function visible() {
  const group = at("group").value;
  return rows.filter(row => group === "" || row.place === group);
}

function axes() {
  return [AXES[at("across").value], AXES[at("up").value]];
}

// The rows that no other one beats, along the first axis.
function front(points) {
  const goodness = point => point.values.map((value, axis) => value * point.signs[axis]);
  const order = points.map(point => ({ point, key: goodness(point) })).sort((a, b) => a.key[0] - b.key[0] || a.key[1] - b.key[1]);
  let best = null;
  return order.filter(({ key }) => {
    const stays = best === null || key[1] < best[1] || (key[0] === best[0] && key[1] === best[1]);
    if (stays) best = key;
    return stays;
  }).map(({ point }) => point);
}

// The ends of an axis and the distance of its ticks: costs and errors begin at 0, likenesses where the figures do.
function range(values, axis) {
  if (values.length === 0) return { low: 0, high: 1, step: 0.25 };
  const most = Math.max(...values), least = axis.sign > 0 ? Math.min(0, ...values) : Math.min(...values);
  const span = most - least || Math.abs(most) || 1;
  const power = 10 ** Math.floor(Math.log10(span / 5));
  const step = [1, 2, 5, 10].map(digit => digit * power).find(step => span <= 5 * step) || span / 5;
  const low = Math.floor(least / step) * step;
  return { low, high: Math.max(low + step, Math.ceil(most / step) * step), step };
}

const WIDTH = 640, HEIGHT = 420, LEFT = 70, RIGHT = 16, TOP = 16, BOTTOM = 48;

function draw() {
  const both = axes(), signs = both.map(axis => axis.sign);
  const points = visible().map(row => ({ row, signs, values: both.map(axis => axis.of(row)) }))
    .filter(point => !lacking(point.row) && point.values.every(value => Number.isFinite(value)));
  const ranges = both.map((axis, index) => range(points.map(point => point.values[index]), axis));
  const along = (value, { low, high }, from, to) => from + (value - low) / (high - low) * (to - from);
  const x = value => along(value, ranges[0], LEFT, WIDTH - RIGHT), y = value => along(value, ranges[1], HEIGHT - BOTTOM, TOP);
  const svg = make("svg", { viewBox: `0 0 ${WIDTH} ${HEIGHT}`, role: "group", "aria-label": `${both[0].name} against ${both[1].name}` });
  ranges.forEach(({ low, high, step }, index) => {
    for (let tick = 0; tick <= Math.round((high - low) / step); tick++) {
      const value = low + tick * step, text = shown(Number(value.toPrecision(9)));
      if (index === 0) {
        svg.append(make("path", { class: "grid", d: `M${x(value)} ${TOP}V${HEIGHT - BOTTOM}` }));
        svg.append(make("text", { x: x(value), y: HEIGHT - BOTTOM + 18, "text-anchor": "middle" }, text));
      } else {
        svg.append(make("path", { class: "grid", d: `M${LEFT} ${y(value)}H${WIDTH - RIGHT}` }));
        svg.append(make("text", { x: LEFT - 8, y: y(value) + 4, "text-anchor": "end" }, text));
      }
    }
  });
  svg.append(make("path", { class: "axis", d: `M${LEFT} ${TOP}V${HEIGHT - BOTTOM}H${WIDTH - RIGHT}` }));
  const [across, up] = both.map(axis => axis.name + (axis.sign < 0 ? " (more is better)" : ""));
  svg.append(make("text", { x: (LEFT + WIDTH - RIGHT) / 2, y: HEIGHT - 10, "text-anchor": "middle" }, across));
  svg.append(make("text", { transform: `translate(16 ${(TOP + HEIGHT - BOTTOM) / 2}) rotate(-90)`, "text-anchor": "middle" }, up));
  const best = front(points);
  svg.append(make("polyline", { class: "line", points: best.map(({ values }) => `${x(values[0])},${y(values[1])}`).join(" ") }));
  points.sort((a, b) => a.values[0] - b.values[0]);
  const circles = points.map(point => {
    const { row, values } = point, onFront = best.includes(point);
    const label = `${row.name}\n${row.place}\n${both.map((axis, index) => `${axis.name} ${shown(values[index])}`).join(", ")}`;
    const circle = make("circle", { cx: x(values[0]), cy: y(values[1]), r: 5, tabindex: -1, role: "button", "aria-label": label });
    circle.classList.toggle("front", onFront);
    circle.dataset.row = row.index;
    circle.addEventListener("pointerenter", () => tip(circle, label));
    circle.addEventListener("pointerleave", () => tip(null));
    circle.addEventListener("focus", () => { tip(circle, label); pick(row); });
    circle.addEventListener("blur", () => tip(null));
    circle.addEventListener("click", () => pick(row));
    return circle;
  });
  // The front lies above the other points.
  [false, true].forEach(onFront => svg.append(...circles.filter(circle => circle.classList.contains("front") === onFront)));
  svg.addEventListener("keydown", event => {
    const step = { ArrowRight: 1, ArrowUp: 1, ArrowLeft: -1, ArrowDown: -1 }[event.key];
    const next = circles[circles.indexOf(event.target) + step];
    if (step && next) { event.preventDefault(); next.focus(); }
  });
  at("plot").replaceChildren(svg);
  mark();
}

function tip(circle, label) {
  const tip = at("tip");
  tip.hidden = circle === null;
  if (circle === null) return;
  tip.textContent = label;
  const box = circle.getBoundingClientRect(), own = tip.getBoundingClientRect();
  tip.style.left = Math.max(4, Math.min(box.right + 8, innerWidth - own.width - 8)) + "px";
  tip.style.top = Math.max(4, box.top - own.height - 8) + "px";
}

function pick(row) {
  picked = row;
  mark();
  detail();
}

// Shows which row is picked, in the plot and the table.
function mark() {
  const circles = [...document.querySelectorAll("circle")];
  circles.forEach(circle => {
    const own = Number(circle.dataset.row) === picked?.index;
    circle.classList.toggle("picked", own);
    circle.setAttribute("tabindex", own ? 0 : -1);
  });
  if (circles.length && !circles.some(circle => circle.tabIndex === 0)) circles[0].setAttribute("tabindex", 0);
  document.querySelectorAll("tbody tr").forEach(line => line.setAttribute("aria-selected", Number(line.dataset.row) === picked?.index));
}

function detail() {
  if (!picked) return;
  at("name").textContent = `${picked.name} — ${picked.place}`;
  const paths = picked.measured ? ["picture", "reference", "heat_map", "flicker_map"] : [];
  at("pictures").replaceChildren(...paths.filter(kind => picked.measured[kind]).map(kind => {
    // Each part of a path is a name, whatever it holds.
    const path = picked.measured[kind], address = path.split("/").map(encodeURIComponent).join("/");
    const what = {
      picture: "picture", reference: "reference", heat_map: "FLIP: bright where a difference is seen",
      flicker_map: "flicker: bright where the error changes from frame to frame",
    }[kind];
    const figure = make("figure"), link = make("a", { href: address });
    link.append(/\.png$/i.test(path) ? make("img", { src: address, alt: what, loading: "lazy" }) : document.createTextNode(path));
    figure.append(link, make("figcaption", {}, what));
    return figure;
  }));
  const list = [];
  if (picked.failed !== undefined) list.push(["error", picked.failed]);
  if (lacking(picked)) {
    const { errors, flicker } = picked.measured, [reference, picture] = errors?.non_finite ?? [0, 0];
    const counts = [[picture, "of the picture"], [reference, "of the reference"], [flicker?.non_finite ?? 0, "of moving frames"]];
    const said = counts.filter(([count]) => count > 0).map(([count, of]) => `${count} pixels ${of}`).join(", ");
    list.push(["not finite", `${said}; they are no part of the figures`]);
  }
  const floor = picked.measured?.reference_errors;
  if (floor) list.push(["reference's own error", `FLIP ${shown(floor.flip.mean)}, RMSE ${shown(floor.rmse)} estimated`]);
  for (const pass of picked.measured?.passes ?? []) list.push([pass.name, pass.gpu_milliseconds ? `${shown(pass.gpu_milliseconds.median)} ms` : "not timed"]);
  const lines = list.map(([name, text]) => [make("dt", {}, name), make("dd", {}, text)]);
  const settings = Object.entries(picked.row.settings).map(([name, value]) =>
    [make("dt", swept.includes(name) ? { class: "swept" } : {}, name), make("dd", {}, value)]);
  at("settings").replaceChildren(...settings.concat(lines).flat());
}

const COLUMNS = [
  ...swept.map(name => ({ name, of: row => row.value(name), text: true })),
  { name: "scene", of: row => row.place, text: true },
  ...AXES.map(axis => ({ name: axis.name, of: axis.of })),
];
const SPREADS = { "GPU ms": "gpu_milliseconds", "GPU ratio": "gpu_ratio", "recording ms": "recording_milliseconds" };

// Figures by size, names in the order of people: 2 before 10. What is missing comes last.
function compare(a, b) {
  const missing = value => value === null || value === undefined;
  if (missing(a) || missing(b)) return missing(a) - missing(b);
  const order = typeof a === "number" ? (a < b ? -1 : a > b ? 1 : 0) : String(a).localeCompare(String(b), undefined, { numeric: true });
  return sorted.up ? order : -order;
}

function table() {
  const head = make("tr");
  for (const column of COLUMNS) {
    const cell = make("th", { scope: "col", class: column.text ? "text" : "" });
    const button = make("button", { type: "button" }, column.name);
    if (sorted.column === column) {
      cell.setAttribute("aria-sort", sorted.up ? "ascending" : "descending");
      button.textContent += sorted.up ? " ▲" : " ▼";
    }
    button.addEventListener("click", () => {
      sorted = { column, up: sorted.column === column ? !sorted.up : true };
      table();
      document.querySelectorAll("th button")[COLUMNS.indexOf(column)].focus();
    });
    cell.append(button);
    head.append(cell);
  }
  document.querySelector("thead").replaceChildren(head);
  const list = visible();
  if (sorted.column) list.sort((a, b) => compare(sorted.column.of(a), sorted.column.of(b)));
  document.querySelector("tbody").replaceChildren(...list.map(row => {
    const line = make("tr", { tabindex: 0, "data-row": row.index });
    for (const column of COLUMNS) {
      if (row.failed !== undefined && !column.text) continue;
      const value = column.of(row), cell = make("td", { class: column.text ? "text" : "" }, column.text ? value ?? "" : shown(value));
      const spread = row.measured?.cost[SPREADS[column.name]];
      if (spread) cell.title = `a quarter is below ${shown(spread.low)}, a quarter above ${shown(spread.high)}`;
      line.append(cell);
    }
    if (row.failed !== undefined) line.append(make("td", { class: "failed", colspan: AXES.length }, row.failed));
    line.addEventListener("click", () => pick(row));
    line.addEventListener("focus", () => pick(row));
    line.addEventListener("keydown", event => {
      const next = { ArrowDown: line.nextElementSibling, ArrowUp: line.previousElementSibling }[event.key];
      if (next) { event.preventDefault(); next.focus(); }
    });
    return line;
  }));
  mark();
}

function renew() {
  const list = visible();
  if (!list.includes(picked)) picked = list.find(row => row.measured) || list[0];
  draw();
  table();
  detail();
}

const { subject } = results;
at("subject").textContent = `${subject.pipeline} on ${subject.device} (${subject.driver}), ${subject.frames} frames a row`;
document.title = `${subject.pipeline}: measured settings`;
const places = [...new Set(rows.map(row => row.place))];
places.forEach(place => at("group").append(make("option", { value: place }, place)));
if (places.length !== 1) at("group").append(make("option", { value: "" }, "all"));
for (const [id, first] of [["across", 0], ["up", 6]]) {
  AXES.forEach((axis, index) => at(id).append(make("option", { value: index }, axis.name)));
  at(id).value = first;
}
for (const id of ["group", "across", "up"]) at(id).addEventListener("change", renew);
renew();
