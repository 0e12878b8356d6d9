"""Python scripts: every callback by either name, as functions or a class, and their errors."""

from __future__ import annotations

import re
import sys
from pathlib import Path

import pytest

from yarpy.data.bottle import Bottle, Property
from yarpy.errors import YarpError
from yarpy.monitors.base import DROP
from yarpy.monitors.event import Events
from yarpy.monitors.script.control import Control
from yarpy.monitors.script.python import PythonScript
from yarpy.monitors.script.script import ScriptError
from yarpy.wire.message import DATA, Message

PATH = Path("/nowhere/gate.py")


def load(text: str, events: Events | None = None) -> PythonScript:
    return PythonScript(PATH, text.encode(), Control(events=events or Events()))


def modules() -> set[str]:
    return {name for name in sys.modules if name.startswith("yarpy_portmonitor")}


def message(*values: object) -> Message:
    return Message(DATA, Bottle(values).to_bytes(), "3 0.5")


FUNCTIONS = """
from __future__ import annotations
import dataclasses
from yarpy.monitors import DROP

@dataclasses.dataclass
class Memory:
    seen: list[str]

memory = Memory([])

def create(options):
    memory.seen.append(f"create {{options['source']}}")

def {accept}(message):
    return message.value[0] != "drop"

def {update}(message):
    return [*message.value, "seen"]

def {update_reply}(message):
    return DROP if message.value == ["no"] else None

def trig():
    memory.seen.append("trig")

def {setparam}(parameters):
    memory.seen.append(parameters["level"])

def {getparam}():
    return {{"seen": memory.seen}}

def destroy():
    print("destroyed")
"""
OURS = {n: n for n in ("accept", "update", "update_reply", "setparam", "getparam")}
CPP_4 = {"accept": "acceptData", "update": "updateData", "update_reply": "updateReply",
         "setparam": "setParams", "getparam": "getParams"}  # fmt: skip
KLASS = """
class Monitor:
    def __init__(self):
        self.count = 0

    def accept(self, message):
        self.count += 1
        return self.count % 2 == 0

    def getparam(self):
        return {"count": self.count}
"""


@pytest.mark.parametrize("names", [OURS, CPP_4], ids=["ours", "C++ 4"])
def test_functions(names: dict[str, str], capsys: pytest.CaptureFixture[str]) -> None:
    before = modules()
    script = load(FUNCTIONS.format(**names))
    assert script.create(Property(source="/a"))
    assert [script.accept(message("hi")), script.accept(message("drop"))] == [True, False]
    assert script.update(message("hi")) == ["hi", "seen"]
    assert script.update_reply(message("no")) is DROP
    assert script.update_reply(message("yes")) is None
    script.trigger()
    script.configure(Property(level=5))
    assert script.parameters() == {"seen": ["create /a", "trig", 5]}
    script.close()
    assert capsys.readouterr().out == "destroyed\n"
    assert modules() == before


def test_class() -> None:
    first, second = load(KLASS), load(KLASS)
    assert [first.accept(message()) for _ in range(3)] == [False, True, False]
    assert (first.parameters(), second.parameters()) == ({"count": 3}, {"count": 0})


def test_script_without_callbacks_does_nothing() -> None:
    script = load("x = 1")
    assert script.create(Property())
    assert script.accept(message("hi"))
    assert script.update(message("hi")) is None
    assert script.update_reply(message("hi")) is None
    script.trigger()
    script.configure(Property())
    assert script.parameters() == {}
    script.close()


@pytest.mark.parametrize(
    ("body", "fine"),
    [
        ("def create(): pass", True),
        ("def create(options): return False", False),
        ("def create(*arguments): return len(arguments) == 1", True),
        ("create = dict", True),
        ("def create(options, extra=1): return extra == 1", True),
    ],
)
def test_create_takes_what_it_likes(body: str, fine: bool) -> None:
    assert load(body).create(Property(source="/a")) is fine


def test_parameters_may_be_filled_in() -> None:
    assert load("def getParams(p): p['gain'] = 3").parameters() == {"gain": 3}
    assert load("def getparam(): return None").parameters() == {}


@pytest.mark.parametrize("result", ["5", "'text'", "[1, 2]", "{'a': object()}", "{1: 2}"])
def test_parameters_that_no_message_can_hold(result: str) -> None:
    with pytest.raises(ScriptError, match="getparam returns no dict"):
        load(f"def getparam(): return {result}").parameters()


def test_events_and_constraint_of_a_script() -> None:
    events = Events()
    script = load("def accept(message): portmonitor.set_event('e'); return True", events)
    script.accept(message())
    assert events.has("e")
    load("def trig(): PortMonitor.setEvent('f', 10)", events).trigger()
    assert events.has("f")


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("def accept(message)\n  pass", f"{PATH}:1: SyntaxError: "),
        ("import nosuchmodule", f"{PATH}:1: ModuleNotFoundError: "),
        ("x = 1\n\ny = 1 / 0", f"{PATH}:3: ZeroDivisionError: "),
        ("class Monitor:\n  def __init__(self):\n    raise OSError('x')", "gate.py:3: OSError: x"),
        ("\0", str(PATH)),
        ("\u00e9 = (", f"{PATH}:1: SyntaxError"),
    ],
)
def test_file_that_cannot_run_names_its_line(text: str, expected: str) -> None:
    before = modules()
    with pytest.raises(ScriptError) as caught:
        load(text)
    assert expected in str(caught.value)
    assert isinstance(caught.value, YarpError)
    assert modules() == before


@pytest.mark.parametrize("callback", ["accept", "update", "update_reply", "setparam"])
def test_callback_that_fails_names_its_line(callback: str) -> None:
    script = load(
        f"def {callback}(x):\n    return inner(x)\n\ndef inner(x):\n    return x.nosuch\n"
    )
    call = {"setparam": script.configure}.get(callback) or getattr(script, callback)
    with pytest.raises(ScriptError, match=f"^{re.escape(str(PATH))}:5: AttributeError: "):
        call(message("hi"))


@pytest.mark.parametrize("callback", ["accept", "update", "update_reply", "setparam"])
def test_callback_cannot_end_the_program(callback: str) -> None:
    script = load(f"import sys\ndef {callback}(x):\n    sys.exit('odd')\n")
    call = {"setparam": script.configure}.get(callback) or getattr(script, callback)
    with pytest.raises(ScriptError, match=f"^{re.escape(str(PATH))}:3: SystemExit: odd"):
        call(message("hi"))


@pytest.mark.parametrize("callback", ["trig", "getparam", "destroy"])
def test_callbacks_without_arguments_fail_alike(callback: str) -> None:
    script = load(f"def {callback}():\n    raise ValueError('odd')\n")
    call = {"trig": script.trigger, "getparam": script.parameters, "destroy": script.close}[
        callback
    ]
    with pytest.raises(ScriptError, match=f"^{re.escape(str(PATH))}:2: ValueError: odd"):
        call()
    script._destroy = None
    script.close()
