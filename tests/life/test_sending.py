"""Who writes to a reader that never reads is told so, and is woken when the port ends."""

from __future__ import annotations

import subprocess
import sys
import threading

import pytest
from support.wait import HANG, wait_until

import yarpy

SCRIPT = """
import signal, sys, time, yarpy

names = yarpy.LocalNames()
with yarpy.Port("/w", names=names) as out, yarpy.Port("/r", names=names):
    out.connect("/r", sys.argv[2])
    ends = out.close if sys.argv[1] == "close" else out.interrupt
    signal.signal(signal.SIGALRM, lambda *_: ends())
    signal.setitimer(signal.ITIMER_REAL, 0.2)
    try:
        while True:
            out.write("x" * 1_000_000)
    except yarpy.PortClosed:
        print("woken", flush=True)
"""


@pytest.mark.skipif(not hasattr(__import__("signal"), "SIGALRM"), reason="a system without SIGALRM")
@pytest.mark.parametrize("carrier", ["tcp", "fast_tcp"])
@pytest.mark.parametrize("how", ["close", "interrupt"])
def test_a_signal_handler_ends_a_write(how: str, carrier: str) -> None:
    done = subprocess.run(
        [sys.executable, "-c", SCRIPT, how, carrier],
        capture_output=True,
        text=True,
        timeout=3 * HANG,
    )
    assert done.stdout == "woken\n", done.stderr


@pytest.mark.parametrize("readers", [1, 3])
def test_interrupting_from_another_thread_ends_a_write(readers: int) -> None:
    names = yarpy.LocalNames()
    with yarpy.Port("/w", names=names) as out:
        inputs = [yarpy.Port(f"/r{number}", names=names) for number in range(readers)]
        for port in inputs:
            out.connect(port.name, "fast_tcp")
        ended: list[Exception] = []

        def write() -> None:
            try:
                while True:
                    out.write("x" * 1_000_000)
            except yarpy.PortClosed as error:
                ended.append(error)

        thread = threading.Thread(target=write)
        thread.start()
        wait_until(lambda: all(link.stats.messages for link in out.outputs))
        out.interrupt()
        thread.join(30)
        assert len(ended) == 1 and "interrupted" in str(ended[0])
        out.resume()
        assert len(out.outputs) == readers, "connections stay"
        for port in inputs:
            port.close()


@pytest.mark.parametrize("value", ["x" * 1_000_000, 1], ids=["large", "small"])
def test_the_log_tells_of_a_reader_that_never_reads(
    value: str | int, caplog: pytest.LogCaptureFixture
) -> None:
    """Large messages wait in the system; of small ones so many go ahead of what is confirmed."""
    names = yarpy.LocalNames()
    with yarpy.Port("/w", names=names) as out, yarpy.Port("/r", names=names):
        out.connect("/r")

        def write() -> None:
            with pytest.raises(yarpy.PortClosed):
                while True:
                    out.write(value)

        thread = threading.Thread(target=write)
        thread.start()
        wait_until(lambda: "/r has taken nothing for 1 s" in caplog.text)
        out.interrupt()
        thread.join(HANG)
        assert not thread.is_alive()
