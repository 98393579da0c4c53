/** The files, line by line. What is selected is shown at its line. */
function sourceView(model) {
  if (model.sources.length === 0) return element("p", {}, DATA.live ? "There is no file to show." : "This page has no texts of files: they were left out, or the Plan came from a file of its own.");
  const files = model.sources.map(({ name, text }) => {
    const lines = text.split("\n").map((line) => element("li", {}, colored(line)));
    return { name, lines, made: element("div", { "data-file": name }, element("h2", {}, name), element("ol", { class: "source" }, lines)) };
  });
  const box = element("div", {}, files.length > 1 ? element("p", { class: "tools" }, files.map(({ name, made }) => element("button", { type: "button", onclick: () => made.scrollIntoView() }, name))) : null, files.map((file) => file.made));
  markMistakes(box);
  box.showPlace = ({ file, line }) => {
    box.querySelectorAll(".here").forEach((one) => one.classList.remove("here"));
    const found = files.find((one) => one.name === file)?.lines[line - 1];
    found?.classList.add("here");
    found?.scrollIntoView({ block: "center" });
  };
  box.reveal = (key) => {
    const place = model.byKey && placeOf(model, key);
    if (place) box.showPlace(place);
  };
  return box;
}

/** The line of a file in which a part of the Plan stands. */
function placeOf(model, key) {
  const found = model.byKey.get(key);
  const cause = (found?.image ?? found?.buffer)?.cause;
  const at = found?.kind === "pass" ? found.node.at : found?.kind === "note" ? found.note.at : found?.kind === "step" ? found.nodes[0]?.at : cause?.written;
  return typeof at === "string" ? splitPlace(at) : null;
}

/** A line of a pipeline or a shader with its comments, texts and numbers apart. */
function colored(line) {
  const pieces = [];
  let from = 0;
  for (const { 0: found, index } of line.matchAll(/\/\/.*$|"(?:[^"\\]|\\.)*"|\b\d[\w.]*/g)) {
    pieces.push(line.slice(from, index), element("span", { class: found.startsWith("//") ? "comment" : found.startsWith('"') ? "text" : "literal" }, found));
    from = index + found.length;
  }
  return [...pieces, line.slice(from)];
}
