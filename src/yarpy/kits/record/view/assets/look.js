// A recording, or the last minutes: one time line, and what was said at the cursor.

import {ask, pause, press, say} from "/*/common.js";
import {beside, query} from "/look_beside.js";
import {Card} from "/look_card.js";
import {Link, after, since} from "/look_link.js";
import {TimeLine} from "/look_time.js";

const LOOK = 1000; // ms between looks at a time line that grows
const FIRST = 4; // ports that are open at the beginning

const byId = (id) => document.getElementById(id);
const cards = new Map();

let told = null; // what the program tells
let origin = null; // the moment from which seconds are counted, in ns
let playing = false;
let following = false;
let link = null;
let asked = 0; // wishes, and those that were answered
let answered = 0;

const line = new TimeLine(byId("time").firstElementChild, {
  seek: (time) => seek(time),
  toggle: (name) => (cards.has(name) ? close(name) : open(name)),
  zoomed: () => draw(),
  chose: () => cut(),
});

const rate = () => Number(byId("rate").value);

// -- time --

// Until it is answered, what the program says of the time is of before.
const wish = (seek = null, speed = rate()) => link?.control(!playing, speed, seek, ++asked);

function seek(time) {
  const [begin, end] = [line.told.begin, line.told.begin + line.told.length];
  line.cursor = Math.min(Math.max(time, begin), end);
  following = false;
  wish(after(origin, line.cursor));
  draw();
}

function play(wanted) {
  playing = wanted;
  following &&= wanted;
  wish();
  tell();
  draw();
}

function follow() {
  following = playing = true;
  wish(after(origin, line.told.begin + line.told.length + 1), 1);
  tell();
}

function tell() {
  press(byId("play"), playing);
  say(byId("play"), playing ? "Pause" : "Play");
  press(byId("live"), following);
}

// -- ports --

function open(name) {
  const port = line.told.ports.find((one) => one.name === name);
  if (!port || cards.has(name)) return;
  const card = new Card(port, () => close(name));
  card.drawn = draw;
  cards.set(name, card);
  line.open.add(name);
  byId("cards").append(card.figure);
  card.end = link?.subscribe(name) ?? null;
  draw();
  remember();
}

function close(name) {
  const card = cards.get(name);
  card?.end?.();
  card?.figure.remove();
  cards.delete(name);
  line.open.delete(name);
  draw();
  remember();
}

// The address tells which ports are open, so that it can be sent to somebody.
function remember() {
  const words = new URLSearchParams([...cards.keys()].map((name) => ["port", name]));
  history.replaceState(null, "", `#${words}`);
}

function first() {
  const named = new URLSearchParams(location.hash.slice(1)).getAll("port");
  if (named.length || location.hash.length > 1) return named;
  const pictured = line.told.ports.filter((port) => port.kind === "yarp/image");
  const others = line.told.ports.filter((port) => port.kind !== "yarp/image");
  return [...pictured.slice(0, FIRST / 2), ...others].slice(0, FIRST).map((port) => port.name);
}

// The moment at which each open port has said something; the beginning, if that is far from it.
function start() {
  const {begin, length, ports} = line.told;
  const opened = ports.filter((port) => cards.has(port.name));
  const later = opened.map((port) => {
    const place = port.bins.findIndex((count) => count);
    return port.from - begin + (place > 0 ? ((place + 1) / port.bins.length) * port.length : 0);
  });
  const last = Math.max(0, ...later);
  return begin + (last <= length / 10 ? last : 0);
}

// -- what is seen --

let waiting = false;

function draw() {
  if (waiting) return;
  waiting = true;
  requestAnimationFrame(() => {
    waiting = false;
    line.draw();
    for (const card of cards.values()) card.show(line.view, line.cursor, origin);
    if (told) {
      const at = new Date(Number(after(origin, line.cursor) / 1000000n));
      const day = at.toLocaleString(undefined, {dateStyle: "short", timeStyle: "medium"});
      const made = told.seen < 1 ? `, ${Math.round(told.seen * 100)} % looked through` : "";
      const end = (line.told.begin + line.told.length).toFixed(1);
      const where = following ? "live" : `${line.cursor.toFixed(3)} of ${end} s`;
      say(byId("state"), `${where} \u00b7 ${day}${made}`);
    }
  });
}

function cut() {
  const link = byId("cut");
  link.hidden = byId("command").hidden = !line.chosen;
  if (!line.chosen) return;
  const [begin, end] = line.chosen;
  const words = {origin: String(origin), begin: begin.toFixed(6), end: end.toFixed(6)};
  link.href = `/cut.mcap?${query(words)}`;
  link.download = "cut.mcap";
  say(link, `Cut ${(end - begin).toFixed(2)} s`);
  const shown = `yarpy convert ${told.title} --start ${begin.toFixed(3)} --duration ${(end - begin).toFixed(3)} -o cut`;
  say(byId("command").firstElementChild, told.live || told.beside ? "" : shown);
}

// The files that were given to the recording.
function files(attached) {
  const list = byId("files");
  list.hidden = !attached.length;
  for (const {name, size} of attached) {
    const link = document.createElement("a");
    link.href = `/attached?${query({name})}`;
    link.download = name;
    say(link, `${name} (${size} bytes)`);
    list.append(link);
  }
}

// -- what the program tells --

async function look() {
  const found = await ask(`/timeline?${query()}`);
  if (!found) return false;
  const began = BigInt(found.begin);
  const initial = told === null;
  origin ??= began;
  const shift = since(began, origin);
  const whole = line.view.length >= line.told.length * 0.999;
  told = found;
  line.told = {
    begin: shift,
    length: found.length,
    ports: found.ports.map((port) => ({
      ...port,
      from: shift + (port.from ?? 0),
      length: port.length ?? found.length,
      gaps: port.gaps.map((gap) => gap.map((t) => t + shift)),
    })),
    notes: found.notes.map((note) => ({...note, t: note.t + shift})),
  };
  say(byId("title"), found.title);
  document.title = `${found.title} - yarpy view`;
  say(byId("trouble"), found.problem || (found.ports.length ? "" : "Nothing came yet."));
  byId("live").hidden = !found.live;
  if (initial) files(found.attached ?? []);
  if (initial) beside(byId("beside"), found.beside);
  if (initial) following = playing = found.live;
  if (initial || whole) line.whole();
  else if (found.live && following) line.move(shift + found.length - line.view.length);
  if (!cards.size && initial | found.live) first().forEach(open);
  if (initial && !found.live) line.cursor = start();
  tell();
  draw();
  return true;
}

function connect() {
  link = new Link(`${location.origin.replace("http", "ws")}/?${query()}`, {
    channels: () => {
      for (const [name, card] of cards) card.end ??= link.subscribe(name);
    },
    info: () => {
      asked = answered = 0;
      if (told && !following) wish(after(origin, line.cursor));
    },
    message: (channel, time, bytes) => cards.get(channel.topic)?.take(bytes, since(time, origin)),
    time: (time) => {
      for (const card of cards.values()) if (card.stale) card.clear();
      if (line.held || answered < asked) return;
      line.cursor = since(time, origin);
      draw();
    },
    state: ({state, jumped, request}) => {
      if (jumped) for (const card of cards.values()) card.stale = true;
      answered = Math.max(answered, request);
      if (answered < asked) return;
      playing = state === "playing";
      tell();
    },
    status: (text) => say(byId("trouble"), text),
    closed: async () => {
      say(byId("state"), "the program does not answer");
      for (const card of cards.values()) card.end = null;
      await pause(LOOK);
      connect();
    },
  });
}

// -- hands --

byId("play").onclick = () => play(!playing);
byId("back").onclick = () => seek(line.cursor - 1);
byId("forth").onclick = () => seek(line.cursor + 1);
byId("rate").onchange = () => wish();
byId("live").onclick = follow;
byId("whole").onclick = () => line.whole();
document.addEventListener("keydown", (event) => {
  if (event.target.closest("input, select, button, a") && event.key !== "Escape") return;
  const step = event.shiftKey ? 10 : 1;
  const does = {
    " ": () => play(!playing),
    ArrowLeft: () => seek(line.cursor - step),
    ArrowRight: () => seek(line.cursor + step),
    Home: () => seek(line.told.begin),
    End: () => seek(line.told.begin + line.told.length),
    "+": () => line.zoom(0.5, line.cursor),
    "-": () => line.zoom(2, line.cursor),
    Escape: () => {
      line.chosen = null;
      cut();
      draw();
    },
  }[event.key];
  if (!does) return;
  event.preventDefault();
  does();
});

while (!(await look())) await pause(LOOK);
connect();
for (;;) {
  await pause(LOOK);
  if (!document.hidden && (told.live || told.seen < 1)) await look();
}
