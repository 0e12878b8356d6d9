"""What programs say as messages, and what is said to them."""

import os
import threading
from typing import Any

import pytest
from support.system import NO_RUN_SERVER
from support.wait import HANG, wait_until

import yarpy
from yarpy.kits.launch.run import relay as module
from yarpy.kits.launch.run.relay import LogRelay, TerminalRelay
from yarpy.link.begin.admission import Gate
from yarpy.nameserver.local import LocalNames

pytestmark = pytest.mark.skipif(bool(NO_RUN_SERVER), reason=NO_RUN_SERVER)


def test_a_logger_that_is_there_is_told(names: LocalNames) -> None:
    with yarpy.BufferedPort("/yarplogger", strict=True, names=names) as logger:
        relay = LogRelay("/log/node/x/7", "/yarplogger", names)
        assert logger.wait_for_inputs(timeout=HANG)
        relay.hear(["one", "[ERROR] two"])
        said = [logger.read(HANG).value for _ in range(2)]
        relay.close()
        relay.wait(HANG)
    assert said == [["[/log/node/x/7]", "one\n"], ["[/log/node/x/7]", "[ERROR] two\n"]]


def test_who_comes_late_is_told_what_was_said(
    names: LocalNames, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("yarpy.kits.launch.run.relay.KEPT", 2)
    relay = LogRelay("/log/node/x/7", "", names)
    relay.hear(["one", "two", "three"])
    wait_until(lambda: names.query("/log/node/x/7"))
    with yarpy.BufferedPort("/late", strict=True, names=names) as late:
        late.listen_to("/log/node/x/7")
        assert [late.read(HANG).value[1] for _ in range(2)] == ["two\n", "three\n"]
    relay.close()
    relay.wait(HANG)


def test_a_terminal(names: LocalNames) -> None:
    ours, theirs = os.pipe()
    relay = TerminalRelay("/node/7/x-1", theirs, lambda name: Gate(), names)
    relay.hear(["hello"])
    with (
        yarpy.BufferedPort("/t/i", strict=True, names=names) as heard,
        yarpy.Port("/t/o", names=names) as typed,
    ):
        wait_until(lambda: names.query("/node/7/x-1/stdout"))
        heard.listen_to("/node/7/x-1/stdout")
        assert heard.read(HANG).value == ["hello\n"]
        typed.connect("/node/7/x-1/stdin")
        typed.write(yarpy.Bottle(["typed\n"]))
        assert os.read(ours, 100) == b"typed\n"
        typed.write(yarpy.Bottle(["two", 2]))
        assert os.read(ours, 100) == b"two 2\n"
        # A program that does not read makes nobody wait.
        for _ in range(40):
            typed.write(yarpy.Bottle(["x" * 4000]))
    relay.close()
    relay.wait(HANG)
    os.close(ours)


def test_the_ports_of_a_terminal_are_there_when_it_is_made(
    names: LocalNames, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Who is told of it connects at once."""
    open_hub = module.open_hub

    def open_late(*words: Any, **more: Any) -> Any:
        threading.Event().wait(0.2)  # a busy computer
        return open_hub(*words, **more)

    monkeypatch.setattr(module, "open_hub", open_late)
    ours, theirs = os.pipe()
    relay = TerminalRelay("/node/7/x-1", theirs, lambda name: Gate(), names)
    assert names.query("/node/7/x-1/stdout") and names.query("/node/7/x-1/stdin")
    relay.close()
    relay.wait(HANG)
    os.close(ours)


def test_a_terminal_that_comes_when_the_program_has_ended(
    names: LocalNames, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(module, "ATTACHING", HANG)
    ours, theirs = os.pipe()
    relay = TerminalRelay("/node/7/x-1", theirs, lambda name: Gate(), names)
    relay.hear(["all of it"])
    relay.close()
    with yarpy.BufferedPort("/t/i", strict=True, names=names) as heard:
        heard.listen_to("/node/7/x-1/stdout")
        assert heard.read(HANG).value == ["all of it\n"]
        for name in ("stdin", "stdout"):  # and nobody else is waited for
            wait_until(lambda name=name: names.query(f"/node/7/x-1/{name}") is None)
    relay.close()  # once more, as a server that Ctrl-C has cut short
    relay.wait(HANG)
    os.close(ours)


def test_a_terminal_that_never_comes(names: LocalNames, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(module, "ATTACHING", 0.0)
    ours, theirs = os.pipe()
    relay = TerminalRelay("/node/7/x-1", theirs, lambda name: Gate(), names)
    relay.close()
    wait_until(lambda: names.query("/node/7/x-1/stdin") is None)
    relay.wait(HANG)
    os.close(ours)
