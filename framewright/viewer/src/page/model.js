/** What the page shows, as the program gives it. */
let DATA = JSON.parse(document.getElementById("data").textContent);

/** A Plan with what its views look up. Keys name its parts: `pass:blur`, `image:color`, `buffer:lights`, `step:a3`. */
class Model {
  constructor(data, index) {
    this.index = index;
    this.letter = "ab"[index];
    this.name = data.name;
    this.sources = data.sources;
    this.outline = data.outline;
    this.summary = data.summary || null;
    this.times = data.times ?? null;
    this.hints = data.hints ?? [];
    const whole = data.whole || { plan: null, nodes: [], edges: [], moved: [], on_chip: [] };
    Object.assign(this, whole);
    /** What each step moves: image by image, and in all. */
    this.movedEach = this.moved;
    this.moved = this.movedEach.map((each) => each.reduce((sum, [, moved]) => {
      for (const kind in sum) sum[kind] += moved[kind];
      return sum;
    }, { loaded: 0, stored: 0, resolved: 0, copied: 0 }));
    /** What each step keeps on the chip, of a device that draws in tiles. */
    this.onChip = this.on_chip.map((each) => each.reduce((sum, [, amount]) => sum + amount, 0));
    this.byKey = new Map();
    this.related = new Map();
    this.lines = new Map();
    if (this.plan) this.connect();
    this.walk(this.outline, []);
  }

  connect() {
    const add = (key, thing) => this.byKey.set(key, thing);
    this.plan.images.forEach((image) => add("image:" + image.name, { kind: "image", image }));
    this.plan.buffers.forEach((buffer) => add("buffer:" + buffer.name, { kind: "buffer", buffer }));
    this.plan.steps.forEach((step, at) => add(this.stepKey(at), { kind: "step", step, at, nodes: [] }));
    this.nodes.forEach((node, at) => {
      let key = "pass:" + node.name;
      for (let more = 2; this.byKey.has(key); more += 1) key = "pass:" + node.name + " (" + more + ")";
      node.key = key;
      node.at_index = at;
      add(key, { kind: "pass", node });
      this.byKey.get(this.stepKey(node.step)).nodes.push(node);
      this.relate(key, this.stepKey(node.step));
      for (const use of node.uses) this.relate(key, this.resourceKey(use.resource));
    });
    this.plan.notes.forEach((note, at) => add("note:" + this.letter + at, { kind: "note", note }));
    this.alive = this.plan.steps.map(() => 0);
    for (const resource of this.resources()) {
      const place = resource.role.transient;
      if (place) for (let at = place.lifetime[0]; at <= place.lifetime[1]; at += 1) this.alive[at] += place.bytes;
    }
    this.peak = this.alive.indexOf(Math.max(0, ...this.alive));
  }

  /**
   * Images and buffers that work uses: how each node does (`marks`), how each step does (`steps`), in which roles, and the bytes that the
   * frame moves of each.
   */
  rows() {
    if (this.made_rows) return this.made_rows;
    const rows = new Map();
    const none = () => ({ reads: false, writes: false, roles: new Set() });
    this.nodes.forEach((node, at) => node.uses.forEach((use) => {
      const key = this.resourceKey(use.resource);
      if (!rows.has(key)) rows.set(key, { key, resource: this.resourceOf(use.resource), first: at, marks: new Map(), steps: new Map(), roles: new Set(), moved: 0 });
      const row = rows.get(key);
      row.last = at;
      row.roles.add(use.role);
      if (!row.marks.has(at)) row.marks.set(at, none());
      if (!row.steps.has(node.step)) row.steps.set(node.step, { ...none(), first: at });
      row.steps.get(node.step).last = at;
      for (const mark of [row.marks.get(at), row.steps.get(node.step)]) {
        mark.reads ||= use.reads;
        mark.writes ||= use.writes;
        mark.roles.add(use.role.replace("_", " "));
      }
    }));
    for (const each of this.movedEach) {
      for (const [resource, moved] of each) {
        const row = rows.get(this.resourceKey(resource));
        if (row) row.moved += movedSum(moved);
      }
    }
    this.made_rows = [...rows.values()];
    for (const row of this.made_rows) this.markAttachments(row);
    return this.made_rows;
  }

  /** Marks where a step waits for an image at a barrier and loads it, at the first of its passes that use it, and where it stores it, at the last. */
  markAttachments(row) {
    if (!("format" in row.resource)) return;
    for (const [at, { first, last }] of row.steps) {
      const step = this.plan.steps[at];
      const attachment = step.work.render?.attachments.find((one) => one.image === row.resource.id);
      row.marks.get(first).barrier = step.image_barriers.some((barrier) => barrier.image === row.resource.id);
      row.marks.get(first).loads = attachment?.load === "LOAD";
      row.marks.get(last).stores = attachment?.store === "STORE";
    }
  }

  /** Whether somebody measured the device's time. */
  timed() { return Boolean(this.times); }

  /** The device's milliseconds of a step; null: nobody measured them. */
  msOfStep(at) { return this.times?.steps[at]?.median ?? null; }

  /** The times of a pass in words; null: nobody measured them. */
  timeWords(node) {
    const step = this.times?.steps[node.step];
    if (!step) return null;
    const at = this.byKey.get(this.stepKey(node.step)).nodes.filter((one) => one.kind !== "folded_resolve").indexOf(node);
    return spreadWords(step.passes[at] ?? step, this.times.frames);
  }

  /** The same of a box of the graph: of its step, or of all steps of its passes. */
  msOf(box) {
    if (!this.times) return null;
    const steps = new Set(box.nodes.map((node) => node.step));
    return [...steps].reduce((sum, at) => sum + (this.msOfStep(at) ?? 0), 0);
  }

  stepKey(at) { return "step:" + this.letter + at; }

  resources() { return [...this.plan.images, ...this.plan.buffers]; }

  resourceKey(resource) {
    return "image" in resource ? "image:" + this.plan.images[resource.image].name : "buffer:" + this.plan.buffers[resource.buffer].name;
  }

  resourceOf(resource) { return "image" in resource ? this.plan.images[resource.image] : this.plan.buffers[resource.buffer]; }

  keyOf(resource) { return ("format" in resource ? "image:" : "buffer:") + resource.name; }

  relate(one, other) {
    for (const [a, b] of [[one, other], [other, one]]) {
      if (!this.related.has(a)) this.related.set(a, new Set());
      this.related.get(a).add(b);
    }
  }

  /** Keeps each line of the outline under what it is about, with the lines above it. */
  walk(line, above) {
    const key = this.keyAbout(line.about);
    line.key = key;
    if (key) {
      if (!this.lines.has(key)) this.lines.set(key, []);
      this.lines.get(key).push({ line, above });
    }
    for (const part of line.parts) this.walk(part, [...above, line]);
  }

  keyAbout(about) {
    if (!about) return null;
    if ("step" in about) return this.stepKey(about.step);
    if ("pass" in about) return "pass:" + about.pass;
    if (!this.plan) return null;
    return this.resourceKey(about);
  }

  users(key) { return this.nodes.filter((node) => node.uses.some((use) => this.resourceKey(use.resource) === key)); }

  /** The images and buffers that are alive at a step, the largest first. */
  aliveAt(at) {
    const alive = this.resources().filter(({ role }) => role.transient && role.transient.lifetime[0] <= at && at <= role.transient.lifetime[1]);
    return alive.sort((one, other) => other.role.transient.bytes - one.role.transient.bytes);
  }
}

/** The Plans of the page. */
let models = [];

/** The sum of what a step moves. */
const movedSum = (moved) => moved.loaded + moved.stored + moved.resolved + moved.copied;

/** Splits `file:line:column`. */
function splitPlace(place) {
  const parts = /^(.*):(\d+):(\d+)$/s.exec(place);
  return parts ? { file: parts[1], line: Number(parts[2]) } : null;
}
