"""Names of topics and nodes."""

import pytest

from yarpy.errors import AddressError
from yarpy.peers.ros2.name import Node, check_node, check_topic, node_of


def test_topics() -> None:
    assert check_topic("chatter") == check_topic("/chatter") == "/chatter"
    assert check_topic("/robot1/camera/image_raw") == "/robot1/camera/image_raw"
    for name in ("", "/", "a b", "1a", "a//b", "a/1", "a:o", "ü", "a" * 300, "a/*", "a%b"):
        with pytest.raises(AddressError, match="no name of ROS 2"):
            check_topic(name)


@pytest.mark.parametrize(
    ("port", "node"),
    [
        ("/icub/head/state:o", Node("/icub/head", "state_o")),
        ("/chatter", Node("/", "chatter")),
        ("/tmp/port/1", Node("/tmp/port", "n1")),
        ("/ä/b-c", Node("/n_", "b_c")),
        ("", Node("/", "yarpy")),
    ],
)
def test_ports_as_nodes(port: str, node: Node) -> None:
    assert node_of(port) == node
    assert check_node(str(node)) == node
