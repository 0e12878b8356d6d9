"""What programs say as messages, and what is said to them."""

import os

import pytest
from support.system import NO_RUN_SERVER
from support.wait import HANG, wait_until

import yarpy
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
