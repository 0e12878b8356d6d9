// A robot: what its cameras see, where its joints are and are to go, what its sensors feel.
// The page talks to the ports of the robot, in HTTP.

import {ask, copyOf, part, pause, press, say} from "./common.js";
import {Horizon} from "./horizon.js";
import {Plot, colour} from "./plot.js";

const WINDOW = 10; // seconds of a curve
const SEND = 60; // ms between two targets while a slider is dragged
const PRISMATIC = 1919972449; // the type of a joint that slides
const ASK = 100; // ms between two questions to a port that sends no events

// The URL of a port; one of this computer is where the page came from, whoever looks at it.
const url = ([host, port]) => `http://${host || location.hostname}:${port}`;

// The name of a part without that of its robot.
const short = (name) => name.slice(title.length + 1) || name;

// A question to a port: the words are the message, what follows $ is filled in by the port.
async function call(address, words, values = {}) {
  const query = new URLSearchParams({req: words, ...values});
  const answer = await fetch(`${url(address)}/?${query}`, {signal: AbortSignal.timeout(5000)});
  return answer.json();
}

// Every message that a port writes while somebody sees the page: told(time, values). Ports of C++
// send no events; `otherwise` is what to do then.
function listen(address, told, otherwise) {
  let events = null;
  const look = () => {
    events?.close();
    if (document.hidden) return;
    events = new EventSource(`${url(address)}/r?sse`);
    events.onmessage = (event) => {
      const time = Number(event.lastEventId.split(" ")[1]);
      told(time || Date.now() / 1000, JSON.parse(event.data));
    };
    events.onerror = () => {
      if (events.readyState !== EventSource.CLOSED || !otherwise) return;
      document.removeEventListener("visibilitychange", look);
      otherwise();
    };
  };
  document.addEventListener("visibilitychange", look);
  look();
}

// -- cameras --

class Camera {
  constructor(info) {
    this.figure = copyOf("camera");
    this.image = this.figure.querySelector("img");
    this.address = info.images;
    this.field = null; // of view, degrees
    say(part(this.figure, "name"), short(info.name));
    this.image.alt = `what ${info.name} sees`;
    this.image.onerror = async () => {
      await pause(1000);
      this.watch();
    };
    this.image.onclick = (event) => this.click(event);
    document.addEventListener("visibilitychange", () => this.watch());
    this.watch();
    call(info.images, "visr get fov").then((reply) => {
      if (reply[1] === "fov") this.field = reply.slice(3, 5);
    }).catch(() => {});
  }

  // A page that nobody sees costs nothing.
  watch() {
    if (document.hidden) this.image.removeAttribute("src");
    else this.image.src = `${url(this.address)}/?action=stream&now=${Date.now()}`;
  }

  tell() {
    const {naturalWidth: width, naturalHeight: height} = this.image;
    if (width) say(part(this.figure, "facts"), `${width} × ${height}`);
    this.image.classList.toggle("looks", gaze !== null && this.field !== null);
  }

  // Who clicks on something wants it in the middle.
  click(event) {
    if (gaze === null || this.field === null) return;
    const {clientWidth: wide, clientHeight: high} = this.image;
    const [x, y] = [event.offsetX / wide - 0.5, 0.5 - event.offsetY / high];
    const [right, up] = [x, y].map((share, axis) => {
      const half = Math.tan((this.field[axis] * Math.PI) / 360);
      return (Math.atan(2 * share * half) * 180) / Math.PI;
    });
    gaze(right, up);
  }
}

let gaze = null; // turns the head so many degrees to the right and up

// -- joints --

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
    this.slider.oninput = () => {
      stop();
      this.send();
    };
    this.slider.ondblclick = () => this.go(0);
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

class Board {
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
    this.curves = new Curves(this.info.name, "position", names);
    this.curves.element.classList.add("joints");
    listen(this.info.state, (time, angles) => this.show(time, angles), () => this.ask());
    this.followOthers();
    this.offerGaze();
  }

  show(time, angles) {
    heard = performance.now();
    this.curves.add(time, angles);
    angles.forEach((angle, number) => this.joints[number]?.show(angle));
  }

  // Where the joints are, from a port that does not tell by itself.
  async ask() {
    for (;;) {
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
    if (!pitch || !roll || !yaw) return;
    gaze = (right, up) => {
      stop();
      const tilt = (roll.now * Math.PI) / 180;
      yaw.go(yaw.now - right * Math.cos(tilt) - up * Math.sin(tilt));
      pitch.go(pitch.now + up * Math.cos(tilt) - right * Math.sin(tilt));
    };
  }
}

// -- curves --

class Curves {
  constructor(name, unit, names) {
    this.element = copyOf("curve");
    say(part(this.element, "name"), short(name));
    say(part(this.element, "unit"), unit);
    this.canvas = part(this.element, "plot");
    this.canvas.role = "img";
    this.canvas.ariaLabel = `${name}, the last ${WINDOW} seconds`;
    this.plot = new Plot(this.canvas);
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
    const view = {end: this.times.at(-1), window: WINDOW, low: null, high: null, hover: null};
    this.plot.draw(curves, view);
  }
}

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

function openSensors(info) {
  const curves = new Map();
  let horizon = null;
  listen(info.measures, (time, kinds) => {
    heard = performance.now();
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

// -- the page --

const cameras = [];
const drawn = [];
let title = ""; // the name of the robot
let heard = null; // when the robot was last heard of
let trying = null; // the joints are being tried; what ends that

function stop() {
  trying?.abort();
}

async function tryJoints(joints) {
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

function draw() {
  for (const each of drawn) each.draw();
  requestAnimationFrame(draw);
}

async function open() {
  const robot = await ask("/robot");
  if (!robot?.boards.length && !robot?.cameras.length) return null;
  title = robot.robot;
  for (const info of robot.cameras) {
    cameras.push(new Camera(info));
    document.getElementById("cameras").append(cameras.at(-1).figure);
  }
  const boards = robot.boards.map((info) => new Board(info));
  for (const board of boards) {
    document.getElementById("boards").append(board.element);
    await board.open().catch(() => {
      say(part(board.element, "banner"), "This part of the robot does not answer.");
    });
  }
  robot.sensors.forEach(openSensors);
  const joints = boards.flatMap((board) => board.joints);
  for (const id of ["try", "home"]) document.getElementById(id).hidden = !joints.length;
  document.getElementById("try").onclick = () => (trying ? stop() : tryJoints(joints));
  document.getElementById("home").onclick = () => {
    stop();
    for (const joint of joints) joint.go(Math.min(Math.max(0, joint.range[0]), joint.range[1]));
  };
  say(document.getElementById("title"), title.slice(1));
  document.title = `${title.slice(1)} - yarpy`;
  const ports = document.getElementById("ports");
  ports.hidden = robot.server === null;
  if (robot.server) ports.href = `${url(robot.server)}/`;
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => {
    for (const each of [...drawn, ...joints]) each.paint();
  });
  return joints.length;
}

const state = document.getElementById("state");
let count;
while ((count = await open().catch(() => null)) === null) {
  say(state, "waiting for the robot ...");
  await pause(1000);
}
requestAnimationFrame(draw);
for (;;) {
  for (const camera of cameras) camera.tell();
  const lost = heard === null || performance.now() - heard > 2000;
  state.classList.toggle("warn", lost && count > 0);
  const click = gaze && cameras.length ? ", click on a picture to look there" : "";
  say(state, lost && count ? "the robot is silent" : `live: drag the sliders${click}`);
  await pause(500);
}
