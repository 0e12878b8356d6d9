"""Questions wait for the way to a server that is seen."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import pytest

from yarpy.peers.ros2.key import Key
from yarpy.peers.ros2.zenoh import querier
from yarpy.peers.ros2.zenoh.querier import Querier

pytest.importorskip("zenoh", reason="pip install eclipse-zenoh")


class Session:
    """One of Zenoh, in which a server can be reached after so many looks."""

    def __init__(self, looks: int) -> None:
        self.looks = looks
        self.asked: list[tuple[int, bytes]] = []
        self.open = True

    def declare_querier(self, key: str, **options: Any) -> Session:
        self.key = key
        return self

    @property
    def matching_status(self) -> Any:
        self.looks -= 1
        return SimpleNamespace(matching=self.looks < 0)

    def get(self, handler: Any, *, payload: bytes, attachment: bytes) -> None:
        self.asked.append((self.looks, payload + attachment))

    def undeclare(self) -> None:
        self.open = False


@pytest.fixture
def key() -> Key:
    return Key(0, "/add", "example_interfaces::srv::dds_::AddTwoInts_", "RIHS01_0")


def ask(session: Session, key: Key, served: bool) -> list[tuple[int, bytes]]:
    made = Querier(session, key)
    made.get(print, print, b"1 2", b"3", served)
    made.undeclare()
    assert session.key == str(key) and not session.open
    return session.asked


def test_who_is_seen_is_waited_for(key: Key) -> None:
    assert ask(Session(4), key, served=True) == [(-1, b"1 23")]


def test_who_is_not_seen_is_not(key: Key) -> None:
    assert ask(Session(4), key, served=False) == [(4, b"1 23")]


def test_the_wait_has_an_end(key: Key, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(querier, "ROUTED", 0.02)
    [(looks, said)] = ask(Session(10**6), key, served=True)
    assert looks < 10**6 and said == b"1 23"
