"""The time of a node: of the computer, or of /clock."""

import time

from support.wait import wait_until

import yarpy
from yarpy.peers import ros2


def test_it_follows_the_clock(names: yarpy.LocalNames) -> None:
    with ros2.Node("/sim") as sim, ros2.Node("/arm", parameters={"use_sim_time": True}) as arm:
        assert arm.now() == 0 and sim.now() > 1e9
        heard: list[float] = []
        sim.subscriber("/head", "std_msgs/msg/Header", lambda got: heard.append(got.stamp.sec))
        head = arm.publisher("/head", "std_msgs/msg/Header")
        clock = sim.publisher("/clock", "rosgraph_msgs/msg/Clock")

        def tick() -> bool:
            clock.write({"clock": {"sec": 12, "nanosec": 500_000_000}})
            return arm.now() == 12.5

        wait_until(tick)
        stamped = arm.publisher("/stamped", "geometry_msgs/msg/PointStamped")
        times: list[float] = []
        sim.subscriber(
            "/stamped",
            "geometry_msgs/msg/PointStamped",
            lambda got: times.append(got.header.stamp.sec),
        )

        def say() -> bool:
            stamped.write({"header": {"frame_id": "map"}})
            return bool(times)

        wait_until(say)
        assert times[0] == 12
        head.close()
        arm.parameters.set({"use_sim_time": False})
        assert abs(arm.now() - time.time()) < 1e4
