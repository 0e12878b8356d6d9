// An application: its programs, its connections and their output, as the program of this page knows
// them, once a second.

import {ask, may, pause, press, say, several} from "/*/common.js";
import {Graph} from "./dash_graph.js";
import {Links, Programs, keyOf} from "./up_list.js";

const ROUND = 1000; // ms between questions
const LINES = 400; // ms between looks at output
const KEPT = 4000; // lines that the page keeps
const SURE = 3000; // ms in which a second click means it
const LIGHTS = {running: 1, failed: -1, unknown: -1, waiting: 0, pausing: 0, stopping: 0};
const LOOKS = {connected: "live", refused: "bad"};

const byId = (id) => document.getElementById(id);

let told = null; // of the application
let whose = ""; // the program whose output is shown
let newest = 0; // number of the last line
let refusal = ""; // why what was done last did not work
let shape = ""; // of the graph

const allowed = (await may()).includes("write");
document.body.classList.toggle("still", !allowed);
const graph = new Graph(byId("graph").querySelector("canvas"), choose);
const programs = new Programs(byId("programs").tBodies[0], toggle, act);
const links = new Links(byId("links").tBodies[0], act);

function choose(kind, key) {
  if (kind !== "port") return;
  const owner = told.ports.find(([name]) => name === key)?.[1] ?? key;
  if (told.programs.some((one) => one.name === owner)) toggle(owner);
}

function toggle(name) {
  select(name === whose ? "" : name);
}

// Show the output of one program, or of all.
function select(name) {
  whose = name;
  newest = 0;
  byId("lines").replaceChildren();
  show();
  listen();
}

function drawn() {
  const states = new Map(told.programs.map((one) => [one.name, one.state]));
  const ports = told.ports.map(([name, owner]) => ({name, process: owner, place: "", title: owner || "outside"}));
  const owners = new Set(told.ports.map(([, owner]) => owner));
  for (const {name} of told.programs) if (!owners.has(name)) ports.push({name, process: name, place: "", title: name});
  const made = told.connections.map((one) => ({key: keyOf(one), source: one.from, target: one.to, look: LOOKS[one.state] ?? "idle"}));
  const next = JSON.stringify([ports, made.map(({key}) => key)]);
  if (next !== shape) graph.arrange(ports, made);
  shape = next;
  graph.update(made, new Map(ports.map(({name, process}) => [name, LIGHTS[states.get(process)] ?? null])));
}

function show() {
  if (!told) return;
  say(byId("name"), told.application);
  document.title = told.application;
  const running = told.programs.filter((one) => one.state === "running").length;
  const facts = [`${running} of ${several(told.programs.length, "program runs", "programs run")}`];
  const joined = told.connections.filter((one) => one.state === "connected").length;
  if (told.connections.length) facts.push(`${joined} of ${several(told.connections.length, "connection", "connections")}`);
  const failed = told.programs.filter((one) => one.state === "failed");
  if (failed.length) facts.push(`${failed.length} failed`);
  say(byId("state"), facts.join(" · "));
  byId("state").classList.toggle("warn", failed.length > 0);
  say(byId("trouble"), refusal);
  programs.show(told.programs, whose);
  links.show(told.connections);
  const choice = byId("whose");
  const names = ["", ...told.programs.map((one) => one.name)];
  if (names.length !== choice.options.length || names.some((name, at) => choice.options[at].value !== name)) {
    choice.replaceChildren(...names.map((name) => new Option(name || "all programs", name)));
  }
  choice.value = whose;
  drawn();
}

async function act(word, ...names) {
  say(byId("command"), commandOf(word, names));
  let answer;
  try {
    const reply = await fetch("/form", {
      method: "POST",
      headers: {"Content-Type": "application/json"},
      body: JSON.stringify({admin: 1, req: ["up", word, ...names]}),
      signal: AbortSignal.timeout(15000),
    });
    answer = await reply.json();
  } catch {
    answer = ["fail", "the program of this page does not answer"];
  }
  refusal = Array.isArray(answer) && answer[0] === "fail" ? answer[1] : "";
  await round();
}

// What does the same in a terminal.
function commandOf(word, names) {
  if (word === "down") return `yarpy down ${told.application}`;
  return names.length === 1 ? `yarpy ${word} ${names[0]}` : "";
}

async function round() {
  const next = await ask("/application");
  if (next === null) {
    say(byId("state"), "the application has ended, or its program does not answer");
    byId("state").classList.add("warn");
    return;
  }
  told = next;
  show();
}

const fits = (text) => text.toLowerCase().includes(byId("filter").value.toLowerCase());

function lineOf(label, text) {
  const line = document.createElement("div");
  if (!whose) {
    const who = document.createElement("span");
    who.className = "who";
    who.textContent = label;
    line.append(who);
  }
  line.append(text);
  if (/^\[?(ERROR|FATAL)\b|^error\b|^Traceback|^\w*(Error|Exception):/.test(text)) line.className = "error";
  else if (/^\[?WARN(ING)?\b|^warning\b/.test(text)) line.className = "warning";
  line.hidden = !fits(line.textContent);
  return line;
}

async function listen() {
  const asked = whose;
  const next = await ask(`/lines?${new URLSearchParams({name: whose, since: newest, most: newest ? 2000 : 500})}`);
  if (!next?.lines?.length || asked !== whose) return;
  const pane = byId("lines");
  const fresh = next.lines.filter(([number]) => number > newest); // another answer may have come first
  if (!fresh.length) return;
  newest = fresh.at(-1)[0];
  pane.append(...fresh.map(([, label, text]) => lineOf(label, text)));
  while (pane.childElementCount > KEPT) pane.firstChild.remove();
  if (byId("follow").ariaPressed === "true") pane.scrollTop = pane.scrollHeight;
}

function follow(on) {
  press(byId("follow"), on);
  if (on) byId("lines").scrollTop = byId("lines").scrollHeight;
}

byId("whose").onchange = () => select(byId("whose").value);
byId("filter").oninput = () => {
  for (const line of byId("lines").children) line.hidden = !fits(line.textContent);
};
byId("follow").onclick = () => follow(byId("follow").ariaPressed !== "true");
byId("lines").onwheel = (event) => {
  if (event.deltaY < 0) follow(false);
};
byId("show-graph").onclick = () => {
  const flat = byId("up").classList.toggle("flat");
  press(byId("show-graph"), !flat);
  byId("fit").hidden = flat;
};
byId("fit").onclick = () => {
  graph.moved = false;
  graph.fit();
};
let sure = 0;
byId("down").onclick = () => {
  const now = Date.now();
  if (now - sure < SURE) return act("down");
  sure = now;
  byId("down").textContent = "Click again to stop all";
  setTimeout(() => (byId("down").textContent = "Stop all"), SURE);
};
byId("down").hidden = !allowed;
document.addEventListener("keydown", (event) => {
  if (event.target.closest("input, select, textarea") || event.ctrlKey || event.metaKey || event.altKey) return;
  const keys = {"/": () => byId("filter").focus(), g: () => byId("show-graph").click(), f: () => byId("fit").click(), e: () => byId("follow").click()};
  if (!keys[event.key]) return;
  event.preventDefault();
  keys[event.key]();
});

(async () => {
  for (;;) {
    if (!document.hidden) await listen();
    await pause(LINES);
  }
})();
for (;;) {
  if (!document.hidden) await round();
  await pause(ROUND);
}
