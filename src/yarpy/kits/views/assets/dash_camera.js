// Small pictures of what the ports that carry images show just now.

import {ask, pause} from "/*/common.js";

const LOOK = 700; // ms between pictures
const MOST = 8; // ports that are looked at

export class Cameras {
  // chosen(kind, name): a picture was clicked.
  constructor(strip, chosen) {
    this.strip = strip;
    this.chosen = chosen;
    this.names = [];
    this.looking = false;
  }

  // The ports that there are. Without any there is nothing to show.
  take(ports) {
    const names = ports.filter((port) => port.image && port.light > 0).map((port) => port.name).slice(0, MOST);
    if (names.join(" ") === this.names.join(" ")) return;
    this.names = names;
    this.strip.replaceChildren(...names.map((name) => this.figure(name)));
  }

  figure(name) {
    const button = document.createElement("button");
    const image = document.createElement("img");
    const title = document.createElement("span");
    image.alt = "";
    title.textContent = name;
    button.onclick = () => this.chosen("port", name);
    button.append(image, title);
    return button;
  }

  async open() {
    this.strip.hidden = false;
    if (this.looking) return;
    this.looking = true;
    while (!this.strip.hidden) {
      if (!document.hidden) await Promise.all([...this.strip.children].map((button, at) => this.look(button, this.names[at])));
      await pause(LOOK);
    }
    this.looking = false;
  }

  async look(button, name) {
    const told = await ask(`/peek?${new URLSearchParams({port: name})}`);
    if (!told?.image || button.shown === told.count) return;
    button.shown = told.count;
    button.firstChild.src = `/peek.jpg?${new URLSearchParams({port: name, n: told.count})}`;
  }

  close() {
    this.strip.hidden = true;
  }
}
