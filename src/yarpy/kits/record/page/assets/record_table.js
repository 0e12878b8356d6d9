// The table of ports, and how numbers are written. A row changes only where its text does.

export function size(bytes) {
  const units = ["B", "kB", "MB", "GB", "TB"];
  let at = 0;
  while (bytes >= 999.5 && at < units.length - 1) {
    bytes /= 1000;
    at += 1;
  }
  return `${at && bytes < 9.995 ? bytes.toFixed(2) : at && bytes < 99.95 ? bytes.toFixed(1) : Math.round(bytes)} ${units[at]}`;
}

export function clock(seconds) {
  const two = (number) => String(Math.floor(number)).padStart(2, "0");
  return `${Math.floor(seconds / 3600)}:${two((seconds / 60) % 60)}:${two(seconds % 60)}`;
}

// Those that lose come first, then those that are waited for.
const order = (port) => (port.lost ? 0 : port.wanted && !port.there ? 1 : 2);

function rate(port, before, passed) {
  if (!port.there) return port.wanted ? "waiting" : "gone";
  if (!before || passed <= 0) return port.messages ? "" : "silent";
  const found = Math.max(0, port.messages - before.messages) / passed;
  return found < 99.95 ? found.toFixed(1) : found.toFixed(0);
}

export class Table {
  constructor(table, body) {
    this.table = table;
    this.body = body;
    this.rows = new Map();
  }

  // Shows these ports; `before` are those of `passed` seconds ago.
  show(ports, before, passed) {
    const old = new Map(before.map((port) => [port.name, port]));
    const names = new Set(ports.map((port) => port.name));
    for (const [name, row] of this.rows) {
      if (names.has(name)) continue;
      row.remove();
      this.rows.delete(name);
    }
    const sorted = [...ports].sort((one, other) => order(one) - order(other));
    sorted.forEach((port, at) => {
      const row = this.row(port.name);
      row.className = port.there ? "" : port.wanted ? "waiting" : "gone";
      const texts = [port.name, rate(port, old.get(port.name), passed), port.messages, size(port.bytes), port.lost, port.missed, port.left, port.replaced];
      texts.forEach((text, column) => {
        const cell = row.cells[column];
        if (cell.textContent !== String(text)) cell.textContent = text;
      });
      row.cells[4].classList.toggle("bad", port.lost > 0);
      if (this.body.children[at] !== row) this.body.insertBefore(row, this.body.children[at] ?? null);
    });
    this.table.classList.toggle("oddities", ports.some((port) => port.missed || port.left || port.replaced));
  }

  row(name) {
    let row = this.rows.get(name);
    if (row) return row;
    row = document.createElement("tr");
    for (let column = 0; column < 8; column += 1) {
      const cell = row.insertCell();
      if (column) cell.className = column > 4 ? "number odd" : "number";
    }
    this.rows.set(name, row);
    return row;
  }
}
