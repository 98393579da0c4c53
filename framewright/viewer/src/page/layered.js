/**
 * Places boxes in layers from top to bottom, in the manner of Sugiyama: each box lies below all that it needs, crossings are few, and
 * edges that pass layers go around their boxes.
 *
 * `boxes` have `width` and `height`, `edges` lead from one index to a larger one. What comes back has a place (its left upper corner) for
 * each box, the points of each edge, and the size of it all.
 */
const LAYER_GAP = 34;
const BOX_GAP = 26;
const LANE = 14;
/** An edge over more layers than this goes behind what lies between: lanes for it would be most of the graph. */
const LONGEST = 30;
function layered(boxes, edges) {
  const above = boxes.map(() => []);
  const below = boxes.map(() => []);
  edges.forEach(({ from, to }) => {
    below[from].push(to);
    above[to].push(from);
  });
  const layer = layersOf(boxes, above, below);
  const rows = Array.from({ length: Math.max(0, ...layer) + 1 }, () => []);
  // A spot is a box, or the place where an edge passes a layer.
  const spots = boxes.map((box, at) => ({ width: box.width, height: box.height, layer: layer[at], up: [], down: [] }));
  const chains = edges.map(({ from, to }) => {
    const chain = [from];
    const passes = layer[to] - layer[from] <= LONGEST;
    for (let between = layer[from] + 1; passes && between < layer[to]; between += 1) {
      spots.push({ width: LANE, height: 0, layer: between, up: [], down: [] });
      chain.push(spots.length - 1);
    }
    return [...chain, to];
  });
  for (const chain of chains) {
    for (let at = 1; at < chain.length; at += 1) {
      spots[chain[at - 1]].down.push(chain[at]);
      spots[chain[at]].up.push(chain[at - 1]);
    }
  }
  spots.forEach((spot, at) => rows[spot.layer].push(at));
  order(rows, spots);
  align(rows, spots);
  let top = 0;
  for (const row of rows) {
    const height = Math.max(0, ...row.map((at) => spots[at].height));
    row.forEach((at) => { spots[at].y = top; });
    row.height = height;
    row.top = top;
    top += height + LAYER_GAP;
  }
  const least = Math.min(0, ...spots.map((spot) => spot.x));
  spots.forEach((spot) => { spot.x -= least; });
  const center = (at) => spots[at].x + spots[at].width / 2;
  const ways = chains.map((chain, at) => chain.flatMap((spot, index) => {
    const row = rows[spots[spot].layer];
    if (index === 0) return [[port(spots, spot, below[spot], edges[at].to), spots[spot].y + spots[spot].height]];
    if (index === chain.length - 1) return [[port(spots, spot, above[spot], edges[at].from), spots[spot].y]];
    return [[center(spot), row.top], [center(spot), row.top + row.height]];
  }));
  return {
    places: boxes.map((_, at) => [spots[at].x, spots[at].y]),
    ways,
    extent: [Math.max(1, ...spots.map((spot) => spot.x + spot.width)), Math.max(1, top - LAYER_GAP)],
  };
}

/** Each box in the layer below the lowest of what it needs; what needs nothing comes right above its first reader. */
function layersOf(boxes, above, below) {
  const layer = boxes.map(() => 0);
  boxes.forEach((_, at) => above[at].forEach((one) => { layer[at] = Math.max(layer[at], layer[one] + 1); }));
  for (let at = boxes.length - 1; at >= 0; at -= 1) {
    if (above[at].length === 0 && below[at].length > 0) layer[at] = Math.min(...below[at].map((one) => layer[one])) - 1;
  }
  return layer;
}

/** Orders each layer by the middles of its neighbours, downwards and upwards in turn. */
function order(rows, spots) {
  const rank = [];
  const number = (row) => row.forEach((at, index) => { rank[at] = index; });
  rows.forEach(number);
  for (let sweep = 0; sweep < 8; sweep += 1) {
    const down = sweep % 2 === 0;
    for (const row of down ? rows : [...rows].reverse()) {
      const middle = (at) => {
        const near = down ? spots[at].up : spots[at].down;
        return near.length === 0 ? rank[at] : near.reduce((sum, one) => sum + rank[one], 0) / near.length;
      };
      const middles = new Map(row.map((at) => [at, middle(at)]));
      row.sort((one, other) => middles.get(one) - middles.get(other) || rank[one] - rank[other]);
      number(row);
    }
  }
}

/** Moves each spot towards the middle of its neighbours, as far as its row lets it. */
function align(rows, spots) {
  const gap = (one, other) => spots[one].height === 0 || spots[other].height === 0 ? LANE / 2 : BOX_GAP;
  for (const row of rows) {
    let x = 0;
    row.forEach((at, index) => {
      if (index > 0) x += gap(row[index - 1], at);
      spots[at].x = x;
      x += spots[at].width;
    });
  }
  for (let sweep = 0; sweep < 12; sweep += 1) {
    const down = sweep % 2 === 0;
    for (const row of down ? rows : [...rows].reverse()) {
      const wish = (at) => {
        const near = (down ? spots[at].up : spots[at].down).map((one) => spots[one].x + spots[one].width / 2);
        const both = near.length > 0 ? near : (down ? spots[at].down : spots[at].up).map((one) => spots[one].x + spots[one].width / 2);
        both.sort((one, other) => one - other);
        const middle = both.length === 0 ? spots[at].x + spots[at].width / 2 : (both[(both.length - 1) >> 1] + both[both.length >> 1]) / 2;
        return middle - spots[at].width / 2;
      };
      settle(row, row.map(wish), spots, gap);
    }
  }
}

/** Places a row as near to its wishes as its order allows: spots that would overlap move as one block, to the mean of their wishes. */
function settle(row, wishes, spots, gap) {
  const blocks = [];
  row.forEach((at, index) => {
    const space = index > 0 ? gap(row[index - 1], at) : 0;
    let block = { spots: [[at, 0]], wish: wishes[index], count: 1, width: spots[at].width, space };
    for (let last = blocks.at(-1); last && last.x + last.width + block.space > block.wish; last = blocks.at(-1)) {
      blocks.pop();
      const shift = last.width + block.space;
      block = {
        spots: [...last.spots, ...block.spots.map(([spot, offset]) => [spot, offset + shift])],
        wish: (last.wish * last.count + (block.wish - shift) * block.count) / (last.count + block.count),
        count: last.count + block.count,
        width: shift + block.width,
        space: last.space,
      };
    }
    block.x = block.wish;
    blocks.push(block);
  });
  for (const block of blocks) block.spots.forEach(([at, offset]) => { spots[at].x = block.x + offset; });
}

/** Where an edge meets its box: the ends of a box's edges lie beside each other, in the order of what they lead to. */
function port(spots, at, others, other) {
  const sorted = [...new Set(others)].sort((one, two) => spots[one].x - spots[two].x);
  const { x, width } = spots[at];
  return x + width * (sorted.indexOf(other) + 1) / (sorted.length + 1);
}
