"""Configurations of Zenoh: files, and what the environment says last."""

from __future__ import annotations

from pathlib import Path

import pytest
from support.port import free_port

from yarpy.errors import (
    AddressError,
    MissingFile,
)
from yarpy.peers.zenoh.config import WAIT_BEFORE_DROP, client
from yarpy.peers.zenoh.place import place
from yarpy.peers.zenoh.transport import share

pytest.importorskip("zenoh", reason='Zenoh: pip install "yarpy[zenoh]"')


pytestmark = pytest.mark.usefixtures("unconfigured")


def test_an_override_comes_last(lone_router: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("ZENOH_CONFIG_OVERRIDE", f'connect/endpoints=["{lone_router}"]')
    with share(f"tcp/127.0.0.1:{free_port()}") as shared:
        assert not shared.session.is_closed()
    monkeypatch.setenv("ZENOH_CONFIG_OVERRIDE", "no/such=1")
    with pytest.raises(AddressError, match="ZENOH_CONFIG_OVERRIDE"):
        share(lone_router)


def test_files_that_are_none(tmp_path: Path) -> None:
    with pytest.raises(MissingFile, match="no configuration file"):
        share(str(tmp_path / "none.json5"))
    (tmp_path / "bad.json5").write_text("{mode: ")
    with pytest.raises(AddressError, match="no configuration of Zenoh"):
        share(str(tmp_path / "bad.json5"))


def test_a_moment_without_room_on_the_way_to_a_router_drops_nothing(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    key = "transport/link/tx/queue/congestion_control/drop/wait_before_drop"
    assert client(place("tcp/127.0.0.1:7447")).get_json(key) == str(WAIT_BEFORE_DROP)
    assert client(place("lan")).get_json(key) == "1000"
    monkeypatch.setenv("ZENOH_CONFIG_OVERRIDE", f"{key}=5")
    assert client(place("tcp/127.0.0.1:7447")).get_json(key) == "5"
