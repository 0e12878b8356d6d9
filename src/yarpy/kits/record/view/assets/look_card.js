// What a port said at the cursor: its picture, its points in space, its sound, its numbers as curves,
// the message as text.

import {ask, copyOf, fileName, part, save, say} from "/*/common.js";
import {Plot, colour} from "/*/plot.js";
import {query} from "/look_beside.js";
import {Cloud} from "/look_cloud.js";
import {pictureOf} from "/look_link.js";
import {Voice} from "/look_sound.js";

const WAIT = 120; // ms until curves are asked for again

// A card of `port` {name, kind}; `close` is called when it is to go.
export class Card {
  constructor(port, close) {
    this.port = port;
    this.figure = copyOf("card");
    this.canvas = part(this.figure, "curves");
    this.image = part(this.figure, "picture");
    this.plot = new Plot(this.canvas);
    this.curves = [];
    this.asked = ""; // the question that was answered
    this.timer = null;
    say(part(this.figure, "name"), port.name);
    part(this.figure, "close").onclick = close;
    part(this.figure, "save").onclick = () => this.jpeg && save(this.jpeg, `${fileName(port.name)}.jpg`);
    this.image.alt = `The picture of ${port.name}`;
    this.clear();
  }

  get pictured() {
    return this.port.kind === "yarp/image";
  }

  // A message of the port, as it came over the connection; `time` in seconds.
  take(bytes, time) {
    this.stale = false;
    if (this.pictured) {
      const found = pictureOf(bytes);
      say(part(this.figure, "facts"), found?.length ? `${time.toFixed(3)} s` : "a picture that cannot be shown");
      if (!found?.length) return;
      this.jpeg = new Blob([found], {type: "image/jpeg"});
      const before = this.image.src;
      this.image.src = URL.createObjectURL(this.jpeg);
      if (before) URL.revokeObjectURL(before);
      this.image.hidden = part(this.figure, "save").hidden = false;
      return;
    }
    const said = JSON.parse(new TextDecoder().decode(bytes));
    const number = said.envelope ? `number ${said.envelope.split(" ")[0]}, ` : "";
    say(part(this.figure, "facts"), `${number}${time.toFixed(3)} s`);
    this.values = said.v;
    if (said.log) this.lines(time);
    else say(part(this.figure, "text"), said.text);
    this.legend(said.names);
    this.points(said.cloud);
    this.sounds(said.sound);
  }

  // The lines of a log until the moment that is shown, however one came there.
  lines(time) {
    this.moment = time;
    clearTimeout(this.reading);
    this.reading = setTimeout(async () => {
      // A line is asked for by its own time, of which a double has not every nanosecond.
      const words = {port: this.port.name, origin: String(this.origin), end: (time + 1e-6).toFixed(6)};
      const found = await ask(`/log?${query(words)}`);
      if (!found || this.moment !== time) return;
      const text = part(this.figure, "text");
      say(text, found.map((one) => `${one.t.toFixed(3)} ${one.level} ${one.from}: ${one.text}`).join("\n"));
      text.scrollTop = text.scrollHeight;
    }, this.origin === undefined ? WAIT : 0);
  }

  // The names of numbers, in the colours of their curves, with what they are at the cursor.
  legend(names) {
    const list = part(this.figure, "legend");
    list.hidden = !names?.length;
    if (list.hidden) return;
    while (list.children.length > names.length) list.lastElementChild.remove();
    names.forEach((name, number) => {
      const row = list.children[number] ?? list.appendChild(document.createElement("li"));
      row.style.color = colour(number);
      const value = this.values?.[number];
      say(row, `${name || number} ${value === null || value === undefined ? "" : Number(value.toPrecision(6))}`);
    });
  }

  points(found) {
    const canvas = part(this.figure, "space");
    canvas.hidden = !found;
    if (!found) return;
    this.cloud ??= new Cloud(canvas);
    canvas.setAttribute("aria-label", `${found.of} points of ${this.port.name}: a drag turns them, the wheel zooms`);
    this.cloud.take(found);
  }

  sounds(found) {
    const [canvas, button] = [part(this.figure, "wave"), part(this.figure, "hear")];
    canvas.hidden = button.hidden = !found;
    if (!found) return;
    this.voice ??= new Voice(canvas, button);
    this.voice.take(found);
  }

  // Nothing came before the cursor.
  clear() {
    this.stale = false;
    this.jpeg = null;
    this.image.hidden = part(this.figure, "save").hidden = true;
    for (const name of ["space", "wave", "hear"]) part(this.figure, name).hidden = true;
    this.moment = null;
    this.legend(null);
    say(part(this.figure, "facts"), "nothing came until here");
    say(part(this.figure, "text"), "");
  }

  // Draw the curves of what the time line shows; ask for them if that has changed.
  show(view, cursor, origin) {
    this.origin = origin;
    if (this.pictured) return;
    const question = `/curve?${query({
      port: this.port.name,
      origin: String(origin),
      begin: view.start.toFixed(6),
      end: (view.start + view.length + 2e-6).toFixed(6), // with the last message
      points: String(Math.round(Math.max(this.canvas.clientWidth, 300))),
    })}`;
    if (question !== this.wanted) {
      this.wanted = question;
      clearTimeout(this.timer);
      this.timer = setTimeout(() => this.ask(question), this.asked ? WAIT : 0);
      const file = part(this.figure, "file");
      file.href = question.replace("/curve?", "/data.csv?");
      file.download = `${fileName(this.port.name)}.csv`;
      say(file, "CSV");
    }
    if (!this.curves.length) return;
    const within = cursor >= view.start && cursor <= view.start + view.length;
    this.plot.draw(this.curves, {
      end: view.start + view.length,
      window: view.length,
      origin: 0,
      low: null,
      high: null,
      hover: within ? cursor : null,
    });
  }

  async ask(question) {
    const found = await ask(question);
    if (!found || question !== this.wanted) return;
    this.asked = question;
    this.curves = found.columns.map((values, number) => ({times: found.times, values, number}));
    this.canvas.hidden = !this.curves.length;
    const thin = found.every > 1 ? `every ${found.every}th of ${found.of} messages is drawn` : "";
    this.canvas.title = thin;
    this.plot.low = this.plot.high = null;
    this.drawn?.();
  }
}
