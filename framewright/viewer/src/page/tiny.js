/** Pictures in rows and boxes: drawn once they are in sight, where a view has them switched on. */
const tiny = { made: new Map(), data: null };

/** The switch of a view: off until somebody turns it on. Null where nothing was captured. */
function picturesSwitch(changed) {
  if (DATA.captures.length === 0) return null;
  return element("label", { title: "Small pictures of what passes wrote" }, element("input", { type: "checkbox", class: "switch", onchange: (event) => changed(event.target.checked) }), " Pictures");
}

/** The capture that shows an image as the frame leaves it, or as `passes` leave it. */
const captureOf = (image, passes = null) => DATA.captures.findLast((one) => one.image === frameName(image) && !one.stencil && (passes === null || passes.has(one.pass)));

/** The name that an image has in the frame: a resolved copy shows the image that it is of. */
const frameName = (name) => name.replace(/ \(resolved\)$/, "");

/** A picture in a drawing, at most so large. What was drawn once is put there again: `place` says where, since an image and its resolved copy have one picture. */
function tinyPicture(capture, place, [x, y, width, height]) {
  if (tiny.data !== DATA) {
    tiny.data = DATA;
    tiny.made.clear();
  }
  const key = JSON.stringify([place, nameOfCapture(capture)]);
  if (!tiny.made.has(key)) {
    const canvas = element("canvas", { class: "tiny", role: "img", "aria-label": capture.image + " after " + capture.pass });
    tiny.made.set(key, canvas);
    askFor(capture, { most: 128 }).then((picture) => paint(canvas, picture), (problem) => {
      canvas.title = visible(problem.message);
      // What failed is asked for again when it is drawn again.
      tiny.made.delete(key);
    });
  }
  return shape("foreignObject", { x, y, width, height, onclick: () => openLarge(capture) }, tiny.made.get(key));
}
