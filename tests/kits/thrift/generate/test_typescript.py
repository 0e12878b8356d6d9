"""typescript: the golden module, what has no spelling there; compiled and run against a port."""

from __future__ import annotations

import subprocess
from pathlib import Path

import pytest
from support.peer import program
from support.thrift import GOLDEN
from support.thrift_module import service
from support.wait import HANG

import yarpy
from yarpy.errors import DecodeError
from yarpy.kits.thrift.file.include import read_interface, text_interface
from yarpy.kits.thrift.generate.typescript import runtime, typescript

SHARED = """
enum Mode { AUTO, MANUAL = 7 }
struct Point { 1: i32 x = 3, 2: i64 big }
const i32 LIMIT = 640
"""
EVERY = """
include "shared.thrift"
/** A word for it. */
typedef list<shared.Point> Path
const Mode FIRST = Mode.SLOW
const map<string, i64> SIZES = {"a": 5}
const set<i8> NONE = []
const shared.Point HOME = {"x": 1}
const binary RAW = "ab"
enum Mode { SLOW, FAST }
/**
 * A robot, */
struct Robot {
  1: required string name   /** its name */
  2: Mode mode = Mode.FAST
  3: shared.Mode other
  4: optional Robot& part
  5: map<shared.Point, set<string>> places
  6: i32 width = shared.LIMIT
  7: Map odd
}
struct Map { 1: bool delete = true }
exception Strange { 1: i32 message }
service Empty { }
service Arm extends Empty {
  /** Moves. */
  Path move(1: shared.Point to, 2: double speed = 1.5, 3: Mode default) throws (1: Strange why)
  oneway void stop()
}
"""
PROGRAM = """
import {Test, All, Inner, Mode, Shape, Bad, Worse} from "./apache.js";
import {Fault} from "./yarpy.js";

function is(found: unknown, wanted: unknown): void {
  if (found !== wanted) throw new Error(`${found} is not ${wanted}`);
}
async function thrown(promise: Promise<unknown>): Promise<any> {
  return promise.then(() => { throw new Error("nothing was thrown"); }, (error) => error);
}

const test = new Test(process.argv[2]!, {timeout: 20000});
is(await test.ping(), "pong");
is(await test.add(1), 11);
is(await test.is_on(true), false);
is(await test.nothing(), undefined);
const all = new All({
  a: true, b: -5, c: -300, d: 70000, e: -(1n << 50n), f: 1.5, g: "gr\\u00fc\\u00df",
  h: new Uint8Array([0, 1]), i: [1, -2, 300000], j: new Set(["x", "y"]),
  k: new Map([["k", 1n << 40n]]), l: Mode.MANUAL, m: new Inner({x: 1, note: "n"}),
  n: [new Inner(), new Inner({x: 2})], o: new Map([[1, [0.5, 2]]]), p: new Shape({radius: 2}),
  q: [true, false], s: new Inner({x: 9}), t: 6, v: [["a"], []], w: [1, -1], y: [1n, -1n],
});
const shown = (value: unknown): string => JSON.stringify(value, (_, each) =>
  typeof each === "bigint" ? `${each}n` : each instanceof Map || each instanceof Set
    ? [...each] : each);
is(shown(await test.echo(all)), shown(all));
const numbers = await test.numbers(100000);
is(numbers.length, 100000);
is(numbers[99999], 49999.5);
const bad = await thrown(test.fail(1));
is(bad instanceof Bad && bad instanceof Error && `${bad.code} ${bad.message}`, "5 bad");
const worse = await thrown(test.fail(2));
is(worse instanceof Worse && worse.why, "worse");
const fault = await thrown(test.fail(4));
is(fault instanceof Fault && fault.kind, 6);
is((await thrown(test.missing())).kind, 5);
is((await thrown(test.add(1.5))).message, "add.a: 1.5 is no integer");
is((await thrown(test.add(2 ** 31))).message, "add.a: 2147483648 is no i32");
await test.fire("one");
is(await test.fail(0), "one");
console.log("all of it");
"""


def test_the_module_is_the_recorded_one() -> None:
    golden = (GOLDEN / "apache.ts").read_text("utf-8")
    assert typescript(read_interface(GOLDEN / "apache.thrift")) == golden


def every(folder: Path) -> str:
    (folder / "shared.thrift").write_text(SHARED)
    (folder / "every.thrift").write_text(EVERY)
    return typescript(read_interface(folder / "every.thrift"))


@pytest.mark.parametrize(
    "line",
    [
        'import * as shared from "./shared.js";',
        "/** A word for it. */",
        "export type Path = shared.Point[];",
        "export const FIRST: Mode = Mode.SLOW;",
        'export const SIZES: Map<string, bigint> = new Map([["a", 5n]]);',
        "export const NONE: Set<number> = new Set();",
        "export const HOME: shared.Point = new shared.Point({x: 1});",
        "export const RAW: Uint8Array = new Uint8Array([97, 98]);",
        "  mode: Mode = Mode.FAST;",
        "  other: shared.Mode = shared.Mode.AUTO;",
        "  part?: Robot;",
        "  places: Map<shared.Point, Set<string>> = new Map();",
        "  width: number = shared.LIMIT;",
        "  odd: Map_ = new Map_();",
        '    ["name", 1, "string", true],',
        '    ["places", 5, {map: [() => shared.Point, {set: "string"}]}],',
        "  delete: boolean = true;",
        "export class Strange {",
        "export class Empty extends yarpy.Client {",
        "  move(to: shared.Point, speed: number = 1.5, default_: Mode): Promise<Path> {",
        "  stop(): Promise<void> {",
        '    return this.$call("stop", [], {}, null);',
    ],
)
def test_everything_has_its_spelling(line: str, tmp_path: Path) -> None:
    assert line in every(tmp_path).splitlines()


@pytest.mark.parametrize(
    ("text", "why"),
    [
        ('struct V { 1: i32 x } (yarp.name = "yarp::sig::Vector")', ":1: V is a type of YARP"),
        ("struct V { 1: i32 constructor }", 'no field is called "constructor"'),
        ("service S { void constructor() }", 'no method is called "constructor"'),
    ],
)
def test_what_has_no_spelling(text: str, why: str) -> None:
    with pytest.raises(DecodeError, match=why):
        typescript(text_interface(text))


def test_documentation_ends_no_comment() -> None:
    text = typescript(text_interface("/** a */ struct A { 1: i32 x }\n// b */\nenum E { X }"))
    assert text.count("/*") == text.count("*/")


def compiled(folder: Path) -> None:
    """Compile what is in a folder, as strictly as the compiler can."""
    (folder / "yarpy.ts").write_text(runtime())
    (folder / "package.json").write_text('{"type": "module"}')
    words = ["--strict", "--noUnusedLocals", "--noImplicitOverride", "--noUncheckedIndexedAccess"]
    words += ["--target", "es2022", "--lib", "es2024,dom", "--module", "nodenext"]
    files = [str(path) for path in sorted(folder.glob("*.ts"))]
    done = subprocess.run(
        [program("tsc"), *words, *files], capture_output=True, text=True, timeout=4 * HANG
    )
    assert (done.stdout, done.returncode) == ("", 0)


@pytest.mark.peer("tsc", "node")
def test_a_compiler_takes_it(tmp_path: Path) -> None:
    (tmp_path / "every.ts").write_text(every(tmp_path))
    shared = read_interface(tmp_path / "shared.thrift")
    (tmp_path / "shared.ts").write_text(typescript(shared))
    compiled(tmp_path)
    assert (tmp_path / "every.js").exists()


@pytest.mark.peer("tsc", "node")
def test_it_calls_a_port(tmp_path: Path) -> None:
    (tmp_path / "apache.ts").write_text((GOLDEN / "apache.ts").read_text("utf-8"), "utf-8")
    globals_ = "declare const process: {argv: string[]};"
    (tmp_path / "main.ts").write_text(f"{PROGRAM}{globals_}\n")
    compiled(tmp_path)
    with yarpy.RpcServer("/test", service(), names=yarpy.LocalNames()) as server:
        done = subprocess.run(
            [program("node"), str(tmp_path / "main.js"), f"http://{server.address}"],
            capture_output=True, text=True, timeout=2 * HANG,
        )  # fmt: skip
    assert (done.stderr, done.stdout) == ("", "all of it\n")
