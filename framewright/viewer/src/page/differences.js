/** Kinds of entries that are about sizes and memory, and not about the frame's structure. */
const SIZES = new Set(["image", "buffer", "heap", "memory"]);

/** Differences between two Plans: their sums, then each thing that differs, with its structure first. */
function differencesList(model, differences) {
  const differ = differences.totals.filter((figure) => figure.a !== figure.b);
  const shown = (figure, amount) => figure.bytes ? bytes(amount) : String(amount);
  const change = (figure) => (figure.b > figure.a ? "+" : "−") + shown(figure, Math.abs(figure.b - figure.a));
  const number = (text, more = "") => element("td", { class: "number " + more }, text);
  const sums = differ.length === 0 ? element("p", {}, "No sum differs.") : element("table", { class: "sums" },
    element("thead", {}, element("tr", {}, ["sum", "A", "B", "B − A"].map((name, at) => element("th", { class: at > 0 ? "number" : null, scope: "col" }, name)))),
    element("tbody", {}, differ.map((figure) => element("tr", {}, element("td", {}, figure.name), number(shown(figure, figure.a)), number(shown(figure, figure.b)), number(change(figure))))));
  const entries = (list) => element("ul", { class: "outline entries" }, list.map((entry) => entryLine(model, entry)));
  const structure = differences.entries.filter((entry) => !SIZES.has(entry.kind));
  const sizes = differences.entries.filter((entry) => SIZES.has(entry.kind));
  return [sums, entries(structure),
    sizes.length === 0 ? null : element("details", { class: "sizes", open: structure.length === 0 }, element("summary", {}, count(sizes.length, "image, buffer or heap differs", "images, buffers and heaps differ") + " in size, memory or use"), entries(sizes))];
}

function entryLine(model, entry) {
  const is = (one) => one !== undefined && one !== null;
  const value = (field) => is(field.a) && is(field.b) ? `${field.name} ${field.b} (was ${field.a})` : `${field.name} ${field.b ?? field.a}`;
  const sign = { added: "+", removed: "−", changed: "~" };
  return element("li", { class: entry.change }, sign[entry.change] + " " + entry.kind + " ", withLinks(entry.name + ": " + entry.fields.map(value).join(", ")),
    entry.because ? [": ", withLinks(entry.because)] : null, " ", placeLink(model, entry.at));
}

/** What every other shipped device changes. */
function devicesView(model) {
  return element("div", {}, element("p", {}, `Here A is the Plan of this page, for ${models[0].plan?.device.name ?? ""}, and B the same frame on another device. What memory takes there is estimated from the device's profile.`), DATA.devices.map(({ profile, differences }) => {
    const told = "Ok" in differences ? differences.Ok : null;
    const number = told ? told.totals.filter((figure) => figure.a !== figure.b).length + told.entries.length : 0;
    const structure = told ? told.entries.filter((entry) => !SIZES.has(entry.kind)).length : 0;
    const line = told ? (number === 0 ? "no difference" : count(number, "difference", "differences") + `, ${structure} of structure`) : "no Plan: " + differences.Err;
    const made = element("details", { class: "device" }, element("summary", {}, element("strong", {}, profile), ": " + line));
    made.addEventListener("toggle", () => {
      if (told && made.open && made.children.length === 1) made.append(...differencesList(model, told).filter(Boolean));
    });
    return made;
  }));
}

/** What a side of a comparison was made with: its device, and the settings in which it differs from the other. */
function sideWords(side, other) {
  const differ = side.settings.filter((setting) => other.settings.find((one) => one.name === setting.name)?.value !== setting.value);
  return `${side.name} on ${side.device.name}` + differ.map((setting) => `, ${setting.name}=${setting.value}`).join("");
}

/** What differs between the two Plans of the page. */
function comparedView() {
  const { a, b } = DATA.differences;
  return element("div", {}, element("p", {}, element("strong", {}, "A: "), sideWords(a, b)), element("p", {}, element("strong", {}, "B: "), sideWords(b, a)), DATA.sides ? comparedStates(DATA.sides) : null, differencesList(models[1], DATA.differences));
}
