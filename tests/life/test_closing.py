"""Closing a port whose readers take nothing: it ends in time; what did not leave is counted, and
said in the log."""

from __future__ import annotations

import re
import threading
import time

import pytest
from support.lasted import lasted
from support.system import NO_MEMFD, NO_UNIX_SOCKETS
from support.wait import wait_until

import yarpy

LIMIT = 0.5  # seconds for closing
SLACK = 2.0  # beyond that, on a loaded machine: what would be wrong is late by more
HANG = 20.0
FULL = 3  # writes in a row that do not go: the first may be a busy machine's
LINE = re.compile(
    r"/out: (\S+) did not take all that was written before the connection was closed: (\d+) "
    r"messages are lost, (\d+) may have arrived or not"
)


def books(port: yarpy.Port | yarpy.BufferedPort) -> dict[str, int]:
    stats = port.stats.past.outputs
    return {
        name: int(getattr(stats, name)) for name in ("messages", "drops", "replaced", "unconfirmed")
    }


@pytest.mark.parametrize("carrier", ["tcp", "fast_tcp", "unix_stream", "memory"])
@pytest.mark.parametrize("kind", [yarpy.Port, yarpy.BufferedPort])
def test_a_reader_that_takes_nothing(
    kind: type[yarpy.Port], carrier: str, caplog: pytest.LogCaptureFixture
) -> None:
    names = yarpy.LocalNames()
    with yarpy.Port("/in", names=names), kind("/out", names=names) as out:
        out.connect("/in", carrier)
        written = refused = 0
        while refused < FULL and written < 200:  # until nothing more goes
            written += 1
            refused = 0 if out.write(["x" * 300_000], timeout=0.05) else refused + 1
        begun = time.monotonic()
        out.close(timeout=LIMIT)
        assert lasted(begun) < LIMIT + SLACK
        found = books(out)
        assert sum(found.values()) == written
        wait_until(lambda: LINE.search(caplog.text))  # a busy machine's comes behind the limit
        [(target, lost, unsure)] = LINE.findall(caplog.text)
        assert target == "/in"
        assert int(unsure) == found["unconfirmed"]
        assert int(lost) <= found["drops"]
        assert int(lost) + int(unsure) > 0


@pytest.mark.parametrize("carrier", ["tcp", "fast_tcp"])
def test_a_write_that_waits_for_such_a_reader_ends(carrier: str) -> None:
    names = yarpy.LocalNames()
    with yarpy.Port("/in", names=names), yarpy.Port("/out", names=names) as out:
        out.connect("/in", carrier)
        ended: list[str] = []

        def write() -> None:
            try:
                while True:
                    out.write(["x" * 1_000_000])
            except yarpy.PortClosed as error:
                ended.append(str(error))

        thread = threading.Thread(target=write)
        thread.start()
        wait_until(lambda: out.stats.outputs[0].messages > 0)
        begun = time.monotonic()
        out.close(timeout=LIMIT)
        assert lasted(begun) < LIMIT + SLACK
        thread.join(HANG)
        assert ended == ['"/out" is closed']


def test_others_get_what_was_written_though_one_takes_nothing() -> None:
    """Each has its share of the time."""
    names = yarpy.LocalNames()
    with (
        yarpy.Port("/stuck", names=names),
        yarpy.BufferedPort("/in", names=names, strict=True) as in_,
        yarpy.BufferedPort("/out", names=names) as out,
    ):
        out.connect("/stuck", "tcp")
        out.connect("/in", "tcp")
        for _ in range(20):
            out.write(["x" * 300_000], wait=True, timeout=0.02)
        (late,) = [item.drops for item in out.stats.outputs if item.target == "/in"]
        assert late < 20  # those for which a busy machine took longer than the time of the write
        out.close(timeout=LIMIT)
        past = books(out)
        came = in_._hub.inputs.past.as_dict
        # Its thread may have the last ones in hand.
        wait_until(lambda: came()["messages"] == 20 - late)
        assert sum(past.values()) == 40
        assert past["unconfirmed"] <= 20


def test_a_close_in_good_order_says_nothing(caplog: pytest.LogCaptureFixture) -> None:
    names = yarpy.LocalNames()
    with yarpy.BufferedPort("/in", names=names, strict=True) as in_:
        carriers = ["tcp", "fast_tcp", "text", "text_ack", "local"]
        carriers += [] if NO_UNIX_SOCKETS else ["unix_stream"]
        carriers += [] if NO_MEMFD else ["memory"]
        for carrier in carriers:
            with yarpy.Port("/out", names=names) as out:
                out.connect("/in", carrier)
                for number in range(100):
                    out.write([number])
            assert books(out) == {"messages": 100, "drops": 0, "replaced": 0, "unconfirmed": 0}
        for _ in range(100 * len(carriers)):
            assert in_.read(timeout=HANG) is not None
    assert not LINE.search(caplog.text)


@pytest.mark.parametrize("carrier", ["tcp", "fast_tcp", "text", "text_ack", "udp", "mcast"])
def test_a_reader_that_has_read_all_and_closes_is_no_cause_for_warning(
    carrier: str, caplog: pytest.LogCaptureFixture
) -> None:
    names = yarpy.LocalNames()
    with yarpy.Port("/out", names=names) as out:
        with yarpy.BufferedPort("/in", names=names, strict=True) as in_:
            out.connect("/in", carrier)
            assert in_.wait_for_inputs(timeout=HANG)
            out.write(["one"])
            assert in_.read(timeout=HANG) is not None
        wait_until(lambda: not out.outputs)
    assert not LINE.search(caplog.text)
