"""Topics of a program."""

import threading
from concurrent.futures import ThreadPoolExecutor
from typing import Any

import pytest
from support.wait import HANG, wait_until

import yarpy
from yarpy.peers import ros2


def test_what_is_written_is_heard(names: yarpy.LocalNames) -> None:
    heard: list[Any] = []
    with ros2.Node("/a") as a, ros2.Node("/b") as b:
        b.subscriber("/joints", "sensor_msgs/msg/JointState", heard.append)
        out = a.publisher("/joints", "sensor_msgs/msg/JointState")
        wait_until(lambda: out.write({"name": ["elbow"], "position": [0.5]}) or heard)
        assert heard[0].name == ["elbow"]
        assert heard[0].header.stamp.sec > 0
        with pytest.raises((TypeError, ValueError)):
            out.write({"name": 5})


def test_subscriptions_are_counted(names: yarpy.LocalNames) -> None:
    with ros2.Node("/a") as a, ros2.Node("/b") as b, yarpy.BufferedPort("/port") as port:
        out = a.publisher("/news", "std_msgs/msg/String")
        assert out.subscribers == 0
        hearer = b.subscriber("/news", "std_msgs/msg/String", print)
        port.listen_to("ros2://news")
        b.subscriber("/news", "std_msgs/msg/Int32", print)  # of another type
        wait_until(lambda: out.subscribers == 2)
        hearer.close()
        wait_until(lambda: out.subscribers == 1)


def test_a_publisher_is_closed_while_others_write(names: yarpy.LocalNames) -> None:
    with ros2.Node("/a") as a:
        for _ in range(5):
            out = a.publisher("/large", "std_msgs/msg/UInt8MultiArray")
            value, begun = out.kind(data=bytes(2_000_000)), threading.Event()

            def write(out: Any = out, value: Any = value, begun: Any = begun) -> None:
                for _ in range(10):
                    out.write(value), begun.set()

            with ThreadPoolExecutor() as pool:
                writes = pool.submit(write)
                assert begun.wait(HANG)
                out.close()
                writes.result(HANG)  # what is written to a closed one is for nobody


def test_who_comes_late_gets_what_was_kept(names: yarpy.LocalNames) -> None:
    heard: list[Any] = []
    with ros2.Node("/a") as a, ros2.Node("/b") as b, yarpy.BufferedPort("/port") as port:
        a.publisher("/map", "std_msgs/msg/String", qos="latched").write("the map")
        b.subscriber("/map", "std_msgs/msg/String", heard.append, qos="latched")
        wait_until(lambda: heard)
        assert heard[0].data == "the map"
        port.listen_to("ros2://map")  # ports of YARP hear it, too
        assert port.read(timeout=HANG).value == "the map"


def test_bytes_that_are_no_message(
    names: yarpy.LocalNames, caplog: pytest.LogCaptureFixture
) -> None:
    heard: list[Any] = []
    with ros2.Node("/a") as a, ros2.Node("/b") as b:
        reader = b.subscriber("/t", "std_msgs/msg/String", heard.append)
        out = a.publisher("/t", "std_msgs/msg/String")
        wait_until(lambda: out.write("first") or heard)
        from yarpy.peers.ros2.carrier import Outgoing

        out.give(Outgoing(out.kind, (b"\0\1\0\0\xff\xff\xff\x7f",)))
        wait_until(lambda: reader.dropped)
        count = len(heard)
        wait_until(lambda: out.write("next") or len(heard) > count)
    assert "is lost" in caplog.text


def test_a_signal_handler_closes_in_the_middle_of_a_write(names: yarpy.LocalNames) -> None:
    with ros2.Node("/a") as node:
        out: Any = node.publisher("/cut", "std_msgs/msg/String")
        give = out.give

        def interrupted(item: Any) -> None:
            out.close()
            give(item)

        out.give = interrupted
        writes = threading.Thread(target=out.write, args=("cut off",), daemon=True)
        writes.start()
        writes.join(HANG)
        assert not writes.is_alive() and out.ended()
