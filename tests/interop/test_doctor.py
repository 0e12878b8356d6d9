"""The doctor and ports of C++ YARP, which do not count."""

from __future__ import annotations

import signal
import time

from support.cpp import CppYarp
from support.cpp_program import CppProgram
from support.wait import HANG, wait_until

import yarpy
from yarpy.kits.doctor import Case, examine


def probes(*wanted: str) -> set[str]:
    return {finding.probe for finding in examine(Case(*wanted, window=0.4))}


def test_what_is_found_at_cpp_ports(our_names: CppYarp) -> None:
    with (
        CppProgram(our_names) as peer,
        yarpy.BufferedPort("/doc/py/in", callback=lambda message: None) as in_,
    ):
        peer.do("out = yarp.BufferedPortBottle(); out.open('/doc/cpp/out')")
        assert probes("/doc/cpp/out", "/doc/py/in") == {"not-connected"}
        peer.do("yarp.Network.connect('/doc/cpp/out', '/doc/py/in')")
        assert in_.wait_for_inputs(timeout=HANG)
        assert probes("/doc/cpp/out", "/doc/py/in") == {"writes-nothing"}
        # It writes to a port of C++ that nobody reads.
        peer.do("plain = yarp.Port(); plain.open('/doc/cpp/in')")
        with yarpy.BufferedPort("/doc/py/out") as out:
            out.connect("/doc/cpp/in")
            wait_until(lambda: out.outputs)
            for number in range(20):
                out.write([number])
                time.sleep(0.002)
            found = probes("/doc/py/out", "/doc/cpp/in")
            assert found & {"held-up", "never-reads"}, found
        peer.process.signal(signal.SIGSTOP)
        try:
            assert "stopped" in probes("/doc/cpp/out", "/doc/py/in")
        finally:
            peer.process.signal(signal.SIGCONT)
        peer.process.kill()
        assert "dead-name" in probes("/doc/cpp/out", "/doc/py/in")
