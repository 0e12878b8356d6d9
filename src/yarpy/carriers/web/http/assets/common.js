// What the pages of programs share: asking the program, and short texts for people.

// What the program says at a path, as JSON; null when it does not answer.
export async function ask(path) {
  try {
    const answer = await fetch(path, {signal: AbortSignal.timeout(5000)});
    return answer.ok ? await answer.json() : null;
  } catch {
    return null;
  }
}

// What whoever has this page open may do with the program's port, such as ["read"]. Without an
// answer nothing is hidden; the port refuses what it must.
export const may = async () => (await ask("/*/may")) ?? ["read", "write"];

// Another port, reached as this page was: by https if that was.
export const portUrl = (host, port) => `${location.protocol}//${host}:${port}`;

export const pause = (ms) => new Promise((done) => setTimeout(done, ms));

// An element of a <template>, by its class.
export const part = (root, name) => root.querySelector(`.${name}`);

export function copyOf(template) {
  return document.getElementById(template).content.firstElementChild.cloneNode(true);
}

// Text changes only when it must, so that it can be selected.
export function say(element, text) {
  if (element.textContent !== text) element.textContent = text;
  element.hidden = text === "";
}

export function press(button, pressed) {
  button.setAttribute("aria-pressed", pressed);
}

export function save(blob, name) {
  const link = document.createElement("a");
  link.href = URL.createObjectURL(blob);
  link.download = name;
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 10000);
}

// A file name from a port's name and the time: view-left_2026-11-21_19-08-01.123
export function fileName(port) {
  const now = new Date();
  const local = new Date(now - now.getTimezoneOffset() * 60000).toISOString().slice(0, -1);
  const name = port.replace(/[^\p{L}\p{N}]+/gu, "-").replace(/^-|-$/g, "") || "port";
  return `${name}_${local.replace("T", "_").replaceAll(":", "-")}`;
}

export function seconds(time) {
  if (time < 1) return `${Math.round(time * 1000)} ms`;
  if (time < 60) return `${time.toFixed(time < 10 ? 1 : 0)} s`;
  return time < 3600 ? `${Math.floor(time / 60)} min` : `${Math.floor(time / 3600)} h`;
}

export const rate = (value) => `${value.toFixed(value < 9.95 ? 1 : 0)}/s`;

export const several = (count, one, many) => `${count} ${count === 1 ? one : many}`;
