"""The graph that tokens make, without a session."""

import threading

import pytest

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
    assert [str(token) for token in found.wait("/goal", "MS", timeout=20.0)] == [HEARS]
    timer.join()


def test_there_is_a_limit(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(graph, "MOST", 10)
    found = Graph(0)
    for at in range(50):
        found.take(NODE.replace("/0/0/", f"/{at}/{at}/"), True)
    assert len(found.tokens) == 10
