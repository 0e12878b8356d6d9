"""Templates: the answers of C++ YARP's type server, without its mistakes."""

import pytest

from yarpy.peers.ros.message.library import Library
from yarpy.peers.ros.message.template import template


@pytest.mark.parametrize(
    ("name", "text"),
    [
        ("std_msgs/String", "vector string 1 *"),
        ("std_msgs/Header", "list 3 uint32 * vector uint32 2 * string *"),
        (
            "sensor_msgs/JointState",
            "list 5 list 3 uint32 * vector uint32 2 * string * vector string * vector float64 * "
            "vector float64 * vector float64 *",
        ),
        ("geometry_msgs/Twist", "list 2 vector float64 3 * vector float64 3 *"),
        ("turtlesim/Pose", "vector float32 5 *"),
    ],
)
def test_recorded_answers(library: Library, name: str, text: str) -> None:
    assert template(library.message(name)._definition) == text


def test_what_cpp_gets_wrong(library: Library) -> None:
    field = template(library.message("sensor_msgs/PointField")._definition)
    assert field == "list 4 string * uint32 * uint8 * uint32 *"
    fixed = library.message_of("p/Fixed", "float64[36] covariance\nduration d")
    assert template(fixed._definition) == "list 2 vector float64 36 * vector int32 2 *"


def test_services(library: Library) -> None:
    add = library.service_of("p/Add", "int64 a\nint64 b\n---\nint64 sum")
    assert template(add.definition) == "vector int64 2 * --- vector int64 1 *"
    nothing = library.service_of("p/Nothing", "---")
    assert template(nothing.definition) == "list 0 --- list 0"


def test_what_no_template_says(library: Library) -> None:
    for name in ("sensor_msgs/PointCloud2", "test/Every"):
        assert template(library.message(name)._definition) == "?"
