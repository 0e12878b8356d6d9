"""What the tests of sessions of Zenoh need."""

from collections.abc import Iterator

import pytest
from support.port import free_port


@pytest.fixture
def unconfigured(monkeypatch: pytest.MonkeyPatch) -> None:
    """The environment says nothing of Zenoh."""
    for name in ("YARPY_ZENOH", "YARPY_TLS", "YARPY_TLS_DIR", "ZENOH_CONFIG_OVERRIDE"):
        monkeypatch.delenv(name, raising=False)


@pytest.fixture
def router(unconfigured: None) -> Iterator[str]:
    """The address of a router."""
    from yarpy.transports.zenoh_router import open_router

    where = f"tcp/127.0.0.1:{free_port()}"
    session = open_router([where])
    yield where
    session.close()
