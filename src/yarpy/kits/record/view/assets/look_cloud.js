// Points in space on a canvas: a drag turns them, the wheel zooms, a double click begins again.

import {bytesOf} from "/look_link.js";

const AXES = [["x", 1, 0, 0], ["y", 0, 1, 0], ["z", 0, 0, 1]];
const TURN = 0.008; // radians for each pixel of a drag
const STEP = 0.15; // radians for each key

export class Cloud {
  constructor(canvas) {
    this.canvas = canvas;
    this.places = new Float32Array(0);
    this.colours = null;
    this.reset();
    this.radius = 0;
    canvas.onpointerdown = (event) => {
      canvas.setPointerCapture(event.pointerId);
      canvas.onpointermove = (moved) => this.turn(moved.movementX * TURN, moved.movementY * TURN);
    };
    canvas.onpointerup = canvas.onpointercancel = () => (canvas.onpointermove = null);
    canvas.ondblclick = () => this.reset();
    canvas.addEventListener("wheel", (event) => {
      event.preventDefault();
      this.zoom(2 ** (-event.deltaY / 400));
    }, {passive: false});
    canvas.onkeydown = (event) => {
      const does = {
        ArrowLeft: () => this.turn(-STEP, 0),
        ArrowRight: () => this.turn(STEP, 0),
        ArrowUp: () => this.turn(0, -STEP),
        ArrowDown: () => this.turn(0, STEP),
        "+": () => this.zoom(1.25),
        "-": () => this.zoom(0.8),
      }[event.key];
      if (!does) return;
      event.preventDefault();
      event.stopPropagation(); // the time line has the same keys
      does();
    };
    new ResizeObserver(() => this.draw()).observe(canvas);
  }

  // From the side and a little above, z up.
  reset() {
    this.yaw = -0.9;
    this.pitch = 0.45;
    this.scale = 1;
    this.draw();
  }

  turn(yaw, pitch) {
    this.yaw += yaw;
    this.pitch = Math.min(Math.max(this.pitch + pitch, -Math.PI / 2), Math.PI / 2);
    this.draw();
  }

  zoom(factor) {
    this.scale = Math.min(Math.max(this.scale * factor, 0.05), 100);
    this.draw();
  }

  // What came: {xyz, rgb, of}, see media.py.
  take({xyz, rgb}) {
    this.places = new Float32Array(bytesOf(xyz).buffer);
    this.colours = rgb ? bytesOf(rgb) : null;
    this.fit();
    this.draw();
  }

  // The middle of the points and how far they reach; a picture that moves is not fitted each time.
  fit() {
    const low = [Infinity, Infinity, Infinity];
    const high = [-Infinity, -Infinity, -Infinity];
    for (let at = 0; at < this.places.length; at++) {
      const axis = at % 3;
      low[axis] = Math.min(low[axis], this.places[at]);
      high[axis] = Math.max(high[axis], this.places[at]);
    }
    if (!this.places.length) return;
    const radius = Math.hypot(...high.map((value, axis) => value - low[axis])) / 2 || 1;
    const middle = high.map((value, axis) => (value + low[axis]) / 2);
    const far = this.radius && Math.hypot(...middle.map((value, axis) => value - this.middle[axis]));
    if (this.radius && radius < 1.5 * this.radius && radius > this.radius / 3 && far < this.radius) return;
    this.radius = radius;
    this.middle = middle;
    [this.low, this.high] = [low[2], high[2]];
  }

  draw() {
    const {canvas} = this;
    const ratio = devicePixelRatio || 1;
    const [width, height] = [canvas.clientWidth, canvas.clientHeight];
    if (!width || !this.radius) return;
    canvas.width = Math.round(width * ratio);
    canvas.height = Math.round(height * ratio);
    const pen = canvas.getContext("2d");
    pen.scale(ratio, ratio);
    const unit = (this.scale * Math.min(width, height)) / 2.2 / this.radius;
    const [sin, cos] = [Math.sin(this.yaw), Math.cos(this.yaw)];
    const [up, along] = [Math.cos(this.pitch), Math.sin(this.pitch)];
    // Right and down of a point, in pixels from the middle.
    const right = (x, y) => width / 2 + (x * cos - y * sin) * unit;
    const down = (x, y, z) => height / 2 - (z * up + (x * sin + y * cos) * along) * unit;
    const [cx, cy, cz] = this.middle;
    const size = Math.max(1.5, Math.min(4, width / 250));
    const span = this.high - this.low || 1;
    for (let at = 0; at + 2 < this.places.length; at += 3) {
      const [x, y, z] = [this.places[at] - cx, this.places[at + 1] - cy, this.places[at + 2] - cz];
      if (this.colours) pen.fillStyle = `rgb(${this.colours[at]} ${this.colours[at + 1]} ${this.colours[at + 2]})`;
      else pen.fillStyle = `hsl(${230 - 200 * Math.min(Math.max((this.places[at + 2] - this.low) / span, 0), 1)} 75% 55%)`;
      pen.fillRect(right(x, y) - size / 2, down(x, y, z) - size / 2, size, size);
    }
    this.axes(pen, right, down);
  }

  axes(pen, right, down) {
    const {color} = getComputedStyle(this.canvas);
    const length = this.radius / 2;
    pen.strokeStyle = pen.fillStyle = color;
    pen.font = "12px system-ui, sans-serif";
    for (const [name, ...way] of AXES) {
      const [x, y, z] = way.map((one) => one * length);
      pen.beginPath();
      pen.moveTo(right(0, 0), down(0, 0, 0));
      pen.lineTo(right(x, y), down(x, y, z));
      pen.stroke();
      pen.fillText(name, right(x, y) + 4, down(x, y, z) - 4);
    }
  }
}
