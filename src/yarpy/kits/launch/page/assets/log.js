// The log of the network: the program of this page has the lines, and filters them.

import {ask, pause, press, say, several} from "/*/common.js";

const ROUND = 400; // ms between questions
const FIRST = 1000; // lines that are shown at once
const KEPT = 5000; // lines that the page keeps

const byId = (id) => document.getElementById(id);
const pane = byId("lines");

let newest = 0; // number of the last line that was looked at
let filter = 0; // counts the changes of the filter
let wake = () => {}; // ends the pause between two questions: there is never more than one under way

const chosen = () => ({level: byId("level").value, program: byId("program").value, text: byId("text").value});

function span(kind, text) {
  const made = document.createElement("span");
  made.className = kind;
  made.textContent = text;
  return made;
}

function lineOf([, time, program, origin, level, component, text]) {
  const line = document.createElement("div");
  line.className = level;
  line.title = origin;
  const clock = time ? new Date(time * 1000).toLocaleTimeString([], {hourCycle: "h23"}) : "--:--:--";
  line.append(span("clock", clock), span("who", program), span("level", level || "?"));
  if (component) line.append(span("component", component));
  line.append(text);
  return line;
}

// What shows the same in a terminal.
function command({level, program, text}) {
  const quoted = (word) => (/^[\w./-]+$/.test(word) ? word : `'${word.replaceAll("'", "'\\''")}'`);
  const literal = text.replace(/[.*+?^${}()|[\]\\]/g, "\\$&");
  return ["yarpy log", level && `--level ${level}`, program && `--program ${quoted(program)}`, text && `--grep ${quoted(literal)}`].filter(Boolean).join(" ");
}

function programs(names) {
  const choice = byId("program");
  const all = ["", ...names];
  if (all.length === choice.options.length && all.every((name, at) => choice.options[at].value === name)) return;
  const before = choice.value;
  choice.replaceChildren(...all.map((name) => new Option(name || "all programs", name)));
  choice.value = before;
}

async function round() {
  const asked = filter;
  const next = await ask(`/lines?${new URLSearchParams({...chosen(), since: newest, most: newest ? 2000 : FIRST})}`);
  if (asked !== filter) return;
  byId("state").classList.toggle("warn", !next || next.lost > 0);
  if (next === null) {
    say(byId("state"), "yarpy log has ended, or does not answer");
    return;
  }
  if (next.newest < newest) return again(); // it was started anew
  const facts = [several(next.newest, "line", "lines"), several(next.programs.length, "program", "programs")];
  if (next.lost) facts.push(`${next.lost} lost`);
  say(byId("state"), facts.join(" · "));
  programs(next.programs);
  newest = next.newest;
  if (!next.lines.length) return;
  pane.append(...next.lines.map(lineOf));
  while (pane.childElementCount > KEPT) pane.firstChild.remove();
  if (byId("follow").ariaPressed === "true") pane.scrollTop = pane.scrollHeight;
}

// Show what another filter lets through, of all lines that are kept.
function again() {
  filter += 1;
  newest = 0;
  pane.replaceChildren();
  say(byId("command"), command(chosen()));
  wake();
}

function follow(on) {
  press(byId("follow"), on);
  if (on) pane.scrollTop = pane.scrollHeight;
}

byId("level").onchange = again;
byId("program").onchange = again;
byId("text").oninput = again;
byId("follow").onclick = () => follow(byId("follow").ariaPressed !== "true");
pane.onwheel = (event) => {
  if (event.deltaY < 0) follow(false);
};
document.addEventListener("keydown", (event) => {
  if (event.target.closest("input, select, textarea") || event.ctrlKey || event.metaKey || event.altKey) return;
  const keys = {"/": () => byId("text").focus(), e: () => byId("follow").click()};
  if (!keys[event.key]) return;
  event.preventDefault();
  keys[event.key]();
});

say(byId("command"), command(chosen()));
for (;;) {
  const before = filter;
  if (!document.hidden) await round();
  if (before === filter) await Promise.race([pause(ROUND), new Promise((done) => (wake = done))]);
}
