// A client of the protocol of Foxglove: channels, subscriptions, playing.

const SECOND = 1000000000;
const STATES = ["playing", "paused", "buffering", "ended"];

// Calls, each if it is there: info(serverInfo), channels(list), message(channel, time, bytes),
// time(t), state({state, time, speed, jumped, request}), status(text), closed(). Times are BigInt,
// in ns; `request` is the number of the wish that is answered.
export class Link {
  constructor(url, calls) {
    this.calls = calls;
    this.channels = new Map();
    this.subscriptions = new Map(); // channels by the numbers of subscriptions
    this.number = 0;
    this.socket = new WebSocket(url, ["foxglove.sdk.v1", "foxglove.websocket.v1"]);
    this.socket.binaryType = "arraybuffer";
    this.socket.onmessage = ({data}) => (typeof data === "string" ? this.text(JSON.parse(data)) : this.binary(data));
    this.socket.onclose = () => this.calls.closed?.();
  }

  text(said) {
    if (said.op === "serverInfo") this.calls.info?.(said);
    else if (said.op === "advertise") {
      for (const one of said.channels) this.channels.set(one.topic, one);
      this.calls.channels?.(said.channels);
    } else if (said.op === "status") this.calls.status?.(said.message);
  }

  binary(data) {
    const view = new DataView(data);
    const kind = view.getUint8(0);
    if (kind === 1) {
      const channel = this.subscriptions.get(view.getUint32(1, true));
      if (channel) this.calls.message?.(channel, view.getBigUint64(5, true), new Uint8Array(data, 13));
    } else if (kind === 2) this.calls.time?.(view.getBigUint64(1, true));
    else if (kind === 5) {
      this.calls.state?.({
        state: STATES[view.getUint8(1)],
        time: view.getBigUint64(2, true),
        speed: view.getFloat32(10, true),
        jumped: view.getUint8(14) === 1,
        request: Number(new TextDecoder().decode(new Uint8Array(data, 19))),
      });
    }
  }

  // Listen to a topic; returns what ends that, null if there is no such topic.
  subscribe(topic) {
    const channel = this.channels.get(topic);
    if (!channel) return null;
    const id = ++this.number;
    this.subscriptions.set(id, channel);
    this.order({op: "subscribe", subscriptions: [{id, channelId: channel.id}]});
    return () => {
      this.subscriptions.delete(id);
      this.order({op: "unsubscribe", subscriptionIds: [id]});
    };
  }

  order(what) {
    if (this.socket.readyState === WebSocket.OPEN) this.socket.send(JSON.stringify(what));
  }

  // Let time stand still or go on, from `seek` (BigInt, or null: from where it is). `request` is a
  // number that the answer has, too.
  control(paused, speed, seek = null, request = 0) {
    if (this.socket.readyState !== WebSocket.OPEN) return;
    const name = new TextEncoder().encode(String(request));
    const bytes = new Uint8Array(19 + name.length);
    const view = new DataView(bytes.buffer);
    view.setUint8(0, 3);
    view.setUint8(1, paused ? 1 : 0);
    view.setFloat32(2, speed, true);
    view.setUint8(6, seek === null ? 0 : 1);
    view.setBigUint64(7, seek ?? 0n, true);
    view.setUint32(15, name.length, true);
    bytes.set(name, 19);
    this.socket.send(bytes);
  }
}

// Seconds between two moments in nanoseconds, and the moment so many seconds later.
export const since = (time, origin) => Number(time - origin) / SECOND;
export const after = (origin, seconds) => origin + BigInt(Math.round(seconds * SECOND));

// The bytes of a text in base64.
export const bytesOf = (text) => Uint8Array.from(atob(text), (letter) => letter.charCodeAt(0));

// The picture in a foxglove.CompressedImage: field 2 of a message of protobuf, null if there is none.
export function pictureOf(bytes) {
  let at = 0;
  const varint = () => {
    let value = 0;
    for (let shift = 1; at < bytes.length; shift *= 128) {
      const byte = bytes[at++];
      value += (byte & 127) * shift;
      if (byte < 128) break;
    }
    return value;
  };
  while (at < bytes.length) {
    const key = varint();
    if ((key & 7) === 2) {
      const size = varint();
      if (key >> 3 === 2) return bytes.subarray(at, at + size);
      at += size;
    } else if ((key & 7) === 0) varint();
    else at += (key & 7) === 1 ? 8 : 4;
  }
  return null;
}
