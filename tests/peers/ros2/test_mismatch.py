"""Others of another type, told once."""

from __future__ import annotations

import logging
import threading

import pytest
from support.wait import HANG

from yarpy.peers.ros2.key import NO_HASH, Key
from yarpy.peers.ros2.mismatch import MOST_TOLD, Mismatch, log
from yarpy.peers.ros2.name import NOBODY, Node
from yarpy.peers.ros2.token import PUBLISHER, Token

TEXT, NUMBER = "std_msgs::msg::dds_::String_", "std_msgs::msg::dds_::Int32_"
ONE, OTHER = (f"RIHS01_{digit * 64}" for digit in "01")
OURS = Key(0, "/chatter", TEXT, ONE)


def token(type_: str, hash_: str, node: Node = NOBODY) -> Token:
    return Token(0, "a", 0, 0, PUBLISHER, node, Key(0, "/chatter", type_, hash_))


def said(caplog: pytest.LogCaptureFixture) -> list[str]:
    return [item.getMessage() for item in caplog.records]


@pytest.fixture(autouse=True)
def heard(caplog: pytest.LogCaptureFixture) -> None:
    caplog.set_level(logging.WARNING, logger="yarpy")


def test_what_is_told(caplog: pytest.LogCaptureFixture) -> None:
    mismatch = Mismatch("/ear", OURS, strict=False)
    for _ in range(2):
        mismatch.look(token(NUMBER, NO_HASH))
        mismatch.look(token(TEXT, OTHER, Node("/robot", "head\n")))
    assert said(caplog) == [
        "/ear and a program do not hear each other at /chatter: it is std_msgs/msg/Int32 there and "
        f"std_msgs/msg/String ({ONE}) here; give both one type, or one of them another name",
        r"/ear and the node /robot/head\n do not hear each other at /chatter: it is "
        f"std_msgs/msg/String ({OTHER}) there and std_msgs/msg/String ({ONE}) here; give both the "
        "same version of that package",
    ]


def test_whom_the_middleware_keeps_apart(caplog: pytest.LogCaptureFixture) -> None:
    mismatch = Mismatch("/ear", OURS, strict=False)
    for _ in range(2):
        mismatch.refused(token(TEXT, NO_HASH), "it may grow there", "declare it as @final")
    assert said(caplog) == [
        "/ear and a program do not hear each other at /chatter: both call their type "
        "std_msgs/msg/String, but it may grow there; declare it as @final"
    ]


def test_what_fits(caplog: pytest.LogCaptureFixture) -> None:
    mismatch = Mismatch("/ear", OURS, strict=False)
    mismatch.look(token(TEXT, ONE))
    mismatch.look(token(TEXT, NO_HASH))
    mismatch.look(Token(0, "a", 0, 0, PUBLISHER, NOBODY))
    assert said(caplog) == []


def test_over_zenoh_no_version_is_another_one(caplog: pytest.LogCaptureFixture) -> None:
    Mismatch("/ear", OURS, strict=True).look(token(TEXT, NO_HASH))
    assert "do not hear each other" in said(caplog)[0]


def test_two_threads_tell_once(caplog: pytest.LogCaptureFixture) -> None:
    """Who is there is looked at by the thread that asks, and by the one that hears of news."""
    mismatch = Mismatch("/ear", OURS, strict=False)
    inside, both = threading.Event(), threading.Event()

    class Slow(set[object]):
        """The first to look whether it was told waits there, until the other one is done or would
        have to wait, too."""

        def __contains__(self, item: object) -> bool:
            found = super().__contains__(item)
            if not inside.is_set():
                inside.set()
                both.wait(0.2)
            return found

    mismatch._told = Slow()  # type: ignore[assignment]
    first = threading.Thread(target=mismatch.look, args=(token(NUMBER, NO_HASH),))
    first.start()
    assert inside.wait(HANG)
    second = threading.Thread(target=mismatch.look, args=(token(NUMBER, NO_HASH),))
    second.start()
    second.join(0.1)
    both.set()
    for thread in (first, second):
        thread.join(HANG)
    assert len(said(caplog)) == 1


def test_a_flood_is_not_told(monkeypatch: pytest.MonkeyPatch) -> None:
    told: list[object] = []
    monkeypatch.setattr(log, "warning", lambda *words: told.append(words))
    mismatch = Mismatch("/ear", OURS, strict=False)
    for number in range(2 * MOST_TOLD):
        mismatch.look(token(NUMBER, NO_HASH, Node("/", f"n{number}")))
    assert len(told) == MOST_TOLD
