"""Two programs of one name, with a name service each, that send to one port."""

from __future__ import annotations

import subprocess
import sys

import pytest
from support.wait import HANG, wait_until

import yarpy

SENDER = """
import logging, sys, time
import yarpy
logging.getLogger("yarpy").setLevel(logging.WARNING)
names = yarpy.LocalNames()
host, port = sys.argv[1].split(":")
names.register("/in", "tcp", host, int(port))  # by name, so that it is dialled again in any case
names.set("/in", "process", 1)
with yarpy.Port("/out", names=names) as out:
    out.connect("/in", "tcp", 30.0)
    print("connected", flush=True)
    while True:
        out.write([sys.argv[2]])
        time.sleep(0.01)
"""


def test_one_stays_and_the_other_is_told(caplog: pytest.LogCaptureFixture) -> None:
    """They used to replace each other for ever: 436 events in 4 s."""
    events: list[yarpy.ConnectionEvent] = []
    came: list[str] = []
    with yarpy.Port(
        "/in", names=yarpy.LocalNames(), callback=lambda message: came.append(message.value[0])
    ) as into:
        into.on_connection(events.append)
        programs = [
            subprocess.Popen(
                [sys.executable, "-c", SENDER, into.address, name],
                stdout=subprocess.PIPE,
                stderr=subprocess.PIPE,
                text=True,
            )
            for name in ("one", "other")
        ]
        try:
            for program in programs:
                assert program.stdout is not None
                assert program.stdout.readline() == "connected\n"
            wait_until(lambda: "two programs called" in caplog.text, HANG)
            begun = len(came) + 20  # by then the last one that was replaced has ended
            wait_until(lambda: len(came) > begun, HANG)
            settled = len(events)
            assert settled <= 10
            wait_until(lambda: len(came) > begun + 100, HANG)
            assert len(set(came[begun:])) == 1
            assert len(events) == settled
        finally:
            for program in programs:
                program.kill()
            told = [program.communicate()[1] for program in programs]
    assert any("another program called" in text for text in told)
    assert caplog.text.count("two programs called") == 1
