"""The helpers of the tests of ROS carriers."""

from support.ros_link import ADD, STRING, AddTwoInts, String, accept, header, taken_header

from yarpy.route import UNDECLARED


def test_the_types_are_those_of_ros() -> None:
    assert (String._md5sum, AddTwoInts.md5sum) == (STRING, ADD)


def test_an_end_is_welcomed() -> None:
    end, carrier = accept(header(callerid="/a", md5sum="*", topic="/t"), UNDECLARED, piece=1)
    assert carrier.name == "tcpros"
    assert taken_header(end) == (
        {"callerid": "/port", "md5sum": "*", "topic": "/t"},
        b"",
    )
