"""portmonitor: scripts on connections - found, run, loaded again, arbitrating with events."""

from __future__ import annotations

import logging
import os
import threading
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st
from support.wait import HANG, wait_until

import yarpy
from yarpy import network, registry
from yarpy.data.bottle import Bottle, Property
from yarpy.data.value import Vocab
from yarpy.errors import LocalProtocolError, UnknownPlugin, YarpError
from yarpy.monitors.base import DROP, Place
from yarpy.monitors.script import portmonitor as module
from yarpy.monitors.script import script
from yarpy.monitors.script.portmonitor import PortMonitor, portmonitor
from yarpy.port.answer import monitoring
from yarpy.route import parse_carrier
from yarpy.wire.message import DATA, Message


@pytest.fixture(autouse=True)
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Where this process looks for scripts, and where no other file is."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("YARP_CONFIG_HOME", str(tmp_path / "config"))
    monkeypatch.setenv("YARP_DATA_HOME", str(tmp_path / "data"))
    return tmp_path


@pytest.fixture
def hasty(monkeypatch: pytest.MonkeyPatch) -> None:
    """Look at files with every message."""
    monkeypatch.setattr(script, "INTERVAL", 0.0)


def message(*values: object) -> Message:
    return Message(DATA, Bottle(values).to_bytes(), "3 0.5")


def make(tokens: str, sending: bool = False, target: str = "/in") -> Any:
    parts = parse_carrier(f"tcp+{tokens}").tokens
    where = "/out", target, f"tcp+{tokens}", sending, parts, parts
    return portmonitor(Place(*where, look=monitoring._look))


def python(folder: Path, text: str, name: str = "gate.py") -> None:
    (folder / name).write_text(text)


# -- making one -----------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("tokens", "name"),
    [
        ("type.python+file.gate", "gate.py"),
        ("type.python+file.gate.py", "gate.py"),
        ("type.python+file.other+file.gate", "gate.py"),
        ("script.python+file.gate", "gate.py"),
        ("type.python", "modifier.py"),
        ("type.python+file.gate+context.app", "data/contexts/app/gate.py"),
        ("type.python+file.gate", "data/gate"),
        ("type.python+file.gate", "config/robots/default/gate.py"),
    ],
)
def test_script_is_found(folder: Path, tokens: str, name: str) -> None:
    (folder / name).parent.mkdir(parents=True, exist_ok=True)
    python(folder, "def accept(message): return False", name)
    assert not make(tokens).accept(message())


def test_missing_script_says_where_it_was_looked_for(folder: Path) -> None:
    with pytest.raises(LocalProtocolError, match=r'no script "gate" or "gate\.py"; it looked in'):
        make("type.python+file.gate")


@pytest.mark.parametrize(
    ("tokens", "kind", "text"),
    [
        ("type.perl+file.x", LocalProtocolError, 'no type "perl"; use one of lua, python, dll'),
        ("type.dll+file.nosuch", UnknownPlugin, 'no monitor "nosuch"'),
        ("type.dll+file.portmonitor", LocalProtocolError, "cannot run portmonitor"),
        ("type.dll", UnknownPlugin, 'no monitor "modifier"'),
        ("type.python+file.gate+constraint.not", LocalProtocolError, "constraint"),
    ],
)
def test_wrong_parameters_refuse(
    folder: Path, tokens: str, kind: type[Exception], text: str
) -> None:
    python(folder, "x = 1")
    with pytest.raises(kind, match=text):
        make(tokens)


def test_installed_monitors_are_those_of_type_dll() -> None:
    class Stock:
        def __init__(self, place: Place) -> None:
            self.level = place.text("level")

    registry.monitors.add("stock", Stock)
    try:
        assert make("type.dll+file.stock+level.3").level == "3"
    finally:
        registry.monitors.remove("stock")


def test_several_at_once_as_cpp_4_asks_for_them(folder: Path) -> None:
    python(folder, "def update(m): return [*m.value, 'a']", "a.py")
    python(folder, "def update(m): return [*m.value, 'b']\ndef destroy(): print('b ends')", "b.py")
    both = make("type.python+file.a+type1.python+file1.b")
    assert both.update(message("hi")).value == ["hi", "a", "b"]
    with pytest.raises(LocalProtocolError, match='no script "c"'):
        make("type.python+file.a+type1.python+file1.b+type2.python+file2.c")


@pytest.mark.parametrize(
    ("text", "what"),
    [
        ("def create(options): return False", "create did not return true"),
        ("def create(options):\n    options.nosuch", r"gate\.py:2: AttributeError"),
        ("1 / 0", r"gate\.py:1: ZeroDivisionError"),
    ],
)
def test_script_that_does_not_start_refuses(folder: Path, text: str, what: str) -> None:
    python(folder, text)
    with pytest.raises(LocalProtocolError, match=what):
        make("type.python+file.gate")


def test_what_create_is_told(folder: Path) -> None:
    python(folder, "def create(options):\n    global told; told = options\n"
                   "def getparam(): return told")  # fmt: skip
    tokens = "recv.portmonitor+type.python+file.gate+period_ms.30+name.a.b+flag+(list 1 2)"
    assert make(tokens).parameters() == {
        "filename": str(folder / "gate.py"),
        "source": "/out",
        "destination": "/in",
        "sender_side": 0,
        "receiver_side": 1,
        "carrier": f"tcp+{tokens}",
        "period_ms": 30,
        "name": "a.b",
        "flag": "",
        "list": [1, 2],
    }
    assert make(tokens, sending=True).parameters()["sender_side"] == 1


# -- messages -------------------------------------------------------------------------------------


def test_failing_accept_drops_and_failing_update_passes(
    folder: Path, caplog: pytest.LogCaptureFixture
) -> None:
    caplog.set_level(logging.WARNING)
    python(folder, "def accept(message):\n    return message.value[0] / 2 > 0\n"
                   "def update(message):\n    return message.nosuch\n"
                   "def update_reply(message): raise OSError('x')\n"
                   "def trig(): raise OSError('y')\n")  # fmt: skip
    monitor = make("type.python+file.gate")
    for _ in range(3):
        assert not monitor.accept(message("text"))
        assert monitor.accept(message(1))
        assert monitor.update(message(1)) is None
        assert monitor.update_reply(message(1)) is None
        monitor.trigger()
    assert [r.getMessage().split("; ")[1] for r in caplog.records] == [
        "messages are dropped",
        "messages pass as they are",
        "replies pass as they are",
        "the next trigger still comes",
    ]
    assert "/out -> /in: " in caplog.text
    assert "gate.py:2: TypeError" in caplog.text
    assert "gate.py:4: AttributeError" in caplog.text


def test_complaints_are_bounded(folder: Path, caplog: pytest.LogCaptureFixture) -> None:
    caplog.set_level(logging.WARNING)
    python(folder, "def accept(message): raise ValueError(message.value[0])")
    monitor = make("type.python+file.gate")
    for number in range(100):
        monitor.accept(message(number))
    assert len(caplog.records) == 16


@pytest.mark.parametrize(
    ("sending", "target", "counts"),
    [(False, "/in", True), (True, "/in", False), (False, "/out", False)],
    ids=["receiver", "sender", "port"],
)
def test_constraint_counts_at_the_receiving_end(
    folder: Path, sending: bool, target: str, counts: bool
) -> None:
    python(folder, "x = 1")
    monitor = make("type.python+file.gate+constraint.e_test_go", sending, target)
    assert monitor.accept(message())
    assert (monitor.update(message()) is DROP) is counts
    assert monitor.state()["constraint"] == "e_test_go"
    monitor.control.set_event("e_test_go")
    assert monitor.update(message()) is None
    monitor.close()


def test_constraint_of_several_words(folder: Path) -> None:
    python(folder, "x = 1")
    monitor = make("type.python+file.gate+(constraint not e_test_a and (true or e_test_b))")
    assert monitor.state()["constraint"] == "not e_test_a and (true or e_test_b)"
    assert monitor.update(message()) is None
    monitor.control.set_event("e_test_a")
    assert monitor.update(message()) is DROP
    monitor.close()


def test_settings_that_a_script_does_not_like_are_an_error(folder: Path) -> None:
    python(folder, "def setparam(p): p['nosuch']\ndef getparam(): 1 / 0\n")
    monitor = make("type.python+file.gate")
    with pytest.raises(LocalProtocolError, match=r"gate\.py:1: KeyError"):
        monitor.configure(Property(level=1))
    with pytest.raises(LocalProtocolError, match=r"gate\.py:2: ZeroDivisionError"):
        monitor.parameters()


# -- loading again --------------------------------------------------------------------------------


def renew(path: Path, text: str) -> None:
    """Write a file so that it certainly looks changed."""
    path.write_text(text, encoding="utf-8")
    os.utime(path, (time.time() + 5, os.stat(path).st_mtime + 5))


@pytest.mark.usefixtures("hasty")
def test_changed_script_is_loaded_again(folder: Path, caplog: pytest.LogCaptureFixture) -> None:
    caplog.set_level(logging.INFO)
    path = folder / "gate.py"
    path.write_text("def accept(m): return True\ndef destroy(): print('old one ends')\n"
                    "def create(options): portmonitor.set_event('e_test_old')\n")  # fmt: skip
    monitor = make("type.python+file.gate+constraint.true")
    assert monitor.accept(message())
    renew(path, "def accept(m):\n    return m.value == ['new']\n"
                "def create(options): portmonitor.set_constraint('e_test_old')\n")  # fmt: skip
    assert not monitor.accept(message("old"))
    assert monitor.accept(message("new"))
    assert monitor.update(message("new")) is DROP  # the event went with the old script
    assert "was loaded again" in caplog.text
    monitor.close()


@pytest.mark.usefixtures("hasty")
def test_changed_script_that_does_not_start_leaves_the_one_before(
    folder: Path, caplog: pytest.LogCaptureFixture
) -> None:
    caplog.set_level(logging.WARNING)
    path = folder / "gate.py"
    path.write_text("def accept(m): return True")
    monitor = make("type.python+file.gate")
    for text, what in (
        ("def accept(m: return", "SyntaxError"),
        ("def create(options): return False", "create did not return true"),
    ):
        caplog.clear()
        renew(path, text)
        assert all(monitor.accept(message()) for _ in range(3))
        assert len(caplog.records) == 1
        assert what in caplog.text
        assert "the old script stays in use" in caplog.text
    path.unlink()
    assert monitor.accept(message())
    renew(path, "def accept(m): return False")
    assert not monitor.accept(message())


# -- whatever comes -------------------------------------------------------------------------------


@given(st.text(max_size=30), st.text(max_size=30), st.text(max_size=30))
def test_any_parameters_make_a_monitor_or_a_clear_error(kind: str, file: str, rest: str) -> None:
    for tokens in (
        (f"type.{kind}", f"file.{file}", rest),
        ("type.python", f"file.{file}", f"context.{rest}"),
        ("type.python", "file./dev/null", f"(constraint {file})", f"({rest})"),
        ("type.python", "file./dev/null", f"constraint.{file}", rest),
    ):
        try:
            made = portmonitor(Place("/out", "/in", "", False, tokens, tokens))
        except YarpError:
            continue
        assert isinstance(made, PortMonitor)
        made.close()


# -- ports ----------------------------------------------------------------------------------------


@pytest.fixture
def names() -> yarpy.LocalNames:
    return yarpy.LocalNames()


@pytest.fixture
def app(folder: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """The folder of a context, whose scripts the network may ask for."""
    monkeypatch.setenv("YARPY_SCRIPTS", "network")
    found = folder / "data" / "contexts" / "app"
    found.mkdir(parents=True)
    return found


GATE = {
    "python": """
level = 1
def accept(message):
    return message.value[0] != "drop"
def update(message):
    return [*message.value, level]
def update_reply(message):
    return [*message.value, "replied"]
def setparam(parameters):
    global level
    level = parameters["level"]
def getparam():
    return {"level": level}
""",
    "lua": """
require("yarp")
local level = 1
PortMonitor.accept = function(thing)
    return thing:asBottle():get(0):asString() ~= "drop"
end
PortMonitor.update = function(thing)
    thing:asBottle():addInt32(level)
    return thing
end
PortMonitor.update_reply = function(thing)
    thing:asBottle():addString("replied")
    return thing
end
PortMonitor.setparam = function(property)
    level = property:find("level"):asInt32()
end
PortMonitor.getparam = function()
    local p = yarp.Property()
    p:put("level", level)
    return p
end
""",
}
ENDINGS = {"python": "py", "lua": "lua"}


@pytest.fixture(params=["python", "lua"])
def kind(request: pytest.FixtureRequest, app: Path) -> str:
    """The language of the scripts `gate` of the context."""
    if request.param == "lua":
        pytest.importorskip("lupa.lua54", reason='Lua is missing: pip install "yarpy[lua]"')
    (app / f"gate.{ENDINGS[request.param]}").write_text(GATE[request.param])
    return str(request.param)


@pytest.mark.parametrize("carrier", ["tcp", "fast_tcp", "udp", "unix_stream", "local", "text_ack"])
def test_both_ends(names: yarpy.LocalNames, kind: str, carrier: str) -> None:
    with yarpy.Port("/in", names=names) as in_, yarpy.Port("/out", names=names) as out:
        one = f"portmonitor+type.{kind}+context.app+file.gate"
        out.connect("/in", f"{carrier}+send.{one}+recv.{one}")
        mine = ("hi",)
        for value, passes in ((mine, True), (["drop"], False), (["ho", [2.5]], True)):
            wait_until(lambda value=value, passes=passes: out.write(value, "5 0.5") == passes)
            if passes:
                got = in_.read(timeout=HANG)
                assert got.value == [*value, 1, 1]
                assert (got.source, got.envelope) == ("/out", "5 0.5")
        assert mine == ("hi",)  # what the program wrote is its own


def test_calls_and_settings(names: yarpy.LocalNames, kind: str) -> None:
    with (
        yarpy.RpcServer("/server", lambda m: m.value, names=names),
        yarpy.RpcClient(names=names) as client,
    ):
        client.connect("/server", f"tcp+send.portmonitor+type.{kind}+context.app+file.gate")
        assert client.call("hi") == ["hi", 1, "replied"]
    with yarpy.Port("/in", names=names) as in_, yarpy.Port("/out", names=names) as out:
        out.connect("/in", f"tcp+recv.portmonitor+type.{kind}+context.app+file.gate")

        def admin(*words: object) -> object:
            return network.admin("/in", *words, names=names)

        wait_until(lambda: in_.inputs)
        assert admin("get", "in", "/out") == [[["level", 1]]]
        done = admin("set", "in", "/out", ["level", 5])
        assert done == [0, "Configured connection from /out\r\n"]
        out.write(["hi"])
        assert in_.read(timeout=HANG).value == ["hi", 5]
        wrong = admin("set", "in", "/out", ["other", 5])
        assert kind == "lua" or (isinstance(wrong, list) and "gate.py" in wrong[1])


def test_attached_to_a_port(names: yarpy.LocalNames, kind: str) -> None:
    with yarpy.Port("/in", names=names) as in_, yarpy.Port("/out", names=names) as out:
        out.connect("/in")
        text = f"(type {kind}) (file gate) (context app)"
        assert network.admin("/in", "atch", "in", text, names=names) == [Vocab("ok")]
        assert network.admin("/out", "atch", "out", text, names=names) == [Vocab("ok")]
        assert out.write(["drop"]) == 0
        assert out.write(["hi"]) == 1
        assert in_.read(timeout=HANG).value == ["hi", 1, 1]
        assert network.admin("/in", "get", "in", "/in", names=names) == [[["level", 1]]]
        reply = network.admin(
            "/in", "atch", "in", f"(type {kind}) (file nosuch) (context app)", names=names
        )
        assert reply[0] == Vocab("fail")
        assert '"nosuch"' in reply[1]
        out.write(["ho"])  # the one before stays
        assert in_.read(timeout=HANG).value == ["ho", 1, 1]
        assert network.admin("/in", "dtch", "in", names=names) == [Vocab("ok")]
        out.write(["ha"])
        assert in_.read(timeout=HANG).value == ["ha", 1]


def test_without_a_script_there_is_no_connection(
    names: yarpy.LocalNames, app: Path, caplog: pytest.LogCaptureFixture
) -> None:
    caplog.set_level(logging.WARNING)
    with yarpy.Port("/in", names=names) as in_, yarpy.Port("/out", names=names) as out:
        for carrier in ("tcp+recv.portmonitor+type.python+context.app+file.gone",
                        "tcp+send.portmonitor+type.python+context.app+file.gone"):  # fmt: skip
            with pytest.raises(yarpy.LocalProtocolError):
                out.connect("/in", carrier)
        assert (out.outputs, in_.inputs) == ([], [])
        # The receiver says it in its log behind its answer.
        wait_until(lambda: 'no script "gone" or "gone.py"' in caplog.text)


ARBITRATION = {
    "ball": {
        "python": "def create(options): portmonitor.set_constraint('true')\n"
        "def accept(message):\n    portmonitor.set_event('e_test_ball', 0.5)\n    return True\n",
        "lua": "PortMonitor.create = function(options)\n"
        "    PortMonitor.setConstraint('true') return true\nend\n"
        "PortMonitor.accept = function(thing)\n"
        "    PortMonitor.setEvent('e_test_ball', 0.5) return true\nend\n",
    },
    "line": {
        "python": "def create(options): portmonitor.set_constraint('not e_test_ball')\n",
        "lua": "PortMonitor.create = function(options)\n"
        "    PortMonitor.setConstraint('not e_test_ball') return true\nend\n",
    },
}


def until(step: Callable[[], object], condition: Callable[[], bool]) -> None:
    """Repeat a step until something holds."""

    def attempt() -> bool:
        step()
        time.sleep(0.01)
        return condition()

    wait_until(attempt)


@pytest.mark.parametrize(("ball_kind", "line_kind"), [("python", "lua"), ("lua", "python")])
def test_arbitration_by_events(
    names: yarpy.LocalNames, app: Path, ball_kind: str, line_kind: str
) -> None:
    """The ball inhibits the line for half a second, whatever language either speaks."""
    pytest.importorskip("lupa.lua54", reason='Lua is missing: pip install "yarpy[lua]"')
    for name, kind in (("ball", ball_kind), ("line", line_kind)):
        (app / f"{name}.{ENDINGS[kind]}").write_text(ARBITRATION[name][kind])
    heard: list[Message] = []
    with (
        yarpy.Port("/in", callback=heard.append, names=names) as in_,
        yarpy.Port("/ball", names=names) as ball,
        yarpy.Port("/line", names=names) as line,
    ):
        ball.connect("/in", f"tcp+recv.portmonitor+type.{ball_kind}+context.app+file.ball")
        line.connect("/in", f"tcp+recv.portmonitor+type.{line_kind}+context.app+file.line")
        wait_until(lambda: len(in_.inputs) == 2)
        of_line = next(link for link in in_.inputs if link.source == "/line")
        line.write(["line"])
        wait_until(lambda: heard and heard[-1].value == ["line"])
        ball.write(["ball"])
        wait_until(lambda: heard[-1].value == ["ball"])
        until(lambda: (ball.write([1]), line.write([2])), lambda: of_line.stats.drops > 5)
        until(lambda: line.write(["late"]), lambda: bool(heard[-1].value == ["late"]))


def test_others_of_the_port_are_triggered(names: yarpy.LocalNames, app: Path) -> None:
    """Recorded with C++: A waits for e_go, which its `trig` sets when B sends."""
    python(app, "def trig(): portmonitor.set_event('e_test_go', 60)\n", "a.py")
    python(app, "x = 1\n", "b.py")
    with (
        yarpy.BufferedPort("/in", strict=True, names=names) as in_,
        yarpy.Port("/a", names=names) as a,
        yarpy.Port("/b", names=names) as b,
    ):
        a.connect("/in", "tcp+recv.portmonitor+type.python+context.app+file.a+constraint.e_test_go")
        b.connect("/in", "tcp+recv.portmonitor+type.python+context.app+file.b")
        a.write(["a1"])
        wait_until(lambda: any(link.stats.drops for link in in_.inputs))
        b.write(["b1"])
        assert in_.read(timeout=HANG).value == ["b1"]
        a.write(["a2"])
        assert in_.read(timeout=HANG).value == ["a2"]


def test_timer_of_a_script_ends_with_its_connection(names: yarpy.LocalNames, app: Path) -> None:
    text = "def create(options): portmonitor.setTrigInterval(0.01)\ncount = 0\n"
    python(app, f"{text}def trig():\n    global count; count += 1\n"
                   "def getparam(): return {'count': count}\n")  # fmt: skip
    with yarpy.Port("/in", names=names) as in_, yarpy.Port("/out", names=names) as out:
        out.connect("/in", "tcp+recv.portmonitor+type.python+context.app+file.gate")

        def count() -> int:
            reply = network.admin("/in", "get", "in", "/out", names=names)
            return int(reply[0][0][1])

        wait_until(lambda: in_.inputs and count() >= 5)
        assert timers()
        out.disconnect("/in")
        wait_until(lambda: not timers(), what="the timer has ended")


def timers() -> list[str]:
    return [one.name for one in threading.enumerate() if one.name.startswith("yarpy trig")]


@pytest.fixture(autouse=True)
def no_timers() -> Iterator[None]:
    yield
    wait_until(lambda: not timers(), what="no timer is left")


# -- what the network may ask for -----------------------------------------------------------------

WRITES = "from pathlib import Path\nPath({path!r}).write_text('ran')\n"


@pytest.fixture
def ran(folder: Path) -> Path:
    """What a script makes that ran; the script lies everywhere that somebody might try."""
    made = folder / "ran"
    contexts = folder / "data" / "contexts"
    for place in (folder, contexts, contexts / "app", contexts / "app" / "deeper", folder / "data"):
        place.mkdir(parents=True, exist_ok=True)
        python(place, WRITES.format(path=str(made)), "evil.py")
    return made


@pytest.mark.parametrize("setting", ["", "system", "network"])
@pytest.mark.parametrize("end", ["recv", "send", "atch"])
def test_scripts_of_the_network_run_if_the_owner_says_so(
    names: yarpy.LocalNames, ran: Path, monkeypatch: pytest.MonkeyPatch, setting: str, end: str
) -> None:
    monkeypatch.setenv("YARPY_SCRIPTS", setting)
    with yarpy.Port("/in", names=names) as in_, yarpy.Port("/out", names=names) as out:
        if end == "atch":
            text = "(type python) (file evil) (context app)"
            reply = network.admin("/in", "atch", "in", text, names=names)
            refused = reply[0] == Vocab("fail")
        else:
            carrier = f"tcp+{end}.portmonitor+type.python+context.app+file.evil"
            reply = network.admin("/out", "add", "/in", carrier, names=names)
            refused = reply[0] == -1
        assert refused == (setting != "network"), reply
        assert ran.exists() == (setting == "network")
        if refused and end != "recv":
            assert "YARPY_SCRIPTS=network" in reply.to_text()
        assert in_.closed == out.closed is False


@pytest.mark.parametrize(
    ("file", "context"),
    [
        ("evil", ""),
        ("evil.py", ""),
        ("../evil", "app"),
        ("deeper/evil", "app"),
        ("evil", ".."),
        ("evil", "app/.."),
        ("evil", "."),
        ("{folder}/evil", ""),
        ("{folder}/evil.py", "app"),
        ("evil", "{folder}"),
    ],
)
def test_network_names_files_of_contexts_alone(
    names: yarpy.LocalNames, folder: Path, ran: Path, monkeypatch: pytest.MonkeyPatch,
    file: str, context: str,
) -> None:  # fmt: skip
    monkeypatch.setenv("YARPY_SCRIPTS", "network")
    words = ["type", "python"], ["file", file.format(folder=folder)]
    with yarpy.Port("/in", names=names):
        given = [*words, ["context", context.format(folder=folder)]] if context else [*words]
        reply = network.admin("/in", "atch", "in", *given, names=names)
        assert reply[0] == Vocab("fail")
        assert "not a path" in reply[1]
    assert not ran.exists()


def test_program_may_attach_what_it_likes(names: yarpy.LocalNames, ran: Path, folder: Path) -> None:
    with yarpy.Port("/in", names=names) as in_:
        in_.attach("in", {"type": "python", "file": str(folder / "evil.py")})
        assert ran.exists()
        in_.detach("in")
        ran.unlink()
        with yarpy.Port("/out", names=names) as out:
            out.connect("/in", "tcp+send.portmonitor+type.python+file.evil")
        assert ran.exists()
        with pytest.raises(yarpy.LocalProtocolError, match="nosuch"):
            in_.attach("in", {"type": "python", "file": "nosuch"})


@pytest.mark.parametrize("right", ["", "script"])
@pytest.mark.parametrize("end", ["recv", "send", "atch"])
def test_scripts_run_for_whom_the_rules_name(
    names: yarpy.LocalNames, ran: Path, monkeypatch: pytest.MonkeyPatch, right: str, end: str
) -> None:
    rules = ran.parent / "access.toml"
    may = '["all", "script"]' if right else '"all"'
    rules.write_text(f'[[allow]]\nwho = "loopback"\nmay = {may}\n')
    monkeypatch.setenv("YARPY_ACCESS", str(rules))
    monkeypatch.delenv("YARPY_SCRIPTS", raising=False)
    with yarpy.Port("/in", names=names), yarpy.Port("/out", names=names):
        if end == "atch":
            text = "(type python) (file evil) (context app)"
            reply = network.admin("/in", "atch", "in", text, names=names)
            refused = reply[0] == Vocab("fail")
        else:
            carrier = f"tcp+{end}.portmonitor+type.python+context.app+file.evil"
            reply = network.admin("/out", "add", "/in", carrier, names=names)
            refused = reply[0] == -1
        assert refused == (not right), reply
        assert ran.exists() == bool(right)
        if right:  # never by a path
            ran.unlink()
            text = f"(type python) (file {ran.parent / 'evil.py'})"
            assert "not a path" in network.admin("/in", "atch", "in", text, names=names)[1]
            assert not ran.exists()


# -- scripts that never come back -----------------------------------------------------------------


ENDLESS = """
import threading
entered, go_on = threading.Event(), threading.Event()
def {callback}(*given):
    entered.set()
    while not go_on.wait(60):  # longer than any test waits
        pass
"""


def endless(script: Any) -> tuple[threading.Event, threading.Event]:
    module = script._script._module
    return module.entered, module.go_on


def closed_in_time(*ports: Any) -> None:
    """Close each in a thread of its own."""
    for port in ports:
        thread = threading.Thread(target=port.close, daemon=True)
        thread.start()
        thread.join(HANG)
        assert not thread.is_alive(), f"close() of {port.name} does not return"


@pytest.mark.parametrize("where", ["sender", "port out", "port in"])
def test_a_port_closes_without_a_python_script_that_never_returns(
    folder: Path, caplog: pytest.LogCaptureFixture, where: str
) -> None:
    python(folder, ENDLESS.format(callback="accept"), "stuck.py")
    names = yarpy.LocalNames()
    a, b = yarpy.Port("/a", names=names), yarpy.BufferedPort("/b", names=names)
    script = {"type": "python", "file": "stuck"}
    if where == "sender":
        a.connect("/b", "tcp+send.portmonitor+type.python+file.stuck")
        found = a._hub.outputs.links[0].chain.monitors[0]
    else:
        a.connect("/b")
        owner = a if where == "port out" else b
        owner.attach(where.split()[1], script)
        chain = a._hub.monitoring.output if owner is a else b._hub.monitoring.input
        assert chain is not None
        found = chain.monitors[0]
    entered, go_on = endless(found)
    writer = threading.Thread(target=a.write, args=([1],), daemon=True)
    writer.start()
    assert entered.wait(HANG)
    closed_in_time(a, b)
    assert "a callback still runs, and nothing can end it" in caplog.text
    go_on.set()
    writer.join(HANG)


def test_a_destroy_that_never_returns(folder: Path, caplog: pytest.LogCaptureFixture) -> None:
    python(folder, ENDLESS.format(callback="destroy"))
    monitor = make("type.python+file.gate")
    entered, go_on = endless(monitor)
    started = threading.Thread(target=monitor.close, daemon=True)
    started.start()
    assert entered.wait(HANG)
    started.join(HANG)
    assert not started.is_alive()
    assert "destroy still runs, and nothing can end it" in caplog.text
    go_on.set()


def test_a_script_that_never_returns_holds_no_other_thread(
    folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(module, "CALLBACK_TIMEOUT", 0.05)
    python(folder, ENDLESS.format(callback="accept") + "def trig(): pass\n")
    monitor = make("type.python+file.gate")
    entered, go_on = endless(monitor)
    reader = threading.Thread(target=monitor.accept, args=(message(1),), daemon=True)
    reader.start()
    assert entered.wait(HANG)
    monitor.trigger()  # of another connection
    for act in (monitor.parameters, lambda: monitor.configure(Property())):
        with pytest.raises(LocalProtocolError, match="a callback still runs"):
            act()
    go_on.set()
    reader.join(HANG)
    monitor.parameters()
    monitor.close()


HOSTILE = [
    "while true do end",
    "string.find(string.rep('a', 5000), '.-.-.-.-b')",
    "getmetatable('').__index = function() while true do end end while true do end",
    "local t = setmetatable({}, {__index = function(t, k) return t[k + 1] end}) local x = t[1]",
    "coroutine.wrap(function() while true do end end)()",
]


@pytest.mark.parametrize("body", HOSTILE)
def test_ports_with_a_hostile_lua_script(
    folder: Path, body: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Writing comes back, what else the port writes arrives, and both ports close."""
    lua = pytest.importorskip("yarpy.monitors.script.lua", reason="needs Lua")
    pytest.importorskip("lupa.lua54", reason='Lua is missing: pip install "yarpy[lua]"')
    monkeypatch.setattr(lua, "SCRIPT_SECONDS", 0.2)
    monkeypatch.setattr(lua.LuaScript.__init__, "__defaults__", (1_000_000, 16 << 20, False))
    for callback in ("accept", "destroy"):
        (folder / f"{callback}.lua").write_text(
            f"PortMonitor.{callback} = function(t)\n{body}\nreturn true end\n"
        )
    names = yarpy.LocalNames()
    a, b = yarpy.Port("/a", names=names), yarpy.BufferedPort("/b", names=names, strict=True)
    c = yarpy.BufferedPort("/c", names=names, strict=True)
    a.connect("/b", "tcp+send.portmonitor+type.lua+file.accept")
    a.connect("/c", "tcp+send.portmonitor+type.lua+file.destroy")
    c.attach("in", {"type": "lua", "file": "destroy"})
    writer = threading.Thread(target=lambda: [a.write([n]) for n in range(2)], daemon=True)
    writer.start()
    writer.join(HANG)
    assert not writer.is_alive(), "write() does not return"
    found = [c.read(HANG) for _ in range(2)]
    assert [one.value for one in found if one] == [[0], [1]]
    closed_in_time(a, b, c)
