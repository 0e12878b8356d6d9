// The sensors of the robot: curves of what they feel, a horizon for which way is up.

import {copyOf, part, say} from "./common.js";
import {Horizon} from "./horizon.js";
import {Curves, drawn} from "./panel_curve.js";
import {listen, robot, short} from "./panel_port.js";

// The kinds of sensors in a message, and how they are drawn.
const KINDS = [
  [0, "°/s, gyroscope", ["x", "y", "z"]],
  [1, "m/s², accelerometer", ["x", "y", "z"]],
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

export function openSensors(info) {
  const curves = new Map();
  let horizon = null;
  listen(info.measures, (time, kinds) => {
    robot.heard = performance.now();
    if (kinds[ORIENTATION]?.length) {
      horizon ??= openHorizon(info.name);
      [horizon.angles] = kinds[ORIENTATION][0];
    }
    for (const [kind, unit, names] of KINDS) {
      if (!kinds[kind]?.length) continue;
      if (!curves.has(kind)) curves.set(kind, new Curves(info.name, unit, names));
      curves.get(kind).add(time, kinds[kind][0][0]);
    }
  });
}
