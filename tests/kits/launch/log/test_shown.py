"""Lines of a log as people and programs read them."""

import json

from yarpy.kits.launch.log.shown import COLOURS, text_of, told_of
from yarpy.port.keep.log_line import LEVELS, LogLine

HOT = LogLine("/log/vm/arm/7", "ERROR", "hot\x1b[2J\nforged", 0.0, "a\rb", {"id": "x", "time": 5})


def test_text() -> None:
    assert text_of(HOT) == "--:--:-- vm/arm/7 [ERROR] |a\\rb| hot\\x1b[2J\\nforged"
    assert text_of(LogLine("/p", "", "plain")) == "--:--:-- /p [?] plain"
    assert text_of(LogLine("/p", "INFO", "x", 1795219554.5)).endswith(" /p [INFO] x")


def test_colours() -> None:
    assert set(COLOURS) == {*LEVELS}
    assert "[\x1b[1;31mERROR\x1b[0m] " in text_of(HOT, coloured=True)
    assert "\x1b" not in text_of(LogLine("/p", "", "plain"), coloured=True)


def test_a_backtrace_stands_behind() -> None:
    line = LogLine("/p", "FATAL", "end", more={"backtrace": "one\ntwo\x1b"})
    assert text_of(line).splitlines()[1:] == ["    one", "    two\\x1b"]


def test_as_an_object() -> None:
    told = told_of(HOT)
    assert json.loads(json.dumps(told))["message"] == "hot\x1b[2J\nforged"
    assert (told["time"], told["id"], told["port"]) == (0.0, "x", "/log/vm/arm/7")
