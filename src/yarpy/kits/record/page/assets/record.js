// A recorder: what comes from each port, and the words that it is told.

import {ask, may, pause, press, say} from "/*/common.js";
import {Table, clock, size} from "/record_table.js";

const ROUND = 500; // ms between questions
const SURE = 4000; // ms in which a second press means it
const SPAN = 1.5; // seconds over which rates are taken

const byId = (id) => document.getElementById(id);
const table = new Table(document.querySelector("table"), byId("ports"));

let told = null; // what the recorder says
let past = []; // what it said in the last second or two: rates are the difference to the first
let refusal = "";

function totals() {
  const lost = told.ports.reduce((sum, port) => sum + port.lost, 0);
  const messages = told.ports.reduce((sum, port) => sum + port.messages, 0);
  const memory = Math.round((100 * told.held) / Math.max(told.memory, 1));
  const file = told.files.at(-1) ?? "none yet";
  const rows = [
    ["messages", messages, false],
    ["lost", lost, lost > 0],
    ["written", size(told.bytes), false],
    ["left on the disk", size(told.free), false],
    ["memory in use", `${memory} %`, memory > 80],
    [told.count > 1 ? `file ${told.count}` : "file", file, false],
  ];
  const list = byId("totals");
  while (list.childElementCount < rows.length) {
    const row = document.createElement("div");
    row.append(document.createElement("dt"), document.createElement("dd"));
    list.append(row);
  }
  rows.forEach(([name, text, bad], at) => {
    const row = list.children[at];
    say(row.firstElementChild, name);
    say(row.lastElementChild, String(text));
    row.classList.toggle("bad", bad);
  });
}

function news() {
  const lines = [...told.news].reverse();
  const list = byId("news");
  if (lines.length === list.childElementCount && lines.every((line, at) => list.children[at].textContent === line)) return;
  list.replaceChildren(...lines.map((line) => {
    const item = document.createElement("li");
    item.textContent = line;
    return item;
  }));
}

function show() {
  say(byId("name"), told.name);
  document.title = `${told.state} - ${told.name}`;
  byId("light").className = told.state;
  say(byId("state"), `${told.state} ${clock(told.seconds)}`);
  say(byId("trouble"), told.failure || refusal);
  press(byId("pause"), told.state === "paused");
  say(byId("pause"), told.state === "paused" ? "Go on" : "Pause");
  say(byId("split"), told.snapshots ? "Snapshot" : "New file");
  totals();
  table.show(told.ports, past[0]?.ports ?? [], past.length ? told.seconds - past[0].seconds : 0);
  say(byId("none"), told.ports.length ? "" : "No port is there yet: what is wanted is recorded as it comes.");
  news();
}

async function look() {
  const next = await ask("/recording");
  if (next === null) {
    byId("light").className = "";
    say(byId("state"), told ? "it has ended, or does not answer" : "it does not answer");
    return;
  }
  if (told && next.seconds < told.seconds) past = []; // another recorder
  else if (told) past.push(told);
  while (past.length > 1 && next.seconds - past[1].seconds >= SPAN) past.shift();
  told = next;
  show();
}

async function act(...words) {
  say(byId("command"), `yarpy rpc ${told.name}/rpc:i ${words.map((word) => (/^\w+$/.test(word) ? word : JSON.stringify(word))).join(" ")}`);
  let answer;
  try {
    const reply = await fetch("/form", {
      method: "POST",
      headers: {"Content-Type": "application/json"},
      body: JSON.stringify({req: words}),
      signal: AbortSignal.timeout(15000),
    });
    answer = await reply.json();
  } catch {
    answer = ["fail", "the recorder does not answer"];
  }
  refusal = Array.isArray(answer) && answer[0] === "fail" ? answer[1] : "";
  await look();
}

// -- hands --

const paused = () => told?.state === "paused";
let sure = 0;

byId("pause").onclick = () => act(paused() ? "resume" : "pause");
byId("split").onclick = () => act(told?.snapshots ? "snapshot" : "split");
byId("mark").onsubmit = (event) => {
  event.preventDefault();
  act("mark", byId("text").value);
  byId("text").value = "";
};
byId("stop").onclick = () => {
  clearTimeout(sure);
  if (byId("stop").classList.toggle("sure")) {
    say(byId("stop"), "Stop now?");
    sure = setTimeout(unsure, SURE);
  } else {
    unsure();
    act("stop");
  }
};

function unsure() {
  byId("stop").classList.remove("sure");
  say(byId("stop"), "Stop");
}

document.addEventListener("keydown", (event) => {
  if (event.target.closest("input, button") || event.ctrlKey || event.metaKey || event.altKey) return;
  const keys = {" ": () => byId("pause").click(), s: () => byId("split").click(), m: () => byId("text").focus()};
  if (!keys[event.key] || byId("does").hidden) return;
  event.preventDefault();
  keys[event.key]();
});

await look();
byId("does").hidden = !(await may()).includes("write");
for (;;) {
  await pause(ROUND);
  if (!document.hidden) await look();
}
