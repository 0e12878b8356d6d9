// The whole network: what the program of this page knows of it, once a second.

import {ask, may, pause, press, say, several} from "/*/common.js";
import {Cameras} from "./dash_camera.js";
import {Detail} from "./dash_detail.js";
import {Graph} from "./dash_graph.js";
import {List} from "./dash_list.js";
import {often} from "./dash_word.js";

const ROUND = 1000; // ms between questions
const KEPT = 120; // seconds of history
const BUSY = 1e6; // bytes per second of a thick line
const EVENTS = 200;

const byId = (id) => document.getElementById(id);

class Network {
  version = -1;
  event = 0;
  ports = new Map(); // by name
  links = new Map(); // by both names

  // Take what was told; whether there are other ports or connections than before.
  take(told) {
    const changed = told.ports !== undefined;
    if (changed) {
      this.version = told.version;
      this.ports = new Map(told.ports.map((port) => [port.name, {...port, title: titled(port)}]));
      const before = this.links;
      this.links = new Map();
      for (const [source, target, carrier] of told.links) {
        const key = `${source} ${target}`;
        this.links.set(key, {key, source, target, carrier, history: before.get(key)?.history ?? {rate: [], latency: [], drops: []}});
      }
    }
    for (const [at, port] of [...this.ports.values()].entries()) [port.light, port.state] = told.states[at] ?? [null, ""];
    for (const [at, link] of [...this.links.values()].entries()) {
      const [messages, rate, speed, latency, jitter, drops, dropped, missed, replaced, thread, packets, monitors] = told.numbers[at];
      Object.assign(link, {messages, rate, speed, latency, jitter, drops, missed, replaced, thread, packets, monitors});
      link.dropping = dropped > 0;
      link.look = link.dropping ? "bad" : speed > BUSY ? "busy" : rate ? "live" : "idle";
      const kept = {rate, latency, drops: dropped};
      for (const [key, values] of Object.entries(link.history)) {
        values.push(kept[key]);
        if (values.length > KEPT) values.shift();
      }
    }
    return changed;
  }

  linksOf(name) {
    return [...this.links.values()].filter((link) => link.source === name || link.target === name);
  }
}

function titled({program, place}) {
  if (!program) return place || "not registered";
  const words = program.split(" ").map((word) => word.split("/").at(-1));
  if (/^python[\d.]*$/.test(words[0]) && words.length > 1) words.shift(); // which one says nothing
  return `${words.slice(0, 4).join(" ")} · ${place}`;
}

const network = new Network();
let selected = {kind: null, key: ""};
let words = [];
let refusal = ""; // why what was done last did not work

const allowed = (await may()).includes("write");
const graph = new Graph(byId("graph").querySelector("canvas"), choose);
const cameras = new Cameras(byId("cameras"), choose);
const list = new List(byId("list"), choose);
const detail = new Detail(byId("detail"), network, {chosen: choose, act, may: allowed});

function choose(kind, key) {
  selected = {kind, key};
  graph.selected = selected;
  show();
}

// What the search finds: every word in a port's name, program or host, or in those of a connection.
function found() {
  const names = new Set();
  const fits = (text) => words.every((word) => text.includes(word));
  const text = (name) => {
    const port = network.ports.get(name);
    return port ? `${port.name} ${port.program} ${port.place} ${port.state}` : name;
  };
  for (const name of network.ports.keys()) if (fits(text(name).toLowerCase())) names.add(name);
  const links = [...network.links.values()].filter(({source, target, carrier}) => fits(`${text(source)} ${text(target)} ${carrier}`.toLowerCase()));
  return {names, links};
}

function show() {
  const {names, links} = found();
  graph.wanted = words.length ? names : null;
  const lights = new Map([...network.ports.values()].map((port) => [port.name, port.light]));
  if (!byId("graph").hidden) graph.update([...network.links.values()], lights);
  if (!byId("list").hidden) list.show(links, selected);
  detail.show(selected);
  if (words.length && names.size === 1 && !byId("graph").hidden) graph.show([...names][0]);
}

function summary(told) {
  const all = [...network.links.values()];
  const rate = all.reduce((sum, link) => sum + (link.rate ?? 0), 0);
  const gone = [...network.ports.values()].filter((port) => port.light < 0).length;
  const facts = [several(network.ports.size, "port", "ports"), several(network.links.size, "connection", "connections"), `${often(rate)} messages/s`];
  const dropping = all.filter((link) => link.dropping).length;
  if (dropping) facts.push(`${dropping} dropping`);
  if (gone) facts.push(`${gone} gone`);
  if (told.more) facts.push(`${told.more} more ports are not shown`);
  say(byId("state"), facts.join(" · "));
  byId("state").classList.toggle("warn", Boolean(dropping));
  say(byId("trouble"), told.problem || refusal);
  const empty = byId("empty");
  say(empty, network.ports.size || told.problem ? "" : "no ports yet; `yarpy sim` starts a robot");
}

function remember(events) {
  for (const [number, at, text] of events) {
    network.event = number;
    const time = document.createElement("time");
    time.textContent = new Date(at * 1000).toLocaleTimeString("en-GB");
    const item = document.createElement("li");
    item.append(time, text);
    byId("events").prepend(item);
    byId("latest").textContent = text;
  }
  while (byId("events").children.length > EVENTS) byId("events").lastChild.remove();
}

async function act(...command) {
  let answer;
  try {
    const told = await fetch("/form", {
      method: "POST",
      headers: {"Content-Type": "application/json"},
      body: JSON.stringify({admin: 1, req: ["dash", ...command]}),
      signal: AbortSignal.timeout(15000),
    });
    answer = await told.json();
  } catch {
    answer = ["fail", "the program of this page does not answer"];
  }
  const failed = Array.isArray(answer) && answer[0] === "fail";
  refusal = failed ? answer[1] : "";
  await look();
}

function tab(graphical) {
  byId("graph").hidden = !graphical;
  byId("list").hidden = graphical;
  byId("fit").hidden = !graphical;
  press(byId("show-graph"), graphical);
  press(byId("show-list"), !graphical);
  show();
}

byId("show-graph").onclick = () => tab(true);
byId("show-list").onclick = () => tab(false);
byId("show-cameras").onclick = () => {
  if (byId("cameras").hidden) cameras.open();
  else cameras.close();
  press(byId("show-cameras"), !byId("cameras").hidden);
};
byId("fit").onclick = () => {
  graph.moved = false;
  graph.fit();
};
byId("undo").onclick = () => act("undo");
byId("search").oninput = () => {
  words = byId("search").value.toLowerCase().split(" ").filter(Boolean);
  show();
};
document.addEventListener("keydown", (event) => {
  if (event.key === "Escape") choose(null, "");
  if (event.target.closest("input, select, textarea") || event.ctrlKey || event.metaKey || event.altKey) return;
  const keys = {"/": () => byId("search").focus(), g: () => tab(true), l: () => tab(false), f: () => byId("fit").click(), c: () => byId("show-cameras").click()};
  if (!keys[event.key]) return;
  event.preventDefault();
  keys[event.key]();
});

let looking = null;
function look() {
  looking ??= round().finally(() => (looking = null));
  return looking;
}

async function round() {
  const told = await ask(`/network?${new URLSearchParams({since: network.version, event: network.event})}`);
  if (told === null) {
    say(byId("state"), "the program of this page does not answer");
    byId("state").classList.add("warn");
    return;
  }
  const changed = network.take(told);
  if (changed) {
    graph.arrange([...network.ports.values()], [...network.links.values()]);
    byId("names").replaceChildren(...[...network.ports.keys()].map((name) => new Option(name)));
  }
  cameras.take([...network.ports.values()]);
  byId("show-cameras").hidden = !cameras.names.length;
  remember(told.events);
  const undo = byId("undo");
  say(undo, allowed && told.undo ? `Undo: ${told.undo}` : "");
  show();
  summary(told);
}

if (matchMedia("(max-width: 46rem)").matches) tab(false);
window.dash = {graph, network}; // for tests, which measure how fast it draws
for (;;) {
  if (!document.hidden) await look();
  await pause(ROUND);
}
