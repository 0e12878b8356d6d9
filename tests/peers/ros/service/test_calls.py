"""Connections to services: how many there are, and for how long a call waits."""

import os
import socket
import sys
import threading
import time
from collections.abc import Iterator
from typing import Any

import pytest
from support.process import Process
from support.ros_graph import RosGraph
from support.wait import HANG, wait_until

from yarpy import idl
from yarpy.errors import LinkClosed, NoNameServer, Timeout
from yarpy.link.begin import handshake
from yarpy.peers.ros.master import RosMaster
from yarpy.peers.ros.node.node import Node
from yarpy.peers.ros.service.calls import ENOUGH, LOOK, Calls

TRIGGER: Any = idl.load("std_srvs/Trigger")


@pytest.fixture
def silent() -> Iterator[int]:
    """The number of a socket that takes connections and says nothing."""
    with socket.create_server(("127.0.0.1", 0)) as server:
        yield server.getsockname()[1]


def test_the_time_of_a_call_covers_dialling(
    graph: RosGraph, silent: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    given = []
    greet = handshake.greet

    def noted(*arguments: Any, timeout: float) -> Any:
        given.append(timeout)
        return greet(*arguments, timeout=timeout)

    monkeypatch.setattr(handshake, "greet", noted)
    where = f"rosrpc://127.0.0.1:{silent}"
    graph.master.call("registerService", "/deaf", "/silence", where, "http://127.0.0.1:1/")
    match = rf"/silence was not called within .*:{silent} did not"
    with Node("/impatient") as node, pytest.raises(Timeout, match=match):
        node.call("/silence", TRIGGER, timeout=0.2)
    assert given[0] <= 0.2
    graph.master.call("unregisterService", "/deaf", "/silence", where)


def test_the_time_of_a_call_covers_the_master(silent: int) -> None:
    calls = Calls("/impatient", RosMaster(f"http://127.0.0.1:{silent}/"))
    with pytest.raises(Timeout, match=r"/any was not called within 0.2 s: the ROS master did not"):
        calls.call("/any", TRIGGER, TRIGGER.Request(), 0.2)


def test_a_master_that_is_away_is_said_so() -> None:
    with socket.create_server(("127.0.0.1", 0)) as server:
        port = server.getsockname()[1]
    calls = Calls("/hopeful", RosMaster(f"http://127.0.0.1:{port}/"))
    with pytest.raises(NoNameServer):
        calls.call("/any", TRIGGER, TRIGGER.Request(), 60)
    with pytest.raises(NoNameServer):
        calls.wait("/any", None)


def test_threads_that_call_at_once_share_a_connection(
    graph: RosGraph, monkeypatch: pytest.MonkeyPatch
) -> None:
    greet = handshake.greet

    def slowly(*arguments: Any, **options: Any) -> Any:
        time.sleep(0.2)  # the others come meanwhile
        return greet(*arguments, **options)

    monkeypatch.setattr(handshake, "greet", slowly)
    answers = []
    with Node("/busy") as node, Node("/popular") as other:
        server = other.service("/popular_service", TRIGGER, lambda asked: [True, "yes"])

        def call() -> None:
            answers.append(node.call("/popular_service", TRIGGER, timeout=HANG).message)

        threads = [threading.Thread(target=call) for _ in range(4)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        assert answers == ["yes"] * 4
        assert len(server.inputs) == 1


THREADS = r"""
import rospy, threading
from std_srvs.srv import Trigger
rospy.init_node("many", disable_signals=True)
rospy.wait_for_service("/slow_service")
def ask(persistent):
    try:
        said = rospy.ServiceProxy("/slow_service", Trigger, persistent)()
        print(f"heard {said.message}\n", end="", flush=True)
    except rospy.ServiceException as error:
        print(f"heard {error}\n", end="", flush=True)
for number in range(4):
    threading.Thread(target=ask, args=(number % 2 == 0,)).start()
"""


def test_threads_of_a_node_of_rospy_are_answered_side_by_side(graph: RosGraph) -> None:
    """They have a connection each, all of one name; none takes the place of another."""
    together = threading.Barrier(4)

    def answer(asked: object) -> list[object]:
        together.wait(HANG)
        return [True, "yes"]

    with Node("/slow") as node:
        node.service("/slow_service", TRIGGER, answer)
        with graph.python(THREADS) as asking:
            asking.wait_line("^heard yes$", stream="out", count=4)


def test_a_call_waits_for_its_turn_no_longer_than_it_may(graph: RosGraph) -> None:
    go, asked = threading.Event(), threading.Event()

    def slow(question: object) -> object:
        asked.set()
        go.wait(HANG)
        return [True, "at last"]

    with Node("/queueing") as node, Node("/slow") as other:
        other.service("/slow_service", TRIGGER, slow)
        first = threading.Thread(target=node.call, args=("/slow_service", TRIGGER))
        first.start()
        assert asked.wait(HANG)
        with pytest.raises(Timeout, match="earlier calls have not ended"):
            node.call("/slow_service", TRIGGER, timeout=0.1)
        go.set()
        first.join()


def test_closing_a_node_ends_its_calls(graph: RosGraph) -> None:
    go, asked, ended = threading.Event(), threading.Event(), []

    def stuck(question: object) -> None:
        asked.set()
        go.wait(HANG)

    node = Node("/leaving")
    with Node("/stuck") as other:
        other.service("/stuck_service", TRIGGER, stuck)

        def call() -> None:
            with pytest.raises(LinkClosed):
                node.call("/stuck_service", TRIGGER, timeout=None)
            ended.append(True)

        caller = threading.Thread(target=call)
        caller.start()
        assert asked.wait(HANG)
        node.close()
        wait_until(lambda: ended, HANG, "the call ended")
        go.set()
        caller.join()


def test_waiting_for_a_service_asks_the_master_now_and_then(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    asked: list[float] = []
    slept: list[float] = []

    class Master(RosMaster):
        def service(self, name: str, timeout: float | None = None) -> Any:
            assert timeout is not None
            asked.append(timeout)
            return "there" if len(asked) == 4 else None

    asking, sleep = threading.get_ident(), time.sleep

    def noted(seconds: float) -> None:
        (slept.append if threading.get_ident() == asking else sleep)(seconds)

    monkeypatch.setattr("yarpy.peers.ros.service.calls.time.sleep", noted)
    calls = Calls("/waiting", Master("http://127.0.0.1:1/"))
    assert calls.wait("/any", None)
    assert slept == [LOOK] * 3
    asked.clear()
    assert not calls.wait("/any", 0)
    assert asked == [ENOUGH]


ROSPY_SERVER = """
import rospy, sys
from std_srvs.srv import Trigger, TriggerResponse
rospy.init_node("mortal", disable_signals=True)
rospy.Service("/mortal_service", Trigger, lambda asked: TriggerResponse(True, sys.argv[1]))
print("serves", flush=True)
rospy.spin()
"""
OUR_SERVER = """
import sys, threading, yarpy
node = yarpy.ros.Node("/mortal")
node.service("/mortal_service", "std_srvs/Trigger", lambda asked: [True, sys.argv[1]])
print("serves", flush=True)
threading.Event().wait()
"""
KEEPER = """
import rospy, sys
from std_srvs.srv import Trigger
rospy.init_node("keeper", disable_signals=True)
proxies = {}
for number, line in enumerate(sys.stdin, 1):
    if line not in proxies:
        rospy.wait_for_service("/mortal_service")
        proxies[line] = rospy.ServiceProxy("/mortal_service", Trigger, persistent=True)
    try:
        print(number, proxies[line]().message, flush=True)
    except Exception as error:
        print(number, type(error).__name__, flush=True)
"""


def test_a_persistent_proxy_of_rospy_has_the_same_fate_with_our_server(graph: RosGraph) -> None:
    """Of rospy the proxy never looks for its server again: whoever needs that makes another one."""
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join(sys.path)}

    def life(ours: bool) -> list[str]:
        def server(word: str) -> Process:
            if not ours:
                return graph.python(ROSPY_SERVER, word)
            return Process([sys.executable, "-c", OUR_SERVER, word], env=environment)

        def asked(which: str) -> str:
            said.append(which)
            keeper.write_line(which)
            return keeper.wait_line(rf"^{len(said)} (.*)$", stream="out")[1]

        said: list[str] = []
        with graph.python(KEEPER) as keeper:
            with server("one") as first:
                first.wait_line("serves")
                heard = [asked("old"), asked("old")]
                first.kill()
                heard += [asked("old"), asked("old")]
            with server("two") as second:
                second.wait_line("serves")
                return [*heard, asked("old"), asked("new"), asked("old"), asked("new")]

    theirs = life(ours=False)
    assert theirs[:2] == ["one", "one"] and theirs[5] == theirs[7] == "two"
    assert life(ours=True) == theirs


def test_our_client_finds_a_server_of_rospy_that_was_killed_and_has_come_back(
    graph: RosGraph,
) -> None:
    with Node("/faithful") as node:
        for word in ("one", "two"):
            with graph.python(ROSPY_SERVER, word) as server:
                server.wait_line("serves")
                assert node.call("/mortal_service", TRIGGER, timeout=HANG).message == word
                assert node.call("/mortal_service", TRIGGER, timeout=HANG).message == word
                server.kill()
                with pytest.raises(LinkClosed):
                    node.call("/mortal_service", TRIGGER, timeout=HANG)
