// Numbers as curves: the program is asked for what is new, and what is seen is drawn again.

import {ask, copyOf, part, pause, press, rate, say, several} from "/*/common.js";
import {Plot, behind, colour, dashes, nearest, search} from "/*/plot.js";

const LOOK = 33; // ms between questions to the program, and between drawings
const KEPT = 20000; // messages of each source

const byId = (id) => document.getElementById(id);

// What came from one port.
class Source {
  constructor(info) {
    this.info = info;
    this.times = [];
    this.columns = []; // for each curve its values, null where a message had none
    this.hidden = new Set(); // curves that somebody switched off
    this.next = 0;
  }

  add(info) {
    this.info = info;
    this.next = info.next;
    for (const row of info.rows) {
      this.times.push(row[0]);
      for (let place = 0; place < info.curves.length; place++) {
        const column = (this.columns[place] ??= new Array(this.times.length - 1).fill(null));
        column.push(row[place + 1] ?? null);
      }
    }
    const surplus = this.times.length - KEPT;
    if (surplus > KEPT / 4) for (const list of [this.times, ...this.columns]) list.splice(0, surplus);
  }
}

// The plot of one source, or of all of them.
class Panel {
  constructor() {
    this.figure = copyOf("plot");
    this.canvas = this.figure.querySelector("canvas");
    this.plot = new Plot(this.canvas);
    this.sources = [];
    this.buttons = new Map();
    this.listen();
  }

  // Each visible curve with its place among all of the panel, which is its colour.
  *curves(all = false) {
    let number = 0;
    for (const source of this.sources) {
      for (const [place, values] of source.columns.entries()) {
        if (all || !source.hidden.has(place)) {
          yield {source, place, times: source.times, values, number};
        }
        number++;
      }
    }
  }

  // The unit of all curves that are seen, "" if they have several.
  unit() {
    const units = new Set([...this.curves()].map(({source, place}) => source.info.curves[place].unit));
    return units.size === 1 ? [...units][0] : "";
  }

  draw(view) {
    this.plot.unit = this.unit();
    if (this.sources.some((source) => source.times.length)) this.plot.draw([...this.curves()], view);
  }

  listen() {
    this.canvas.onpointermove = (event) => {
      if (event.buttons === 1 && view.paused) {
        view.end -= (event.movementX / this.plot.width) * view.window;
      }
      view.hover = this.plot.timeAt(event.offsetX, view);
    };
    this.canvas.onpointerdown = (event) => {
      view.hover = this.plot.timeAt(event.offsetX, view);
      if (view.paused) this.canvas.setPointerCapture(event.pointerId);
    };
    this.canvas.onpointerleave = () => (view.hover = null);
    this.canvas.addEventListener(
      "wheel",
      (event) => {
        event.preventDefault();
        choose(view.window * 1.15 ** Math.sign(event.deltaY));
      },
      {passive: false},
    );
  }

  // -- what is told --

  tell() {
    const {figure, sources} = this;
    say(part(figure, "name"), sources.map((source) => source.info.name).join(" "));
    const facts = [];
    const complaints = [];
    for (const {info} of sources) {
      const words = [];
      if (info.carrier) words.push(info.carrier);
      if (info.total) words.push(rate(info.rate));
      if (!info.carrier) words.push("not connected");
      if (info.others.length) words.push(`skipped, being no numbers: ${info.others.join(", ")}`);
      if (info.more) words.push(`${several(info.more, "number", "numbers")} more: --index draws others`);
      facts.push(`${sources.length > 1 ? `${info.name}: ` : ""}${words.join(" · ")}`);
      const empty = several(info.empty, "message had no number", "messages had no number");
      if (info.empty) complaints.push(`${info.name}: ${empty}. The last: ${info.complaint}`);
    }
    say(part(figure, "facts"), facts.join(" | "));
    say(part(figure, "banner"), complaints.join(" "));
    const drawn = sources.some((source) => source.times.length);
    part(figure, "hint").hidden = drawn;
    if (!drawn) say(part(figure, "says"), "Nothing came yet.");
    this.legend();
  }

  legend() {
    for (const {source, place, times, values, number} of this.curves(true)) {
      const key = `${source.info.name} ${place}`;
      let button = this.buttons.get(key);
      if (!button) {
        button = copyOf("curve");
        button.onclick = () => {
          if (!source.hidden.delete(place)) source.hidden.add(place);
          press(button, !source.hidden.has(place));
        };
        press(button, !source.hidden.has(place));
        this.buttons.set(key, button);
        part(this.figure, "curves").append(button);
      }
      const {index, label, unit} = source.info.curves[place];
      const prefix = this.sources.length > 1 ? `${source.info.name} ` : "";
      say(part(button, "label"), `${prefix}${index}${label ? ` ${label}` : ""}`);
      const line = part(button, "colour").style;
      line.borderTopColor = colour(number);
      line.borderTopStyle = dashes(number).length ? "dashed" : "solid";
      const at = view.hover === null ? lastOf(times, view) : nearest(times, values, view.hover);
      const value = at === null ? null : values[at];
      say(part(button, "value"), value === null || value === undefined ? "-" : short(value) + behind(unit));
    }
  }
}

function lastOf(times, view) {
  const at = search(times, view.end + 1e-9) - 1;
  return at < 0 ? null : at;
}

const short = (value) => (Number.isInteger(value) ? `${value}` : Number(value).toPrecision(5));

// -- the page --

let run = "";
let sources = [];
let panels = [];
let together = false;
const view = {end: 0, window: 10, low: null, high: null, hover: null, paused: false};
let clock = null; // what the program's time is ahead of ours, in seconds
let drawings = 0;

const ours = () => performance.now() / 1000;

function choose(window) {
  view.window = Math.min(Math.max(window, 0.01), 3600);
  if (document.activeElement !== byId("window")) byId("window").value = Number(view.window.toPrecision(3));
}

const limit = (id) => (byId(id).value === "" ? null : Number(byId(id).value));

function readLimits() {
  [view.low, view.high] = [limit("min"), limit("max")];
  for (const panel of panels) panel.plot.low = panel.plot.high = null;
}

function begin(status) {
  run = status.run;
  sources = [];
  clock = null;
  arrange();
  if (drawings) return; // started again: what somebody chose here stays
  choose(status.view.window ?? 10);
  byId("min").value = status.view.min ?? "";
  byId("max").value = status.view.max ?? "";
  readLimits();
}

// One plot for each source, or one for all.
function arrange() {
  const groups = together ? [sources] : sources.map((source) => [source]);
  panels = (groups.length ? groups : [[]]).map((group) => {
    const panel = new Panel();
    panel.sources = group;
    return panel;
  });
  byId("plots").replaceChildren(...panels.map((panel) => panel.figure));
  byId("together").hidden = sources.length < 2;
}

async function learn() {
  const status = await ask(`/data?after=${sources.map((source) => source.next).join(",")}`);
  if (status === null) {
    say(byId("state"), "the program does not answer");
    byId("state").classList.add("warn");
    await pause(500);
    return;
  }
  byId("state").classList.remove("warn");
  if (status.run !== run) {
    const first = run === "";
    begin(status);
    if (!first) return; // these rows are those after what another program sent
  }
  const ahead = status.now - ours();
  clock = clock === null || Math.abs(ahead - clock) > 1 ? ahead : clock + (ahead - clock) * 0.05;
  const known = sources.length;
  status.sources.forEach((info, place) => (sources[place] ??= new Source(info)).add(info));
  if (sources.length !== known) arrange();
  tellAll(status);
}

let told = 0;

function tellAll(status) {
  if (performance.now() - told < 200 && view.hover === null) return;
  told = performance.now();
  const names = sources.map((source) => source.info.name).join(" ");
  document.title = `${names || status.name} - yarpy scope`;
  if (!sources.length) {
    say(part(panels[0].figure, "says"), "Nobody sends numbers here. To change that:");
    say(part(panels[0].figure, "command"), `yarpy connect /PORT ${status.name}`);
  } else {
    for (const panel of panels) panel.tell();
  }
  const lines = [...status.waiting];
  if (status.refused) lines.push(`${several(status.refused, "message", "messages")} of more sources are not drawn`);
  const banners = lines.map((line) => {
    const banner = copyOf("banner");
    banner.textContent = line;
    return banner;
  });
  byId("banners").replaceChildren(...banners);
  const points = sources.reduce((sum, {times, columns}) => {
    return sum + (times.length - search(times, view.end - view.window)) * columns.length;
  }, 0);
  say(byId("state"), `${points} points${view.paused ? ", paused" : ""}`);
}

function hold(paused) {
  view.paused = paused;
  press(byId("pause"), paused);
}

let drawn = 0;

function redraw(now) {
  requestAnimationFrame(redraw);
  if (now - drawn < LOOK - 8 || clock === null) return;
  drawn = now;
  if (!view.paused) view.end = ours() + clock;
  for (const panel of panels) panel.draw(view);
  document.body.dataset.drawings = ++drawings;
}

byId("pause").onclick = () => hold(!view.paused);
byId("together").onclick = () => {
  together = !together;
  press(byId("together"), together);
  arrange();
};
byId("window").oninput = () => Number(byId("window").value) > 0 && choose(Number(byId("window").value));
byId("min").oninput = byId("max").oninput = readLimits;
document.addEventListener("keydown", (event) => {
  if (event.key === " " && !["BUTTON", "INPUT"].includes(event.target.tagName)) {
    event.preventDefault();
    hold(!view.paused);
  }
});

requestAnimationFrame(redraw);
for (;;) {
  const began = performance.now();
  await learn();
  await pause(document.hidden ? 1000 : Math.max(0, LOOK - (performance.now() - began)));
}
