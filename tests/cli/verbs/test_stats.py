"""`yarpy stats`."""

import json
import re
import signal
import threading
import time

import pytest
from support.system import NO_MARKS
from support.wait import HANG, wait_until

import yarpy
from yarpy.cli.verbs.stats import Tally, _measure, size_of

LINE = r"^[\d.e-]+ Mb/s, [\d.]+ btl/s, [\d.]+ mean period \(s\)$"


@pytest.fixture
def source(names):
    stop = threading.Event()
    with yarpy.Port("/stats/source", names=names) as port:

        def send():
            while not stop.wait(0.02):
                port.write([0, "x" * 100])

        sender = threading.Thread(target=send)
        sender.start()
        yield port
        stop.set()
        sender.join()


def test_each_second_and_the_total(cli, source):
    started = time.monotonic()
    said = cli.run("stats", "/stats/source", "--duration", "1.5")
    most = (time.monotonic() - started) / 0.02 + 1
    assert said.returncode == 0
    lines = said.stdout.splitlines()
    assert len(lines) == 3
    for line in lines[:2]:
        assert re.match(LINE, line)
    match = re.fullmatch(
        r"([\d.]+) total MB received,  (\d+) total bottles received, ([\d.]+) mean period \(s\)",
        lines[2],
    )
    assert match is not None
    assert 0 < int(match[2]) <= most
    assert abs(float(match[1]) - int(match[2]) * 128e-6) / float(match[1]) < 0.15
    assert float(match[3]) * int(match[2]) > 1.49


def test_a_wait_that_ends_a_moment_early_is_no_second(capsys: pytest.CaptureFixture[str]) -> None:
    """As on Windows, which measures time in steps: there was a line more, of no messages."""

    class Early:
        def read(self, timeout: float) -> yarpy.Message:
            time.sleep(timeout / 2)
            raise yarpy.Timeout("nothing came")

    _measure(Early(), Tally(), time.perf_counter() + 0.2, as_json=False)
    assert len(capsys.readouterr().out.splitlines()) == 1


@pytest.mark.parametrize("words", [(), ("--port_type", "Port", "--protocol", "fast_tcp")])
def test_until_interrupted(cli, source, words):
    with cli.start("stats", "/stats/source", *words) as process:
        process.wait_line(LINE, stream="out")
        process.signal(signal.SIGINT)
        assert process.wait() == 0
    assert "total bottles received" in process.stdout.splitlines()[-1]


def test_json(cli, source):
    said = cli.run("stats", "/stats/source", "--duration", "0.5", "--json")
    seconds, total = map(json.loads, said.stdout.splitlines())
    assert seconds["messages"] == total["total"]["messages"] > 0
    assert total["total"]["bytes"] > 100 * total["total"]["messages"]


def test_nobody(here):
    said = here("stats", "/nobody")
    assert said.code == 255 and said.err.count("error: Connection failed: ") == 1


def test_tally(monkeypatch):
    now = time.perf_counter()
    monkeypatch.setattr(time, "perf_counter", lambda: now)
    tally = Tally(started=now - 2.0)
    for _ in range(20):
        tally.count(47)
    assert tally.line() == "0.00376 Mb/s, 10 btl/s, 0.1 mean period (s)"
    assert (
        tally.total()
        == "0.00094 total MB received,  20 total bottles received, 0.1 mean period (s)"
    )
    assert Tally().period == 0.0


def test_size_of():
    assert size_of(yarpy.Message("D", b"12345")) == 5
    assert size_of(yarpy.Message("D", ["x"], spelling="object")) == 0


@pytest.fixture(scope="module")
def flowing(names):
    with (
        yarpy.Port("/over/in", names=names) as in_,
        yarpy.BufferedPort("/over/[bold]out", names=names) as out,
    ):
        out.connect("/over/in")
        out.outputs[0].qos = yarpy.Qos(packets=None if NO_MARKS else "HIGH")
        for number in range(5):
            wait_until(lambda number=number: out.write([number]))
            in_.read(timeout=HANG)
        yield out, in_


def test_all_connections(here, flowing):
    lines = here("stats", "--wide").out.splitlines()
    assert lines[0].split()[:4] == ["from", "to", "carrier", "messages"]
    [line] = [line for line in lines if "/over/in" in line]
    assert re.match(r"/over/\[bold\]out +/over/in +tcp +5 ", line)
    assert NO_MARKS or "AF42 / CS0" in line


def test_few_columns_by_default_and_numbers_aligned(here, flowing):
    lines = here("stats").out.splitlines()
    assert lines[0].split("  ")[0] == "from"
    assert re.split(r"  +", lines[0]) == ["from", "to", "carrier", "msg/s", "MB/s", "drops",
                                          "latency ms"]  # fmt: skip
    end = lines[0].index("drops") + len("drops")
    assert [line[:end].split()[-1].isdigit() for line in lines[1:]] == [True] * len(lines[1:])
    assert all(line[end : end + 1] in ("", " ") for line in lines[1:])


def test_what_is_written_to_nobody_is_no_trouble(here, flowing):
    with yarpy.Port("/over/idle") as idle:
        idle.write(["nobody"])
        assert "/over/idle" not in here("stats").out
        lines = here("stats", "--wide").out.splitlines()
    [line] = [line for line in lines if "/over/idle" in line]
    assert line.split()[:5] == ["/over/idle", "(past)", "0", "0", "0"]
    assert "1" in line.split()


def test_all_connections_for_programs(here, flowing):
    told = [json.loads(line) for line in here("stats", "--json").out.splitlines()]
    [flow] = [one for one in told if one["target"] == "/over/in"]
    assert (flow["source"], flow["carrier"]) == ("/over/[bold]out", "tcp")
    assert flow["sender"]["messages"] == flow["receiver"]["messages"] == 5
    assert flow["sender"]["qos"]["packets"] == ("CS0" if NO_MARKS else "AF42")
