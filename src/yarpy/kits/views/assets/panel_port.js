// How the panel talks to the ports of a robot: questions, commands, events.

import {portUrl} from "/*/common.js";

const SILENT = 10000; // ms without an event after which they are asked for anew

// Its name, and when this page last heard of its joints, which it is to move.
export const robot = {name: "", heard: null};

// The name of a part without that of its robot.
export const short = (name) => name.slice(robot.name.length + 1) || name;

// The URL of a port; one of this computer is where the page came from, whoever looks at it.
export const url = ([host, port]) => portUrl(host || location.hostname, port);

// A question to a port, with the values for what follows $. The panel's program asks it: ports let
// no page of another origin do more than read. What only asks is a page, which may be read.
export async function call([host, port], words, values = {}) {
  const question = words.replace(/\$(\w+)/g, (_, name) => values[name]);
  if (question.startsWith("get ")) {
    const asked = new URLSearchParams({host, port, question});
    return (await fetch(`/get?${asked}`, {signal: AbortSignal.timeout(5000)})).json();
  }
  const answer = await fetch("/form", {
    method: "POST",
    headers: {"Content-Type": "application/json"},
    body: JSON.stringify({admin: 1, req: ["ask", host, port, question]}),
    signal: AbortSignal.timeout(5000),
  });
  return answer.json();
}

// Every message that a port writes while somebody sees the page: told(time, values). address() is
// where the port is now. Ports of C++ send no events; `otherwise` is what to do with such a one.
export function listen(address, told, otherwise) {
  let events = null;
  let where = "";
  let heard = 0;
  let mute = ""; // where a port without events is
  const open = () => {
    events?.close();
    events = null;
    where = url(address());
    if (document.hidden || where === mute) return;
    heard = performance.now();
    const source = (events = new EventSource(`${where}/r?sse`));
    source.onmessage = (event) => {
      heard = performance.now();
      const time = Number(event.lastEventId.split(" ")[1]);
      told(time || Date.now() / 1000, JSON.parse(event.data));
    };
    source.onerror = () => {
      if (events !== source || source.readyState !== EventSource.CLOSED || !otherwise) return;
      mute = where;
      otherwise();
    };
  };
  document.addEventListener("visibilitychange", open);
  setInterval(() => {
    if (document.hidden) return;
    if (where !== url(address()) || performance.now() - heard > SILENT) open();
  }, 1000);
  open();
}
