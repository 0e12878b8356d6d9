"""A robot of ROS as a control board: over ports with such messages, over DDS, and with ROS 1."""

from __future__ import annotations

import json
import math
import os
import sys
from collections.abc import Iterator
from contextlib import ExitStack
from pathlib import Path
from typing import Any

import pytest
from support.process import Process
from support.ros_graph import RosGraph, graph, graph_apart  # noqa: F401 (fixtures)
from support.wait import HANG, wait_until

import yarpy
from yarpy import Property, Timeout, ros2
from yarpy.kits.devices import ControlBoard, ControlBoardServer
from yarpy.kits.devices.closeable import Closeable
from yarpy.kits.devices.hardware import topics
from yarpy.kits.devices.hardware.topics import TopicBoard, ros_board
from yarpy.kits.devices.publisher import Publisher
from yarpy.nameserver.local import LocalNames

DDS_ROBOT = str(Path(__file__).parents[3] / "support" / "dds_robot.py")
DEGREE = math.radians(1.0)
ROS_1 = """
import json, rospy
from sensor_msgs.msg import JointState
from std_msgs.msg import Float64MultiArray

rospy.init_node("robot")
at = [0.5, 0.25]

def go(told):
    at[:] = told.data
    print(json.dumps(list(told.data)), flush=True)

rospy.Subscriber("/arm/command", Float64MultiArray, go)
states = rospy.Publisher("/joint_states", JointState, queue_size=10)
rate = rospy.Rate(50)
while not rospy.is_shutdown():
    states.publish(JointState(name=["shoulder", "elbow"], position=at))
    rate.sleep()
"""


class Robot(Closeable):
    """A port that says all the time what is in `rows`, and one that is told where to go."""

    def __init__(self, names: LocalNames) -> None:
        self.rows: list[Any] = []
        self.say(["shoulder", "finger"], [90 * DEGREE, 0.02], [DEGREE, 0.0], [1.5, 0.5])
        self.told = yarpy.BufferedPort("/robot/commands", strict=True, names=names)
        self._out = yarpy.BufferedPort("/robot/states", strict=True, names=names)
        publisher = Publisher("/robot", 0.01, self._publish)
        self._resources = ExitStack()
        for each in (self.told, self._out, publisher):
            self._resources.callback(each.close)

    def say(self, *rows: list[Any]) -> None:
        """Say names, positions, velocities and efforts."""
        self.rows = [yarpy.Bottle([[[12, 500_000_000], "base"], *rows])]

    def next(self) -> Any:
        """The next command."""
        message = self.told.read(timeout=HANG)
        assert message is not None
        return message.value

    def _publish(self) -> None:
        for row in self.rows:
            self._out.write(row)


@pytest.fixture
def robot(names: LocalNames) -> Iterator[Robot]:
    with Robot(names) as found:
        yield found


def board(names: LocalNames, **more: Any) -> TopicBoard:
    return TopicBoard("/robot/states", "/robot/commands", names=names, timeout=HANG, **more)


def trajectory(value: Any) -> tuple[list[str], list[float], float]:
    """The names, positions and seconds of a trajectory."""
    [point] = value["points"]
    seconds, rest = point["time_from_start"]
    return [*value["joint_names"]], [*point["positions"]], seconds + rest * 1e-9


def test_measurements(robot: Robot, names: LocalNames) -> None:
    with board(names, prismatic=["finger"]) as found:
        assert found.axis_names == ["shoulder", "finger"]
        assert found.axis_types == ["revolute", "prismatic"]
        assert found.encoders() == pytest.approx([90.0, 20.0])
        assert found.encoder_speeds() == pytest.approx([1.0, 0.0])
        assert found.torques() == [1.5, 0.5]
        assert found.motion_done() == [True, True]
        robot.say(["finger", "head"], [0.03, 1.0])
        wait_until(lambda: found.encoders()[1] == pytest.approx(30.0))
        assert found.encoders()[0] == pytest.approx(90.0), "a message may have a few joints"
        with pytest.raises(NotImplementedError, match="does not say it of all joints"):
            found.torques()


def test_names_that_are_never_the_same_take_no_memory(
    robot: Robot, names: LocalNames, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(topics, "MOST", 5)
    with board(names) as found:
        robot.say([f"other{n}" for n in range(20)] + ["finger"], [0.0] * 20 + [0.03])
        wait_until(lambda: found.encoders()[1] == pytest.approx(math.degrees(0.03)))
        assert len(found._joints) == 5


def test_moving(robot: Robot, names: LocalNames) -> None:
    with board(names, axis_names=["finger", "shoulder"], prismatic=["finger"]) as found:
        found.position_move([1], [100.0])
        called, goals, seconds = trajectory(robot.next())
        assert called == ["finger", "shoulder"]
        assert goals == pytest.approx([0.02, 100 * DEGREE])
        assert seconds == pytest.approx(1.0), "10 degrees at 10 degrees a second"
        assert found.motion_done() == [True, False]
        # The other joint is told something at once; this one is not hurried.
        found.position_direct([0], [50.0])
        _, goals, seconds = trajectory(robot.next())
        assert goals == pytest.approx([0.05, 100 * DEGREE])
        assert seconds == pytest.approx(1.0)
        found.stop([1])
        _, goals, seconds = trajectory(robot.next())
        assert goals == pytest.approx([0.05, 90 * DEGREE])
        assert seconds == pytest.approx(3.0), "30 millimetres at 10 a second"
        robot.say(["shoulder", "finger"], [90 * DEGREE, 0.05])
        wait_until(lambda: found.motion_done() == [True, True])
        found.position_direct([0, 1], [51.0, 300.0])
        _, goals, seconds = trajectory(robot.next())
        assert goals == pytest.approx([0.051, 180 * DEGREE]), "not beyond its limits"
        assert seconds == pytest.approx(topics.DIRECT)
        assert found.control_modes() == ["pos", "pos"]
        found.switch_control_modes([0], ["posd"])
        with pytest.raises(ValueError, match="the mode pos and posd"):
            found.switch_control_modes([0], ["vel"])


def test_a_controller_of_positions(robot: Robot, names: LocalNames) -> None:
    with board(names, form="positions", limits={"shoulder": (-10.0, 10.0)}) as found:
        found.position_direct([0], [20.0])
        assert [*robot.next()] == pytest.approx([10 * DEGREE, 0.02])
        with pytest.raises(NotImplementedError, match="use position_direct"):
            found.position_move([0], [0.0])
        assert found.control_modes() == ["posd", "posd"]
        with pytest.raises(ValueError, match="the mode posd"):
            found.switch_control_modes([0], ["pos"])


def test_it_falls_silent(robot: Robot, names: LocalNames, caplog: pytest.LogCaptureFixture) -> None:
    with board(names) as found:
        robot.rows = [yarpy.Bottle(["hello"])]
        wait_until(lambda: "this is no JointState" in caplog.text)
        found._timeout = 0.0
        with pytest.raises(Timeout, match="nothing came from /robot/states"):
            found.encoders()


def test_joints_that_do_not_come(
    robot: Robot, names: LocalNames, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(topics, "FIRST", 0.1)
    with pytest.raises(Timeout, match="said nothing of elbow within"):
        board(names, axis_names=["shoulder", "elbow"])
    robot.rows = []
    with pytest.raises(Timeout, match="said nothing of any joint within"):
        board(names)


def test_on_ports(robot: Robot, names: LocalNames) -> None:
    options = Property.from_text(
        "(states /robot/states) (commands /robot/commands) (AxisName (shoulder finger)) "
        "(prismatic (finger)) (jntPosMin (-10 0)) (jntPosMax (120 80)) (name /arm)"
    )
    made = ros_board(options, names=names)
    assert isinstance(made, TopicBoard)
    with (
        made,
        ControlBoardServer("/arm", made, names=names),
        ControlBoard("/arm", names=names, timeout=HANG) as client,
    ):
        assert client.position_limits == ((-10.0, 120.0), (0.0, 80.0))
        assert [*client.encoders()] == pytest.approx([90.0, 20.0])
        client.position_move("shoulder", 95.0)
        assert trajectory(robot.next())[1] == pytest.approx([95 * DEGREE, 0.02])


def test_parameters_that_are_wrong() -> None:
    for text, why in (
        ("(states /a)", "it needs the parameters states"),
        ("(states /a) (commands /b) (jntPosMin (0))", "a number for each joint"),
        ("(states /a) (commands /b) (form speeds)", "trajectory or positions, not speeds"),
    ):
        with pytest.raises(ValueError, match=why):
            ros_board(Property.from_text(text))


def test_a_robot_of_ros_2(names: LocalNames, monkeypatch: pytest.MonkeyPatch) -> None:
    pytest.importorskip("cyclonedds")
    from yarpy.peers.ros2.dds.participant import LOCAL

    monkeypatch.setenv("CYCLONEDDS_URI", LOCAL)
    monkeypatch.delenv("ROS_DOMAIN_ID", raising=False)
    monkeypatch.setattr(topics, "FIRST", HANG)
    monkeypatch.setattr(topics, "CONNECTED", HANG)
    states, commands = (f"/n{os.getpid()}_{what}" for what in ("states", "commands"))
    program = [sys.executable, "-P", DDS_ROBOT, states, commands]
    with (
        ros2.Node(f"/n{os.getpid()}", rmw="dds"),  # takes part already: that takes a while
        Process(program) as peer,
        TopicBoard(
            f"ros2+dds:/{states}~sensor_msgs/msg/JointState",
            f"ros2+dds:/{commands}~trajectory_msgs/msg/JointTrajectory",
            prismatic=["finger"],
            timeout=HANG,
            names=names,
        ) as found,
    ):
        assert found.axis_names == ["shoulder", "finger"]
        assert found.encoders() == pytest.approx([math.degrees(0.5), 10.0])
        assert found.torques() == [2.0, 2.0]
        assert found.timestamps() == [1234.5] * 2
        found.reference_speeds = [360.0, 100.0]

        def moved() -> bool:  # until DDS has found who listens, nobody hears it
            found.position_move([0, 1], [-30.0, 25.0])
            return bool(peer.stdout)

        wait_until(moved)
        row = json.loads(peer.stdout.splitlines()[0])
        assert row[0] == ["shoulder", "finger"]
        assert row[1] == pytest.approx([-30 * DEGREE, 0.025])
        assert row[2] == pytest.approx((math.degrees(0.5) + 30.0) / 360.0)
        assert row[3] == 0, "it begins when it comes, whatever the robot's clock says"
        wait_until(lambda: found.encoders() == pytest.approx([-30.0, 25.0]))


def test_a_robot_of_ros_1(
    graph: RosGraph,  # noqa: F811 (the fixture)
    names: LocalNames,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(topics, "FIRST", HANG)
    peer = graph.python(ROS_1)
    with TopicBoard(
        "/joint_states-@/yarp_arm",
        "/arm/command+@/yarp_arm~std_msgs/Float64MultiArray",
        form="positions",
        timeout=HANG,
        names=names,
    ) as found:
        assert found.axis_names == ["shoulder", "elbow"]
        assert found.encoders() == pytest.approx([math.degrees(0.5), math.degrees(0.25)])

        def moved() -> bool:
            found.position_direct([1], [30.0])
            return bool(peer.stdout)

        wait_until(moved)
        assert json.loads(peer.stdout.splitlines()[0]) == pytest.approx([0.5, 30 * DEGREE])
        wait_until(lambda: found.motion_done() == [True, True])
