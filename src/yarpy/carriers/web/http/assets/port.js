// The page of a port: what it writes, live - a picture, curves, the last value, or a list of
// messages - and its connections. The page asks for no more than people can see, and for nothing
// while it is in the background.

import {may, pause, press, rate, say, seconds, several} from "/*/common.js";
import {Live, OLD} from "/*/live.js";
import {Plot, colour, dashes} from "/*/plot.js";
import {cut, isPicture, line, numbers, tree} from "/*/tree.js";

const RATE = 20; // messages a second that the page asks for
const PICTURES = 15; // pictures a second
const ROUND = 2000; // ms between requests for the connections
const LOOK = 250; // ms between changes of text, so that it can be read
const WINDOW = 10; // seconds of a curve
const CURVES = 12;
const KEPT = 3000; // messages of a curve
const ROWS = 200; // messages, and answers, that are listed
const LONG = 1000; // characters of one
const SILENT = 10000; // ms without a message after which they are requested again

const byId = (id) => document.getElementById(id);
const name = document.querySelector("h1").textContent;
const now = () => performance.now() / 1000;

function make(tag, className, parent) {
  const element = document.createElement(tag);
  element.className = className;
  parent?.append(element);
  return element;
}

// -- what flows --

const flow = byId("flow");
const list = byId("messages");
let paused = false;
let last = null; // the newest message: {value, envelope, time}
let told = null; // the message that is shown
let times = []; // of the messages of the last seconds
let picture = null;
let curves = null;

class Curves {
  constructor() {
    this.element = make("figure", "curves-of", flow);
    this.plot = new Plot(make("canvas", "plot", this.element));
    this.plot.canvas.role = "img";
    this.plot.canvas.ariaLabel = `numbers of ${name}, the last ${WINDOW} seconds`;
    this.legend = make("ul", "legend", this.element);
    this.times = [];
    this.columns = new Map(); // by name: its values, and where it is listed
    this.more = 0;
  }

  add(time, found) {
    this.more = Math.max(0, found.length - CURVES);
    for (const [name] of found.slice(0, CURVES)) {
      if (this.columns.has(name) || this.columns.size >= CURVES) continue;
      const item = make("li", "", this.legend);
      make("span", "colour", item);
      make("span", "name", item).textContent = name;
      const value = make("output", "value", item);
      this.columns.set(name, {values: this.times.map(() => null), item, value});
    }
    const known = new Map(found);
    this.times.push(time);
    for (const [name, {values}] of this.columns) values.push(known.get(name) ?? null);
    if (this.times.length < KEPT) return;
    this.times.splice(0, KEPT / 3);
    for (const {values} of this.columns.values()) values.splice(0, KEPT / 3);
  }

  draw() {
    const found = [...this.columns.values()];
    const drawn = found.map(({values}, number) => ({times: this.times, values, number}));
    this.plot.draw(drawn, {end: now(), window: WINDOW, low: null, high: null, hover: null});
  }

  tell() {
    [...this.columns.values()].forEach(({values, item, value}, number) => {
      const line = item.querySelector(".colour").style;
      line.borderTopColor = colour(number);
      line.borderTopStyle = dashes(number).length ? "dashed" : "solid";
      const newest = values.at(-1);
      value.textContent = newest === null ? "-" : short(newest);
    });
  }
}

const short = (value) => (Number.isInteger(value) ? `${value}` : value.toPrecision(5));

function showPicture() {
  const element = make("figure", "picture", null);
  flow.prepend(element);
  const screen = make("div", "screen", element);
  const canvas = make("canvas", "", screen);
  canvas.role = "img";
  canvas.ariaLabel = `what ${name} sends`;
  const where = () => `${location.origin}/?action=stream&rate=${PICTURES}`;
  const drawn = () => screen.style.setProperty("--shape", picture.size.join(" / "));
  picture = new Live(screen, where, {drawn, wanted: () => !paused});
}

function take(value, envelope) {
  last = {value, envelope, time: now()};
  times.push(last.time);
  while (times[0] < last.time - 3) times.shift();
  if (list) row();
  if (isPicture(value)) {
    if (!picture) showPicture();
    return;
  }
  const found = numbers(value);
  if (!found.length || list) return;
  curves ??= new Curves();
  curves.add(last.time, found);
}

function row() {
  const item = make("li", "", null);
  make("time", "", item).textContent = new Date().toTimeString().slice(0, 8);
  if (last.envelope) make("span", "soft", item).textContent = cut(last.envelope, 60);
  make("code", "", item).textContent = line(last.value, LONG);
  list.prepend(item);
  while (list.children.length > ROWS) list.lastChild.remove();
}

let events = null;
let heard = 0;
let hears = false; // whoever has this page open may read, and the port sends something by itself

// Listen while the page is visible.
function listen() {
  events?.close();
  events = null;
  if (!hears || document.hidden || paused) return;
  heard = performance.now();
  events = new EventSource(`/r?sse&rate=${RATE}`);
  events.onmessage = (event) => {
    heard = performance.now();
    try {
      take(JSON.parse(event.data), event.lastEventId);
    } catch {
      // not readable; the next one follows
    }
  };
}

const button = make("button", "", document.querySelector("nav"));
button.textContent = "Pause";
button.title = "show nothing new";
button.onclick = () => {
  paused = !paused;
  press(button, paused);
  picture?.look();
  listen();
};
press(button, false);
document.addEventListener("visibilitychange", listen);

const value = make("details", "value-of", null);
value.open = true;
make("summary", "", value).textContent = "the last message";
const shown = make("div", "tree", value);

// -- its connections --

let connections = null; // null: the port does not answer
let before = new Map(); // messages of each, and when
let flowing = null; // messages a second that the port writes

async function port(req) {
  const answer = await fetch("/form", {
    method: "POST",
    headers: {"Content-Type": "application/json"},
    body: JSON.stringify({admin: 1, req}),
    signal: AbortSignal.timeout(5000),
  });
  if (!answer.ok) throw new Error(answer.statusText);
  return answer.json();
}

async function ask() {
  const found = await port(["stat"]);
  const seen = new Map();
  flowing = null;
  for (const one of found) {
    const key = `${one.side} ${one.source} ${one.target} ${one.carrier}`;
    const count = one.messages + one.drops;
    seen.set(key, {count, time: now()});
    const old = before.get(key);
    one.now = old && count >= old.count ? (count - old.count) / (now() - old.time) : null;
    if (one.side === "out" && one.now !== null) flowing = Math.max(flowing ?? 0, one.now);
  }
  before = seen;
  connections = found;
}

const plain = [...document.querySelectorAll("pre")].find((pre) => pre.textContent.startsWith(`This is ${name} at `));
const table = plain ? make("table", "", null) : null;

function showConnections() {
  if (!table) return;
  const found = connections.filter(({source, target}) => ![source, target].includes("web"));
  const rows = found.filter(({target}) => target !== "null" && target !== "").map((one) => {
    const out = one.side === "out";
    const drops = one.drops ? `${one.drops} dropped` : "";
    const cells = [out ? `to ${one.target}` : `from ${one.source}`, one.carrier];
    cells.push(one.now === null ? "" : rate(one.now), several(one.messages, "message", "messages"), drops);
    const row = make("tr", "", null);
    for (const text of cells) make("td", "", row).textContent = text;
    return row;
  });
  if (!rows.length) {
    const row = make("tr", "", null);
    make("td", "soft", row).textContent = "no connections with other ports";
    rows.push(row);
  }
  table.replaceChildren(...rows);
  if (!table.isConnected) plain.replaceWith(table);
}

// -- what is sent to it --

const form = byId("ask");
const said = make("ol", "said", null);

form?.addEventListener("submit", async (event) => {
  event.preventDefault();
  const text = form.elements.data.value;
  const item = make("li", "", null);
  make("code", "", item).textContent = `> ${text}`;
  const reply = make("pre", "", item);
  reply.textContent = "...";
  if (!said.isConnected) form.after(said);
  said.prepend(item);
  while (said.children.length > ROWS) said.lastChild.remove();
  try {
    const body = new URLSearchParams({data: text, format: "text"});
    const answer = await fetch("/form", {method: "POST", body});
    reply.textContent = answer.status === 204 ? "(no reply)" : (await answer.text()).trimEnd();
    reply.classList.toggle("warn", !answer.ok);
  } catch {
    reply.textContent = "the port does not answer";
    reply.classList.add("warn");
  }
});

// -- the page --

let sends = true; // it may send

function tell() {
  const age = last ? now() - last.time : null;
  const span = times.length > 1 ? times.at(-1) - times[0] : 0;
  const mine = span && age < 3 ? (times.length - 1) / span : 0;
  const facts = [];
  if (connections === null) facts.push("the port does not answer");
  if (last) {
    const real = flowing !== null && mine > 0.8 * RATE && flowing > mine ? flowing : mine;
    facts.push(age < 3 ? rate(real) : "nothing new", `${seconds(age)} old`);
    const shows = picture ? picture.fps : mine;
    if (real > 1.3 * shows && age < 3) facts.push(`this page shows ${rate(shows)} of them`);
    if (isPicture(last.value)) facts.unshift(line(last.value, LONG));
  } else if (connections !== null) {
    facts.push(sends ? "it has sent nothing since this page was opened" : "it receives messages and sends none by itself");
  }
  if (paused) facts.push("paused");
  say(byId("state"), facts.join(" · "));
  const still = last !== null && !paused && (connections === null || age > OLD);
  byId("state").classList.toggle("warn", connections === null || still);
  flow.classList.toggle("still", still);
  flow.hidden = !last;
  curves?.tell();
  if (last === told || list || isPicture(last.value)) return;
  told = last;
  flow.append(value);
  shown.replaceChildren(tree(last.value));
}

function draw() {
  requestAnimationFrame(draw);
  if (!paused) curves?.draw();
}

async function learn() {
  for (;;) {
    if (!document.hidden) {
      try {
        await ask();
        showConnections();
      } catch {
        connections = null;
      }
      if (performance.now() - heard > SILENT) listen();
    }
    await pause(ROUND);
  }
}

connections = [];
may().then((found) => {
  hears = found.includes("read");
  listen();
});
requestAnimationFrame(draw);
learn();
port(["prop", "get", name]).then(({port: kind}) => (sends = kind?.is_output !== 0)).catch(() => {});
for (;;) {
  tell();
  await pause(LOOK);
}
