// Every connection as a line of a table, for those who sort, for small screens and for screen
// readers; ports without a connection follow.

import {say} from "/*/common.js";
import {bytes, count, ms, often, order, short} from "./dash_word.js";

const MOST = 400; // lines that are shown; the search finds the others

const COLUMNS = [
  {title: "from", of: (link) => link.source, port: true},
  {title: "to", of: (link) => link.target, port: true},
  {title: "carrier", of: (link) => short(link.carrier), wide: true},
  {title: "msg/s", of: (link) => link.rate, tell: often},
  {title: "B/s", of: (link) => link.speed, tell: bytes, wide: true},
  {title: "latency", of: (link) => link.latency, tell: ms, wide: true},
  {title: "jitter", of: (link) => link.jitter, tell: ms, wide: true},
  {title: "replaced", of: (link) => link.replaced, tell: count},
  {title: "drops", of: (link) => link.drops, tell: count, warn: (link) => link.dropping},
  {title: "missed", of: (link) => link.missed, tell: count, warn: (link) => link.missed > 0, wide: true},
  {title: "thread", of: (link) => link.thread, wide: true},
  {title: "packets", of: (link) => link.packets, wide: true},
];

export class List {
  constructor(pane, chosen) {
    this.body = pane.querySelector("tbody");
    this.more = pane.querySelector("#more");
    this.chosen = chosen;
    this.by = {column: COLUMNS[0], down: false};
    this.rows = new Map();
    this.links = [];
    this.heads(pane.querySelector("thead"));
  }

  heads(head) {
    const row = document.createElement("tr");
    for (const column of COLUMNS) {
      const cell = document.createElement("th");
      cell.scope = "col";
      const button = document.createElement("button");
      button.textContent = column.title;
      button.onclick = () => {
        const down = this.by.column === column ? !this.by.down : Boolean(column.tell);
        this.by = {column, down};
        this.show(this.links, this.selected);
      };
      cell.classList.toggle("number", Boolean(column.tell));
      cell.classList.toggle("wide", Boolean(column.wide));
      cell.append(button);
      column.head = cell;
      row.append(cell);
    }
    head.append(row);
  }

  show(links, selected) {
    this.links = links;
    this.selected = selected;
    const {column, down} = this.by;
    for (const each of COLUMNS) {
      if (each === column) each.head.setAttribute("aria-sort", down ? "descending" : "ascending");
      else each.head.removeAttribute("aria-sort");
    }
    const found = [...links].sort((a, b) => order(column.of(a), column.of(b), down));
    const shown = found.slice(0, MOST);
    const rows = shown.map((link) => this.row(link, selected));
    if (rows.length !== this.body.children.length || rows.some((row, at) => row !== this.body.children[at])) {
      this.body.replaceChildren(...rows);
    }
    const kept = new Set(shown.map((link) => link.key));
    for (const key of this.rows.keys()) if (!kept.has(key)) this.rows.delete(key);
    const left = found.length - shown.length;
    say(this.more, left ? `and ${left} more: search for what you look for` : found.length ? "" : "no connections");
  }

  row(link, selected) {
    let row = this.rows.get(link.key);
    if (!row) {
      row = document.createElement("tr");
      for (const column of COLUMNS) {
        const cell = row.insertCell();
        cell.classList.toggle("number", Boolean(column.tell));
        cell.classList.toggle("wide", Boolean(column.wide));
        if (!column.port) continue;
        const button = document.createElement("button");
        button.className = "link";
        button.onclick = (event) => {
          event.stopPropagation();
          this.chosen("port", column.of(link));
        };
        cell.append(button);
      }
      row.onclick = () => this.chosen("link", link.key);
      this.rows.set(link.key, row);
    }
    row.classList.toggle("chosen", selected.kind === "link" && selected.key === link.key);
    for (const [at, column] of COLUMNS.entries()) {
      const value = column.of(link);
      const text = column.tell ? column.tell(value) : value;
      const place = column.port ? row.cells[at].firstChild : row.cells[at];
      if (place.textContent !== text) place.textContent = text;
      if (column.warn) row.cells[at].classList.toggle("bad", column.warn(link));
    }
    return row;
  }
}
