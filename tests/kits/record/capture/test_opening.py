"""The name of a recording, and the port of a recorder."""

import re
from pathlib import Path

import pytest

import yarpy
from yarpy.errors import AddressError, LocalProtocolError
from yarpy.kits.record.capture.opening import open_port, without_ending


@pytest.fixture
def names():
    with yarpy.NameServer() as server:
        yield server.client


def test_names() -> None:
    assert without_ending("a/walk.mcap") == Path("a/walk")
    assert without_ending(Path("walk.v2")) == Path("walk.v2")
    with pytest.raises(LocalProtocolError, match="no name of a recording"):
        without_ending(".")
    assert re.fullmatch(r"record-\d{4}(-\d\d){5}", str(without_ending(None)))


def test_ports(names) -> None:
    opened = []
    try:
        for _ in range(3):
            opened.append(open_port("", lambda m: None, lambda e: None, names))
        found = [port.name for port in opened]
        assert found[0] == "/record" and found[1].startswith("/record/")
        assert len({*found}) == 3
        with pytest.raises(AddressError):
            open_port("/record", lambda m: None, lambda e: None, names)
    finally:
        for port in opened:
            port.close()
