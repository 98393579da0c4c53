/** Empty room around a drawing. */
const MARGIN = 20;

/**
 * A drawing that is moved by dragging and zoomed by the wheel, with a map of all of it in a corner. It holds only what is in sight:
 * `draw(svg, [left, top, width, height])` is called at each change.
 */
function canvas(label, extent, draw) {
  const view = shape("svg", { class: "view", role: "group", "aria-label": label });
  const map = shape("svg", { class: "minimap", "aria-hidden": "true" });
  const box = element("div", { class: "canvas", tabindex: "0", role: "region", "aria-label": label }, view, map);
  const camera = { x: 0, y: 0, scale: 1 };
  let fitted = false;
  let waiting = false;
  const size = () => [box.clientWidth || 1, box.clientHeight || 1];
  const redraw = () => {
    waiting = false;
    const [wide, high] = extent();
    const [width, height] = size();
    if (!fitted && box.clientWidth > 0) fit();
    const seen = printing ? [-MARGIN, -MARGIN, wide + 2 * MARGIN, high + 2 * MARGIN] : [camera.x, camera.y, width / camera.scale, height / camera.scale];
    view.setAttribute("viewBox", seen.join(" "));
    view.replaceChildren();
    draw(view, seen);
    highlight(view);
    const whole = seen[0] <= 0 && seen[1] <= 0 && seen[0] + seen[2] >= wide && seen[1] + seen[3] >= high;
    map.toggleAttribute("hidden", whole || printing);
    if (!whole) {
      const side = Math.min(130 / wide, 160 / high);
      map.setAttribute("width", wide * side);
      map.setAttribute("height", high * side);
      map.setAttribute("viewBox", [0, 0, wide, high].join(" "));
      map.replaceChildren(shape("rect", { class: "all", width: wide, height: high }), shape("rect", { class: "sight", x: seen[0], y: seen[1], width: seen[2], height: seen[3], "vector-effect": "non-scaling-stroke" }));
    }
  };
  const ask = () => {
    if (!waiting) {
      waiting = true;
      requestAnimationFrame(redraw);
    }
  };
  const zoom = (factor, at = size().map((side) => side / 2)) => {
    const to = Math.max(0.05, Math.min(4, camera.scale * factor));
    const moved = 1 / camera.scale - 1 / to;
    camera.x += at[0] * moved;
    camera.y += at[1] * moved;
    camera.scale = to;
    ask();
  };
  /** Shows all of it, but no smaller than can be read; then its beginning. */
  const fit = (least = 0.55) => {
    const [width, height] = size();
    const [wide, high] = extent().map((side) => side + 2 * MARGIN);
    const all = Math.min(width / wide, height / high, 1);
    camera.scale = Math.max(all, Math.min(least, width / wide), 0.05);
    camera.x = Math.min(-MARGIN, (wide - width / camera.scale) / 2 - MARGIN);
    if (wide * camera.scale > width) camera.x = (wide - width / camera.scale) / 2 - MARGIN;
    camera.y = -MARGIN;
    fitted = box.clientWidth > 0;
    ask();
  };
  box.addEventListener("wheel", (event) => {
    event.preventDefault();
    const place = box.getBoundingClientRect();
    zoom(Math.exp(-event.deltaY * (event.deltaMode === 1 ? 0.05 : 0.0015)), [event.clientX - place.left, event.clientY - place.top]);
  }, { passive: false });
  let held = null;
  box.addEventListener("pointerdown", (event) => { if (event.button === 0) held = { x: event.clientX, y: event.clientY, moved: false }; });
  box.addEventListener("pointermove", (event) => {
    if (!held) return;
    const [x, y] = [event.clientX - held.x, event.clientY - held.y];
    if (!held.moved && Math.hypot(x, y) < 4) return;
    if (!held.moved) box.setPointerCapture(event.pointerId);
    camera.x -= x / camera.scale;
    camera.y -= y / camera.scale;
    held = { x: event.clientX, y: event.clientY, moved: true };
    ask();
  });
  box.addEventListener("pointerup", () => {
    const dragged = held?.moved;
    held = null;
    // What was dragged isn't clicked.
    if (dragged) box.addEventListener("click", (event) => event.stopPropagation(), { capture: true, once: true });
  });
  box.addEventListener("keydown", (event) => {
    const way = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] }[event.key];
    if (way && event.target === box) {
      camera.x += way[0] * 60 / camera.scale;
      camera.y += way[1] * 60 / camera.scale;
      ask();
    } else if (event.key === "+" || event.key === "=") zoom(1.25);
    else if (event.key === "-") zoom(0.8);
    else if (event.key === "0") fit();
    else return;
    event.preventDefault();
    event.stopPropagation();
  });
  map.addEventListener("pointerdown", (event) => {
    const place = map.getBoundingClientRect();
    const [wide, high] = extent();
    const [width, height] = size();
    camera.x = (event.clientX - place.left) / place.width * wide - width / camera.scale / 2;
    camera.y = (event.clientY - place.top) / place.height * high - height / camera.scale / 2;
    event.stopPropagation();
    ask();
  });
  new ResizeObserver(ask).observe(box);
  const button = (name, title, act) => element("button", { type: "button", title, onclick: act }, name);
  box.buttons = [button("−", "Smaller", () => zoom(0.8)), button("+", "Larger", () => zoom(1.25)), button("Fit", "All of it", () => fit(0.05)),
    button("1:1", "Full size", () => zoom(1 / camera.scale))];
  box.redraw = redraw;
  box.fit = fit;
  box.show = (left, top, width, height) => {
    const [wide, high] = size().map((side) => side / camera.scale);
    if (left < camera.x || left + width > camera.x + wide) camera.x = left + width / 2 - wide / 2;
    if (top < camera.y || top + height > camera.y + high) camera.y = top + height / 2 - high / 2;
    ask();
  };
  return box;
}
