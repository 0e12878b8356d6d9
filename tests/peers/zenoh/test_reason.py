"""Why a router of Zenoh could not be reached."""

from __future__ import annotations

from pathlib import Path

import pytest
from support import tls
from support.port import free_port

from yarpy.errors import (
    LinkClosed,
    RemoteProtocolError,
)
from yarpy.peers.zenoh import config as zenoh_config
from yarpy.peers.zenoh import reason as zenoh_reason
from yarpy.peers.zenoh.router import open_router
from yarpy.peers.zenoh.transport import close, share

pytest.importorskip("zenoh", reason='Zenoh: pip install "yarpy[zenoh]"')


@pytest.fixture(autouse=True)
def _nothing_configured(monkeypatch: pytest.MonkeyPatch) -> None:
    for name in ("YARPY_ZENOH", "YARPY_TLS", "YARPY_TLS_DIR", "ZENOH_CONFIG_OVERRIDE"):
        monkeypatch.delenv(name, raising=False)


def test_no_router() -> None:
    with pytest.raises(LinkClosed, match=r"no Zenoh router .* refused.*`yarpy router`"):
        share(f"tcp/127.0.0.1:{free_port()}")


def test_tls_both_ways(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    tls.prepare(tmp_path / "tls", monkeypatch, "mutual")
    where = f"127.0.0.1:{free_port()}"
    router = open_router([where])
    try:
        with share(where) as shared:
            assert [str(link.dst) for link in shared.session.info.links()] == [f"tls/{where}"]
        monkeypatch.setenv("YARPY_TLS", "")
        with pytest.raises(LinkClosed, match=r"wants TLS"):
            share(f"tcp/{where}")
        (tmp_path / "strangers").mkdir()
        (tmp_path / "strangers" / "ca.pem").write_bytes((tmp_path / "tls" / "ca.pem").read_bytes())
        monkeypatch.setenv("YARPY_TLS_DIR", str(tmp_path / "strangers"))
        with pytest.raises(RemoteProtocolError, match="refuses our certificate"):
            share(f"tls/{where}")
        tls.prepare(tmp_path / "others", monkeypatch)
        with pytest.raises(RemoteProtocolError, match="certificate is not valid"):
            share(f"tls/{where}")
    finally:
        close(router)


def test_a_router_that_speaks_no_tls(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    tls.prepare(tmp_path, monkeypatch)
    monkeypatch.setenv("YARPY_TLS", "")
    monkeypatch.setattr(zenoh_config, "OPEN_TIMEOUT", 200)
    monkeypatch.setattr(zenoh_reason, "HANDSHAKE", 0.2)
    where = f"127.0.0.1:{free_port()}"
    router = open_router([f"tcp/{where}"])
    try:
        with pytest.raises(LinkClosed, match="says nothing in TLS"):
            share(f"tls/{where}")
    finally:
        close(router)
