// Texts in sight whose contrast is below WCAG 2.2's AA (success criterion 1.4.3): 4.5 to 1, or 3 to 1 for large text. Each as words.
(() => {
  const canvas = document.createElement("canvas").getContext("2d", { willReadFrequently: true });
  const parsed = (color) => {
    canvas.clearRect(0, 0, 1, 1);
    canvas.fillStyle = color;
    canvas.fillRect(0, 0, 1, 1);
    const [red, green, blue, alpha] = canvas.getImageData(0, 0, 1, 1).data;
    return [red, green, blue, alpha / 255];
  };
  const over = ([r, g, b, a], [red, green, blue]) => [[r, red], [g, green], [b, blue]].map(([top, below]) => top * a + below * (1 - a)).concat(1);
  const linear = (byte) => byte / 255 <= 0.04045 ? byte / 255 / 12.92 : ((byte / 255 + 0.055) / 1.055) ** 2.4;
  const luminance = ([red, green, blue]) => 0.2126 * linear(red) + 0.7152 * linear(green) + 0.0722 * linear(blue);
  const ratio = (one, other) => {
    const [low, high] = [luminance(one), luminance(other)].sort((a, b) => a - b);
    return (high + 0.05) / (low + 0.05);
  };
  const isSvg = (node) => node instanceof SVGElement;
  // What lies below a text: the grounds of what it stands in. In an SVG, the box of its group.
  const ground = (node) => {
    const below = [];
    for (let at = node; at; at = at.parentElement) {
      const box = isSvg(at) && at.tagName === "g" ? at.querySelector(":scope > rect") : null;
      below.push(parsed(box ? getComputedStyle(box).fill : isSvg(at) && at.tagName !== "svg" ? "#0000" : getComputedStyle(at).backgroundColor));
    }
    return below.reverse().reduce((color, top) => over(top, color), parsed(getComputedStyle(document.body).backgroundColor));
  };
  const opacity = (node) => {
    let product = 1;
    for (let at = node; at; at = at.parentElement) product *= Number(getComputedStyle(at).opacity);
    return product;
  };
  const found = new Set();
  const walker = document.createTreeWalker(document.body, NodeFilter.SHOW_TEXT);
  while (walker.nextNode()) {
    const node = walker.currentNode.parentElement;
    const style = getComputedStyle(node);
    if (walker.currentNode.data.trim() === "" || ["SCRIPT", "STYLE", "OPTION"].includes(node.tagName) || node.closest(":disabled, .dim, .culled")) continue;
    const box = node.getBoundingClientRect();
    if (box.width === 0 || box.height === 0 || style.visibility !== "visible") continue;
    const below = ground(node);
    const [red, green, blue, alpha] = parsed(isSvg(node) ? style.fill : style.color);
    const size = Number.parseFloat(style.fontSize);
    const needed = size >= 24 || (size >= 18.66 && Number(style.fontWeight) >= 700) ? 3 : 4.5;
    const is = ratio(over([red, green, blue, alpha * opacity(node)], below), below);
    if (is < needed) found.add(`${is.toFixed(2)}: ${node.tagName}.${node.getAttribute("class") ?? ""} "${walker.currentNode.data.trim().slice(0, 30)}"`);
  }
  return [...found];
})()
