"""`yarpy scope`."""

from __future__ import annotations

import json
import signal
import urllib.request

import pytest
from support.wait import HANG, wait_until

import yarpy


def address(process):
    return process.wait_line(r"^/\S+ is shown at (http://\S+/)$", stream="out", timeout=HANG)[1]


def told(url):
    with urllib.request.urlopen(f"{url}data", timeout=HANG) as answer:
        return json.load(answer)


def test_numbers_of_ports(cli, names):
    words = ("--index", "0,2", "--min", "-1", "--max", "1", "--window", "5", "--carrier", "udp")
    with (
        yarpy.Port("/sc/a", names=names) as a,
        cli.start("scope", "/sc/a", "/sc/late", *words) as process,
    ):
        url = address(process)
        assert a.wait_for_outputs(timeout=HANG)
        assert a.outputs[0].carrier == "udp"

        def came():
            a.write([1.5, "x", 2.5])
            return told(url)["sources"][0]["rows"]

        wait_until(came)
        found = told(url)
        assert found["view"] == {"min": -1.0, "max": 1.0, "window": 5.0}
        assert [one["name"] for one in found["sources"]] == ["/sc/a", "/sc/late"]
        assert found["sources"][0]["rows"][0][1:] == [1.5, 2.5]
        assert found["waiting"][0].startswith("Waiting for /sc/late: ")
        with yarpy.Port("/sc/late", names=names) as late:
            assert late.wait_for_outputs(timeout=HANG)
            wait_until(lambda: not told(url)["waiting"])
        process.signal(signal.SIGINT)
        assert process.wait() == 130
    assert names.query(found["name"]) is None


def test_it_waits_for_whoever_connects(cli, names):
    with cli.start("scope") as process, yarpy.Port("/sc/b", names=names) as b:
        url = address(process)
        assert url == f"http://{names.query('/scope').address}/"
        b.connect("/scope")
        b.write([7])
        wait_until(lambda: told(url)["sources"])
        assert told(url)["sources"][0]["name"] == "/sc/b"
        for path in ("", "scope.js", "*/plot.js", "*/style.css", "*/common.js"):
            with urllib.request.urlopen(f"{url}{path}", timeout=HANG) as answer:
                assert answer.status == 200


def test_two_of_them_are_not_in_each_others_way(cli, names):
    with (
        yarpy.Port("/sc/c", names=names) as c,
        cli.start("scope", "/sc/c") as one,
        cli.start("scope", "/sc/c", "--name", "/sc/mine") as two,
    ):
        assert address(one) != address(two)
        assert c.wait_for_outputs(2, timeout=HANG)
        assert "/sc/mine" in [link.name for link in c.outputs]


@pytest.mark.parametrize(
    ("words", "error"),
    [
        (("--index", "x"), "is no index"),
        (("--min", "2", "--max", "1"), "--min 2 is not below --max 1"),
        (("--window", "0"), "--window"),
        (("noslash",), 'must start with "/"'),
        (("/sc/x", "--carrier", "nonsense"), "nonsense"),
        (("--name", "noslash"), 'must start with "/"'),
    ],
)
def test_wrong_use(here, words, error):
    said = here("scope", *words)
    assert (said.code, said.out) == (1, "")
    assert error in said.err
