"""A router of Zenoh for the tests of one file, a plain client of it, and names for ports."""

import json
from collections.abc import Iterator
from typing import Any

import pytest
from support.port import free_port

import yarpy
from yarpy.names.default import DEFAULT


@pytest.fixture(scope="module")
def router() -> Iterator[str]:
    """Its address; this process finds it."""
    from yarpy.transports.zenoh import close
    from yarpy.transports.zenoh_router import open_router

    where = f"tcp/127.0.0.1:{free_port()}"
    opened = open_router([where])
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("YARPY_ZENOH", where)
        yield where
    close(opened)


@pytest.fixture
def client(router: str) -> Iterator[Any]:
    """A session that knows nothing of YARP."""
    import zenoh

    said = {
        "mode": "client",
        "connect": {"endpoints": [router]},
        "scouting": {"multicast": {"enabled": False}},
    }
    with zenoh.open(zenoh.Config.from_json5(json.dumps(said))) as session:
        yield session


@pytest.fixture
def names() -> Iterator[yarpy.LocalNames]:
    """Names within this process."""
    found = yarpy.LocalNames()
    DEFAULT.push(found)
    try:
        yield found
    finally:
        DEFAULT.pop(found)
