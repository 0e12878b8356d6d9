"""A managed node, changed by its program and by others."""

import json
import threading
from pathlib import Path
from typing import Any

import pytest
from support.process import Process
from support.ros2_peer import peer_command, peer_environment
from support.wait import HANG, wait_until

import yarpy
from yarpy.peers import ros2
from yarpy.peers.ros2.message.library import hash_of
from yarpy.peers.ros2.node.managed import EVENT, LifecyclePublisher
from yarpy.peers.ros2.node.state import State

STRING = "std_msgs/msg/String"


class Driver(ros2.LifecycleNode):
    """Fails where it is told to."""

    told: LifecyclePublisher
    answers: dict[str, object]

    def _say(self, name: str) -> Any:
        said = getattr(self, "answers", {}).get(name)
        if isinstance(said, Exception | SystemExit):
            raise said
        return said

    def on_configure(self) -> bool | None:
        self.told = self.lifecycle_publisher("told", STRING)
        return self._say("configure")  # type: ignore[no-any-return]

    def on_activate(self) -> bool | None:
        return self._say("activate")  # type: ignore[no-any-return]

    def on_error(self) -> bool | None:
        return self._say("error")  # type: ignore[no-any-return]


def test_a_life(names: yarpy.LocalNames) -> None:
    with Driver("/laser") as node:
        assert node.state is State.UNCONFIGURED
        assert not node.trigger("activate") and node.state is State.UNCONFIGURED
        assert node.trigger("configure") and node.state is State.INACTIVE
        assert not node.told.write("unheard")
        assert node.trigger("activate") and node.told.write("heard")
        assert node.trigger("deactivate") and node.trigger("cleanup")
        assert node.state is State.UNCONFIGURED
        assert node.trigger("shutdown") and node.state is State.FINALIZED
        assert not node.trigger("configure")


@pytest.mark.parametrize(
    ("answers", "state"),
    [
        ({"activate": False}, State.INACTIVE),
        ({"activate": OSError("no device")}, State.FINALIZED),
        ({"activate": OSError("no device"), "error": True}, State.UNCONFIGURED),
        ({"activate": OSError("no device"), "error": OSError("again")}, State.FINALIZED),
    ],
)
def test_what_fails(names: yarpy.LocalNames, answers: dict[str, object], state: State) -> None:
    with Driver("/laser") as node:
        node.trigger("configure")
        node.answers = answers
        assert not node.trigger("activate")
        assert node.state is state


def test_who_calls_sys_exit_is_in_no_state_in_between(names: yarpy.LocalNames) -> None:
    with Driver("/laser") as node:
        node.answers = {"configure": SystemExit(3)}
        thread = threading.Thread(target=node.trigger, args=("configure",))
        thread.start()
        thread.join(HANG)
        assert node.state is State.FINALIZED


def test_others_change_it(names: yarpy.LocalNames) -> None:
    """By the services that `ros2 lifecycle` uses."""
    change, get = "lifecycle_msgs/srv/ChangeState", "lifecycle_msgs/srv/GetState"
    ways = "lifecycle_msgs/srv/GetAvailableTransitions"
    events: list[Any] = []
    with Driver("/laser") as node, ros2.Node("/tool") as tool:
        tool.subscriber("/laser/transition_event", EVENT, events.append)
        assert tool.client("/laser/change_state", change).wait(HANG)
        wait_until(lambda: len(node._event.kind._type) > 0)
        for asked, done in (({"id": 1}, True), ({"label": "activate"}, True), ({"id": 1}, False)):
            answer = tool.call("/laser/change_state", change, [asked], timeout=HANG)
            assert answer.success is done
        found = tool.call("/laser/get_state", get, [], timeout=HANG).current_state
        assert (found.id, found.label) == (3, "active")
        listed = tool.call("/laser/get_available_transitions", ways, [], timeout=HANG)
        labels = [item.transition.label for item in listed.available_transitions]
        assert labels == ["deactivate", "shutdown"]
        whole = tool.call("/laser/get_transition_graph", ways, [], timeout=HANG)
        assert len(whole.available_transitions) == 25
        states = "lifecycle_msgs/srv/GetAvailableStates"
        told = tool.call("/laser/get_available_states", states, [], timeout=HANG)
        assert len(told.available_states) == 11
        # The first may have come before the subscription was known.
        wait_until(lambda: events and events[-1].goal_state.label == "active")
        assert node.state is State.ACTIVE


@pytest.mark.parametrize(
    ("service", "request_", "response", "asked", "answer"),
    [
        ("ChangeState", "uint8 id;string label", "bool success", {"id": 1, "label": ""}, True),
        ("ChangeState", "uint8 id;string label", "bool success", {"id": 3, "label": ""}, False),
        ("GetState", "", "uint8 id;string label", {}, 1),
    ],
)
def test_another_implementation(
    router: int,
    names: yarpy.LocalNames,
    tmp_path: Path,
    service: str,
    request_: str,
    response: str,
    asked: object,
    answer: object,
) -> None:
    """zenoh-ros2-sdk; what is nested is written as its fields, which have the same bytes."""
    type_ = f"lifecycle_msgs/srv/{service}"
    name = {"ChangeState": "change_state", "GetState": "get_state"}[service]
    said = (f"type={type_}", f"hash={hash_of(ros2.load(type_))}")
    words = (*said, f"request={request_}", f"response={response}")
    with Driver("/laser") as node:
        command = peer_command(router, "ask", f"{node.name}/{name}", *words)
        with Process(command, env=peer_environment(tmp_path)) as peer:
            wait_until(lambda: "ready" in peer.stdout, 2 * HANG)
            peer.write(json.dumps(asked) + "\n")
            wait_until(lambda: len(peer.stdout.splitlines()) > 1)
            found = json.loads(peer.stdout.splitlines()[1])
        assert found["id" if service == "GetState" else "success"] == answer


def test_over_dds(monkeypatch: pytest.MonkeyPatch) -> None:
    pytest.importorskip("cyclonedds", reason="pip install 'yarpy[dds]'")
    monkeypatch.setenv("ROS_LOCALHOST_ONLY", "1")
    with Driver("/laser", rmw="dds", domain=67) as node, ros2.Node("/t", rmw="dds", domain=67) as t:
        answer = t.call(
            "/laser/change_state", "lifecycle_msgs/srv/ChangeState", [[1, ""]], timeout=HANG
        )
        assert answer.success and node.state is State.INACTIVE
