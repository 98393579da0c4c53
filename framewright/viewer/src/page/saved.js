/** A frame that was saved: the page opens from disk, and its pictures lie within it. */

/** Which frame it is, and of what: above all views. */
function addSavedBar({ seconds, lost, program, took, message }) {
  const when = new Date(seconds * 1000).toISOString().slice(0, 16).replace("T", " ") + " UTC";
  const renderer = program?.renderers.find(({ id }) => id === program.renderer)?.name;
  const which = program ? [`Frame ${program.frame ?? "?"}`, renderer ? " of " + renderer : "", ` on ${program.device} (${program.driver})`] : ["A frame of framewright serve"];
  document.getElementById("body").before(element("section", { id: "live", "aria-label": "Saved frame" },
    element("p", { id: "saved-frame" }, which, `, saved ${when}`, took ? "; " + took : null),
    element("div", { id: "live-wrong" }, lost ? element("pre", {}, "The last frame that was shown: " + lost) : null, message ? element("pre", {}, message) : null)));
}

/** Its outputs, and what validation found. */
function savedView() {
  const { outputs, program } = DATA.saved;
  return element("div", {}, findingsOf(program?.findings ?? []),
    element("div", { class: "outputs" }, outputs.map(({ name, picture }) => element("figure", {}, element("img", { src: picture, alt: name }), element("figcaption", {}, name)))));
}
