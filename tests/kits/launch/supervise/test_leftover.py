"""The end of what a killed supervisor has left."""

import signal
import subprocess

import pytest

import yarpy
from yarpy import Bottle
from yarpy.kits.launch.supervise import leftover, process
from yarpy.kits.launch.supervise.leftover import end_all, end_away, told


def test_told() -> None:
    assert told({8: "b", 7: "a"}) == "a (pid 7), b (pid 8)"


@pytest.mark.skipif(not process.known(), reason="this system has no /proc to look at")
def test_both_the_willing_and_the_deaf_end() -> None:
    deaf = ["sh", "-c", "trap '' TERM; echo ready; while :; do sleep 0.05; done"]
    children = [
        subprocess.Popen(["sleep", "600"]),
        subprocess.Popen(deaf, stdout=subprocess.PIPE),
    ]
    out = children[1].stdout
    assert out is not None and out.readline() == b"ready\n"
    try:
        assert end_all({child.pid: "x" for child in children}, 0.2) == []
        assert [child.wait() for child in children] == [-15, -9]
    finally:
        out.close()
        for child in children:
            child.kill()
            child.wait()


@pytest.mark.skipif(not process.known(), reason="this system has no /proc to look at")
def test_who_is_gone_is_no_trouble() -> None:
    child = subprocess.Popen(["true"])
    child.wait()
    assert end_all({child.pid: "x"}, 5.0) == []


class Node:
    """The answers of a server of programs; SIGTERM ends those that are not deaf, and
    nothing those of stone."""

    def __init__(self, names: yarpy.LocalNames, *running: str) -> None:
        self.running = {*running}
        self.sent: list[tuple[str, int]] = []
        self.server = yarpy.RpcServer("/node", self.answer, names=names)

    def answer(self, message: yarpy.Message) -> list[str]:
        word, tag, *rest = message.as_(Bottle)[0]
        if word == "isrunning":
            return ["running" if tag in self.running else "not running"]
        number = rest[0] if rest else int(signal.SIGTERM)
        self.sent.append((tag, number))
        if "stone" not in tag and (number == 9 or "deaf" not in tag):
            self.running.discard(tag)
        return [f"{word} OK"]


def test_programs_at_servers_end_and_those_of_silent_ones_may_go_on(
    network: yarpy.LocalNames,
) -> None:
    found = {"a:x": "/node", "a:deaf": "/node", "a:over": "/node", "a:far": "/gone"}
    node = Node(network, "a:x", "a:deaf")
    with node.server:
        ended, left = end_away(found, 0.01, network)
        assert ended == ["a:x", "a:deaf"] and node.running == set()
        assert node.sent == [("a:x", 15), ("a:deaf", 15), ("a:deaf", 9)]
        assert [*left] == ["a:far"] and "/gone" in left["a:far"]


def test_one_that_does_not_end_holds_up_no_other_and_is_told(
    network: yarpy.LocalNames, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(leftover, "_GONE", 0.01)
    node = Node(network, "a:stone", "a:x")
    with node.server:
        ended, left = end_away({"a:stone": "/node", "a:x": "/node"}, 0.01, network)
    assert ended == ["a:x"] and node.running == {"a:stone"}
    assert left == {"a:stone": "it does not end, not even when it is killed"}
    assert node.sent == [("a:stone", 15), ("a:stone", 9), ("a:x", 15)]
