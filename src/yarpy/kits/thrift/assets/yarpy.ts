// Calls of a port's service, for modules that `yarpy idl thrift --gen ts` writes: Apache Thrift's
// TBinaryProtocol over HTTP, by `fetch`.
//
// Rules: no library is needed, in a browser, in node or in any other place with `fetch`. A 64-bit
// integer is a bigint, a binary a Uint8Array. Fields that are not known are passed over.

export type Scalar = "bool" | "i8" | "i16" | "i32" | "i64" | "ui8" | "ui16" | "ui32" | "ui64"
  | "double" | "string" | "binary";
/** A type: of a container what is in it, of a struct a function that returns its class. */
export type Kind = Scalar | {list: Kind} | {set: Kind} | {map: readonly [Kind, Kind]}
  | (() => Struct);
/** A field: its name, its number, its type, and whether it has to be there. */
export type Field = readonly [name: string, number: number, kind: Kind, required?: boolean];
export interface Struct {
  new (): object;
  readonly name: string;
  readonly fields: readonly Field[];
}

/** Why a call has no result. `kind` is a number of TApplicationException, such as 1 for a method
 * that is not there; -1 if there was no answer of a service at all. */
export class Fault extends Error {
  constructor(readonly kind: number, text: string) {
    super(text);
    this.name = "Fault";
  }
}

export interface Options {
  /** Milliseconds that a call may take. */
  timeout?: number;
  /** Of each request: a web token is `{Authorization: "Bearer TOKEN"}`. */
  headers?: Record<string, string>;
}

const [BOOL, BYTE, DOUBLE, I16, I32, I64, STRING, STRUCT, MAP, SET, LIST] =
  [2, 3, 4, 6, 8, 10, 11, 12, 13, 14, 15] as const;
const SORTS: Record<Scalar, number> = {
  bool: BOOL, i8: BYTE, ui8: BYTE, i16: I16, ui16: I16, i32: I32, ui32: I32, i64: I64, ui64: I64,
  double: DOUBLE, string: STRING, binary: STRING,
};
const RANGES: Partial<Record<Scalar, readonly [number, number]>> = {
  i8: [-(2 ** 7), 2 ** 7], i16: [-(2 ** 15), 2 ** 15], i32: [-(2 ** 31), 2 ** 31],
  ui8: [0, 2 ** 8], ui16: [0, 2 ** 16], ui32: [0, 2 ** 32],
};
const [CALL, EXCEPTION, ONEWAY] = [1, 3, 4] as const;
const VERSION = 0x80010000;
const [PROTOCOL_ERROR, NO_ANSWER] = [7, -1] as const;
const DEPTH = 64;
const CONTENT = "application/x-thrift";

function sortOf(kind: Kind): number {
  if (typeof kind === "string") return SORTS[kind];
  if (typeof kind === "function") return STRUCT;
  return "list" in kind ? LIST : "set" in kind ? SET : MAP;
}

class Writer {
  private view = new DataView(new ArrayBuffer(256));
  private size = 0;

  get bytes(): Uint8Array<ArrayBuffer> {
    return new Uint8Array(this.view.buffer as ArrayBuffer, 0, this.size);
  }

  private grow(more: number): number {
    const at = this.size;
    this.size += more;
    if (this.size > this.view.byteLength) {
      const held = new Uint8Array(Math.max(this.size, 2 * this.view.byteLength));
      held.set(new Uint8Array(this.view.buffer));
      this.view = new DataView(held.buffer);
    }
    return at;
  }

  byte(value: number): void { const at = this.grow(1); this.view.setInt8(at, value); }
  i16(value: number): void { const at = this.grow(2); this.view.setInt16(at, value); }
  i32(value: number): void { const at = this.grow(4); this.view.setInt32(at, value); }
  i64(value: bigint): void { const at = this.grow(8); this.view.setBigInt64(at, value); }
  double(value: number): void { const at = this.grow(8); this.view.setFloat64(at, value); }

  blob(data: Uint8Array): void {
    this.i32(data.length);
    const at = this.grow(data.length);
    new Uint8Array(this.view.buffer).set(data, at);
  }

  fields(fields: readonly Field[], values: Record<string, unknown>, path: string): void {
    for (const [name, number, kind, required] of fields) {
      const value = values[name];
      if (value === undefined || value === null) {
        if (required) throw new TypeError(`${path}.${name} is required`);
        continue;
      }
      this.byte(sortOf(kind));
      this.i16(number);
      this.put(kind, value, `${path}.${name}`);
    }
    this.byte(0);
  }

  private put(kind: Kind, value: unknown, path: string): void {
    if (typeof kind === "string") {
      this.scalar(kind, value, path);
    } else if (typeof kind === "function") {
      this.fields(kind().fields, value as Record<string, unknown>, path);
    } else if ("map" in kind) {
      const [key, item] = kind.map;
      const pairs = [...(value as Map<unknown, unknown>)];
      this.byte(sortOf(key));
      this.byte(sortOf(item));
      this.i32(pairs.length);
      for (const [one, other] of pairs) {
        this.put(key, one, path);
        this.put(item, other, path);
      }
    } else {
      const inner = "list" in kind ? kind.list : kind.set;
      const items = [...(value as Iterable<unknown>)];
      this.byte(sortOf(inner));
      this.i32(items.length);
      items.forEach((item, at) => this.put(inner, item, `${path}[${at}]`));
    }
  }

  private scalar(kind: Scalar, value: unknown, path: string): void {
    if (kind === "bool") this.byte(value ? 1 : 0);
    else if (kind === "string") this.blob(new TextEncoder().encode(String(value)));
    else if (kind === "binary") this.blob(value as Uint8Array);
    else if (kind === "double") this.double(Number(value));
    else if (kind === "i64" || kind === "ui64") this.i64(whole(kind, value, path));
    else {
      const number = Number(value);
      const [low, high] = RANGES[kind]!;
      if (!Number.isInteger(number)) throw new TypeError(`${path}: ${value} is no integer`);
      if (number < low || number >= high) throw new RangeError(`${path}: ${number} is no ${kind}`);
      if (SORTS[kind] === BYTE) this.byte(number);
      else if (SORTS[kind] === I16) this.i16(number);
      else this.i32(number);
    }
  }
}

function whole(kind: "i64" | "ui64", value: unknown, path: string): bigint {
  const number = BigInt(value as bigint);
  const fits = kind === "i64" ? BigInt.asIntN(64, number) : BigInt.asUintN(64, number);
  if (fits !== number) throw new RangeError(`${path}: ${number} is no ${kind}`);
  return number;
}

class Reader {
  private at = 0;
  private depth = 0;
  private readonly view: DataView;

  constructor(private readonly data: Uint8Array) {
    this.view = new DataView(data.buffer, data.byteOffset, data.byteLength);
  }

  private step(size: number): number {
    const at = this.at;
    this.at += size;
    if (size < 0 || this.at > this.data.length) throw wrong("it ends too early");
    return at;
  }

  byte(): number { return this.view.getInt8(this.step(1)); }
  i16(): number { return this.view.getInt16(this.step(2)); }
  i32(): number { return this.view.getInt32(this.step(4)); }

  blob(): Uint8Array<ArrayBuffer> {
    const size = this.i32();
    const at = this.step(size);
    return this.data.slice(at, at + size) as Uint8Array<ArrayBuffer>;
  }

  text(): string { return new TextDecoder().decode(this.blob()); }

  private count(): number {
    const count = this.i32();
    if (count < 0 || count > this.data.length) throw wrong("it ends too early");
    return count;
  }

  /** Read a struct into `into`; fields that are not there keep what they have. */
  fields(fields: readonly Field[], into: Record<string, unknown>, path: string): void {
    if (++this.depth > DEPTH) throw wrong("it is nested too deeply");
    const seen = new Set<number>();
    for (let sort = this.byte(); sort !== 0; sort = this.byte()) {
      const number = this.i16();
      const field = fields.find((each) => each[1] === number);
      if (field === undefined || sortOf(field[2]) !== sort) {
        this.skip(sort);
        continue;
      }
      into[field[0]] = this.get(field[2]);
      seen.add(number);
    }
    const missed = fields.find((each) => each[3] && !seen.has(each[1]));
    if (missed) throw wrong(`${path}.${missed[0]} is required, and not there`);
    this.depth--;
  }

  private get(kind: Kind): unknown {
    if (typeof kind === "string") return this.scalar(kind);
    if (typeof kind === "function") {
      const type = kind();
      const made = new type();
      this.fields(type.fields, made as Record<string, unknown>, type.name);
      return made;
    }
    if ("map" in kind) {
      const [key, item] = kind.map;
      const sorts = [this.byte(), this.byte()];
      const count = this.count();
      if (count && (sorts[0] !== sortOf(key) || sorts[1] !== sortOf(item))) {
        throw wrong("a map of other types");
      }
      const found = new Map<unknown, unknown>();
      for (let at = 0; at < count; at++) {
        const one = this.get(key);
        found.set(one, this.get(item));
      }
      return found;
    }
    const inner = "list" in kind ? kind.list : kind.set;
    const sort = this.byte();
    const count = this.count();
    if (count && sort !== sortOf(inner)) throw wrong("a list of another type");
    const found: unknown[] = [];
    for (let at = 0; at < count; at++) found.push(this.get(inner));
    return "list" in kind ? found : new Set(found);
  }

  private scalar(kind: Scalar): unknown {
    switch (kind) {
      case "bool": return this.byte() !== 0;
      case "i8": return this.byte();
      case "ui8": return this.byte() & 0xff;
      case "i16": return this.i16();
      case "ui16": return this.i16() & 0xffff;
      case "i32": return this.i32();
      case "ui32": return this.i32() >>> 0;
      case "i64": return this.view.getBigInt64(this.step(8));
      case "ui64": return this.view.getBigUint64(this.step(8));
      case "double": return this.view.getFloat64(this.step(8));
      case "string": return this.text();
      case "binary": return this.blob();
    }
  }

  private skip(sort: number): void {
    if (sort === BOOL || sort === BYTE) this.step(1);
    else if (sort === I16) this.step(2);
    else if (sort === I32) this.step(4);
    else if (sort === I64 || sort === DOUBLE) this.step(8);
    else if (sort === STRING) this.step(this.i32());
    else if (++this.depth > DEPTH) throw wrong("it is nested too deeply");
    else {
      if (sort === STRUCT) {
        for (let inner = this.byte(); inner !== 0; inner = this.byte()) {
          this.i16();
          this.skip(inner);
        }
      } else if (sort === LIST || sort === SET || sort === MAP) {
        const sorts = sort === MAP ? [this.byte(), this.byte()] : [this.byte()];
        for (let left = this.count(); left > 0; left--) sorts.forEach((each) => this.skip(each));
      } else {
        throw wrong(`it has a value of the unknown type ${sort}`);
      }
      this.depth--;
    }
  }
}

function wrong(why: string): Fault {
  return new Fault(PROTOCOL_ERROR, `an answer that cannot be read: ${why}`);
}

const FAULT: readonly Field[] = [["message", 1, "string"], ["type", 2, "i32"]];

/** A service at a port: the base of those that are written. */
export class Client {
  readonly $url: string;
  readonly $options: Options;
  private $number = 0;

  /** `url`: where the port is, as in "http://127.0.0.1:10002". */
  constructor(url: string, options: Options = {}) {
    this.$url = url;
    this.$options = options;
  }

  /** Call a method. `answer`: the result (0) and the exceptions that it throws; null: nobody
   * answers. Throws what the method throws, and Fault. */
  protected async $call<T>(
    name: string, given: readonly Field[], values: Record<string, unknown>,
    answer: readonly Field[] | null,
  ): Promise<T> {
    const writer = new Writer();
    const number = (this.$number = (this.$number + 1) & 0x7fffffff);
    writer.i32(VERSION | (answer === null ? ONEWAY : CALL));
    writer.blob(new TextEncoder().encode(name));
    writer.i32(number);
    writer.fields(given, values, name);
    const {timeout, headers} = this.$options;
    const response = await fetch(this.$url, {
      method: "POST",
      headers: {...headers, "Content-Type": CONTENT},
      body: writer.bytes,
      ...(timeout === undefined ? {} : {signal: AbortSignal.timeout(timeout)}),
    });
    if (!response.ok) throw new Fault(NO_ANSWER, (await response.text()).trim());
    if (answer === null) return undefined as T;
    const reader = new Reader(new Uint8Array(await response.arrayBuffer()));
    const head = reader.i32();
    if ((head & ~0xff) !== (VERSION | 0)) throw wrong("it is of another protocol");
    reader.text();
    if (reader.i32() !== number) throw wrong("it belongs to another call");
    const found: Record<string, unknown> = {};
    if ((head & 0xff) === EXCEPTION) {
      reader.fields(FAULT, found, "fault");
      throw new Fault(Number(found["type"] ?? 0), String(found["message"] ?? ""));
    }
    reader.fields(answer, found, name);
    for (const [key, at] of answer) if (at !== 0 && key in found) throw found[key];
    if (answer.some((each) => each[1] === 0) && !("" in found)) {
      throw wrong(`${name} has no result`);
    }
    return found[""] as T;
  }
}
