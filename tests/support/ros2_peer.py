"""A node of ROS 2 by an independent implementation, as a program of its own; and the router.

    python ros2_peer.py PORT hear TOPIC            prints what is published, as JSON;
                                                   say=TOPIC publishes lines beside it
    python ros2_peer.py PORT show TOPIC            prints the fields of what is published; wants
                                                   type=, hash=, definition=
    python ros2_peer.py PORT say TOPIC             publishes the lines of its input
    python ros2_peer.py PORT serve NAME            adds two numbers for whoever asks
    python ros2_peer.py PORT call NAME             asks for the sums of the lines of its input
    python ros2_peer.py PORT list                  prints topics with their types, and nodes
    python ros2_peer.py PORT ask NAME              asks with the fields that lines of its input are
    python ros2_peer.py PORT act NAME              an action server, of Fibonacci

Rules: it is zenoh-ros2-sdk, with the definitions given as text, since it would download them. An
option `hash=...` gives the type another hash, `latched=1` keeps the last message, `qos=...` is the
text of a QoS. `ask` wants type=, hash=, request=, response=, with `;` between declarations: what is
nested is written as its fields, which have the same bytes.
"""

from __future__ import annotations

import contextlib
import json
import os
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

STRING = "string data"
ADD = {"request_definition": "int64 a\nint64 b", "response_definition": "int64 sum"}
ADD_TYPE = "example_interfaces/srv/AddTwoInts"
ADD_HASH = "RIHS01_e118de6bf5eeb66a2491b5bda11202e7b68f198d6f67922cf30364858239c81a"
LATCHED = ":1:,1:,:,:,,"


@contextlib.contextmanager
def ros2_router() -> Iterator[int]:
    """A router of Zenoh on the loopback; its number."""
    from support.port import free_port  # the peer is a program by itself, which has none

    from yarpy.peers.zenoh.router import open_router
    from yarpy.peers.zenoh.transport import close

    port = free_port()
    router = open_router([f"127.0.0.1:{port}"])
    try:
        yield port
    finally:
        close(router)


def peer_command(port: int, *words: str) -> list[str]:
    """The command line of the program."""
    return [sys.executable, "-P", __file__, str(port), *words]  # not what lies beside it


def peer_environment(home: Path) -> dict[str, str]:
    """Its environment: a client, since routers do not forward between peers."""
    return {**os.environ, "HOME": str(home), "ZENOH_CONFIG_OVERRIDE": 'mode="client"'}


#: the services of Fibonacci: type, hash, request, response
ACTION = {
    "send_goal": (
        "example_interfaces/action/Fibonacci_SendGoal",
        "RIHS01_d1a57fb2a4afe8c21e34fb10db206f16ce6729b28531141472df92277c55b557",
        "uint8[16] goal_id;int32 order",
        "bool accepted;int32 sec;uint32 nanosec",
    ),
    "get_result": (
        "example_interfaces/action/Fibonacci_GetResult",
        "RIHS01_1b0de0d5d29dc955d92f546706568428632771db13ec84c15ec1c1a59f424a57",
        "uint8[16] goal_id",
        "int8 status;int32[] sequence",
    ),
}


def _array(value: Any) -> Any:
    import numpy as np

    numbers = isinstance(value, list) and value and not isinstance(value[0], str)
    return np.array(value, "u1") if numbers else value


def _plain(value: Any) -> Any:
    return value.tolist() if hasattr(value, "tolist") else value


def _fields(value: Any) -> Any:
    """A message as JSON has it."""
    if hasattr(value, "__dataclass_fields__"):
        names = [name for name in value.__dataclass_fields__ if name[0] != "_"]
        return {name: _fields(getattr(value, name)) for name in names}
    return [*map(_fields, value)] if isinstance(value, list) else _plain(value)


def _action_service(sdk: Any, name: str, what: str, where: dict[str, Any]) -> Any:
    """Half of an action server: what it is told is printed; the result is 0, 1, 1 of any goal."""
    import numpy as np

    kind, hash_, request, response = ACTION[what]
    made: Any = None

    def answer(asked: Any) -> Any:
        _say([what, _plain(asked.goal_id), getattr(asked, "order", None)])
        if what == "send_goal":
            return made.response_msg_class(accepted=asked.order > 0, sec=1, nanosec=2)
        return made.response_msg_class(status=4, sequence=np.array([0, 1, 1], "i4"))

    made = sdk.ROS2ServiceServer(
        f"{name}/_action/{what}",
        kind,
        answer,
        type_hash=hash_,
        request_definition=request.replace(";", "\n"),
        response_definition=response.replace(";", "\n"),
        **{**where, "node_name": f"sdk_{what}"},
    )
    return made


def _say(item: Any) -> None:
    print(json.dumps(item), flush=True)


def main(port: int, verb: str, name: str, options: dict[str, str]) -> None:
    import zenoh_ros2_sdk as sdk

    where: dict[str, Any] = {"router_port": port, "node_name": f"sdk_{verb}"}
    topic: dict[str, Any] = {**where, "msg_definition": STRING}
    if "hash" in options:
        topic["type_hash"] = options["hash"]
    if "latched" in options:
        topic["qos"] = LATCHED
    elif "qos" in options:
        topic["qos"] = options["qos"]
    kind = options.get("type", "std_msgs/msg/String")
    if verb == "hear":
        node = sdk.ROS2Subscriber(name, kind, lambda message: _say(message.data), **topic)
        also = sdk.ROS2Publisher(options["say"], kind, **topic) if "say" in options else None
        _say("ready")
        for line in sys.stdin:
            also.publish(data=line.rstrip("\n"))  # type: ignore[union-attr]
        node.close()
    elif verb == "show":
        topic["msg_definition"] = options["definition"]
        node = sdk.ROS2Subscriber(name, kind, lambda message: _say(_fields(message)), **topic)
        _say("ready")
        sys.stdin.read()
        node.close()
    elif verb == "say":
        publisher = sdk.ROS2Publisher(name, kind, **topic)
        _say("ready")
        for line in sys.stdin:
            publisher.publish(data=line.rstrip("\n"))
        publisher.close()
    elif verb == "serve":
        made: Any = None

        def add(asked: Any) -> Any:
            return made.response_msg_class(sum=asked.a + asked.b)

        made = sdk.ROS2ServiceServer(name, ADD_TYPE, add, type_hash=ADD_HASH, **ADD, **where)
        _say("ready")
        sys.stdin.read()
        made.close()
    elif verb == "call":
        client = sdk.ROS2ServiceClient(name, ADD_TYPE, type_hash=ADD_HASH, **ADD, **where)
        _say("ready")
        for line in sys.stdin:
            a, b = map(int, line.split())
            answer = client.call(a=a, b=b)
            _say(None if answer is None else int(answer.sum))
        client.close()
    elif verb == "ask":
        client = sdk.ROS2ServiceClient(
            name,
            kind,
            type_hash=options["hash"],
            request_definition=options["request"].replace(";", "\n"),
            response_definition=options["response"].replace(";", "\n"),
            **where,
        )
        _say("ready")
        for line in sys.stdin:
            answer = client.call(**{k: _array(v) for k, v in json.loads(line).items()})
            fields = {} if answer is None else vars(answer)
            _say({k: _plain(v) for k, v in fields.items() if k[0] != "_"})
        client.close()
    elif verb == "act":
        held = [_action_service(sdk, name, what, where) for what in ACTION]
        _say("ready")
        sys.stdin.read()
        for item in held:
            item.close()
    elif verb == "list":
        from zenoh_ros2_sdk.discovery import get_topic_names_and_types

        _say(get_topic_names_and_types(router_port=port))
    os._exit(0)  # its session has threads that outlive it


if __name__ == "__main__":
    given = dict(word.split("=", 1) for word in sys.argv[3:] if "=" in word)
    names = [word for word in sys.argv[3:] if "=" not in word]
    main(int(sys.argv[1]), sys.argv[2], names[0] if names else "", given)
