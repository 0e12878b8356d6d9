"""A router of Zenoh for the tests of one file, a plain client of it, and names for ports."""

import json
from collections.abc import Iterator
from typing import Any

import pytest
from support.port import free_port
from support.wrapping import no_settings

import yarpy
from yarpy.names.default import DEFAULT

__all__ = ["client", "lone_router", "names", "no_settings", "router", "unconfigured"]


@pytest.fixture(scope="module")
def router() -> Iterator[str]:
    """Its address; this process finds it."""
    pytest.importorskip("zenoh", reason='Zenoh: pip install "yarpy[zenoh]"')
    from yarpy.peers.zenoh.router import open_router
    from yarpy.peers.zenoh.transport import close

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


@pytest.fixture
def unconfigured(monkeypatch: pytest.MonkeyPatch) -> None:
    """The environment says nothing of Zenoh."""
    for name in ("YARPY_ZENOH", "YARPY_TLS", "YARPY_TLS_DIR", "ZENOH_CONFIG_OVERRIDE"):
        monkeypatch.delenv(name, raising=False)


@pytest.fixture
def lone_router(unconfigured: None) -> Iterator[str]:
    """The address of a router that this process does not find by itself."""
    from yarpy.peers.zenoh.router import open_router

    where = f"tcp/127.0.0.1:{free_port()}"
    session = open_router([where])
    yield where
    session.close()
