"""Routers of Zenoh."""

from __future__ import annotations

import sys
from pathlib import Path

import pytest
from support.port import free_port
from support.wait import wait_until
from support.zenoh_session import ask, listening

from yarpy.errors import (
    LinkClosed,
    MissingFile,
)
from yarpy.peers.zenoh import router as zenoh_router
from yarpy.peers.zenoh.router import open_router, unjoined
from yarpy.peers.zenoh.transport import close, share

pytest.importorskip("zenoh", reason='Zenoh: pip install "yarpy[zenoh]"')


pytestmark = pytest.mark.usefixtures("unconfigured")


def test_a_router_of_a_chain_passes_on_what_the_next_one_has(lone_router: str) -> None:
    second = f"tcp/127.0.0.1:{free_port()}"
    chained = open_router([second], [lone_router])
    try:
        with share(lone_router) as one, share(second) as other:
            queryable = one.session.declare_queryable("x/y", lambda q: q.reply("x/y", b"far"))
            wait_until(lambda: ask(other.session, "x/y") == [b"far"])
            queryable.undeclare()
    finally:
        chained.close()


def test_two_routers_cannot_have_one_address(lone_router: str) -> None:
    with pytest.raises(LinkClosed, match="no router can listen"):
        open_router([lone_router])


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
    lone_router: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    nobody = f"tcp/127.0.0.1:{free_port()}"
    named = lone_router.replace("127.0.0.1", "localhost")
    second = open_router([f"tcp/127.0.0.1:{free_port()}"], [named, nobody])
    try:
        assert unjoined(second, [named]) == []
        monkeypatch.setattr(zenoh_router, "JOINING", 0.0)
        assert unjoined(second, []) == unjoined(second, [lone_router]) == []
        (line,) = unjoined(second, [lone_router, nobody])
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
