"""Applications in TOML: the same as in XML, and every slip with its place."""

import sys
from collections.abc import Callable
from types import FrameType
from typing import Any

import pytest

from yarpy.errors import DecodeError
from yarpy.kits.launch.application.application import Need
from yarpy.kits.launch.application.toml_file import read

WHOLE = """
name = "my demo"
description = "d"
variables = { robot = "/icub", home = "$ENV{HOME}" }
needs = ["/clock"]
connections = [
    "${robot}/cam -> /view tcp+recv.priority",
    "/a -> /b",
    { from = "/c", to = "/d", carrier = "udp", id = "C1", persist = true, external = ["from"] },
]
applications = ["other.xml", { file = "x.toml", prefix = "/left" }]

[programs.robot]
command = 'yarpy sim --robot "${robot}"'
restart = "always"
delay = 0.5

[programs.view]
command = ["yarpy", "view", "a b"]
after = ["robot"]
needs = ["/x", { port = "/y", timeout = 2, request = "help", reply = "ok" }]
environment = { A = "b", N = 1 }
node = "nodeB"
workdir = "${home}"

[programs]
short = "sleep 1"
"""


def problems(text: str) -> list[str]:
    return [str(one) for one in read(text.encode(), "a.toml", {}).application.problems]


def test_everything_in_a_file() -> None:
    whole = WHOLE.replace("[programs]\nshort", "[programs.short]\ncommand")
    document = read(whole.encode(), "a.toml", {"HOME": "/home"})
    found = document.application
    assert found.problems == []
    assert (found.name, [need.port for need in found.needs]) == ("my_demo", ["/clock"])
    robot, view, short = found.modules
    assert robot.command == ["yarpy", "sim", "--robot", "/icub"]
    assert (robot.label, robot.restart, robot.delay, robot.node) == ("robot", "always", 0.5, "")
    assert view.command == ["yarpy", "view", "a b"] and view.after == ["robot"]
    assert (view.node, view.workdir) == ("/nodeB", "/home")
    assert view.environment == {"A": "b", "N": "1"}
    assert view.needs[1] == Need("/y", 2.0, "help", "ok", view.needs[1].where)
    assert short.command == ["sleep", "1"]
    one, two, three = found.connections
    assert (one.source, one.target, one.carrier) == ("/icub/cam", "/view", "tcp+recv.priority")
    assert (two.source, two.target, two.carrier) == ("/a", "/b", "")
    assert (three.carrier, three.id, three.persist) == ("udp", "C1", True)
    assert (three.source_external, three.target_external) == (True, False)
    assert [(one.name, one.prefix) for one in document.nested] == [
        ("other.xml", ""),
        ("x.toml", "/left"),
    ]
    assert (str(robot.where), str(view.where)) == ("a.toml:13:1", "a.toml:18:1")


def test_a_name_and_programs_that_are_only_commands() -> None:
    found = read(
        b"[programs]\na = 'sleep 1'\nb = ['echo', 'a b']\n", "/x/demo app.toml", {}
    ).application
    assert found.name == "demo_app"
    assert [one.command for one in found.modules] == [["sleep", "1"], ["echo", "a b"]]


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("nmae = 'x'", 'a.toml:1:1: warning: "nmae" is ignored: did you mean "name"?'),
        (
            "[programs.a]\ncommand = 'x'\nrestrat = 'no'",
            'a.toml:3:1: warning: "restrat" in [programs.a] is ignored: did you mean "restart"?',
        ),
        (
            "[programs.a]\ncommand = 'x'\nrestart = 'allways'",
            '3:1: error: "allways" is none of no, on-failure, always: did you mean "always"?',
        ),
        ("[programs.a]\nnode = 'b'", 'a.toml:1:1: error: the program "a" has no command'),
        ("[programs]\na = 1", 'a.toml:2:1: error: "a" is no table'),
        ("connections = ['/a to /b']", '1:17: error: "/a to /b" is no connection: "/a -> /b tcp"'),
        ("connections = [{ from = '/a' }]", 'a connection without "to" is left out'),
        ("connections = [7]", "a connection is"),
        ("[programs.a]\ncommand='x'\ndelay = 'long'", '3:1: error: "delay" is a number of seconds'),
        ("name = ['x']", '1:1: error: "name" is a text'),
        ("needs = [7]", "what is needed is"),
        ("applications = [7]", "an application is"),
        ("name = '${x}'", "1:1: warning: ${x} is not defined, and so is empty"),
    ],
)
def test_slips(text: str, said: str) -> None:
    found = problems(text)
    assert len(found) == 1 and said in found[0]


@pytest.mark.parametrize(
    ("data", "said"),
    [
        (b"a = 1\n[b\n", "a.toml:2:3: this is no TOML: "),
        (b"a = 1\nb =", "a.toml:2:4: this is no TOML: Invalid value before the end"),
        (b"a = 1\nb = '\xff'", "a.toml:2:6: these bytes are not utf-8"),
        (b"a = " + b"[" * 100_000, "a.toml: this is no TOML: brackets"),
        (b"#" + b"x" * (5 << 20), "a.toml: the file has more than"),
    ],
)
def test_what_is_no_file(data: bytes, said: str) -> None:
    with pytest.raises(DecodeError) as caught:
        read(data, "a.toml", {})
    assert str(caught.value).startswith(said)


@pytest.mark.parametrize("extra", ["needs = ['/p0']", "odd = 1", "after = ['p0']\nneeds = '${x}'"])
def test_a_file_twice_as_long_is_twice_the_work(extra: str) -> None:
    """A search for each program made it four times the work."""
    once, twice = work(250, extra), work(500, extra)
    assert 1.9 * once < twice < 2.1 * once


def work(count: int, extra: str) -> int:
    """Return how many lines of code it takes to read a file of so many programs and connections."""
    tables = "".join(f"[programs.p{n}]\ncommand = 'sleep {n}'\n{extra}\n" for n in range(count))
    wires = ", ".join(f"'/a{n} -> /b{n}'" for n in range(count))
    data = f"connections = [{wires}]\n{tables}".encode()
    lines = 0

    def step(frame: FrameType, event: str, value: object) -> Callable[..., Any] | None:
        nonlocal lines
        if "kits/launch/application" not in frame.f_code.co_filename.replace("\\", "/"):
            return None
        lines += event == "line"
        return step

    before = sys.gettrace()
    sys.settrace(step)
    try:
        found = read(data, "a.toml", {}).application
    finally:
        sys.settrace(before)
    assert (len(found.modules), len(found.connections)) == (count, count)
    last = found.modules[-1]
    assert last.where.line == 2 + (count - 1) * (3 + extra.count("\n"))
    assert all(need.where.line > last.where.line for need in last.needs)
    return lines
