"""What strangers write into logs."""

from __future__ import annotations

import logging
import re
import threading
from contextlib import suppress
from pathlib import Path

import pytest
from support.moments import cut, elsewhere, moments

import yarpy.log
from yarpy.log import BURST, MINUTE, log_failure, logger, readable

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
        log.info("from %s", "/caf\udce9")
    assert [record.getMessage() for record in caplog.records] == [
        "/in: refused: evil\\n[ERROR] all is lost\\x1b[2J",
        "1 of 2",
        "from /caf\\udce9",
    ]
    assert logger("yarpy.test_log") is log and len(log.filters) == 1


def test_strangers_cannot_fill_the_log(
    caplog: pytest.LogCaptureFixture, monkeypatch: pytest.MonkeyPatch
) -> None:
    now = 1000.0
    monkeypatch.setattr("yarpy.log.time.monotonic", lambda: now)
    log = logger("yarpy.test_log_flood")

    def flood(count: int) -> list[str]:
        caplog.clear()
        with caplog.at_level(logging.INFO, "yarpy"):
            for number in range(count):
                log.warning("%s: connection from %s refused: %s", "/in", number, "not you\x1b")
        return [record.getMessage() for record in caplog.records]

    lines = flood(1000)
    assert len(lines) == BURST
    assert lines[0] == "/in: connection from 0 refused: not you\\x1b"
    assert lines[-1].endswith("not you\\x1b (others like it are only counted for a minute)")
    assert flood(200) == []
    with caplog.at_level(logging.INFO, "yarpy"):
        log.warning("%s: connection from %s refused: %s", "/other", 1, "not you")
        log.warning("%s: something else", "/in")
        for _ in range(2 * BURST):
            log.info("%s: nothing bad", "/in")
    assert len(caplog.records) == 2 + 2 * BURST
    now += MINUTE
    assert flood(2)[:2] == [
        f"/in: connection from 0 refused: not you\\x1b (and {1200 - BURST} like it since)",
        "/in: connection from 1 refused: not you\\x1b",
    ]


def test_what_is_known_of_warnings_is_bounded() -> None:
    log = logger("yarpy.test_log_kinds")
    for number in range(3000):
        log.warning("%s: refused", number)
    assert len(yarpy.log._kinds) <= 1000


def test_everybody_logs_that_way() -> None:
    for path in SOURCE.rglob("*.py"):
        if path.name == "log.py":
            continue
        found = re.search(r"logging\.getLogger\(", path.read_text())
        assert found is None, f"{path} asks for a logger elsewhere than of yarpy.log"


def test_without_memory_no_traceback_is_made(caplog: pytest.LogCaptureFixture) -> None:
    """It would fail itself, and print another one."""

    class Hungry:
        def __str__(self) -> str:
            raise MemoryError

    log = logger("yarpy.test")
    try:
        raise MemoryError
    except MemoryError:
        log.exception("%s: connection %s fails on a defect", "/p", "x")
    log.error("%s", Hungry())
    first, second = caplog.records
    assert first.exc_info is None
    assert first.getMessage() == "/p: connection x fails on a defect (no memory is left)"
    assert "no memory to tell" in second.getMessage()


def test_no_signal_handler_leaves_a_handler_of_the_log_locked() -> None:
    """Up to Python 3.12 it may: every thread that logs would wait for it for ever."""

    class Silent(logging.Handler):
        def emit(self, record: logging.LogRecord) -> None:
            pass

    log = logger("yarpy.test.locked")
    log.propagate = False
    log.setLevel(logging.INFO)  # warnings that are alike are only counted after a while
    handler = Silent()
    log.addHandler(handler)
    tried = 0
    try:
        log.info("before")  # from now on it is known which levels are shown
        for one in moments():
            tried += 1
            with suppress(Exception), one.interrupts(cut, re.compile(r"/logging/__init__\.py$")):
                log.info("%s moment", tried)

            def others() -> bool:
                log.info("others")
                return True

            assert elsewhere(others), f"moment {tried}"
    finally:
        log.removeHandler(handler)
        log.setLevel(logging.NOTSET)
    assert tried > 10


def test_what_a_function_of_the_program_raises(caplog: pytest.LogCaptureFixture) -> None:
    log = logger("yarpy.test")
    log_failure(log, ZeroDivisionError("oh"), "%s: it failed", "/here")
    with pytest.raises(SystemExit):  # in the main thread the program ends
        log_failure(log, SystemExit(3), "%s: it failed", "/here")
    ended = threading.Thread(target=log_failure, args=(log, SystemExit(3), "%s: it failed", "/in"))
    ended.start()
    ended.join()
    assert [bool(record.exc_info) for record in caplog.records] == [True, False]
    assert caplog.messages[0] == "/here: it failed"
    assert caplog.messages[1].startswith("/in: it failed: sys.exit() in a thread of a port ends no")
