"""The graph that tokens make, without a session."""

import threading

import pytest
from support.wait import HANG

from yarpy.peers.ros2.name import Node
from yarpy.peers.ros2.token import Token
from yarpy.peers.ros2.zenoh import graph
from yarpy.peers.ros2.zenoh.graph import Graph

NODE = "@ros2_lv/0/abc/0/0/NN/%/%robot/arm"
HASH = "TypeHashNotSupported"
HEARS = f"@ros2_lv/0/abc/0/1/MS/%/%robot/arm/%goal/std_msgs::msg::dds_::String_/{HASH}/::,10:,:,:,,"
SAYS = HEARS.replace("/1/MS/", "/2/MP/").replace("%goal", "%robot%pose")


def test_what_is_there() -> None:
    found = Graph(0)
    for text in (NODE, HEARS, SAYS, HEARS, "@ros2_lv/0/nonsense", "x" * 10_000):
        found.take(text, True)
    assert [str(token) for token in found.tokens] == [NODE, HEARS, SAYS]
    assert [str(token) for token in found.endpoints("/goal", "MS")] == [HEARS]
    assert found.endpoints("/goal", "MP") == []
    assert [token.kind for token in found.endpoints("/robot/pose", "MP", "MS")] == ["MP"]
    assert found.nodes(Node("/robot", "arm")) == {("abc", 0)}
    found.take(HEARS, False)
    found.take(HEARS, False)
    assert found.endpoints("/goal", "MS") == []


def test_watching() -> None:
    found, seen = Graph(0), []  # type: ignore[var-annotated]

    def watch(token: Token, come: bool) -> None:
        seen.append((token.kind, come))

    found.take(NODE, True)
    assert [token.kind for token in found.watch(watch)] == ["NN"]
    for text, come in ((HEARS, True), (HEARS, True), (HEARS, False)):
        found.take(text, come)
    found.unwatch(watch)
    found.take(SAYS, True)
    assert seen == [("MS", True), ("MS", False)]


def test_waiting() -> None:
    found = Graph(0)
    assert found.wait("/goal", "MS", timeout=0.01) == []
    timer = threading.Timer(0.05, found.take, (HEARS, True))
    timer.start()
    assert [str(token) for token in found.wait("/goal", "MS", timeout=HANG)] == [HEARS]
    timer.join()


def test_there_is_a_limit(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(graph, "MOST", 10)
    found = Graph(0)
    for at in range(50):
        found.take(NODE.replace("/0/0/", f"/{at}/{at}/"), True)
    assert len(found.tokens) == 10


def test_there_is_a_limit_of_letters(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(graph, "MOST_LETTERS", len(NODE) + len(SAYS))
    found = Graph(0)
    for text in (NODE, HEARS, SAYS):
        found.take(text, True)
    assert [str(token) for token in found.tokens] == [NODE, HEARS]
    found.take(SAYS, False)  # which was not kept
    found.take(HEARS, False)
    found.take(SAYS, True)
    assert [str(token) for token in found.tokens] == [NODE, SAYS]


def test_a_flood_is_gone_without_a_trace() -> None:
    """5000 endpoints of a topic and others of as many, which come and go: a node that flaps."""
    found = Graph(0)
    flood = [HEARS.replace("/1/MS/", f"/{at}/MS/") for at in range(1, 5001)]
    flood += [SAYS.replace("/2/MP/", f"/{at}/MP/").replace("pose", f"p{at}") for at in range(5000)]
    for _ in range(3):
        for text in flood:
            found.take(text, True)
        assert len(found.endpoints("/goal", "MS")) == 5000
        assert len(found.endpoints("/robot/p7", "MP")) == 1
        for text in flood:
            found.take(text, False)
        assert found.tokens == [] and found.endpoints("/goal", "MS") == []
        assert (found._named, found._letters) == ({}, 0)
