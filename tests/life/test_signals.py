"""A signal handler that closes a port, above whatever frame of another call: it waits for no lock
that the frame has."""

from __future__ import annotations

import pytest
from support.cut import cut_at

import yarpy

FILES = (
    "nameserver/local.py",
    "nameserver/store.py",
    "port/hub.py",
    "port/inputs.py",
    "port/outputs.py",
    "link/counter.py",
    "begin/accept_loop.py",
    "begin/occupancy.py",
)


@pytest.mark.timeout(240)
@pytest.mark.parametrize("verb", ["connect", "disconnect", "write"])
def test_a_handler_closes_another_port_wherever_it_comes(verb: str) -> None:
    number, there = 0, True
    while there or number < 2:  # the second time Python 3.13 shows more
        number += 1
        names = yarpy.LocalNames()
        with (
            yarpy.BufferedPort("/in", names=names) as in_,
            yarpy.Port("/out", names=names) as out,
            yarpy.Port("/other", names=names) as other,
        ):
            other.connect("/in", "tcp")
            if verb == "disconnect":
                out.connect("/in", "tcp")
            acts = {
                "connect": lambda out=out: out.connect("/in", "tcp"),
                "disconnect": lambda out=out: out.disconnect("/in"),
                "write": lambda out=out: out.write([1]),
            }
            there = cut_at(number, acts[verb], *FILES, handle=other.close)
            assert there == other.closed
            assert (names.query("/other") is None) == there
            assert in_.name == "/in"
    assert number > 1
