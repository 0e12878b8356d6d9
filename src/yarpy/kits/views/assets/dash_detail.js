// What is known of the port or the connection that was chosen, and what can be done to it.

import {ask, pause, portUrl, rate, seconds} from "/*/common.js";
import {bytes, count, ms, often, short} from "./dash_word.js";

const LOOK = 500; // ms between looks at a port's messages

const make = (tag, attributes = {}, ...children) => {
  const element = document.createElement(tag);
  for (const [key, value] of Object.entries(attributes)) {
    if (key.startsWith("on")) element[key] = value;
    else if (value !== null && value !== false) element.setAttribute(key, value);
  }
  element.append(...children);
  return element;
};

// A port of this computer is where the page came from, whoever looks at it.
const here = (host) => (/^(127\.|localhost$)/.test(host) ? location.hostname : host);

export class Detail {
  // network: what is known. act(...words): does something and tells how it went. may: whether this
  // page's reader is allowed to.
  constructor(element, network, {chosen, act, may}) {
    Object.assign(this, {element, network, chosen, act, may});
    this.shown = "";
    this.facts = new Map();
    this.sparks = [];
  }

  // The choice is another, or what is known of it has changed.
  show({kind, key}) {
    const found = kind === "port" ? this.network.ports.get(key) : kind === "link" ? this.network.links.get(key) : null;
    this.element.hidden = !found;
    if (!found) {
      this.shown = "";
      return;
    }
    const peers = kind === "port" ? this.network.linksOf(key) : [];
    const shape = `${kind} ${key} ${peers.map((link) => link.key).join(" ")} ${kind === "link" ? found.carrier : found.address}`;
    if (shape !== this.shown) {
      const kept = this.element.contains(document.activeElement) && this.shown.startsWith(`${kind} ${key} `);
      if (kept && document.activeElement.tagName === "INPUT") return this.tell(kind, found, peers); // somebody types
      this.shown = shape;
      this.facts.clear();
      this.element.replaceChildren(...(kind === "port" ? this.port(found, peers) : this.link(found)));
      if (kind === "port") this.peek(found, shape);
    }
    this.tell(kind, found, peers);
  }

  title(text) {
    return make("div", {class: "title"}, make("h2", {}, text), make("button", {onclick: () => this.chosen(null, ""), "aria-label": "Close"}, "✕"));
  }

  fact(name) {
    const value = make("dd");
    this.facts.set(name, value);
    return [make("dt", {}, name), value];
  }

  tell(kind, found, peers) {
    const set = (name, text) => {
      const value = this.facts.get(name);
      if (!value) return;
      if (value.textContent !== text) value.textContent = text;
      if (value.previousElementSibling?.tagName === "DT") value.previousElementSibling.hidden = value.hidden = text === "";
    };
    if (kind === "port") {
      set("state", found.state);
      for (const link of peers) set(link.key, [short(link.carrier), link.rate ? rate(link.rate) : "", link.drops ? `${link.drops} drops` : ""].filter(Boolean).join(", "));
      return;
    }
    set("messages", count(found.messages));
    set("rate", found.rate === null ? "" : `${often(found.rate)} messages/s, ${bytes(found.speed)}/s`);
    set("latency", ms(found.latency));
    set("jitter", ms(found.jitter));
    set("replaced", count(found.replaced));
    set("drops", count(found.drops));
    set("deadlines missed", count(found.missed));
    set("thread", found.thread);
    set("packets", found.packets);
    set("monitors", found.monitors);
    for (const {canvas, key} of this.sparks) {
      canvas.parentElement.hidden = found.history[key].every((value) => value === null);
      spark(canvas, found.history[key]);
    }
  }

  // -- a port ------------------------------------------------------------------------------------

  port(port, links) {
    const [host, number] = port.address;
    const facts = make("dl", {}, ...this.fact("state"));
    if (number) {
      const page = `${portUrl(here(host), number)}/`;
      const place = `${host}:${number}`;
      facts.append(make("dt", {}, "at"), make("dd", {}, port.ours ? make("a", {href: page, target: "_blank", rel: "noreferrer"}, place) : place));
    }
    if (port.program) facts.append(make("dt", {}, "program"), make("dd", {}, port.program));
    const out = links.filter((link) => link.source === port.name);
    const into = links.filter((link) => link.target === port.name);
    return [
      this.title(port.name),
      facts,
      this.peers("Sends to", out, (link) => link.target),
      this.peers("Hears from", into, (link) => link.source),
      this.connectForm(port),
      make("section", {class: "peek"}, make("h3", {}, "Messages"), make("p", {class: "soft"}, "waiting for one ..."), make("pre", {hidden: ""}), make("img", {alt: "The newest picture", hidden: ""})),
    ];
  }

  peers(title, links, other) {
    if (!links.length) return "";
    const list = make("ul");
    for (const link of links) {
      const words = make("span");
      this.facts.set(link.key, words);
      list.append(make("li", {}, make("button", {class: "peer", onclick: () => this.chosen("link", link.key)}, make("span", {}, other(link)), words)));
    }
    return make("section", {}, make("h3", {}, title), list);
  }

  connectForm(port) {
    if (!this.may) return "";
    const target = make("input", {list: "names", placeholder: "/port", required: "", "aria-label": "The other port"});
    const carrier = make("input", {list: "carriers", placeholder: "tcp", "aria-label": "Carrier"});
    const send = (event) => {
      event.preventDefault();
      const from = event.submitter?.value === "from";
      this.act("connect", from ? target.value : port.name, from ? port.name : target.value, carrier.value);
    };
    return make("form", {onsubmit: send}, target, carrier, make("button", {value: "to"}, "Connect to"), make("button", {value: "from"}, "Connect from"));
  }

  async peek(port, shape) {
    const section = this.element.querySelector(".peek");
    const [line, text, image] = ["p", "pre", "img"].map((tag) => section.querySelector(tag));
    let last = -1;
    while (this.shown === shape) {
      if (!document.hidden) {
        const told = await ask(`/peek?${new URLSearchParams({port: port.name})}`);
        if (this.shown !== shape) return;
        const facts = told === null ? "the program of this page does not answer" : told.problem || (told.count ? [`${told.of}${count(told.count)} since you look`, told.rate ? rate(told.rate) : "", told.age > 2 ? `the last ${seconds(told.age)} ago` : ""].filter(Boolean).join(" · ") : `${told.of}none since you look`);
        line.textContent = facts;
        if (told?.count && told.count !== last) {
          last = told.count;
          image.hidden = !told.image;
          text.hidden = told.image;
          if (told.image) image.src = `/peek.jpg?${new URLSearchParams({port: port.name, n: told.count})}`;
          else if (text.textContent !== told.text && getSelection().isCollapsed) text.textContent = told.text;
        }
      }
      await pause(LOOK);
    }
  }

  // -- a connection ------------------------------------------------------------------------------

  link(link) {
    this.sparks = ["rate", "latency", "drops"].map((key) => ({key, canvas: make("canvas", {class: "spark", "aria-hidden": "true"})}));
    const names = ["messages", "rate", "latency", "jitter", "replaced", "drops", "deadlines missed", "thread", "packets", "monitors"];
    const ends = make("ul", {}, ...[link.source, link.target].map((name, at) => make("li", {}, make("button", {class: "peer", onclick: () => this.chosen("port", name)}, make("span", {}, name), make("span", {}, at ? "receives" : "sends")))));
    const parts = [this.title(`${link.source} → ${link.target}`), ends, make("dl", {}, make("dt", {}, "carrier"), make("dd", {}, link.carrier), ...names.flatMap((name) => this.fact(name)))];
    const told = {rate: "messages per second", latency: "latency", drops: "drops per second"};
    for (const {key, canvas} of this.sparks) parts.push(make("figure", {}, canvas, make("figcaption", {class: "soft"}, `${told[key]}, the last two minutes`)));
    if (this.may) parts.push(...this.linkForms(link));
    return parts;
  }

  linkForms(link) {
    const carrier = make("input", {list: "carriers", value: link.carrier, "aria-label": "Carrier"});
    const priority = make("input", {type: "number", min: 0, max: 99, placeholder: "thread 0-99", "aria-label": "Thread priority: 0 for none, 1 to 99 for real time"});
    const packets = make("select", {"aria-label": "Packet priority"}, make("option", {value: ""}, "packets"), ...["LOW", "NORM", "HIGH", "CRIT"].map((level) => make("option", {}, level)));
    const deadline = make("input", {type: "number", min: 0, step: "any", placeholder: "deadline in ms", "aria-label": "Deadline in milliseconds, 0 for none"});
    const submit = (act) => (event) => {
      event.preventDefault();
      act();
    };
    return [
      make("form", {onsubmit: submit(() => this.act("carrier", link.source, link.target, carrier.value))}, carrier, make("button", {}, "Change carrier")),
      make("form", {onsubmit: submit(() => this.act("priority", link.source, link.target, priority.value, packets.value))}, priority, packets, make("button", {}, "Set priority")),
      make("form", {onsubmit: submit(() => this.act("deadline", link.source, link.target, deadline.value))}, deadline, make("button", {}, "Set deadline")),
      make("form", {onsubmit: submit(() => this.act("disconnect", link.source, link.target))}, make("button", {}, "Disconnect")),
    ];
  }
}

// A small curve of what was measured each second; the largest value is written beside it.
function spark(canvas, values) {
  const scale = window.devicePixelRatio || 1;
  const {clientWidth: wide, clientHeight: high} = canvas;
  if (!wide) return;
  canvas.width = wide * scale;
  canvas.height = high * scale;
  const ctx = canvas.getContext("2d");
  ctx.scale(scale, scale);
  const style = getComputedStyle(document.documentElement);
  const known = values.filter((value) => value !== null);
  const most = Math.max(...known, 0);
  ctx.fillStyle = style.getPropertyValue("--soft");
  ctx.font = "11px system-ui, sans-serif";
  ctx.textAlign = "right";
  ctx.fillText(most >= 100 || most === 0 ? most.toFixed(0) : most.toPrecision(2), wide - 2, 11);
  ctx.strokeStyle = style.getPropertyValue("--line-live");
  ctx.lineWidth = 1.5;
  ctx.beginPath();
  let on = false;
  for (const [at, value] of values.entries()) {
    if (value === null) {
      on = false;
      continue;
    }
    const x = ((at + 120 - values.length) / 119) * (wide - 46);
    const y = high - 3 - (most ? value / most : 0) * (high - 8);
    if (on) ctx.lineTo(x, y);
    else ctx.moveTo(x, y);
    on = true;
  }
  ctx.stroke();
}
