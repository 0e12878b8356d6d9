"""Classes that carry finished bytes."""

from cyclonedds.idl.types import sequence, uint32

from yarpy.peers.ros.message.source import Texts
from yarpy.peers.ros2.dds.raw import raw_class
from yarpy.peers.ros2.message.library import Library, default_library


def test_bytes_go_and_come_as_they_are() -> None:
    kind = raw_class(default_library().message("sensor_msgs/JointState")._definition.struct)
    sample = kind.deserialize(bytearray(b"anything"))
    assert (sample.body, sample.serialize()) == (b"anything", b"anything")
    assert kind.__idl_typename__ == "sensor_msgs.msg.dds_.JointState_"


def test_a_class_is_whole_before_threads_share_it() -> None:
    kind = raw_class(default_library().message("sensor_msgs/JointState")._definition.struct)
    assert all(kind.__idl__._xt_bytedata)


def test_services_have_a_header() -> None:
    service = default_library().service("std_srvs/Trigger")
    made = raw_class(service.Request._definition.struct, "srv")
    assert made.__idl_typename__ == "std_srvs.srv.dds_.Trigger_Request_"
    assert [*made.__annotations__][:2] == ["guid", "seq"]
    action = default_library().service("example_interfaces/action/Fibonacci_SendGoal")
    made = raw_class(action.Response._definition.struct, "srv")
    assert made.__idl_typename__ == "example_interfaces.action.dds_.Fibonacci_SendGoal_Response_"


def test_wide_strings_have_the_bytes_of_numbers() -> None:
    library = Library([Texts({"p/T": "wstring a"}, "here")])
    made = raw_class(library.message("p/T")._definition.struct)
    assert made.__annotations__ == {"a": sequence[uint32]}
