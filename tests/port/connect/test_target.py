"""What a target and a carrier mean together, before any port is asked."""

from __future__ import annotations

import subprocess
import sys

import pytest
from support.wait import HANG

from yarpy.nameserver.local import LocalNames
from yarpy.port.connect.target import joined, unknown
from yarpy.port.port import Port

JOINED = [
    # destination, carrier, as one text
    ("/in", "", "/in"),
    ("/in", "tcp", "tcp://in"),
    ("/in", "tcp+recv.x", "tcp+recv.x://in"),
    ("udp://in", "tcp", "tcp://in"),
    ("/127.0.0.1:10002", "tcp", "tcp://127.0.0.1:10002"),
    ("tcp://127.0.0.1:10002/", "udp", "udp://127.0.0.1:10002"),
]


@pytest.mark.parametrize(("destination", "carrier", "text"), JOINED)
def test_destination_and_carrier_as_one(destination: str, carrier: str, text: str) -> None:
    assert joined(destination, carrier) == text


def test_nearest_name_is_suggested(names: LocalNames) -> None:
    with Port("/camera/left", names=names), Port("/camera/right", names=names):
        assert 'did you mean "/camera/left"' in str(unknown("/camera/lef", names))
        assert "is its program running" in str(unknown("/something", names))
    assert "is its program running" in str(unknown("/x", None))
    assert "HOST:NUMBER, over TCP; there is no ipc" in str(unknown("ipc:///tmp/x", None))


@pytest.mark.parametrize("module", ["yarpy.network.asking", "yarpy.network.pairing"])
def test_who_only_asks_loads_no_port(module: str) -> None:
    """Such as `yarpy name list`, a third of whose start it would be."""
    program = f"import sys, {module}; print({'yarpy.port.hub'!r} in sys.modules)"
    said = subprocess.check_output([sys.executable, "-c", program], text=True, timeout=HANG)
    assert said.strip() == "False"
