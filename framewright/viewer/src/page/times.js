/** What the times of a Plan mean: how many frames of which device they are of, and on a software driver what they don't tell. */
function timesNote(model) {
  const { times } = model;
  if (!times) return null;
  const { device, frames, recording } = times;
  const of = (frames > 1 ? `Each time is the middle one of ${frames} frames` : "Times are of one frame") + (device ? " on " + device.name : "");
  return element("p", { class: "times" }, element("span", { class: "faint" }, `${of}; the host records a frame in ${milliseconds(recording.median)}.`),
    device?.is_processor ? [" ", element("strong", {}, "The device is the processor: "), "a software driver draws. Compare passes of this frame with each other; nothing follows for a GPU."] : null);
}

/** A time that stands in a narrow column: two digits, without its unit. */
const shortTime = (ms) => ms >= 9.95 ? ms.toFixed(0) : ms >= 0.995 ? ms.toFixed(1) : ms.toFixed(2).replace(/^0/, "");

/** The same beside one time: that it is no GPU's. */
const processorNote = (model) => model.times?.device?.is_processor ? element("p", { class: "faint times" }, "Of the processor, by a software driver: compare it with other passes alone.") : null;
