/** How often each number is in a picture: per channel, and between which numbers it is drawn. */
const BINS = 96;
const CHANNEL_COLORS = ["var(--bad)", "#3a9d4a", "var(--accent)", "var(--faint)"];

/** The names of a picture's channels. */
const channelNames = (picture) => picture.channels === 1 ? [/^(D|X8_D)\d/.test(picture.format) && !picture.stencil ? "depth" : picture.stencil ? "stencil" : "r"] : ["r", "g", "b", "a"].slice(0, picture.channels);

/** Counts of the numbers of each channel between the smallest and the largest, and of those that are NaN or infinite. */
function histogramOf(picture) {
  const values = decoded(picture);
  const [low, high] = picture.range ?? [0, 1];
  const channels = channelNames(picture).map((name) => ({ name, bins: new Array(BINS).fill(0), others: 0 }));
  for (let at = 0; at < values.length; at += 1) {
    const channel = channels[at % picture.channels];
    if (!Number.isFinite(values[at])) channel.others += 1;
    else channel.bins[Math.max(0, Math.min(BINS - 1, Math.floor((values[at] - low) / (high - low || 1) * BINS)))] += 1;
  }
  return { low, high, channels };
}

/** The histogram, with two handles for the numbers that are drawn darkest and brightest. `ranged` gets both, or null for all. */
function histogram(picture, ranged) {
  const { low, high, channels } = histogramOf(picture);
  const most = Math.max(1, ...channels.flatMap(({ bins }) => bins));
  // A few large counts would hide all others.
  const height = (amount) => amount === 0 ? 0 : 4 + 56 * Math.log1p(amount) / Math.log1p(most);
  const svg = shape("svg", { class: "histogram", viewBox: `0 0 ${BINS} 60`, preserveAspectRatio: "none", role: "img", "aria-label": "Histogram" },
    channels.map(({ bins }, at) => shape("path", { d: "M0 60" + bins.map((amount, bin) => `L${bin} ${60 - height(amount)}H${bin + 1}`).join("") + "V60Z", fill: CHANNEL_COLORS[at], opacity: 0.45 })));
  const words = element("output", {});
  const number = (share) => low + share / 1000 * (high - low);
  const handle = (label, value) => element("input", { type: "range", min: 0, max: 1000, value, "aria-label": label, oninput: () => change() });
  const handles = [handle("Darkest number", 0), handle("Brightest number", 1000)];
  const change = () => {
    const [from, to] = handles.map((one) => Number(one.value)).sort((one, other) => one - other);
    words.textContent = `${Number(number(from).toPrecision(4))} to ${Number(number(to).toPrecision(4))}`;
    ranged(from === 0 && to === 1000 ? null : [number(from), number(to)]);
  };
  words.textContent = `${Number(low.toPrecision(4))} to ${Number(high.toPrecision(4))}`;
  const others = channels.reduce((sum, one) => sum + one.others, 0);
  return element("div", { class: "ranged" }, svg, handles, element("p", { class: "faint" }, "Drawn: ", words, others > 0 ? `; ${count(others, "number is", "numbers are")} NaN or infinite` : "", element("br"),
    channels.map(({ name }, at) => {
      const swatch = element("span", { class: "swatch" });
      swatch.style.background = CHANNEL_COLORS[at];
      return [swatch, " " + name + " "];
    })));
}
