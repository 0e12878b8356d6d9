// The joints of the robot: a board of sliders for each part that moves.

import {copyOf, part, pause, press, say} from "/*/common.js";
import {Curves} from "./panel_curve.js";
import {call, listen, robot, short, url} from "./panel_port.js";
import {colour} from "/*/plot.js";

const ASK = 100; // ms between two questions to a port that sends no events
const SEND = 60; // ms between two targets while a slider is dragged
const PRISMATIC = 1919972449; // the type of a joint that slides

export let gaze = null; // turns the head so many degrees to the right and up
export let moves = true; // whether whoever has this page open may move the robot

// From now on the page shows the robot and moves nothing.
export function watchOnly() {
  moves = false;
}

class Joint {
  constructor(board, number, name, slides, limits) {
    const [lowest, highest] = slides ? limits : limits.map((angle) => Math.min(Math.max(angle, -360), 360));
    this.board = board;
    this.number = number;
    this.name = name;
    this.unit = slides ? "" : "°"; // of length robots have any
    this.range = [lowest, highest];
    this.element = copyOf("joint");
    this.slider = this.element.querySelector("input");
    this.value = part(this.element, "value");
    this.now = null;
    this.sent = 0;
    const id = `${board.info.name}-${number}`;
    const step = highest - lowest > 20 ? 0.5 : (highest - lowest) / 200;
    Object.assign(this.slider, {id, min: lowest, max: highest, step});
    this.element.querySelector("label").htmlFor = id;
    say(part(this.element, "name"), name);
    const written = (limit) => `${Number(limit.toFixed(1))}${this.unit}`;
    say(part(this.element, "low"), written(lowest));
    say(part(this.element, "middle"), slides ? "slides, in the robot's unit of length" : "");
    say(part(this.element, "high"), written(highest));
    this.slider.oninput = () => {
      stop();
      this.send();
    };
    this.slider.ondblclick = () => this.go(0);
    this.slider.disabled = !moves;
    this.paint();
  }

  paint() {
    this.element.style.setProperty("--tint", colour(this.number));
  }

  go(angle) {
    this.slider.value = angle;
    this.send();
  }

  // The newest target, but not more often than the robot needs it.
  async send() {
    if (this.sending) return;
    this.sending = true;
    const wait = this.sent + SEND - performance.now();
    if (wait > 0) await pause(wait);
    this.sending = false;
    this.sent = performance.now();
    const values = {axis: this.number, angle: this.slider.value};
    const reply = await call(this.board.info.rpc, "set pos $axis $angle", values).catch(() => null);
    this.board.told("set+pos+$axis+$angle", values, reply);
    const refused = reply?.[0] === "ok" ? "" : `The robot does not move ${this.name}.`;
    say(part(this.board.element, "banner"), refused);
  }

  show(angle) {
    this.now = angle;
    const [lowest, highest] = this.range;
    const place = (value) => {
      const share = (value - lowest) / (highest - lowest);
      return 100 * Math.min(1, Math.max(0, share));
    };
    const [from, to] = [place(Math.min(0, angle)), place(Math.max(0, angle))];
    this.element.style.setProperty("--from", `${from.toFixed(2)}%`);
    this.element.style.setProperty("--to", `${to.toFixed(2)}%`);
    say(this.value, `${(Math.abs(angle) < 0.05 ? 0 : angle).toFixed(1)}${this.unit}`);
  }

  follow(target) {
    if (document.activeElement !== this.slider && !this.sending) this.slider.value = target;
  }
}

export class Board {
  constructor(info) {
    this.info = info;
    this.joints = [];
    this.element = copyOf("board");
    say(part(this.element, "name"), short(info.name));
  }

  async open() {
    const axes = (await call(this.info.rpc, "get axes"))[2];
    const targets = (await call(this.info.rpc, "get poss"))[2];
    for (let number = 0; number < axes; number++) {
      const name = (await call(this.info.rpc, "get name $axis", {axis: number}))[2];
      const limits = (await call(this.info.rpc, "get llim $axis", {axis: number})).slice(2, 4);
      const type = (await call(this.info.rpc, "get type $axis", {axis: number}))[2];
      const joint = new Joint(this, number, name, type === PRISMATIC, limits);
      joint.slider.value = targets[number];
      joint.show(targets[number]);
      this.joints.push(joint);
      part(this.element, "joints").append(joint.element);
    }
    const names = this.joints.map((joint) => joint.name);
    const unit = this.joints.some((joint) => joint.unit === "") ? "" : "°";
    this.curves = new Curves(this.info.name, "position", names, unit);
    this.curves.element.classList.add("joints");
    const show = (time, angles) => this.show(time, angles);
    listen(() => this.info.state, show, () => this.ask());
    this.followOthers();
    this.offerGaze();
  }

  // The robot was started again, with other numbers.
  move(info) {
    this.info = info;
  }

  show(time, angles) {
    robot.heard = performance.now();
    this.curves.add(time, angles);
    angles.forEach((angle, number) => this.joints[number]?.show(angle));
  }

  // Where the joints are, from a port that does not tell by itself.
  async ask() {
    const {info} = this;
    while (info === this.info) {
      await pause(ASK);
      if (document.hidden) continue;
      const reply = await call(this.info.rpc, "get encs").catch(() => null);
      if (reply?.[1] === "encs") this.show(reply[5], reply[2]);
    }
  }

  // What the page said last, for who wants to say it as well.
  told(words, values, reply) {
    const said = part(this.element, "said");
    said.hidden = false;
    const query = Object.entries(values).map(([name, value]) => `&${name}=${value}`).join("");
    say(part(said, "command"), `curl '${url(this.info.rpc)}/?req=${words}${query}'`);
    say(part(said, "answer"), reply === null ? "(no answer)" : JSON.stringify(reply));
  }

  // Others may move the robot as well.
  async followOthers() {
    for (;;) {
      await pause(1000);
      if (document.hidden) continue;
      const reply = await call(this.info.rpc, "get poss").catch(() => null);
      reply?.[2]?.forEach((target, number) => this.joints[number].follow(target));
    }
  }

  offerGaze() {
    const joint = (name) => this.joints.find((one) => one.name === name);
    const [pitch, roll, yaw] = ["neck_pitch", "neck_roll", "neck_yaw"].map(joint);
    if (!pitch || !roll || !yaw || !moves) return;
    gaze = (right, up) => {
      stop();
      const tilt = (roll.now * Math.PI) / 180;
      yaw.go(yaw.now - right * Math.cos(tilt) - up * Math.sin(tilt));
      pitch.go(pitch.now + up * Math.cos(tilt) - right * Math.sin(tilt));
    };
  }
}

// -- trying them --

export let trying = null; // the joints are being tried; what ends that

export function stop() {
  trying?.abort();
}

export async function tryJoints(joints) {
  const button = document.getElementById("try");
  const control = (trying = new AbortController());
  press(button, true);
  for (const joint of joints) {
    const start = Number(joint.slider.value);
    const [lowest, highest] = joint.range;
    for (const target of [0.6 * highest, 0.6 * lowest, start]) {
      if (control.signal.aborted) break;
      joint.go(Math.min(highest, Math.max(lowest, target)));
      await pause(1100);
    }
  }
  if (trying === control) trying = null;
  press(button, false);
}
