// Live pictures: a port's stream of JPEG files, drawn on a canvas as fast as the browser can. A
// stream that ends, or stays silent for long, is requested again.

import {pause} from "/*/common.js";

export const OLD = 2; // seconds after which a picture is old
const LOOK = 500; // ms between looks at a stream, and between attempts
const SILENT = 10000; // ms without a picture after which a stream is asked for anew
const PROBE = 2000; // ms between questions to a port whose stream scripts may not read

export class Live {
  // screen: the element around the canvas. where(): the URL of the stream. drawn(): called when a
  // picture was drawn. wanted(): whether the picture is needed; never on a page in the background.
  constructor(screen, where, {drawn = () => {}, wanted = () => true} = {}) {
    this.canvas = screen.querySelector("canvas");
    this.where = where;
    this.drawn = drawn;
    this.asked = wanted;
    this.file = null; // the JPEG file on the screen
    this.times = []; // when pictures were drawn, ms
    this.last = null; // time of the newest
    this.image = null; // in place of the canvas
    this.stream = null; // ends the request
    this.waiting = null; // the newest file not yet drawn
    document.addEventListener("visibilitychange", () => this.look());
    setInterval(() => this.look(), LOOK);
    this.watch();
  }

  get wanted() {
    return !document.hidden && this.asked();
  }

  // Seconds since the newest picture; null before the first.
  get age() {
    return this.last === null ? null : (performance.now() - this.last) / 1000;
  }

  // Pictures per second that were drawn.
  get fps() {
    const times = this.times.filter((time) => time > performance.now() - 2000);
    return times.length > 1 ? (1000 * (times.length - 1)) / (times.at(-1) - times[0]) : 0;
  }

  get size() {
    const {image, canvas} = this;
    return image ? [image.naturalWidth, image.naturalHeight] : [canvas.width, canvas.height];
  }

  // The pixel of the picture under the pointer; null beside it.
  place(event) {
    const {clientWidth: wide, clientHeight: high} = this.image ?? this.canvas;
    const [width, height] = this.size;
    const scale = Math.min(wide / width, high / height);
    const x = Math.floor((event.offsetX - wide / 2) / scale + width / 2);
    const y = Math.floor((event.offsetY - high / 2) / scale + height / 2);
    return x >= 0 && y >= 0 && x < width && y < height ? [x, y] : null;
  }

  // End a stream that is no longer wanted, or whose sender is gone.
  look() {
    const silent = performance.now() - this.heard > SILENT;
    if (!this.wanted || this.url !== this.where() || silent) this.stream?.abort();
  }

  async watch() {
    let unread = 0; // attempts in a row that were refused without a word
    for (;;) {
      if (!this.wanted) {
        await pause(50);
        continue;
      }
      this.stream = new AbortController();
      this.url = this.where();
      this.heard = performance.now();
      try {
        const answer = await fetch(this.url, {signal: this.stream.signal});
        unread = 0;
        for await (const file of files(answer)) this.take(file);
      } catch (error) {
        if (!this.wanted) continue;
        if (!(error instanceof TypeError) || !(await this.answers())) unread = 0;
        else if (++unread > 1) await this.show();
        await pause(LOOK);
      }
    }
  }

  take(file) {
    this.heard = performance.now();
    const busy = this.waiting !== null;
    this.waiting = file;
    if (!busy) this.draw();
  }

  async draw() {
    while (this.waiting !== null && this.wanted) {
      const file = this.waiting;
      try {
        const bitmap = await createImageBitmap(new Blob([file], {type: "image/jpeg"}));
        if (this.wanted) this.paint(file, bitmap);
        bitmap.close();
      } catch {
        // a damaged file; the next one comes
      }
      if (this.waiting === file) this.waiting = null;
    }
    this.waiting = null;
  }

  paint(file, bitmap) {
    const {canvas} = this;
    if (canvas.width !== bitmap.width || canvas.height !== bitmap.height) {
      canvas.width = bitmap.width;
      canvas.height = bitmap.height;
    }
    canvas.getContext("2d").drawImage(bitmap, 0, 0);
    this.file = file;
    this.last = performance.now();
    this.times.push(this.last);
    while (this.times[0] < this.last - 2000) this.times.shift();
    this.drawn();
  }

  // -- cameras of C++, whose streams scripts of other pages may not read --

  async answers() {
    try {
      const signal = AbortSignal.timeout(PROBE);
      await fetch(new URL("/?", this.url), {mode: "no-cors", signal});
      return true;
    } catch {
      return false;
    }
  }

  // Let the browser show the stream while the port answers; it does not report the stream's end.
  async show() {
    this.image = new Image();
    this.image.alt = this.canvas.ariaLabel ?? "";
    this.image.src = this.url;
    this.canvas.after(this.image);
    this.canvas.hidden = true;
    while (this.wanted && this.url === this.where() && (await this.answers())) {
      if (this.image.naturalWidth) {
        this.last = performance.now();
        this.drawn();
      }
      await pause(LOOK);
    }
    if (this.image.naturalWidth) this.freeze();
    this.image.remove();
    this.image.src = "";
    this.image = null;
    this.canvas.hidden = false;
  }

  // Keep the last picture.
  freeze() {
    const {canvas, image} = this;
    [canvas.width, canvas.height] = [image.naturalWidth, image.naturalHeight];
    canvas.getContext("2d").drawImage(image, 0, 0);
  }
}

// The JPEG files of a stream, each as a Uint8Array.
async function* files(answer) {
  if (!answer.ok || !answer.body) throw new Error("no stream");
  const reader = answer.body.getReader();
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

// Where the header lines end, -1 if they have not arrived yet.
function headEnd(data) {
  for (let at = 0; at + 3 < data.length; at++) {
    if (data[at] === 13 && data[at + 1] === 10 && data[at + 2] === 13 && data[at + 3] === 10) {
      return at + 4;
    }
    if (at > 2000) throw new Error("no header");
  }
  return -1;
}
