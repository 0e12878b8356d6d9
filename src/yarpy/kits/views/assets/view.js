// Pictures side by side, and what there is to tell of each.

import {ask, copyOf, fileName, may, part, pause, portUrl, press, rate, save, say, seconds, several} from "/*/common.js";
import {Live, OLD} from "/*/live.js";

const LOOK = 500; // ms between questions to the program

class Picture {
  constructor(index, info) {
    this.index = index;
    this.info = info;
    this.figure = copyOf("picture");
    this.paused = false;
    const where = () => `${portUrl(location.hostname, this.info.port)}/?action=stream&${this.info.wish}`;
    const wishes = {drawn: () => this.drawn(), wanted: () => !this.paused};
    this.live = new Live(part(this.figure, "screen"), where, wishes);
    this.canvas = this.live.canvas;
    part(this.figure, "hold").onclick = () => this.hold(!this.paused);
    part(this.figure, "jpeg").onclick = () => {
      save(new Blob([this.live.file], {type: "image/jpeg"}), `${fileName(this.info.name)}.jpg`);
    };
    part(this.figure, "png").onclick = () => {
      this.canvas.toBlob((blob) => save(blob, `${fileName(this.info.name)}.png`), "image/png");
    };
    this.clicks();
  }

  hold(paused) {
    this.paused = paused;
    press(part(this.figure, "hold"), paused);
    part(this.figure, "badge").hidden = !paused;
    press(document.getElementById("pause"), pictures.every((picture) => picture.paused));
    this.live.look();
  }

  drawn() {
    const [width, height] = this.live.size;
    this.figure.style.setProperty("--shape", `${width} / ${height}`);
    part(this.figure, "hint").hidden = true;
    for (const name of ["jpeg", "png"]) part(this.figure, name).disabled = false;
  }

  // -- what is told --

  tell(info) {
    this.info = info;
    const figure = this.figure;
    say(part(figure, "name"), info.name);
    const facts = [];
    if (info.frames) {
      facts.push(`${info.width} × ${info.height} ${info.pixel}`);
      if (info.range) facts.push(info.range.map((value) => Number(value.toPrecision(4))).join(" … "));
      facts.push(rate(info.rate));
      if (!this.paused && this.live.fps < 0.8 * info.rate) facts.push(`shown ${rate(this.live.fps)}`);
      facts.push(`${seconds(info.age)} old`);
      facts.push(`${info.replaced} replaced`);
      if (info.drops) facts.push(`${info.drops} lost`);
    }
    const sources = info.sources.map((one) => `${one.name} (${one.carrier})`);
    if (sources.length) facts.push(`from ${sources.join(", ")}`);
    say(part(figure, "facts"), facts.join(" · "));
    part(figure, "hold").title = pictures.length < 2 ? "Space does it too" : "";
    const still = info.frames > 0 && info.age > OLD;
    part(figure, "facts").classList.toggle("warn", still);
    figure.classList.toggle("still", still);
    const others = several(info.others, "message was no picture", "messages were no pictures");
    const lines = [still ? this.awaited(info) : ""];
    if (info.others) lines.push(`${others}. The last came from ${info.complaint}`);
    say(part(figure, "banner"), lines.join(" ").trim());
    this.canvas.classList.toggle("clicks", info.clicks && acts);
    if (this.live.file === null) this.hint(info);
  }

  // Why the picture is an old one, and what to do.
  awaited(info) {
    const since = `This picture is ${seconds(info.age)} old.`;
    if (info.waiting) return `${since} ${info.waiting}`;
    const [source] = info.sources;
    if (source) return `${since} ${source.name} is connected, but sends nothing: is it paused or stopped?`;
    return `${since} Nobody sends pictures here: yarpy connect /CAMERA ${info.name}`;
  }

  hint(info) {
    let text = "No picture came yet.";
    let command = "";
    if (info.waiting) text = info.waiting;
    else if (!info.sources.length) {
      text = "Nobody sends pictures here. To change that:";
      command = `yarpy connect /CAMERA ${info.name}`;
    } else if (info.frames) text = "One moment ...";
    say(part(this.figure, "says"), text);
    say(part(this.figure, "command"), command);
  }

  // -- clicks --

  clicks() {
    let start = null;
    this.canvas.onpointerdown = (event) => {
      start = event.button === 0 && this.info.clicks && acts ? this.live.place(event) : null;
      held = start !== null;
      if (held) this.canvas.setPointerCapture(event.pointerId);
    };
    this.canvas.onlostpointercapture = () => (held = false);
    this.canvas.onpointerup = (event) => {
      const end = this.live.place(event);
      if (!start || !end) return;
      const same = start[0] === end[0] && start[1] === end[1];
      const click = ["click", this.index, ...start, ...(same ? [] : end)];
      start = null;
      fetch("/form", {
        method: "POST",
        headers: {"Content-Type": "application/json"},
        body: JSON.stringify({admin: 1, req: click}),
      });
    };
  }
}

// -- the page --

const pictures = [];
let held = false; // a pointer is down on a picture, which stays where it is: text may move it
const acts = (await may()).includes("write"); // whether clicks may be sent

async function tell() {
  const status = await ask("/status");
  if (held) return;
  const state = document.getElementById("state");
  if (status === null) {
    say(state, "the program does not answer");
    state.classList.add("warn");
    for (const picture of pictures) picture.figure.classList.add("still");
    return;
  }
  state.classList.remove("warn");
  status.pictures.forEach((info, index) => {
    info.wish = status.wish;
    if (!pictures[index]) {
      pictures[index] = new Picture(index, info);
      document.getElementById("pictures").append(pictures[index].figure);
    }
    pictures[index].tell(info);
  });
  const names = status.pictures.map((info) => info.name).join(" ");
  document.title = `${names} - yarpy view`;
  document.getElementById("pause").hidden = pictures.length < 2;
  const moving = status.pictures.filter((info) => info.rate > 0).length;
  const readOnly = !acts && status.pictures.some((info) => info.clicks) ? " · read only: clicks are not sent" : "";
  say(state, `${moving} of ${several(pictures.length, "picture", "pictures")} moving${readOnly}`);
}

function holdAll() {
  const paused = !pictures.every((picture) => picture.paused);
  for (const picture of pictures) picture.hold(paused);
}

document.getElementById("pause").onclick = holdAll;
document.addEventListener("keydown", (event) => {
  if (event.key === " " && event.target.tagName !== "BUTTON") {
    event.preventDefault();
    holdAll();
  }
});

for (;;) {
  await tell();
  await pause(document.hidden ? 5 * LOOK : LOOK);
}
