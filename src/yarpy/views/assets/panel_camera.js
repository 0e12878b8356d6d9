// A camera of the robot: its pictures as they come, and a click on one that turns the head there.

import {copyOf, part, pause, say} from "./common.js";
import {gaze} from "./panel_joint.js";
import {call, short, url} from "./panel_port.js";

export class Camera {
  constructor(info) {
    this.figure = copyOf("camera");
    this.image = this.figure.querySelector("img");
    this.address = info.images;
    this.field = null; // of view, degrees
    say(part(this.figure, "name"), short(info.name));
    this.image.alt = `what ${info.name} sees`;
    this.image.onerror = async () => {
      await pause(1000);
      this.watch();
    };
    this.image.onclick = (event) => this.click(event);
    document.addEventListener("visibilitychange", () => this.watch());
    this.watch();
    call(info.images, "visr get fov").then((reply) => {
      if (reply[1] === "fov") this.field = reply.slice(3, 5);
    }).catch(() => {});
  }

  // A page that nobody sees costs nothing.
  watch() {
    if (document.hidden) this.image.removeAttribute("src");
    else this.image.src = `${url(this.address)}/?action=stream&now=${Date.now()}`;
  }

  tell() {
    const {naturalWidth: width, naturalHeight: height} = this.image;
    if (width) say(part(this.figure, "facts"), `${width} × ${height}`);
    this.image.classList.toggle("looks", gaze !== null && this.field !== null);
  }

  // Who clicks on something wants it in the middle.
  click(event) {
    if (gaze === null || this.field === null) return;
    const {clientWidth: wide, clientHeight: high} = this.image;
    const [x, y] = [event.offsetX / wide - 0.5, 0.5 - event.offsetY / high];
    const [right, up] = [x, y].map((share, axis) => {
      const half = Math.tan((this.field[axis] * Math.PI) / 360);
      return (Math.atan(2 * share * half) * 180) / Math.PI;
    });
    gaze(right, up);
  }
}
