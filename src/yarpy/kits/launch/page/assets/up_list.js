// The tables of an application: its programs, its connections, and what may be done with each.
// Rows are made once and change only where what is told of them does, so that a button stays where
// the pointer is.

import {bytes} from "./dash_word.js";

const AT_REST = ["ended", "failed", "stopped"]; // nothing of such a program runs

export class Programs {
  // chosen(name): a row was clicked. act(word, ...names): a button was.
  constructor(body, chosen, act) {
    this.body = body;
    this.chosen = chosen;
    this.act = act;
    this.rows = new Map();
  }

  show(programs, selected) {
    this.body.closest("table").classList.toggle("alone", programs.every((one) => one.host === "here"));
    const seen = new Set(programs.map((one) => one.name));
    for (const [name, row] of this.rows) {
      if (seen.has(name)) continue;
      row.remove();
      this.rows.delete(name);
    }
    for (const one of programs) {
      const row = this.rows.get(one.name) ?? this.made(one.name);
      const [, state, host, cpu, memory, last] = row.cells;
      const rest = AT_REST.includes(one.state);
      put(state, one.restarts ? `${one.state} (${one.restarts} ×)` : one.state, one.state);
      put(host, one.host);
      put(cpu, one.cpu === null ? "" : `${one.cpu.toFixed(0)} %`);
      put(memory, bytes(one.memory));
      put(last, one.state !== "running" && one.detail ? one.detail : one.line);
      row.title = one.detail;
      const [start, again, stop] = row.querySelectorAll(".acts button");
      start.hidden = !rest;
      again.hidden = rest;
      stop.hidden = rest || one.state === "stopping";
      row.classList.toggle("chosen", one.name === selected);
    }
  }

  made(name) {
    const row = rowOf(7);
    const open = document.createElement("button");
    open.className = "link";
    open.textContent = name;
    row.cells[0].append(open);
    row.cells[2].className = "host wide";
    row.cells[3].className = "number";
    row.cells[4].className = "number wide";
    row.cells[5].className = "last wide";
    row.cells[6].className = "acts";
    for (const [word, shown] of [["start", "Start"], ["restart", "Restart"], ["stop", "Stop"]]) {
      row.cells[6].append(button(shown, `${shown} ${name}`, () => this.act(word, name)));
    }
    row.onclick = () => this.chosen(name);
    this.body.append(row);
    this.rows.set(name, row);
    return row;
  }
}

export class Links {
  constructor(body, act) {
    this.body = body;
    this.act = act;
    this.rows = new Map();
  }

  show(links) {
    this.body.closest("table").hidden = !links.length;
    const keys = new Set(links.map(keyOf));
    for (const [key, row] of this.rows) {
      if (keys.has(key)) continue;
      row.remove();
      this.rows.delete(key);
    }
    for (const one of links) {
      const row = this.rows.get(keyOf(one)) ?? this.made(one);
      put(row.cells[1], one.detail ? `${one.state}: ${one.detail}` : one.state, one.state);
      put(row.cells[2], one.carrier);
      const [connect, disconnect] = row.querySelectorAll("button");
      connect.hidden = one.state !== "off";
      disconnect.hidden = one.state === "off";
    }
  }

  made(one) {
    const row = rowOf(4);
    const name = `${one.from} → ${one.to}`;
    row.cells[0].textContent = name;
    row.cells[2].className = "wide";
    row.cells[3].className = "acts";
    for (const [word, shown] of [["connect", "Connect"], ["disconnect", "Disconnect"]]) {
      row.cells[3].append(button(shown, `${shown} ${name}`, () => this.act(word, one.from, one.to)));
    }
    this.body.append(row);
    this.rows.set(keyOf(one), row);
    return row;
  }
}

export const keyOf = ({from, to}) => `${from} ${to}`;

function rowOf(count) {
  const row = document.createElement("tr");
  for (let at = 0; at < count; at++) row.insertCell();
  return row;
}

function button(shown, label, act) {
  const made = document.createElement("button");
  made.textContent = shown;
  made.setAttribute("aria-label", label);
  made.onclick = (event) => {
    event.stopPropagation();
    act();
  };
  return made;
}

function put(cell, text, look) {
  if (cell.textContent !== text) cell.textContent = text;
  if (look !== undefined) cell.className = look;
}
