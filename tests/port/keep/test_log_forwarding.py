"""What a program logs goes to whoever reads its port."""

from __future__ import annotations

import logging
import os
import subprocess
import sys
import threading
from collections.abc import Iterator

import pytest
from support.wait import HANG, wait_until

import yarpy
from yarpy.port.keep import log_forwarding, log_sender
from yarpy.port.keep.log_line import LogLine, port_name, read_line
from yarpy.testing import private_names, private_server

log = logging.getLogger("test.forwarding")


@pytest.fixture
def names(monkeypatch: pytest.MonkeyPatch) -> Iterator[yarpy.LocalNames]:
    monkeypatch.setenv("YARP_FORWARD_LOG_ENABLE", "1")
    log.setLevel(logging.INFO)
    with private_names() as found:
        try:
            yield found
        finally:
            log_forwarding.end()


def read(port: yarpy.BufferedPort) -> LogLine:
    message = port.read(timeout=HANG)
    line = read_line(message.value, message.source)
    assert line is not None
    return line


def test_a_logger_gets_what_is_logged(names: yarpy.LocalNames) -> None:
    with yarpy.BufferedPort("/yarplogger", strict=True) as logger:
        log.debug("not at this level")
        log.warning("hot: %d", 90)
        line = read(logger)
        assert (line.level, line.text, line.component) == ("WARNING", "hot: 90", "test.forwarding")
        assert line.origin == port_name(os.environ)
        assert [str(one.carrier) for one in logger.inputs] == ["fast_tcp"]
        logging.getLogger("yarpy.port").warning("the network itself")
        logging.getLogger("yarpy.devices").warning("a device")
        assert read(logger).text == "a device"


def test_who_comes_late_gets_what_was_logged(
    names: yarpy.LocalNames, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(log_sender, "LINES", 3)
    with yarpy.Port("/any"):
        for number in range(5):
            log.info("line %d", number)
        name = port_name(os.environ)
        wait_until(lambda: names.query(name))
        for _ in range(2):
            with yarpy.BufferedPort("/late", strict=True) as late:
                late.listen_to(name)
                assert [read(late).text for _ in range(3)] == ["line 2", "line 3", "line 4"]


def test_a_slow_reader_is_told_what_is_lost(
    names: yarpy.LocalNames, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(log_sender, "LINES", 2)
    monkeypatch.setattr(log_sender, "AHEAD", 2)
    go = threading.Event()
    real = log_sender.LogSender._send
    monkeypatch.setattr(
        log_sender.LogSender, "_send", lambda *all_: real(*all_) if go.is_set() else 0
    )
    with yarpy.BufferedPort("/yarplogger", strict=True) as logger:
        log.info("first")
        forwarder = log_forwarding._begun
        assert forwarder is not None
        wait_until(lambda: forwarder._sender._wanted is not None)  # it knows who reads
        for number in range(5):
            log.info("line %d", number)
        log.info("last")
        go.set()
        forwarder._sender._news.wake()
        texts = [read(logger).text for _ in range(3)]
        assert texts[0].endswith("lines before this one are lost")
        assert texts[1:] == ["line 4", "last"]


def test_handlers_of_the_program_are_left_alone(names: yarpy.LocalNames) -> None:
    before = [*logging.getLogger().handlers]
    with yarpy.Port("/any"):
        assert logging.getLogger().handlers == before
        assert logging.getLogRecordFactory() is not logging.LogRecord
        record = logging.makeLogRecord({"msg": "of another process"})  # nobody logs this
        assert record.name is None
    log_forwarding.end()
    assert logging.getLogRecordFactory() is logging.LogRecord


def test_nothing_is_forwarded_unasked(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("YARP_FORWARD_LOG_ENABLE", "0")
    with private_names() as names, yarpy.Port("/any"):
        log.error("nobody hears this")
        assert [one.name for one in names.list()] == ["/any"]
    assert log_forwarding._begun is None


def test_a_port_that_cannot_open_costs_a_warning(
    names: yarpy.LocalNames, caplog: pytest.LogCaptureFixture
) -> None:
    with yarpy.Port("/any"), yarpy.Port(port_name(os.environ)):
        log.warning("into the void")
        wait_until(lambda: f"the log of {port_name(os.environ)} is not sent" in caplog.text)
        log.warning("and on it goes")


PROGRAM = """
import logging, os, sys, yarpy
import yarpy.port.keep.log_forwarding as forwarding
forwarding.TIMEOUT = 20.0  # for its last words, on a busy machine
logging.basicConfig(level="INFO", stream=sys.stdout)
with yarpy.Port("/parent"):
    logging.info("parent")
    if hasattr(os, "fork") and os.fork() == 0:
        with yarpy.Port("/child"):
            logging.info("child")
            forwarding.end()
            os._exit(0)
    os.wait()
logging.warning("the end")
"""


@pytest.mark.skipif(not hasattr(os, "fork"), reason="this system does not fork")
def test_the_last_words_of_a_program_and_its_child() -> None:
    with private_server() as server, yarpy.BufferedPort("/yarplogger", strict=True) as logger:
        environment = {**os.environ, **server.environment, "YARP_FORWARD_LOG_ENABLE": "1"}
        done = subprocess.run(
            [sys.executable, "-W", "ignore", "-c", PROGRAM],
            env=environment, capture_output=True, text=True, timeout=50, check=True,
        )  # fmt: skip
        assert "INFO:root:parent" in done.stdout
        lines = [read(logger) for _ in range(3)]
        assert sorted(line.text for line in lines) == ["child", "parent", "the end"]
        assert len({line.origin for line in lines}) == 2
        assert not any(yarpy.query(line.origin) for line in lines), "they are gone"
