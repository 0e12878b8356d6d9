"""What a port writes is spelled as its reader spells it, whichever version of YARP that is: 4 has
other floats (`data/yarp4.py`)."""

from __future__ import annotations

import pytest
from support.cpp import CppYarp
from support.wait import HANG

import yarpy

VALUES = [1, 2.25, "a b", [1.5, 2.5], ["x", 0.5]]
LINE = r'1 2\.25 "a b" \(1\.5 2\.5\) \(x 0\.5\)'


@pytest.mark.parametrize("carrier", ["tcp", "fast_tcp", "udp", "text"])
def test_floats_reach_readers_of_any_version(network: CppYarp, carrier: str) -> None:
    with network.popen("read", "/tool/cpp") as reader, yarpy.Port("/ours") as port:
        yarpy.wait_for("/tool/cpp", timeout=HANG)
        port.connect("/tool/cpp", carrier)
        for _ in range(3):
            port.write(VALUES)
        reader.wait_line(LINE, count=1 if carrier == "udp" else 3, timeout=HANG)
        assert port.outputs, "what cannot be read ends a connection"


def test_floats_of_questions(network: CppYarp) -> None:
    with network.popen("rpcserver", "--echo", "/tool/cpp"), yarpy.RpcClient() as client:
        yarpy.wait_for("/tool/cpp", timeout=HANG)
        client.connect("/tool/cpp")
        assert client.call(*VALUES, timeout=HANG) == VALUES
