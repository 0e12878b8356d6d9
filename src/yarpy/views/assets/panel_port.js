// How the panel talks to the ports of a robot: questions, commands, events.

// Its name, and when this page last heard of its joints or sensors.
export const robot = {name: "", heard: null};

// The name of a part without that of its robot.
export const short = (name) => name.slice(robot.name.length + 1) || name;

// The URL of a port; one of this computer is where the page came from, whoever looks at it.
export const url = ([host, port]) => `http://${host || location.hostname}:${port}`;

// A question to a port: the words are the message, what follows $ is filled in by the port.
export async function call(address, words, values = {}) {
  const query = new URLSearchParams({req: words, ...values});
  const answer = await fetch(`${url(address)}/?${query}`, {signal: AbortSignal.timeout(5000)});
  return answer.json();
}

// Every message that a port writes while somebody sees the page: told(time, values). Ports of C++
// send no events; `otherwise` is what to do then.
export function listen(address, told, otherwise) {
  let events = null;
  const look = () => {
    events?.close();
    if (document.hidden) return;
    events = new EventSource(`${url(address)}/r?sse`);
    events.onmessage = (event) => {
      const time = Number(event.lastEventId.split(" ")[1]);
      told(time || Date.now() / 1000, JSON.parse(event.data));
    };
    events.onerror = () => {
      if (events.readyState !== EventSource.CLOSED || !otherwise) return;
      document.removeEventListener("visibilitychange", look);
      otherwise();
    };
  };
  document.addEventListener("visibilitychange", look);
  look();
}
