// The interface apache, written by `yarpy idl thrift --gen ts`.

import * as yarpy from "./yarpy.js";

export const Mode = {
  AUTO: 0,
  MANUAL: 7,
} as const;
export type Mode = (typeof Mode)[keyof typeof Mode];

export class Inner {
  x: number = 3;
  note?: string;
  static readonly fields: readonly yarpy.Field[] = [
    ["x", 1, "i32"],
    ["note", 2, "string"],
  ];
  constructor(values: Partial<Inner> = {}) {
    Object.assign(this, values);
  }
}

export class Shape {
  side?: number;
  radius?: number;
  static readonly fields: readonly yarpy.Field[] = [
    ["side", 1, "i32"],
    ["radius", 2, "double"],
  ];
  constructor(values: Partial<Shape> = {}) {
    Object.assign(this, values);
  }
}

export class Bad extends Error {
  code: number = 0;
  override message: string = "";
  static readonly fields: readonly yarpy.Field[] = [
    ["code", 1, "i32"],
    ["message", 2, "string"],
  ];
  constructor(values: Partial<Bad> = {}) {
    super();
    Object.assign(this, values);
  }
}

export class Worse extends Error {
  why: string = "";
  static readonly fields: readonly yarpy.Field[] = [
    ["why", 1, "string"],
  ];
  constructor(values: Partial<Worse> = {}) {
    super();
    Object.assign(this, values);
  }
}

export class All {
  a: boolean = false;
  b: number = 0;
  c: number = 0;
  d: number = 0;
  e: bigint = 0n;
  f: number = 0;
  g: string = "";
  h: Uint8Array = new Uint8Array();
  i: number[] = [];
  j: Set<string> = new Set();
  k: Map<string, bigint> = new Map();
  l: Mode = Mode.AUTO;
  m: Inner = new Inner();
  n: Inner[] = [];
  o: Map<number, number[]> = new Map();
  p: Shape = new Shape();
  q: boolean[] = [];
  r?: number;
  s?: Inner;
  t: number = 5;
  u: Mode[] = [];
  v: string[][] = [];
  w: number[] = [];
  y: bigint[] = [];
  static readonly fields: readonly yarpy.Field[] = [
    ["a", 1, "bool"],
    ["b", 2, "i8"],
    ["c", 3, "i16"],
    ["d", 4, "i32"],
    ["e", 5, "i64"],
    ["f", 6, "double"],
    ["g", 7, "string"],
    ["h", 8, "binary"],
    ["i", 9, {list: "i32"}],
    ["j", 10, {set: "string"}],
    ["k", 11, {map: ["string", "i64"]}],
    ["l", 12, "i32"],
    ["m", 13, () => Inner],
    ["n", 14, {list: () => Inner}],
    ["o", 15, {map: ["i32", {list: "double"}]}],
    ["p", 16, () => Shape],
    ["q", 17, {list: "bool"}],
    ["r", 18, "i32"],
    ["s", 19, () => Inner],
    ["t", 40, "i16", true],
    ["u", 21, {list: "i32"}],
    ["v", 22, {list: {list: "string"}}],
    ["w", 23, {list: "i8"}],
    ["y", 24, {list: "i64"}],
  ];
  constructor(values: Partial<All> = {}) {
    Object.assign(this, values);
  }
}

export class Base extends yarpy.Client {
  ping(): Promise<string> {
    return this.$call("ping", [], {}, [["", 0, "string"]]);
  }
}

export class Test extends Base {
  echo(all: All): Promise<All> {
    return this.$call("echo", [["all", 1, () => All]], {all}, [["", 0, () => All], ["bad", 1, () => Bad]]);
  }
  add(a: number, b: number = 10): Promise<number> {
    return this.$call("add", [["a", 1, "i32"], ["b", 2, "i32"]], {a, b}, [["", 0, "i32"]]);
  }
  is_on(value: boolean): Promise<boolean> {
    return this.$call("is_on", [["value", 3, "bool"]], {value}, [["", 0, "bool"]]);
  }
  nothing(): Promise<void> {
    return this.$call("nothing", [], {}, []);
  }
  fire(what: string): Promise<void> {
    return this.$call("fire", [["what", 1, "string"]], {what}, null);
  }
  fail(how: number): Promise<string> {
    return this.$call("fail", [["how", 1, "i32"]], {how}, [["", 0, "string"], ["bad", 1, () => Bad], ["worse", 4, () => Worse]]);
  }
  missing(): Promise<string> {
    return this.$call("missing", [], {}, [["", 0, "string"]]);
  }
  numbers(count: number): Promise<number[]> {
    return this.$call("numbers", [["count", 1, "i32"]], {count}, [["", 0, {list: "double"}]]);
  }
}
