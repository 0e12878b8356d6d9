"""Who listens to a port of this computer."""

from __future__ import annotations

import os
import socket
import sys

import pytest
from support.system import NO_OWNERS

from yarpy.platform.listening import listening


@pytest.mark.skipif(sys.platform != "win32", reason="only Windows says that to everybody")
@pytest.mark.skipif(bool(NO_OWNERS), reason=NO_OWNERS)
@pytest.mark.parametrize("family", [socket.AF_INET, socket.AF_INET6])
def test_whoever_listens_is_found(family: socket.AddressFamily) -> None:
    try:
        server = socket.create_server(("localhost", 0), family=family)
    except OSError:
        pytest.skip("this computer has no such addresses: give its loopback one of IPv6")
    with server:
        port = server.getsockname()[1]
        assert listening()[port] == os.getpid()
    assert port not in listening()


@pytest.mark.skipif(sys.platform == "win32", reason="Windows says it")
def test_elsewhere_nobody_says_it() -> None:
    assert listening() == {}
