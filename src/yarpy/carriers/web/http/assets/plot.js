// A plot: curves over time on a canvas, drawn from arrays of times and values.

const LEFT = 58;
const RIGHT = 12;
const TOP = 10;
const BOTTOM = 24;
const CALM = 0.06; // fraction by which a range shrinks per drawing
const OUTAGE = 5; // times the usual interval of messages: no line is drawn across such a gap
const HICCUP = 0.5; // seconds that a line may always bridge
const SAMPLES = 64; // intervals from which the usual one is estimated

// Colours that stay apart for most eyes, on light and on dark; a second round is dashed.
const LIGHT = ["#0072b2", "#d55e00", "#009e73", "#b5179e", "#8a6d00", "#c1121f", "#7a3ff2", "#555f6b"];
const DARK = ["#56b4e9", "#ff8c42", "#2fd6a5", "#f07ad8", "#e5c234", "#ff6b6b", "#b79bff", "#aab4c0"];
const dark = matchMedia("(prefers-color-scheme: dark)");

export const colour = (number) => (dark.matches ? DARK : LIGHT)[number % LIGHT.length];
export const dashes = (number) => (number < LIGHT.length ? [] : [6, 4]);

// A unit as written after a number.
export const behind = (unit) => (unit === "" || unit === "°" ? unit : ` ${unit}`);

// The index of the first time that is not before `time`.
export function search(times, time) {
  let low = 0;
  let high = times.length;
  while (low < high) {
    const middle = (low + high) >> 1;
    if (times[middle] < time) low = middle + 1;
    else high = middle;
  }
  return low;
}

// The longest interval that a line may bridge, judged by the messages between two places.
export function outage(times, first, last) {
  const step = Math.max(1, Math.floor((last - first - 1) / SAMPLES));
  const found = [];
  for (let at = first + 1; at < last; at += step) found.push(times[at] - times[at - 1]);
  found.sort((a, b) => a - b);
  return Math.max(HICCUP, OUTAGE * (found[found.length >> 1] ?? 0));
}

// Round numbers in a range, about `count` of them, and how many decimals they need.
export function ticks(low, high, count) {
  const rough = (high - low) / Math.max(count, 1);
  const power = 10 ** Math.floor(Math.log10(rough));
  const step = power * ([1, 2, 5].find((factor) => factor * power >= rough * 0.999) ?? 10);
  const found = [];
  for (let n = Math.ceil(low / step); n * step <= high + step * 1e-6; n++) found.push(n * step);
  return {found, decimals: Math.min(Math.max(0, -Math.floor(Math.log10(step) + 1e-9)), 15)};
}

export function written(value, decimals) {
  const size = Math.abs(value);
  if (size >= 1e6 || (size > 0 && size < 1e-4 && decimals > 5)) return value.toExponential(2);
  return (value === 0 ? 0 : value).toFixed(decimals);
}

export class Plot {
  constructor(canvas, unit = "") {
    this.canvas = canvas;
    this.unit = unit; // of the vertical axis
    this.context = canvas.getContext("2d");
    this.low = null; // the range as it is drawn
    this.high = null;
    this.style = null;
    dark.addEventListener("change", () => (this.style = null));
  }

  get width() {
    return this.canvas.clientWidth;
  }

  get height() {
    return this.canvas.clientHeight;
  }

  // The time at a distance from the left edge; null beside the curves.
  timeAt(x, view) {
    const span = this.width - LEFT - RIGHT;
    const share = (x - LEFT) / span;
    return share < 0 || share > 1 ? null : view.end - view.window * (1 - share);
  }

  // Draw `curves`, each {times, values, number}, as `view` says: {end, window, low, high, hover}.
  // Times are written as seconds before the end, or from `view.origin` on.
  draw(curves, view) {
    this.fit();
    const {context, width, height} = this;
    this.style ??= getComputedStyle(this.canvas);
    const right = width - RIGHT;
    const bottom = height - BOTTOM;
    if (right - LEFT < 20 || bottom - TOP < 20) return;
    const start = view.end - view.window;
    this.range(curves, start, view);
    const x = (time) => LEFT + ((time - start) / view.window) * (right - LEFT);
    const y = (value) => bottom - ((value - this.low) / (this.high - this.low)) * (bottom - TOP);
    context.clearRect(0, 0, width, height);
    this.grid(x, y, view, right, bottom);
    context.save();
    context.beginPath();
    context.rect(LEFT, TOP, right - LEFT, bottom - TOP);
    context.clip();
    context.lineWidth = 1.6;
    context.lineJoin = context.lineCap = "round";
    for (const curve of curves) this.curve(curve, start, view, x, y);
    context.restore();
    if (this.unit.length > 1) this.name();
    if (view.hover !== null) this.mark(curves, view, x, y, bottom);
  }

  fit() {
    const scale = devicePixelRatio || 1;
    const width = Math.round(this.width * scale);
    const height = Math.round(this.height * scale);
    if (this.canvas.width !== width || this.canvas.height !== height) {
      this.canvas.width = width;
      this.canvas.height = height;
    }
    this.context.setTransform(scale, 0, 0, scale, 0, 0);
  }

  // The visible range: grows immediately when something would be cut off, shrinks slowly.
  range(curves, start, view) {
    let low = Infinity;
    let high = -Infinity;
    for (const {times, values} of curves) {
      const last = search(times, view.end + 1e-9);
      for (let at = search(times, start); at < last; at++) {
        const value = values[at];
        if (value === null) continue;
        if (value < low) low = value;
        if (value > high) high = value;
      }
    }
    if (low > high) [low, high] = this.low === null ? [-1, 1] : [this.low, this.high];
    else {
      const room = (high - low) * 0.06 || Math.abs(high) * 0.1 || 1;
      low -= room;
      high += room;
    }
    if (this.low === null || low < this.low) this.low = low;
    else this.low += (low - this.low) * CALM;
    if (this.high === null || high > this.high) this.high = high;
    else this.high += (high - this.high) * CALM;
    if (view.low !== null) this.low = view.low;
    if (view.high !== null) this.high = view.high;
    if (!(this.high > this.low)) {
      if (view.low === null) this.low = this.high - 1;
      else this.high = this.low + 1;
    }
  }

  grid(x, y, view, right, bottom) {
    const {context} = this;
    const ink = this.style.getPropertyValue("--soft");
    const line = this.style.getPropertyValue("--line");
    context.font = `12px ${this.style.fontFamily}`;
    context.lineWidth = 1;
    context.textBaseline = "middle";
    context.textAlign = "right";
    const rows = ticks(this.low, this.high, (bottom - TOP) / 32);
    for (const value of rows.found) {
      const at = Math.round(y(value)) + 0.5;
      if (at < TOP || at > bottom) continue;
      context.strokeStyle = Math.abs(value) < 1e-12 * (this.high - this.low) ? ink : line;
      context.beginPath();
      context.moveTo(LEFT, at);
      context.lineTo(right, at);
      context.stroke();
      context.fillStyle = ink;
      context.fillText(written(value, rows.decimals) + (this.unit.length > 1 ? "" : behind(this.unit)), LEFT - 6, at);
    }
    context.strokeStyle = line;
    context.textBaseline = "top";
    const origin = view.origin ?? view.end;
    const columns = ticks(view.end - view.window - origin, view.end - origin, (right - LEFT) / 90);
    for (const age of columns.found) {
      const at = Math.round(x(origin + age)) + 0.5;
      context.beginPath();
      context.moveTo(at, TOP);
      context.lineTo(at, bottom);
      context.stroke();
      context.textAlign = at > right - 30 ? "right" : at < LEFT + 20 ? "left" : "center";
      context.fillText(`${written(age, columns.decimals)} s`, Math.min(at, right), bottom + 7);
    }
  }

  // A long unit goes to the upper end of the axis, a short one after each number.
  name() {
    const {context} = this;
    context.fillStyle = this.style.getPropertyValue("--soft");
    context.textBaseline = "top";
    context.textAlign = "left";
    context.fillText(this.unit, LEFT + 6, TOP + 2);
  }

  curve({times, values, number}, start, view, x, y) {
    const {context} = this;
    const first = Math.max(0, search(times, start) - 1);
    const last = Math.min(times.length, search(times, view.end) + 1);
    const most = outage(times, Math.max(0, last - 10 * SAMPLES), last);
    const apart = (at) => at > first && times[at] - times[at - 1] > most;
    context.strokeStyle = colour(number);
    context.setLineDash(dashes(number));
    context.beginPath();
    const scale = devicePixelRatio || 1;
    if (last - first < 3 * scale * this.width) {
      let drawing = false;
      for (let at = first; at < last; at++) {
        if (apart(at)) drawing = false;
        if (values[at] === null) drawing = false;
        else {
          const place = [x(times[at]), y(values[at])];
          if (!drawing) context.moveTo(...place);
          context.lineTo(...place); // also to itself: a message between two gaps is a dot
          drawing = true;
        }
      }
    } else {
      // More points than pixels: draw each column's first, lowest, highest and last value.
      let column = null;
      let [low, high, previous] = [0, 0, 0];
      const leave = () => {
        context.lineTo(column, y(low));
        context.lineTo(column, y(high));
        context.lineTo(column, y(previous));
      };
      for (let at = first; at < last; at++) {
        const value = values[at];
        if (column !== null && (value === null || apart(at))) {
          leave();
          column = null;
        }
        if (value === null) continue;
        const now = Math.round(x(times[at]) * scale) / scale;
        if (now !== column) {
          if (column === null) context.moveTo(now, y(value));
          else {
            leave();
            context.lineTo(now, y(value));
          }
          column = now;
          low = high = value;
        } else if (value < low) low = value;
        else if (value > high) high = value;
        previous = value;
      }
      if (column !== null) leave();
    }
    context.stroke();
    context.setLineDash([]);
  }

  mark(curves, view, x, y, bottom) {
    const {context} = this;
    const at = x(view.hover);
    context.strokeStyle = this.style.getPropertyValue("--soft");
    context.beginPath();
    context.moveTo(at, TOP);
    context.lineTo(at, bottom);
    context.stroke();
    const early = at < this.width / 2;
    context.fillStyle = this.style.getPropertyValue("--ink");
    context.textBaseline = "top";
    context.textAlign = early ? "left" : "right";
    context.fillText(`${(view.hover - (view.origin ?? view.end)).toFixed(3)} s`, at + (early ? 5 : -5), TOP);
    for (const {times, values, number} of curves) {
      const found = nearest(times, values, view.hover);
      if (found === null) continue;
      const height = y(values[found]);
      if (height < TOP || height > bottom) continue;
      context.fillStyle = colour(number);
      context.beginPath();
      context.arc(x(times[found]), height, 3.5, 0, 2 * Math.PI);
      context.fill();
    }
  }
}

// The index of the value nearest in time; null if there is none.
export function nearest(times, values, time) {
  const at = search(times, time);
  let best = null;
  for (const place of [at - 1, at]) {
    const value = values[place];
    if (value === null || value === undefined) continue;
    if (best === null || Math.abs(times[place] - time) < Math.abs(times[best] - time)) best = place;
  }
  return best;
}
