// The sensors of the robot: curves of what they feel, a horizon for which way is up.

import {copyOf, part, say} from "/*/common.js";
import {Horizon} from "./horizon.js";
import {Curves, drawn} from "./panel_curve.js";
import {listen, short} from "./panel_port.js";

// The kinds of sensors in a message, and how they are drawn.
const KINDS = [
  [0, "gyroscope", "°/s"],
  [1, "accelerometer", "m/s²"],
];
const ORIENTATION = 3;

function openHorizon(name) {
  const element = copyOf("attitude");
  say(part(element, "name"), short(name));
  document.getElementById("boards").append(element);
  const horizon = new Horizon(part(element, "horizon"), part(element, "facts"));
  drawn.push(horizon);
  return horizon;
}

export class Sensors {
  constructor(info) {
    this.info = info;
    this.curves = new Map();
    this.horizon = null;
    listen(() => this.info.measures, (time, kinds) => this.show(time, kinds));
  }

  // The robot was started again, with other numbers.
  move(info) {
    this.info = info;
  }

  show(time, kinds) {
    const {curves, info} = this;
    if (kinds[ORIENTATION]?.length) {
      this.horizon ??= openHorizon(info.name);
      [this.horizon.angles] = kinds[ORIENTATION][0];
    }
    for (const [kind, name, unit] of KINDS) {
      if (!kinds[kind]?.length) continue;
      if (!curves.has(kind)) curves.set(kind, new Curves(info.name, name, ["x", "y", "z"], unit));
      curves.get(kind).add(time, kinds[kind][0][0]);
    }
  }
}
