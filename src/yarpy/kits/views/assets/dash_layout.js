// Where everything stands in the graph: a box for each program, its ports in it, from those that
// send on the left to those that receive on the right. Pure: the same network gives the same picture.

export const ROW = 18; // height of a port
export const HEAD = 22; // height of a box's title
const LETTER = 6.3; // width of a letter
const NARROW = 90;
const WIDE = 250;
const TALL = 16; // ports in a column of a box
const GAP_X = 90;
const GAP_Y = 18;
const SHAPE = 1.7; // width of the picture for its height
const SWEEPS = 4;

// ports: [{name, program, place}], links: [{source, target}]. Returns {boxes, at, width, height}: `at`
// gives for the name of a port its {box, x, y, w}.
export function layout(ports, links) {
  const boxes = gathered(ports);
  const home = new Map();
  for (const box of boxes) for (const port of box.ports) home.set(port.name, box);
  const next = new Map(boxes.map((box) => [box, new Set()]));
  const back = new Map(boxes.map((box) => [box, new Set()]));
  for (const {source, target} of links) {
    const from = home.get(source);
    const to = home.get(target);
    if (!from || !to || from === to) continue;
    next.get(from).add(to);
    back.get(to).add(from);
  }
  const joined = boxes.filter((box) => next.get(box).size + back.get(box).size);
  const alone = boxes.filter((box) => !(next.get(box).size + back.get(box).size));
  const columns = ranked(joined, next, back);
  sorted(columns, next, back);
  const size = placed(columns, alone);
  const at = new Map();
  for (const box of boxes) {
    for (const [index, port] of box.ports.entries()) {
      const column = Math.floor(index / box.rows);
      const x = box.x + column * box.column;
      at.set(port.name, {box, x, y: box.y + HEAD + (index % box.rows) * ROW, w: box.column});
    }
  }
  return {boxes, at, ...size};
}

function gathered(ports) {
  const boxes = new Map();
  for (const port of ports) {
    const key = port.process ? `${port.place} ${port.process}` : `port ${port.name}`;
    if (!boxes.has(key)) boxes.set(key, {key, title: port.title, ports: []});
    boxes.get(key).ports.push(port);
  }
  for (const box of boxes.values()) {
    box.ports.sort((a, b) => (a.name < b.name ? -1 : 1));
    const columns = Math.ceil(box.ports.length / TALL);
    box.rows = Math.ceil(box.ports.length / columns);
    const longest = Math.max(...box.ports.map((port) => port.name.length));
    box.column = Math.min(Math.max(longest * LETTER + 26, NARROW), WIDE);
    box.w = Math.max(box.column * columns, Math.min((box.title.length + 2) * LETTER, WIDE));
    box.column = box.w / columns;
    box.h = HEAD + box.rows * ROW + 4;
  }
  return [...boxes.values()].sort((a, b) => (a.key < b.key ? -1 : 1));
}

// Columns of boxes: every connection goes to the right, but for those that close a circle. Who sends
// more than it receives comes first (Eades, Lin and Smyth).
function ranked(boxes, next, back) {
  const left = new Set(boxes);
  const into = new Map(boxes.map((box) => [box, back.get(box).size]));
  const out = new Map(boxes.map((box) => [box, next.get(box).size]));
  const first = [];
  const last = [];
  const take = (box, list) => {
    left.delete(box);
    list.push(box);
    for (const to of next.get(box)) if (left.has(to)) into.set(to, into.get(to) - 1);
    for (const from of back.get(box)) if (left.has(from)) out.set(from, out.get(from) - 1);
  };
  while (left.size) {
    let found = true;
    while (found) {
      found = false;
      for (const box of left) {
        if (!out.get(box)) (take(box, last), (found = true));
        else if (!into.get(box)) (take(box, first), (found = true));
      }
    }
    let best = null;
    for (const box of left) {
      const surplus = out.get(box) - into.get(box);
      if (best === null || surplus > best.surplus) best = {box, surplus};
    }
    if (best) take(best.box, first);
  }
  const order = [...first, ...last.reverse()];
  const place = new Map(order.map((box, index) => [box, index]));
  let ranks = 1;
  for (const box of order) {
    box.rank = 0;
    for (const from of back.get(box)) if (place.get(from) < place.get(box)) box.rank = Math.max(box.rank, from.rank + 1);
    ranks = Math.max(ranks, box.rank + 1);
  }
  // A long chain is folded, so that the picture is not much wider than high.
  const most = Math.max(4, Math.ceil(Math.sqrt(boxes.length)));
  const columns = [];
  for (const box of order) (columns[ranks > most ? Math.floor((box.rank * most) / ranks) : box.rank] ??= []).push(box);
  return columns.filter(Boolean);
}

// Within a column, boxes stand beside those they are connected with.
function sorted(columns, next, back) {
  const seat = () => {
    for (const column of columns) for (const [index, box] of column.entries()) box.seat = (index + 0.5) / column.length;
  };
  seat();
  for (let sweep = 0; sweep < SWEEPS; sweep++) {
    const sides = sweep % 2 ? next : back;
    for (const column of sweep % 2 ? [...columns].reverse() : columns) {
      for (const box of column) {
        const others = [...sides.get(box)];
        box.pull = others.length ? others.reduce((sum, other) => sum + other.seat, 0) / others.length : box.seat;
      }
      column.sort((a, b) => a.pull - b.pull);
      for (const [index, box] of column.entries()) box.seat = (index + 0.5) / column.length;
    }
  }
}

// A long column is broken into several; what is not connected comes below.
function placed(columns, alone) {
  const area = [...columns.flat(), ...alone].reduce((sum, box) => sum + (box.w + GAP_X) * (box.h + GAP_Y), 0);
  const tall = Math.max(Math.sqrt(area / SHAPE), 400);
  let x = 0;
  let height = 0;
  const shown = [];
  for (const column of columns) {
    let part = [];
    let y = 0;
    for (const box of column) {
      if (part.length && y + box.h > tall) {
        shown.push({part, y});
        part = [];
        y = 0;
      }
      box.y = y;
      y += box.h + GAP_Y;
      part.push(box);
    }
    shown.push({part, y});
  }
  height = Math.max(0, ...shown.map(({y}) => y - GAP_Y));
  for (const {part, y} of shown) {
    for (const box of part) {
      box.x = x;
      box.y += (height - (y - GAP_Y)) / 2;
    }
    x += Math.max(...part.map((box) => box.w)) + GAP_X;
  }
  let width = Math.max(0, x - GAP_X);
  const wide = Math.max(width, Math.sqrt(area * SHAPE), 600);
  let row = height ? height + 3 * GAP_Y : 0;
  let deep = 0;
  x = 0;
  for (const box of alone) {
    if (x && x + box.w > wide) {
      row += deep + GAP_Y;
      x = deep = 0;
    }
    [box.x, box.y] = [x, row];
    x += box.w + GAP_Y;
    deep = Math.max(deep, box.h);
    width = Math.max(width, x - GAP_Y);
  }
  return {width, height: alone.length ? row + deep : height};
}
