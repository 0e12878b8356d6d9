// Pictures as they come: the stream of JPEG files of each port, drawn as fast as this browser can.

import {ask, copyOf, fileName, part, pause, press, rate, save, say, seconds, several} from "./common.js";

const LOOK = 500; // ms between questions to the program
const OLD = 2; // seconds after which a picture is old

class Picture {
  constructor(index, info) {
    this.index = index;
    this.info = info;
    this.figure = copyOf("picture");
    this.canvas = this.figure.querySelector("canvas");
    this.paused = false;
    this.stream = null; // ends the request
    this.waiting = null; // the newest file that was not drawn yet
    this.shown = null; // the file on the screen
    this.times = []; // when pictures were drawn
    part(this.figure, "hold").onclick = () => this.hold(!this.paused);
    part(this.figure, "jpeg").onclick = () => {
      save(new Blob([this.shown], {type: "image/jpeg"}), `${fileName(this.info.name)}.jpg`);
    };
    part(this.figure, "png").onclick = () => {
      this.canvas.toBlob((blob) => save(blob, `${fileName(this.info.name)}.png`), "image/png");
    };
    this.clicks();
    this.watch();
  }

  // -- the stream --

  get wanted() {
    return !this.paused && !document.hidden;
  }

  hold(paused) {
    this.paused = paused;
    press(part(this.figure, "hold"), paused);
    part(this.figure, "badge").hidden = !paused;
    press(document.getElementById("pause"), pictures.every((picture) => picture.paused));
    this.look();
  }

  // Begin or end watching, as it is wanted: a page that nobody sees costs nothing.
  look() {
    if (!this.wanted) this.stream?.abort();
  }

  async watch() {
    for (;;) {
      if (!this.wanted) {
        await pause(50);
        continue;
      }
      this.stream = new AbortController();
      try {
        const where = `http://${location.hostname}:${this.info.port}/?action=stream&${this.info.wish}`;
        for await (const file of files(where, this.stream.signal)) {
          const busy = this.waiting !== null;
          this.waiting = file;
          if (!busy) this.draw();
        }
      } catch {
        await pause(this.wanted ? 500 : 0); // it is asked for again
      }
    }
  }

  async draw() {
    while (this.waiting !== null && this.wanted) {
      const file = this.waiting;
      try {
        const bitmap = await createImageBitmap(new Blob([file], {type: "image/jpeg"}));
        if (this.wanted) this.show(file, bitmap);
        bitmap.close();
      } catch {
        // a damaged file; the next one comes
      }
      if (this.waiting === file) this.waiting = null;
    }
    this.waiting = null;
  }

  show(file, bitmap) {
    const {canvas} = this;
    if (canvas.width !== bitmap.width || canvas.height !== bitmap.height) {
      canvas.width = bitmap.width;
      canvas.height = bitmap.height;
      this.figure.style.setProperty("--shape", `${bitmap.width} / ${bitmap.height}`);
    }
    canvas.getContext("2d").drawImage(bitmap, 0, 0);
    if (this.shown === null) {
      part(this.figure, "hint").hidden = true;
      for (const name of ["jpeg", "png"]) part(this.figure, name).disabled = false;
    }
    this.shown = file;
    const now = performance.now();
    this.times.push(now);
    while (this.times[0] < now - 2000) this.times.shift();
  }

  // -- what is told --

  // Pictures per second that were drawn.
  get fps() {
    const times = this.times.filter((time) => time > performance.now() - 2000);
    return times.length > 1 ? (1000 * (times.length - 1)) / (times.at(-1) - times[0]) : 0;
  }

  tell(info) {
    this.info = info;
    const figure = this.figure;
    say(part(figure, "name"), info.name);
    const facts = [];
    if (info.frames) {
      facts.push(`${info.width} × ${info.height} ${info.pixel}`);
      if (info.range) facts.push(info.range.map((value) => Number(value.toPrecision(4))).join(" … "));
      facts.push(rate(info.rate));
      if (!this.paused && this.fps < 0.8 * info.rate) facts.push(`shown ${rate(this.fps)}`);
      facts.push(`${seconds(info.age)} old`);
      facts.push(`${info.dropped} dropped`);
    }
    const sources = info.sources.map((one) => `${one.name} (${one.carrier})`);
    if (sources.length) facts.push(`from ${sources.join(", ")}`);
    say(part(figure, "facts"), facts.join(" · "));
    part(figure, "facts").classList.toggle("warn", info.frames > 0 && info.age > OLD);
    part(figure, "hold").title = pictures.length < 2 ? "Space does it too" : "";
    const others = several(info.others, "message was no picture", "messages were no pictures");
    say(part(figure, "banner"), info.others ? `${others}. The last came from ${info.complaint}` : "");
    this.canvas.classList.toggle("clicks", info.clicks);
    if (this.shown === null) this.hint(info);
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
      start = event.button === 0 && this.info.clicks ? this.place(event) : null;
      if (start) this.canvas.setPointerCapture(event.pointerId);
    };
    this.canvas.onpointerup = (event) => {
      const end = this.place(event);
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

  // The pixel of the picture under the pointer; null beside it.
  place(event) {
    const {canvas} = this;
    const scale = Math.min(canvas.clientWidth / canvas.width, canvas.clientHeight / canvas.height);
    const x = Math.floor((event.offsetX - canvas.clientWidth / 2) / scale + canvas.width / 2);
    const y = Math.floor((event.offsetY - canvas.clientHeight / 2) / scale + canvas.height / 2);
    return x >= 0 && y >= 0 && x < canvas.width && y < canvas.height ? [x, y] : null;
  }
}

// The JPEG files of a stream, each as a Uint8Array.
async function* files(url, signal) {
  const reader = (await fetch(url, {signal})).body.getReader();
  let data = new Uint8Array(0);
  async function more() {
    const {done, value} = await reader.read();
    if (done) throw new Error("the stream has ended");
    const joined = new Uint8Array(data.length + value.length);
    joined.set(data);
    joined.set(value, data.length);
    data = joined;
  }
  for (;;) {
    let head = -1;
    while ((head = headEnd(data)) < 0) await more();
    const size = Number(/content-length: *(\d+)/i.exec(ascii(data.subarray(0, head)))?.[1]);
    if (!(size > 0)) throw new Error("a part without a length");
    while (data.length < head + size) await more();
    yield data.slice(head, head + size);
    data = data.subarray(head + size);
  }
}

const ascii = (bytes) => String.fromCharCode(...bytes);

// Where the header lines end, -1 if they did not come yet.
function headEnd(data) {
  for (let at = 0; at + 3 < data.length; at++) {
    if (data[at] === 13 && data[at + 1] === 10 && data[at + 2] === 13 && data[at + 3] === 10) {
      return at + 4;
    }
    if (at > 2000) throw new Error("no header");
  }
  return -1;
}

// -- the page --

const pictures = [];

async function tell() {
  const status = await ask("/status");
  const state = document.getElementById("state");
  if (status === null) {
    say(state, "the program does not answer");
    state.classList.add("warn");
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
  say(state, `${moving} of ${several(pictures.length, "picture", "pictures")} moving`);
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
document.addEventListener("visibilitychange", () => pictures.forEach((picture) => picture.look()));

for (;;) {
  await tell();
  await pause(document.hidden ? 5 * LOOK : LOOK);
}
