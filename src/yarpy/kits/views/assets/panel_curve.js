// Curves of the last seconds, a plot for what belongs together.

import {copyOf, part, say} from "/*/common.js";
import {short} from "./panel_port.js";
import {Plot, colour} from "/*/plot.js";

const WINDOW = 10; // seconds of a curve

export const drawn = []; // what is drawn anew for each picture of the screen

export class Curves {
  // what: is drawn of the part `name`; unit: of the vertical axis.
  constructor(name, what, names, unit) {
    this.element = copyOf("curve");
    say(part(this.element, "name"), short(name));
    say(part(this.element, "what"), what);
    this.canvas = part(this.element, "plot");
    this.canvas.role = "img";
    this.canvas.ariaLabel = `${name}, the last ${WINDOW} seconds`;
    this.plot = new Plot(this.canvas, unit);
    this.clock = null; // what the robot's time is ahead of ours, s
    this.times = [];
    this.values = names.map(() => []);
    this.items = names.map((name) => {
      const item = document.createElement("li");
      item.textContent = name;
      part(this.element, "legend").append(item);
      return item;
    });
    this.paint();
    document.getElementById("curves").append(this.element);
    drawn.push(this);
  }

  paint() {
    this.items.forEach((item, number) => item.style.setProperty("--tint", colour(number)));
  }

  add(time, values) {
    const {times} = this;
    const ahead = time - performance.now() / 1000;
    const known = this.clock !== null && Math.abs(ahead - this.clock) < 1;
    this.clock = known ? this.clock + (ahead - this.clock) * 0.05 : ahead;
    if (times.length && time <= times.at(-1)) {
      if (time > times.at(-1) - 1) return;
      this.times.length = 0; // the robot's clock was set back
      for (const each of this.values) each.length = 0;
    }
    times.push(time);
    this.values.forEach((each, number) => each.push(values[number] ?? null));
    if (times.length > 3000) {
      times.splice(0, 1000);
      for (const each of this.values) each.splice(0, 1000);
    }
  }

  draw() {
    if (!this.times.length) return;
    const curves = this.values.map((values, number) => ({times: this.times, values, number}));
    // Curves go on to the left when the robot is silent: what is old must look old.
    const end = performance.now() / 1000 + this.clock;
    const view = {end, window: WINDOW, low: null, high: null, hover: null};
    this.plot.draw(curves, view);
  }
}
