// A sound: its shape on a canvas; with the button pressed, what comes is heard.

import {press} from "/*/common.js";
import {colour} from "/*/plot.js";
import {bytesOf} from "/look_link.js";

const LATE = 0.5; // seconds by which what is heard may lag behind before it is left out

let speaker = null; // one for the page; browsers want a click before it

export class Voice {
  constructor(canvas, button) {
    this.canvas = canvas;
    this.button = button;
    this.samples = new Int16Array(0);
    this.rate = 0;
    this.next = 0; // when what came before is over, by the clock of the speaker
    this.heard = false;
    button.onclick = () => {
      this.heard = !this.heard;
      press(button, this.heard);
      if (!this.heard) return;
      speaker ??= new AudioContext();
      speaker.resume();
      this.play();
    };
    new ResizeObserver(() => this.draw()).observe(canvas);
  }

  // What came: {rate, samples}, see media.py.
  take({rate, samples}) {
    this.samples = new Int16Array(bytesOf(samples).buffer);
    this.rate = rate;
    this.draw();
    if (this.heard) this.play();
  }

  play() {
    const {samples, rate} = this;
    // Browsers play from 3000 to 768000 samples a second.
    if (!samples.length || rate < 3000 || rate > 768000) return;
    const now = speaker.currentTime;
    if (this.next > now + LATE + samples.length / rate) return;
    const buffer = speaker.createBuffer(1, samples.length, rate);
    const values = buffer.getChannelData(0);
    for (let at = 0; at < samples.length; at++) values[at] = samples[at] / 32768;
    const source = speaker.createBufferSource();
    source.buffer = buffer;
    source.connect(speaker.destination);
    this.next = Math.max(this.next, now);
    source.start(this.next);
    this.next += buffer.duration;
  }

  draw() {
    const {canvas, samples} = this;
    const ratio = devicePixelRatio || 1;
    const [width, height] = [canvas.clientWidth, canvas.clientHeight];
    if (!width || !samples.length) return;
    canvas.width = Math.round(width * ratio);
    canvas.height = Math.round(height * ratio);
    const pen = canvas.getContext("2d");
    pen.scale(ratio, ratio);
    pen.fillStyle = colour(0);
    for (let x = 0; x < width; x++) {
      const first = Math.floor((x * samples.length) / width);
      const last = Math.max(first + 1, Math.floor(((x + 1) * samples.length) / width));
      let [low, high] = [32767, -32768];
      for (let at = first; at < last; at++) {
        low = Math.min(low, samples[at]);
        high = Math.max(high, samples[at]);
      }
      const top = (height / 2) * (1 - high / 32768);
      pen.fillRect(x, top, 1, Math.max(1, ((high - low) / 65536) * height));
    }
  }
}
