"""The messages of a log: what is recorded of C++ is read, and what we write is the same."""

from __future__ import annotations

import logging
import os
import socket
import sys
from typing import Any

import pytest

import yarpy
from yarpy.port.keep.log_line import LONGEST, LogLine, level_of, message_of, port_name, read_line

# Recorded from C++ YARP.
DEVICE = [
    "[/log/vm/yarpdev/30646]",
    "(level INFO) (systemtime 1795219554.10) (component yarp.dev.PolyDriver) (id fakeFrameGrabber) "
    '(message "Created device <fakeFrameGrabber>")',
]
RUN = ["[/log/nodeC/yarp/16755]", "period 500.000 msec\n"]


def record(text: str = "hello", *arguments: object, **more: Any) -> logging.LogRecord:
    made = logging.LogRecord("my.arm", 20, "/a/b.py", 7, text, arguments, None, "run")
    made.created = 1795219554.5
    for key, value in more.items():
        setattr(made, key, value)
    return made


def test_what_cpp_says() -> None:
    assert read_line(yarpy.Bottle(DEVICE)) == LogLine(
        "/log/vm/yarpdev/30646",
        "INFO",
        "Created device <fakeFrameGrabber>",
        1795219554.10,
        "yarp.dev.PolyDriver",
        {"id": "fakeFrameGrabber"},
    )
    assert read_line(yarpy.Bottle(RUN)) == LogLine(
        "/log/nodeC/yarp/16755", "", "period 500.000 msec"
    )
    plain = read_line(yarpy.Bottle(["x", "[WARNING] |a| hot"]), "/log/here")
    assert plain == LogLine("/log/here", "WARNING", "|a| hot")


@pytest.mark.parametrize("time", ["999999999999.0", "17179869184.0", "1e300", "-1.0"])
def test_a_time_beyond_all_calendars_is_none(time: str) -> None:
    text = f"(level INFO) (systemtime {time}) (message hello)"
    found = read_line(yarpy.Bottle(["[/log/a]", text]))
    assert found is not None and found.time == 0.0 and found.text == "hello"


@pytest.mark.parametrize(
    "value",
    [None, "text", [], ["one"], ["a", 1], ["a", "b", "c"], {"a": 1}, [["a"], "b"]],
)
def test_what_is_no_line(value: object) -> None:
    assert read_line(value) is None


@pytest.mark.parametrize(
    "text",
    [
        '(level INFO) (systemtime "x") (message (1 2))',
        "(level (INFO)) (systemtime -5)",
        "(level NONSENSE) (systemtime 1e99)",
        "(level INFO",
        "((((((((",
        "[INFO",
        "",
        "x" * 100_000,
        "(" * 50_000,
    ],
)
def test_nonsense_is_a_line_all_the_same(text: str) -> None:
    found = read_line(yarpy.Bottle(["[/log/a/b/1]", text]))
    assert found is not None
    assert found.time == 0.0
    assert len(found.text) <= LONGEST


def test_a_record_as_cpp_would_spell_it() -> None:
    made = message_of(record('say "%s"', "hi"), "/log/vm/arm/1", {})
    assert [*made] == [
        "[/log/vm/arm/1]",
        '(level INFO) (systemtime 1795219554.5) (component my.arm) (message "say \\"hi\\"")',
    ]
    assert read_line(made) == LogLine(
        "/log/vm/arm/1", "INFO", 'say "hi"', 1795219554.5, "my.arm", {}
    )
    root = message_of(record("", name="root"), "/p", {})
    assert root[1] == "(level INFO) (systemtime 1795219554.5)"


def test_more_is_told_where_the_environment_says_so() -> None:
    wanted = ("CODEINFO", "HOSTNAME", "PROCESSINFO")
    environment = {f"YARP_FORWARD_{each}_ENABLE": "1" for each in wanted}
    line = read_line(message_of(record(thread=0xBD2), "/p", environment))
    assert line is not None
    assert [*line.more] == [
        *("filename", "line", "function", "hostname", "pid", "cmd", "args", "thread_id"),
    ]
    assert (line.more["filename"], line.more["line"]) == ("/a/b.py", 7)
    assert (line.more["pid"], line.more["thread_id"]) == (os.getpid(), "0x00000bd2")


def test_errors_bring_where_they_were_raised() -> None:
    try:
        raise ValueError("wrong")
    except ValueError:
        line = read_line(message_of(record(exc_info=sys.exc_info()), "/p", {}))
    assert line is not None
    assert str(line.more["backtrace"]).endswith("ValueError: wrong\n")


def test_a_wrong_format_and_a_long_text() -> None:
    line = read_line(message_of(record("%d", "x"), "/p", {}))
    assert line is not None
    assert line.text.startswith("%d (")
    assert len(message_of(record("y" * 100_000), "/p", {})[1]) < LONGEST + 200


def test_levels() -> None:
    assert [level_of(number) for number in (0, 5, 10, 25, 30, 40, 50, 99)] == [
        *("TRACE", "TRACE", "DEBUG", "INFO", "WARNING", "ERROR", "FATAL", "FATAL")
    ]


def test_the_name_of_the_port(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(socket, "gethostname", lambda: "my host")
    monkeypatch.setattr(sys, "argv", ["/somewhere/arm control.py", "-x"])
    assert port_name({}) == f"/log/my_host/arm_control.py/{os.getpid()}"
    label = {"YARP_LOG_PROCESS_LABEL": "left"}
    assert port_name(label) == f"/log/my_host/arm_control.py[left]/{os.getpid()}"
    monkeypatch.setattr(sys, "argv", ["-c"])
    assert port_name({}).split("/")[3].startswith("python")
