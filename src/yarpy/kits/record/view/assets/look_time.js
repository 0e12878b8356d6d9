// The time line: a row for each port with what came when, silences, marks, the cursor.

import {ticks, written} from "/*/plot.js";

const ROW = 24;
const TOP = 42; // times, and below them marks
const NAME = 190; // pixels of names, on wide screens
const NARROW = 700;
const LEAST = 0.01; // seconds that are shown at least

const dark = matchMedia("(prefers-color-scheme: dark)");

// `told` are the ports as the program tells them, with times in seconds; `view` {start, length} is
// what is shown, `cursor` where we are, `chosen` [begin, end] what was marked, or null.
export class TimeLine {
  constructor(canvas, calls) {
    this.canvas = canvas;
    this.context = canvas.getContext("2d");
    this.calls = calls; // seek(t), toggle(name), zoomed(), chose()
    this.told = {ports: [], notes: [], begin: 0, length: 1};
    this.view = {start: 0, length: 1};
    this.cursor = 0;
    this.chosen = null;
    this.open = new Set();
    this.held = null; // what a pointer does: "seek", "choose", "move"
    this.listen();
    new ResizeObserver(() => this.draw()).observe(canvas.parentElement);
    dark.addEventListener("change", () => this.draw());
  }

  get width() {
    return this.canvas.parentElement.clientWidth;
  }

  // Where times begin: behind the names, or below them on a narrow screen.
  get left() {
    return this.width > NARROW ? NAME : 8;
  }

  x(time) {
    return this.left + ((time - this.view.start) / this.view.length) * (this.width - this.left - 10);
  }

  timeAt(x) {
    const share = (x - this.left) / (this.width - this.left - 10);
    return this.view.start + Math.min(Math.max(share, 0), 1) * this.view.length;
  }

  get rowHeight() {
    return this.width > NARROW ? ROW : ROW + 12;
  }

  draw() {
    const {context, canvas, told, view} = this;
    const scale = devicePixelRatio || 1;
    const [width, height] = [this.width, TOP + Math.max(told.ports.length, 1) * this.rowHeight + 4];
    if (width < 50) return;
    if (canvas.width !== Math.round(width * scale) || canvas.height !== Math.round(height * scale)) {
      canvas.width = Math.round(width * scale);
      canvas.height = Math.round(height * scale);
      canvas.style.height = `${height}px`;
    }
    context.setTransform(scale, 0, 0, scale, 0, 0);
    context.clearRect(0, 0, width, height);
    const style = getComputedStyle(canvas);
    const paint = (name) => style.getPropertyValue(name);
    context.font = `12px ${style.fontFamily}`;
    context.textBaseline = "middle";
    const [left, right] = [this.left, width - 10];
    const found = ticks(view.start, view.start + view.length, (right - left) / 90);
    context.fillStyle = paint("--soft");
    context.strokeStyle = paint("--line");
    for (const time of found.found) {
      const at = Math.round(this.x(time)) + 0.5;
      context.beginPath();
      context.moveTo(at, TOP - 8);
      context.lineTo(at, height);
      context.stroke();
      context.textAlign = at > right - 30 ? "right" : at < left + 20 ? "left" : "center";
      context.fillText(`${written(time, found.decimals)} s`, at, 12);
    }
    if (this.chosen) {
      const [begin, end] = this.chosen.map((time) => this.x(time));
      context.fillStyle = paint("--link");
      context.globalAlpha = 0.15;
      context.fillRect(begin, TOP - 8, end - begin, height);
      context.globalAlpha = 1;
    }
    context.save();
    for (const [number, port] of told.ports.entries()) this.row(port, number, paint);
    context.restore();
    this.marks(paint, height);
    const at = this.x(Math.min(this.cursor, told.begin + told.length));
    if (at >= left - 1 && at <= right + 1) {
      context.strokeStyle = paint("--ink");
      context.lineWidth = 2;
      context.beginPath();
      context.moveTo(at, TOP - 10);
      context.lineTo(at, height);
      context.stroke();
      context.lineWidth = 1;
    }
    canvas.setAttribute("aria-valuenow", this.cursor.toFixed(3));
    canvas.setAttribute("aria-valuemin", told.begin.toFixed(3));
    canvas.setAttribute("aria-valuemax", (told.begin + told.length).toFixed(3));
  }

  row(port, number, paint) {
    const {context, told} = this;
    const [height, left, right] = [this.rowHeight, this.left, this.width - 10];
    const top = TOP + number * height;
    const wide = this.width > NARROW;
    const [bar, low] = wide ? [height - 8, top + 4] : [height - 20, top + 16];
    context.textAlign = "left";
    context.fillStyle = paint(this.open.has(port.name) ? "--link" : "--ink");
    const room = wide ? left - 20 : right - left;
    context.fillText(cutOff(context, `${this.open.has(port.name) ? "\u25be" : "\u25b8"} ${port.name}`, room), 10, wide ? top + height / 2 : top + 8);
    const most = Math.max(...port.bins, 1);
    const step = port.length / port.bins.length; // what stands beside another one has a length of its own
    context.save();
    context.beginPath();
    context.rect(left, top, right - left, height);
    context.clip();
    context.fillStyle = paint("--screen");
    context.fillRect(this.x(port.from), low, this.x(port.from + port.length) - this.x(port.from), bar);
    context.fillStyle = paint("--link");
    for (const [place, count] of port.bins.entries()) {
      if (!count) continue;
      const from = this.x(port.from + place * step);
      const to = this.x(port.from + (place + 1) * step);
      if (to < left || from > right) continue;
      const part = Math.max(0.25, count / most) * bar;
      context.globalAlpha = 0.75;
      context.fillRect(from, low + bar - part, Math.max(to - from + 0.3, 1), part);
    }
    context.globalAlpha = 1;
    context.fillStyle = paint("--warn");
    for (const [begin, end] of port.gaps) {
      const [from, to] = [this.x(begin), this.x(end)];
      context.globalAlpha = 0.3;
      context.fillRect(from, low, Math.max(to - from, 2), bar);
      context.globalAlpha = 1;
      if (to - from > 60) {
        context.textAlign = "center";
        context.fillText(`${(end - begin).toFixed(1)} s`, (from + to) / 2, low + bar / 2);
      }
    }
    context.restore();
  }

  marks(paint, height) {
    const {context, told} = this;
    for (const note of told.notes) {
      const at = this.x(note.t);
      if (at < this.left - 1 || at > this.width - 9) continue;
      if (note.what === "lost") {
        // At the lower end of the row of its port.
        const low = TOP + (told.ports.findIndex((port) => port.name === note.text) + 1) * this.rowHeight - 1;
        context.fillStyle = paint("--warn");
        context.beginPath();
        context.moveTo(at - 4, low);
        context.lineTo(at + 4, low);
        context.lineTo(at, low - 7);
        if (low > TOP) context.fill();
      }
      if (note.what !== "mark") continue;
      context.strokeStyle = context.fillStyle = paint("--link");
      context.setLineDash([3, 3]);
      context.beginPath();
      context.moveTo(at, TOP - 17);
      context.lineTo(at, height);
      context.stroke();
      context.setLineDash([]);
      context.beginPath();
      context.moveTo(at, TOP - 17);
      context.lineTo(at + 7, TOP - 13);
      context.lineTo(at, TOP - 9);
      context.fill();
      context.textAlign = at > this.width - 120 ? "right" : "left";
      context.fillText(cutOff(context, note.text || note.what, 160), at + (at > this.width - 120 ? -4 : 10), TOP - 13);
    }
  }

  // -- what people do --

  listen() {
    const {canvas} = this;
    canvas.onpointerdown = (event) => {
      const number = Math.floor((event.offsetY - TOP) / this.rowHeight);
      const port = this.told.ports[number];
      const named = this.width > NARROW ? event.offsetX < this.left - 4 : (event.offsetY - TOP) % this.rowHeight < 16;
      if (port && named) return this.calls.toggle(port.name);
      canvas.setPointerCapture(event.pointerId);
      this.held = event.shiftKey ? "choose" : "seek";
      this.from = this.timeAt(event.offsetX);
      this.drag(event);
    };
    canvas.onpointermove = (event) => this.held && this.drag(event);
    canvas.onpointerup = canvas.onpointercancel = () => (this.held = null);
    canvas.addEventListener(
      "wheel",
      (event) => {
        if (event.offsetX < this.left) return;
        event.preventDefault();
        if (event.shiftKey) this.move(this.view.start + (Math.sign(event.deltaY) * this.view.length) / 10);
        else this.zoom(1.25 ** Math.sign(event.deltaY), this.timeAt(event.offsetX));
      },
      {passive: false},
    );
  }

  drag(event) {
    const time = this.timeAt(event.offsetX);
    if (this.held === "seek") this.calls.seek(time);
    else {
      this.chosen = [Math.min(this.from, time), Math.max(this.from, time)];
      if (this.chosen[1] - this.chosen[0] < this.view.length / 500) this.chosen = null;
      this.calls.chose();
      this.draw();
    }
  }

  zoom(factor, around) {
    const length = Math.min(Math.max(this.view.length * factor, LEAST), this.told.length);
    const share = (around - this.view.start) / this.view.length;
    this.view.length = length;
    this.move(around - share * length);
  }

  move(start) {
    const {told, view} = this;
    view.start = Math.min(Math.max(start, told.begin), told.begin + told.length - view.length);
    this.calls.zoomed();
    this.draw();
  }

  whole() {
    this.view = {start: this.told.begin, length: Math.max(this.told.length, LEAST)};
    this.calls.zoomed();
    this.draw();
  }
}

function cutOff(context, text, room) {
  if (context.measureText(text).width <= room) return text;
  while (text.length > 1 && context.measureText(`${text}\u2026`).width > room) text = text.slice(0, -1);
  return `${text}\u2026`;
}
