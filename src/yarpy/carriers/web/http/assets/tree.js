// A message for people: as a tree that can be expanded, as one line, and its numbers.

const ITEMS = 100; // elements of a list that are shown
const DEEP = 12; // nested lists
const LONG = 500; // characters of a word
const LEAVES = 2000; // elements that are searched for numbers

export const isPicture = (value) => value?.type === "image" && value.width > 0 && value.height > 0;

// A value as an element; everything in it is text, whatever it looks like.
export function tree(value, depth = 0) {
  if (typeof value !== "object" || value === null) {
    const leaf = document.createElement("code");
    leaf.textContent = cut(String(value), LONG);
    leaf.className = typeof value;
    return leaf;
  }
  const entries = Array.isArray(value) ? value.map((item, at) => [at, item]) : Object.entries(value);
  const list = document.createElement("ul");
  if (depth >= DEEP) return add(list, "...", null);
  for (const [key, item] of entries.slice(0, ITEMS)) add(list, key, tree(item, depth + 1));
  if (entries.length > ITEMS) add(list, `and ${entries.length - ITEMS} more`, null);
  if (!entries.length) add(list, "nothing in it", null);
  return list;
}

function add(list, key, element) {
  const item = list.appendChild(document.createElement("li"));
  const name = item.appendChild(document.createElement("span"));
  name.textContent = cut(String(key), LONG);
  if (element) item.append(element);
  return list;
}

export const cut = (text, most) => (text.length > most ? `${text.slice(0, most)}...` : text);

// A value as one line.
export function line(value, most) {
  if (isPicture(value)) return `image ${value.width} × ${value.height} ${value.pixel}`;
  if (!Array.isArray(value)) return cut(JSON.stringify(value), most);
  return cut(value.map((item) => JSON.stringify(item)).join(" "), most);
}

// Whether a number is a time stamp: the one sensors put after their values, or one near our time.
function isTime(value, list, at, depth) {
  if (depth > 2 && list.length === 2 && at === 1 && Array.isArray(list[0])) return true;
  return Math.abs(value - Date.now() / 1000) < 86400;
}

// The numbers in a value except times, each named by the word before it, its key, or its index.
export function numbers(value) {
  const found = [];
  let place = 0;
  const look = (item, name, depth, list, at) => {
    if (place > LEAVES) return;
    if (Array.isArray(item)) {
      item.forEach((one, at) => {
        const before = item[at - 1];
        look(one, typeof before === "string" ? before : "", depth + 1, item, at);
      });
    } else if (typeof item === "object" && item !== null) {
      for (const [key, one] of Object.entries(item)) look(one, key, depth + 1, [], 0);
    } else {
      if (typeof item === "number" && !isTime(item, list, at, depth)) {
        found.push([name ? `${place} ${cut(name, 30)}` : `${place}`, item]);
      }
      place++;
    }
  };
  look(value, "", 0, [], 0);
  return found;
}
