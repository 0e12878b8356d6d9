// The graph on its canvas: drawing, moving, zooming, and what is under the pointer.
// Lines are collected into one path for each look, and where there are many they are as thin as a
// pixel, which browsers without a graphics card draw ten times as fast as anything wider.

import {HEAD, ROW, layout} from "./dash_layout.js";

const NEAR = 0.02; // smallest and ...
const FAR = 2.5; // ... largest zoom
const READABLE = 0.42; // zoom from which ports have names
const CURVED = 0.2; // ... and lines are curves
const MANY = 500; // lines that are drawn paler and thin
const REACH = 5; // pixels beside a line that belong to it
const LOOKS = ["idle", "live", "busy", "bad"];

export class Graph {
  // chosen(kind, key): something was clicked, null beside everything.
  constructor(canvas, chosen) {
    this.canvas = canvas;
    this.chosen = chosen;
    this.map = layout([], []);
    this.links = [];
    this.lights = new Map();
    this.wanted = null; // names that a search found
    this.selected = {kind: null, key: ""};
    this.hover = "";
    this.view = {x: 0, y: 0, zoom: 1};
    this.moved = false; // by a person: it stays as it is
    this.pointers = new Map();
    this.later = null; // ports to arrange when no pointer is down
    this.due = false;
    new ResizeObserver(() => this.resize()).observe(canvas);
    matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => this.paint());
    this.listen();
    this.paint();
  }

  // The ports and connections are others. What a pointer holds stays under it.
  arrange(ports, links) {
    this.later = this.pointers.size ? ports : null;
    if (this.later) return this.update(links);
    this.map = layout(ports, links);
    if (!this.moved) this.fit();
    this.update(links);
  }

  // What is told of them is. links: [{key, source, target, look}].
  update(links, lights = this.lights) {
    this.links = links;
    this.lights = lights;
    this.paths = null;
    this.draw();
  }

  paint() {
    const style = getComputedStyle(document.documentElement);
    const colour = (name) => style.getPropertyValue(name).trim();
    this.colours = Object.fromEntries(
      ["ink", "soft", "line", "back", "box", "head", "link", "good", "bad", "warn", "line-idle", "line-live"].map((name) => [name, colour(`--${name}`)]),
    );
    this.draw();
  }

  resize() {
    const {clientWidth, clientHeight} = this.canvas;
    this.scale = window.devicePixelRatio || 1;
    this.canvas.width = Math.round(clientWidth * this.scale);
    this.canvas.height = Math.round(clientHeight * this.scale);
    if (!this.moved && !this.pointers.size) this.fit();
    this.draw();
  }

  fit() {
    const {clientWidth: wide, clientHeight: high} = this.canvas;
    const {width, height} = this.map;
    if (!wide || !width) return;
    const zoom = Math.max(NEAR, Math.min((wide - 40) / width, (high - 40) / height, 1.2));
    this.view = {zoom, x: (wide - width * zoom) / 2, y: (high - height * zoom) / 2};
    this.draw();
  }

  // Bring a port into sight.
  show(name) {
    const spot = this.map.at.get(name);
    if (!spot) return;
    const {clientWidth: wide, clientHeight: high} = this.canvas;
    const zoom = Math.max(this.view.zoom, 0.8);
    this.view = {zoom, x: wide / 2 - (spot.x + spot.w / 2) * zoom, y: high / 2 - spot.y * zoom};
    this.moved = true;
    this.draw();
  }

  draw() {
    if (this.due) return;
    this.due = true;
    requestAnimationFrame(() => {
      this.due = false;
      this.redraw();
    });
  }

  redraw() {
    const ctx = this.canvas.getContext("2d");
    const {zoom, x, y} = this.view;
    const scale = this.scale ?? 1;
    ctx.setTransform(1, 0, 0, 1, 0, 0);
    ctx.clearRect(0, 0, this.canvas.width, this.canvas.height);
    ctx.setTransform(zoom * scale, 0, 0, zoom * scale, x * scale, y * scale);
    this.drawLinks(ctx, zoom);
    this.drawBoxes(ctx, zoom);
  }

  // One path for each look. A search leaves the others pale.
  collect(zoom) {
    const curved = zoom > CURVED;
    if (this.paths?.curved === curved) return this.paths;
    const paths = {curved};
    for (const look of LOOKS) paths[look] = new Path2D();
    for (const link of this.links) {
      const ends = this.ends(link);
      if (ends) trace(paths[link.look], ends, curved);
    }
    return (this.paths = paths);
  }

  ends({source, target}) {
    const from = this.map.at.get(source);
    const to = this.map.at.get(target);
    if (!from || !to) return null;
    const x = from.x + from.w;
    if (from.box === to.box) return [x, from.y + ROW / 2, to.x + to.w, to.y + ROW / 2, true];
    return [x, from.y + ROW / 2, to.x, to.y + ROW / 2, false];
  }

  drawLinks(ctx, zoom) {
    const {colours} = this;
    const paths = this.collect(zoom);
    const thin = 1 / Math.max(zoom, 0.35);
    const many = this.links.length > MANY;
    const hair = 1 / (zoom * (this.scale ?? 1));
    ctx.globalAlpha = this.wanted ? 0.2 : many ? 0.5 : 0.8;
    const looks = {idle: [colours["line-idle"], 1], live: [colours["line-live"], 1.2], busy: [colours["line-live"], 2.6], bad: [colours.bad, 2]};
    for (const look of LOOKS) {
      [ctx.strokeStyle] = looks[look];
      ctx.lineWidth = many && look !== "bad" ? hair : looks[look][1] * thin;
      ctx.stroke(paths[look]);
    }
    ctx.globalAlpha = 1;
    const bold = this.links.filter((link) => this.stressed(link));
    for (const link of bold) {
      const ends = this.ends(link);
      if (!ends) continue;
      const path = new Path2D();
      trace(path, ends, true);
      ctx.strokeStyle = link.look === "bad" ? colours.bad : colours.link;
      ctx.lineWidth = 3 * thin;
      ctx.stroke(path);
      const [, , tipX, tipY, inside] = ends;
      const back = (inside ? 8 : -8) * thin;
      ctx.fillStyle = ctx.strokeStyle;
      ctx.beginPath();
      ctx.moveTo(tipX, tipY);
      ctx.lineTo(tipX + back, tipY - 4.5 * thin);
      ctx.lineTo(tipX + back, tipY + 4.5 * thin);
      ctx.fill();
    }
  }

  stressed({key, source, target}) {
    const {kind, key: chosen} = this.selected;
    if (kind === "link" && key === chosen) return true;
    const port = kind === "port" ? chosen : this.hover;
    return (port && (source === port || target === port)) || this.hover === source || this.hover === target;
  }

  drawBoxes(ctx, zoom) {
    const {colours, view} = this;
    const left = -view.x / zoom;
    const top = -view.y / zoom;
    const right = left + this.canvas.clientWidth / zoom;
    const bottom = top + this.canvas.clientHeight / zoom;
    const readable = zoom > READABLE;
    ctx.textBaseline = "middle";
    const seen = this.map.boxes.filter((box) => box.x < right && box.x + box.w > left && box.y < bottom && box.y + box.h > top);
    ctx.fillStyle = colours.box;
    ctx.strokeStyle = colours.line;
    ctx.lineWidth = 1;
    const outlines = new Path2D();
    for (const box of seen) outlines.roundRect(box.x, box.y, box.w, box.h, 6);
    ctx.fill(outlines);
    ctx.stroke(outlines);
    ctx.fillStyle = colours.head;
    const heads = new Path2D();
    for (const box of seen) heads.roundRect(box.x, box.y, box.w, HEAD - 3, [6, 6, 0, 0]);
    ctx.fill(heads);
    if (zoom > 0.16) {
      ctx.fillStyle = colours.soft;
      ctx.font = `600 ${readable ? 11 : Math.min(11 / zoom / 2.2, 18)}px system-ui, sans-serif`;
      for (const box of seen) ctx.fillText(cut(ctx, box.title, box.w - 12, true), box.x + 7, box.y + HEAD / 2 - 1);
    }
    ctx.font = "11px system-ui, sans-serif";
    for (const box of seen) {
      for (const port of box.ports) this.drawPort(ctx, port, readable);
    }
  }

  drawPort(ctx, {name}, readable) {
    const {colours} = this;
    const spot = this.map.at.get(name);
    const chosen = this.selected.kind === "port" && this.selected.key === name;
    const wanted = !this.wanted || this.wanted.has(name);
    if (chosen || (this.wanted && wanted) || this.hover === name) {
      ctx.fillStyle = chosen ? colours.link : colours.head;
      ctx.fillRect(spot.x + 1, spot.y, spot.w - 2, ROW - 1);
    }
    const light = this.lights.get(name);
    ctx.fillStyle = light > 0 ? colours.good : light < 0 ? colours.bad : light === 0 ? colours.warn : colours["line-idle"];
    ctx.fillRect(spot.x + 8, spot.y + ROW / 2 - 3, 6, 6);
    if (!readable) return;
    ctx.globalAlpha = wanted ? 1 : 0.35;
    ctx.fillStyle = chosen ? colours.back : colours.ink;
    ctx.fillText(cut(ctx, name, spot.w - 26), spot.x + 20, spot.y + ROW / 2);
    ctx.globalAlpha = 1;
  }

  // -- the pointer, fingers, keys ----------------------------------------------------------------

  listen() {
    const {canvas} = this;
    canvas.addEventListener("wheel", (event) => {
      event.preventDefault();
      this.zoomAt(event.offsetX, event.offsetY, Math.exp(-event.deltaY * (event.ctrlKey ? 0.01 : 0.0015)));
    }, {passive: false});
    canvas.addEventListener("pointerdown", (event) => {
      canvas.setPointerCapture(event.pointerId);
      this.pointers.set(event.pointerId, [event.offsetX, event.offsetY]);
      if (this.pointers.size === 1) this.still = true;
    });
    canvas.addEventListener("pointermove", (event) => this.move(event));
    const up = (event) => {
      this.pointers.delete(event.pointerId);
      if (event.type === "pointerup" && this.still && !this.pointers.size) this.click(event.offsetX, event.offsetY);
      if (this.later && !this.pointers.size) this.arrange(this.later, this.links);
    };
    canvas.addEventListener("pointerup", up);
    canvas.addEventListener("pointercancel", up);
    canvas.addEventListener("pointerleave", () => this.point(""));
    canvas.addEventListener("keydown", (event) => {
      const steps = {ArrowLeft: [60, 0], ArrowRight: [-60, 0], ArrowUp: [0, 60], ArrowDown: [0, -60]};
      const {clientWidth: wide, clientHeight: high} = canvas;
      if (steps[event.key]) this.pan(...steps[event.key]);
      else if (event.key === "+" || event.key === "=") this.zoomAt(wide / 2, high / 2, 1.25);
      else if (event.key === "-") this.zoomAt(wide / 2, high / 2, 0.8);
      else return;
      event.preventDefault();
    });
  }

  move(event) {
    const before = this.pointers.get(event.pointerId);
    const now = [event.offsetX, event.offsetY];
    if (!before) return event.pointerType === "mouse" ? this.point(this.portAt(...now)) : undefined;
    if (this.pointers.size === 2) {
      const [other] = [...this.pointers].filter(([id]) => id !== event.pointerId).map(([, at]) => at);
      const apart = (at) => Math.max(Math.hypot(at[0] - other[0], at[1] - other[1]), 1);
      this.zoomAt((now[0] + other[0]) / 2, (now[1] + other[1]) / 2, apart(now) / apart(before));
      this.still = false;
    } else {
      const [dx, dy] = [now[0] - before[0], now[1] - before[1]];
      if (this.still && Math.hypot(dx, dy) < 4) return;
      this.still = false;
      this.pan(dx, dy);
    }
    this.pointers.set(event.pointerId, now);
  }

  pan(dx, dy) {
    this.view.x += dx;
    this.view.y += dy;
    this.moved = true;
    this.draw();
  }

  zoomAt(x, y, factor) {
    const zoom = Math.min(Math.max(this.view.zoom * factor, NEAR), FAR);
    const ratio = zoom / this.view.zoom;
    this.view = {zoom, x: x - (x - this.view.x) * ratio, y: y - (y - this.view.y) * ratio};
    this.moved = true;
    this.draw();
  }

  point(name) {
    if (name === this.hover) return;
    this.hover = name;
    this.canvas.title = name;
    this.draw();
  }

  portAt(x, y) {
    const at = [(x - this.view.x) / this.view.zoom, (y - this.view.y) / this.view.zoom];
    for (const box of this.map.boxes) {
      if (at[0] < box.x || at[0] > box.x + box.w || at[1] < box.y + HEAD || at[1] > box.y + box.h) continue;
      const column = Math.min(Math.floor((at[0] - box.x) / box.column), Math.ceil(box.ports.length / box.rows) - 1);
      return box.ports[column * box.rows + Math.floor((at[1] - box.y - HEAD) / ROW)]?.name ?? "";
    }
    return "";
  }

  linkAt(x, y) {
    const ctx = this.canvas.getContext("2d");
    ctx.save();
    ctx.setTransform(1, 0, 0, 1, 0, 0);
    ctx.lineWidth = (2 * REACH) / this.view.zoom;
    const at = [(x - this.view.x) / this.view.zoom, (y - this.view.y) / this.view.zoom];
    const found = this.links.find((link) => {
      const ends = this.ends(link);
      if (!ends) return false;
      const path = new Path2D();
      trace(path, ends, this.view.zoom > CURVED);
      return ctx.isPointInStroke(path, ...at);
    });
    ctx.restore();
    return found?.key ?? "";
  }

  click(x, y) {
    const port = this.portAt(x, y);
    if (port) return this.chosen("port", port);
    const link = this.linkAt(x, y);
    this.chosen(link ? "link" : null, link);
  }
}

// Within a box a line goes round on its right side.
function trace(path, [x0, y0, x1, y1, inside], curved) {
  path.moveTo(x0, y0);
  if (inside) return path.bezierCurveTo(x0 + 34, y0, x1 + 34, y1, x1, y1);
  if (!curved) return path.lineTo(x1, y1);
  const bend = x1 > x0 ? Math.max((x1 - x0) / 2, 30) : Math.min(60 + (x0 - x1) / 4, 220);
  path.bezierCurveTo(x0 + bend, y0, x1 - bend, y1, x1, y1);
}

// The end of a port's name says more than its beginning; a program's title begins with its name and
// ends with its place.
const widths = new Map();
function cut(ctx, text, room, middle = false) {
  const key = `${ctx.font} ${text} ${Math.round(room)} ${middle}`;
  if (widths.has(key)) return widths.get(key);
  let shown = text;
  for (let out = 1; out < text.length - 3 && ctx.measureText(shown).width > room; out++) {
    const start = middle ? Math.ceil((text.length - out) / 2) : 0;
    shown = `${text.slice(0, start)}…${text.slice(start + out)}`;
  }
  if (widths.size > 20000) widths.clear();
  widths.set(key, shown);
  return shown;
}
