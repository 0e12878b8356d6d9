"""`yarpy ping`."""

import json
import re
import threading
import time

import pytest
from support.wait import wait_until

import yarpy
from yarpy.cli.verbs.ping import read_description, seconds, spread


def test_a_port(cli, names):
    with (
        yarpy.Port("/ping/a", names=names) as a,
        yarpy.Port("/ping/b", names=names, callback=lambda message: None) as b,
    ):
        a.connect("/ping/b")
        said = cli.run("ping", "/ping/a")
        assert (said.returncode, said.stderr) == (0, "")
        assert said.stdout == (
            f'This is "/ping/a" at "tcp://{a.address}/"\n'
            'There is an output connection from "/ping/a" to "/ping/b" using tcp\n'
            'There is an input connection from "<ping>" to "/ping/a" using text_ack\n'
        )
        said = cli.run("ping", "--json", "/ping/b")
        assert json.loads(said.stdout) == {
            "port": "/ping/b",
            "address": f"tcp://{b.address}/",
            "outputs": [],
            "inputs": [{"name": "/ping/a", "carrier": "tcp"}],
        }


def test_who_is_not_registered_as_tcp(here, server, names):
    """C++ says the opposite for these."""
    assert here("ping", "/root").code == 0
    said = here("ping", "fallback")
    assert (said.code, said.out) == (1, "")
    names.register("/ping/odd", "", server.host, server.port)
    assert here("ping", "/ping/odd").code == 0


@pytest.mark.parametrize("topic", ["zenoh://in", "ros2://x"])
@pytest.mark.parametrize("words", [[], ["--time"]])
def test_a_topic_is_no_port(here, topic, words):
    said = here("ping", *words, topic)
    assert said.code == 1
    assert f'error: "{topic}" is no port but a topic of {topic.partition(":")[0]}' in said.err


def test_nobody(here, names):
    said = here("ping", "/nobody")
    assert (said.code, said.out) == (1, "")
    assert said.err.startswith('error: no port "/nobody" is registered')
    names.register("/ping/dead", "tcp", "127.0.0.1", 1)
    assert here("ping", "/ping/dead").code == 1


def test_time(here, names):
    with yarpy.Port("/ping/c", names=names):
        said = here("ping", "--time", "/ping/c")
        assert said.code == 0
        lines = said.out.splitlines()
        assert lines[0] == "Timing communication with /ping/c..."
        assert lines[1] == "Ping #1:" and lines[-3] == "Ping #10:"
        assert re.fullmatch(
            r"  [\d.]+ [mu]?s connection time \([\d.]+ [mu]?s with name lookup\)", lines[2]
        )
        assert re.fullmatch(r"  .* \+/- .* on average \(.* \+/- .* with name lookup\)", lines[-1])
        said = here("ping", "--time", "--json", "/ping/c")
        assert len(json.loads(said.out)["connection_times"]) == 10


def test_rate(here, names):
    stop = threading.Event()
    with yarpy.Port("/ping/d", names=names) as port:

        def send():
            while not stop.wait(0.05):
                port.write([1])

        sender = threading.Thread(target=send)
        sender.start()
        started = time.monotonic()
        try:
            said = here("ping", "--rate", "--duration", "1", "/ping/d")
        finally:
            passed = time.monotonic() - started
            stop.set()
            sender.join()
        assert said.code == 0
        assert said.out.startswith("Measuring rate of output from /ping/d...\n")
        match = re.search(r"^Period is ([\d.]+) \+/- [\d.e-]+ \((\d+)\)$", said.out, re.M)
        assert match is not None
        period, count = float(match[1]), int(match[2])
        assert 1 < count <= passed / 0.05 + 1 and 0 < period * (count - 1) < passed
        wait_until(lambda: not port.outputs)


def test_no_rate(here, names):
    with yarpy.Port("/ping/e", names=names):
        said = here("ping", "--rate", "--duration", "0.1", "--json", "/ping/e")
        assert said.code == 1
        assert json.loads(said.out)["messages"] == 0


@pytest.mark.parametrize(
    ("value", "text"),
    [
        (0.00039148331, "391.48331 us"),
        (0.00286055, "2.86055 ms"),
        (2.5, "2.50000 s"),
        (0, "0.00000 us"),
    ],
)
def test_seconds(value, text):
    assert seconds(value) == text


def test_spread():
    assert spread([0.001, 0.003]) == "2.00000 ms +/- 1.00000 ms"


def test_descriptions_of_strangers():
    lines = ["This is /x", "There is an elephant", "", "There is an output connection"]
    assert read_description(lines) == {"address": "", "outputs": [], "inputs": []}
