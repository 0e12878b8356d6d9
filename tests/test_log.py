"""What strangers write into logs."""

from __future__ import annotations

import logging
import re
from pathlib import Path

import pytest

from yarpy.log import logger, readable

SOURCE = Path(__file__).parents[1] / "src" / "yarpy"


@pytest.mark.parametrize(
    ("text", "shown"),
    [
        ("/cam é 日本 🙂", "/cam é 日本 🙂"),
        ("\x1b[31mred\x07", "\\x1b[31mred\\x07"),
        ("one\r\ntwo\tthree\0", "one\\r\\ntwo\\tthree\\x00"),
        ("\x9b2J\x7f", "\\x9b2J\\x7f"),
        ("\u202egnp.exe\u2066", "\\u202egnp.exe\\u2066"),
        ("caf\udce9", "caf\udce9"),
    ],
)
def test_readable(text: str, shown: str) -> None:
    assert readable(text) == shown
    assert readable(shown) == shown


def test_what_is_kept() -> None:
    assert readable("a\nb\tc\x1b", keep="\n\t") == "a\nb\tc\\x1b"


def test_records(caplog: pytest.LogCaptureFixture) -> None:
    log = logger("yarpy.test_log")
    with caplog.at_level(logging.INFO, "yarpy"):
        log.info("%s: refused: %s", "/in", "evil\n[ERROR] all is lost\x1b[2J")
        log.info("%d of %d", 1, 2)
    assert [record.getMessage() for record in caplog.records] == [
        "/in: refused: evil\\n[ERROR] all is lost\\x1b[2J",
        "1 of 2",
    ]
    assert logger("yarpy.test_log") is log and len(log.filters) == 1


def test_everybody_logs_that_way() -> None:
    for path in SOURCE.rglob("*.py"):
        if path.name == "log.py":
            continue
        found = re.search(r"logging\.getLogger\(", path.read_text())
        assert found is None, f"{path} asks for a logger elsewhere than of yarpy.log"
