"""Routers of Zenoh."""

from __future__ import annotations

import os
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from support.port import free_port
from support.wait import wait_until

from yarpy.errors import (
    LinkClosed,
    MissingFile,
)
from yarpy.transports import zenoh_router
from yarpy.transports.zenoh import close, share
from yarpy.transports.zenoh_router import open_router, unjoined

pytest.importorskip("zenoh", reason='Zenoh: pip install "yarpy[zenoh]"')


@pytest.fixture(autouse=True)
def _nothing_configured(monkeypatch: pytest.MonkeyPatch) -> None:
    for name in ("YARPY_ZENOH", "YARPY_TLS", "YARPY_TLS_DIR", "ZENOH_CONFIG_OVERRIDE"):
        monkeypatch.delenv(name, raising=False)


@pytest.fixture
def router() -> Iterator[str]:
    """The address of a router."""
    where = f"tcp/127.0.0.1:{free_port()}"
    session = open_router([where])
    yield where
    session.close()


def ask(session: Any, key: str) -> list[bytes]:
    return [reply.ok.payload.to_bytes() for reply in session.get(key, timeout=5)]


def listening() -> set[str]:
    """The listening sockets of this process, as numbers of the system."""
    own = {link for fd in Path("/proc/self/fd").glob("*") if (link := linked(fd))}
    found = set()
    for table in ("tcp", "tcp6", "udp"):
        for line in Path(f"/proc/self/net/{table}").read_text().splitlines()[1:]:
            words = line.split()
            if words[3] in ("0A", "07") and f"socket:[{words[9]}]" in own:
                found.add(f"{table} {words[1]}")
    return found


def linked(path: Path) -> str:
    try:
        return os.readlink(path)
    except OSError:  # closed meanwhile
        return ""


def test_a_router_of_a_chain_passes_on_what_the_next_one_has(router: str) -> None:
    second = f"tcp/127.0.0.1:{free_port()}"
    chained = open_router([second], [router])
    try:
        with share(router) as one, share(second) as other:
            queryable = one.session.declare_queryable("x/y", lambda q: q.reply("x/y", b"far"))
            wait_until(lambda: ask(other.session, "x/y") == [b"far"])
            queryable.undeclare()
    finally:
        chained.close()


def test_two_routers_cannot_have_one_address(router: str) -> None:
    with pytest.raises(LinkClosed, match="no router can listen"):
        open_router([router])


@pytest.mark.skipif(sys.platform != "linux", reason="looks into /proc")
def test_a_file_changes_what_it_mentions(tmp_path: Path) -> None:
    port = free_port()
    file = tmp_path / "router.json5"
    file.write_text(f'{{listen: {{endpoints: ["tcp/127.0.0.1:{port}"]}}}}')
    before = listening()
    router = open_router(file=str(file))
    assert len(listening() - before) == 1  # and nothing for scouting
    close(router)
    router = open_router([f"tcp/127.0.0.1:{free_port()}"], file=str(file))
    with pytest.raises(LinkClosed):
        share(f"tcp/127.0.0.1:{port}")
    close(router)


def test_a_router_without_a_certificate(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("YARPY_TLS_DIR", str(tmp_path))
    with pytest.raises(MissingFile, match="yarpy cert"):
        open_router([f"tls/127.0.0.1:{free_port()}"])


def test_those_that_are_not_joined_are_told_one_by_one(
    router: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    nobody = f"tcp/127.0.0.1:{free_port()}"
    named = router.replace("127.0.0.1", "localhost")
    second = open_router([f"tcp/127.0.0.1:{free_port()}"], [named, nobody])
    try:
        assert unjoined(second, [named]) == []
        monkeypatch.setattr(zenoh_router, "JOINING", 0.0)
        assert unjoined(second, []) == unjoined(second, [router]) == []
        (line,) = unjoined(second, [router, nobody])
        assert line == f"not joined with {nobody} yet: Connection refused"
    finally:
        close(second)


def test_a_router_that_has_dialled_us_is_joined(monkeypatch: pytest.MonkeyPatch) -> None:
    own = f"tcp/127.0.0.1:{free_port()}"
    first = open_router([own])
    second = open_router([f"tcp/127.0.0.1:{free_port()}"], [own])
    try:
        assert unjoined(first, [f"tcp/127.0.0.1:{free_port()}"]) == []
        monkeypatch.setattr(zenoh_router, "JOINING", 0.0)
        (line,) = unjoined(first, ["tcp/127.1.2.3:1"])
        assert line.startswith("not joined with tcp/127.1.2.3:1 yet: ")
    finally:
        close(second)
        close(first)
