// An artificial horizon: roll and pitch as a pilot sees them.

import {say} from "/*/common.js";

const RANGE = 45; // degrees of pitch from the middle to the edge

export class Horizon {
  constructor(canvas, facts) {
    this.canvas = canvas;
    this.facts = facts;
    this.angles = null; // roll, pitch, yaw in degrees
    canvas.role = "img";
    canvas.ariaLabel = "artificial horizon";
  }

  paint() {}

  draw() {
    if (this.angles === null) return;
    const [roll, pitch, yaw] = this.angles;
    const {canvas} = this;
    const scale = devicePixelRatio || 1;
    const size = canvas.clientWidth;
    if (size < 8) return; // not laid out yet
    if (canvas.width !== Math.round(size * scale)) {
      canvas.width = canvas.height = Math.round(size * scale);
    }
    const context = canvas.getContext("2d");
    const radius = size / 2 - 2;
    const middle = (size / 2) * scale;
    context.setTransform(scale, 0, 0, scale, middle, middle);
    context.clearRect(-size, -size, 2 * size, 2 * size);
    context.save();
    context.beginPath();
    context.arc(0, 0, radius, 0, 2 * Math.PI);
    context.clip();
    context.rotate((-roll * Math.PI) / 180);
    this.world(context, radius, -pitch); // a positive pitch of a frame looks down
    context.restore();
    this.wings(context, radius);
    const texts = [["roll", roll], ["pitch", -pitch], ["yaw", yaw]];
    say(this.facts, texts.map(([name, angle]) => `${name} ${angle.toFixed(1)}°`).join(" · "));
  }

  // Sky, ground, and a ladder of angles.
  world(context, radius, up) {
    const degree = radius / RANGE;
    context.translate(0, up * degree);
    context.fillStyle = "#4d9de0";
    context.fillRect(-4 * radius, -8 * radius, 8 * radius, 8 * radius);
    context.fillStyle = "#9c6b3f";
    context.fillRect(-4 * radius, 0, 8 * radius, 8 * radius);
    context.strokeStyle = context.fillStyle = "#fff";
    context.lineWidth = 1.5;
    context.font = "11px system-ui, sans-serif";
    context.textBaseline = "middle";
    for (let angle = -60; angle <= 60; angle += 10) {
      const half = radius * (angle === 0 ? 4 : angle % 20 ? 0.14 : 0.28);
      const at = -angle * degree;
      context.beginPath();
      context.moveTo(-half, at);
      context.lineTo(half, at);
      context.stroke();
      if (angle && angle % 20 === 0) context.fillText(Math.abs(angle), half + 4, at);
    }
  }

  wings(context, radius) {
    context.strokeStyle = "#ffcc33";
    context.lineWidth = 3;
    context.beginPath();
    for (const side of [-1, 1]) {
      context.moveTo(side * radius * 0.62, 0);
      context.lineTo(side * radius * 0.22, 0);
      context.lineTo(side * radius * 0.22, radius * 0.08);
    }
    context.moveTo(-1.5, 0);
    context.lineTo(1.5, 0);
    context.stroke();
  }
}
