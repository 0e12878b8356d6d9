// A camera of the robot: its pictures as they come, and a click on one that turns the head there.

import {copyOf, part, rate, say, seconds} from "/*/common.js";
import {Live, OLD} from "/*/live.js";
import {gaze} from "./panel_joint.js";
import {call, short, url} from "./panel_port.js";

export class Camera {
  constructor(info) {
    this.info = info;
    this.figure = copyOf("camera");
    this.field = null; // of view, degrees
    say(part(this.figure, "name"), short(info.name));
    const screen = part(this.figure, "screen");
    const canvas = screen.querySelector("canvas");
    canvas.role = "img";
    canvas.ariaLabel = `what ${info.name} sees`;
    this.live = new Live(screen, () => `${url(this.info.images)}/?action=stream`);
    screen.onclick = (event) => this.click(event);
    this.began = performance.now();
    this.learn();
  }

  // The robot was started again, perhaps with other numbers.
  move(info) {
    this.info = info;
    if (this.field === null) this.learn();
  }

  learn() {
    call(this.info.images, "visr get fov").then((reply) => {
      if (reply[1] === "fov") this.field = reply.slice(3, 5);
    }).catch(() => {});
  }

  tell() {
    const {age, fps, size} = this.live;
    const still = age === null ? performance.now() - this.began > 1000 * OLD : age > OLD;
    const facts = [];
    if (age !== null) facts.push(size.join(" × "));
    if (!still && fps) facts.push(rate(fps));
    say(part(this.figure, "facts"), facts.join(" · "));
    const badge = age === null ? "no picture came yet" : `still for ${seconds(age)}`;
    say(part(this.figure, "badge"), still ? badge : "");
    this.figure.classList.toggle("still", still);
    part(this.figure, "screen").classList.toggle("looks", gaze !== null && this.field !== null);
  }

  // Who clicks on something wants it in the middle.
  click(event) {
    const place = this.live.place(event);
    if (gaze === null || this.field === null || place === null) return;
    const [width, height] = this.live.size;
    const [x, y] = [(place[0] + 0.5) / width - 0.5, 0.5 - (place[1] + 0.5) / height];
    const [right, up] = [x, y].map((share, axis) => {
      const half = Math.tan((this.field[axis] * Math.PI) / 360);
      return (Math.atan(2 * share * half) * 180) / Math.PI;
    });
    gaze(right, up);
  }
}
