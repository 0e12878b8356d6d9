// Every port that the name server knows: alive or not, whose it is, what it is connected to.

import {ask, copyOf, part, pause, portUrl, rate, say, several} from "/*/common.js";

const ROUND = 2000; // ms between questions to the server
const LINKS = 8; // connections of a port that are listed

const byId = (id) => document.getElementById(id);
const rows = new Map(); // by name
let found = {name: "", ports: [], more: 0};

// A port of this computer is where the page came from, whoever looks at it.
const here = (host) => (/^(127\.|localhost$)/.test(host) ? location.hostname : host);

const program = (port) => {
  if (!port.program) return "";
  const name = port.program.split(" ")[0].split("/").at(-1);
  const rest = port.program.split(" ").slice(1, 3).map((word) => word.split("/").at(-1));
  return `${[name, ...rest].join(" ")} (process ${port.process})`;
};

function life(port) {
  if (port.name === "fallback") return "";
  if (port.carrier === "mcast") return "a multicast group";
  if (port.alive) return "";
  if (port.alive === false) return "gone: nobody listens there; yarpy clean removes such names";
  return port.silent ?? "";
}

// What there is to tell of a port, in the words that the filter looks through.
function words(port) {
  const place = `${here(port.host)}:${port.port}`;
  if (port.name === "fallback") {
    return [place, "where programs ask for a name server by multicast when they know none (yarpy detect)"];
  }
  return [[place, program(port)].filter(Boolean).join(" · "), links(port)];
}

function links(port) {
  const all = port.links ?? [];
  const told = all.slice(0, LINKS).map(({out, peer, carrier, rate: often}) => {
    const facts = [carrier, often ? rate(often) : ""].filter(Boolean).join(", ");
    return `${out ? "→" : "←"} ${peer} (${facts})`;
  });
  if (all.length > LINKS) told.push(`and ${all.length - LINKS} more`);
  return told.join(" · ");
}

function row(port) {
  let item = rows.get(port.name);
  if (!item) {
    item = copyOf("row");
    rows.set(port.name, item);
    say(part(item, "name"), port.name);
  }
  const link = part(item, "name");
  const url = `${portUrl(here(port.host), port.port)}/`;
  if (port.carrier === "tcp" && URL.canParse(url)) link.href = url;
  else link.removeAttribute("href");
  const state = port.alive === true ? "alive" : port.alive === false ? "gone" : port.silent ? "silent" : "unknown";
  part(item, "light").className = `light ${state}`;
  part(item, "light").title = state;
  const [place, connected] = words(port);
  say(part(item, "life"), life(port));
  say(part(item, "place"), place);
  say(part(item, "links"), connected);
  return item;
}

function show() {
  const wanted = byId("filter").elements.data.value.toLowerCase().split(" ").filter(Boolean);
  const seen = found.ports.filter((port) => {
    const text = [port.name, ...words(port), life(port)].join(" ").toLowerCase();
    return wanted.every((word) => text.includes(word));
  });
  const names = new Set(found.ports.map((port) => port.name));
  for (const name of rows.keys()) if (!names.has(name)) rows.delete(name);
  const items = seen.map(row);
  const list = byId("ports");
  if (items.length !== list.children.length || items.some((item, at) => item !== list.children[at])) {
    list.replaceChildren(...items);
  }
  const alive = found.ports.filter((port) => port.alive).length;
  const facts = [several(found.ports.length + found.more, "name", "names"), `${alive} alive`];
  const gone = found.ports.filter((port) => port.alive === false).length;
  if (gone) facts.push(`${gone} gone`);
  if (wanted.length) facts.push(`${seen.length} shown`);
  if (found.more) facts.push(`the first ${found.ports.length} shown`);
  say(byId("state"), facts.join(" · "));
}

byId("filter").oninput = show;
byId("filter").onsubmit = (event) => event.preventDefault();

for (;;) {
  if (!document.hidden) {
    const told = await ask("/ports");
    byId("state").classList.toggle("warn", told === null);
    byId("ports").classList.toggle("still", told === null);
    if (told === null) say(byId("state"), "the name server does not answer");
    else {
      found = told;
      say(byId("name"), `${found.name}: name server`);
      show();
    }
  }
  await pause(rows.size && [...found.ports].some((port) => port.alive !== null) ? ROUND : ROUND / 4);
}
