"""TopicBoard: the joints of a robot of ROS as a control board, by its topics.

    yarpy dev rosControlBoard --name /arm --states ros2+dds://joint_states
        --commands "ros2+dds://arm_controller/joint_trajectory~trajectory_msgs/msg/JointTrajectory"
    yarpy dev rosControlBoard --name /arm --states /joint_states-@/yarp_arm
        --commands /arm_controller/command+@/yarp_arm~trajectory_msgs/JointTrajectory

Rules: it has the members of `control_board.interface`. Where the joints are comes as messages of
sensor_msgs/JointState, also a few joints at a time; where they go leaves as JointTrajectory of one
point, or with `form positions` as Float64MultiArray, always with all joints: those that are not
told keep their goals, and none of them is hurried. What has an `@` is the name of our own port, a
topic of ROS 1; all others are connected, so any port with such messages will do. ROS has radians
and metres, YARP degrees, and millimetres for the joints that `prismatic` names.
"""

from __future__ import annotations

import math
import threading
import time
from collections.abc import Mapping, Sequence
from contextlib import ExitStack
from typing import Final

from yarpy.data.bottle import Bottle, Property
from yarpy.data.sig.vector import Vector
from yarpy.data.stamp import Stamp
from yarpy.errors import DecodeError, Timeout
from yarpy.kits.devices.closeable import Closeable, local_prefix
from yarpy.kits.devices.refusal import DeviceErrorLog
from yarpy.kits.devices.simulated.plugin import values
from yarpy.names.base import NameClient
from yarpy.port.port import BufferedPort
from yarpy.wire.message import Message

FORMS: Final = ("trajectory", "positions")
CONNECTED: Final = 10.0  # seconds for a connection
FIRST: Final = 5.0  # seconds for the first message with all joints
DIRECT: Final = 0.1  # seconds of a trajectory that is there at once
MOST: Final = 1000  # joints that are remembered
DONE: Final = 0.5  # degrees or millimetres from its goal, where a joint has arrived
_SLOWEST: Final = 0.1  # of a reference speed
_SPEED: Final = 10.0
_DEGREE, _MILLIMETRE = math.degrees(1.0), 1000.0  # in a radian, in a metre
#: The time of a trajectory that begins when it comes.
_AT_ONCE: Final = Stamp(0, 0.0)


class TopicBoard(Closeable):
    """The joints that `states` tells, moved by `commands`.

    axis_names: in which order; those of the first message without it. limits: by the name of a
    joint, its least and largest position. timeout: seconds after which a message no longer counts.
    Raises Timeout (no message with these joints came), YarpError (no such port), ValueError.
    """

    def __init__(
        self,
        states: str,
        commands: str,
        *,
        form: str = "trajectory",
        axis_names: Sequence[str] = (),
        prismatic: Sequence[str] = (),
        limits: Mapping[str, tuple[float, float]] | None = None,
        local: str = "",
        timeout: float = 1.0,
        names: NameClient | None = None,
    ) -> None:
        if form not in FORMS:
            raise ValueError(f"the form of commands is {' or '.join(FORMS)}, not {form}")
        local = local_prefix(local, "/rosControlBoard")
        self._states, self._form, self._timeout = states, form, timeout
        self._complain = DeviceErrorLog(local)
        self._changed = threading.Condition()  # guards the ones below
        self._joints: dict[str, list[float | None]] = {}  # name -> position, velocity, effort
        self._time, self._came = 0.0, 0.0
        with ExitStack() as resources:
            reader = BufferedPort(
                states if "@" in states else f"{local}/states:i", callback=self._take, names=names
            )
            resources.enter_context(reader)
            own = commands if "@" in commands else f"{local}/commands:o"
            self._out = resources.enter_context(BufferedPort(own, strict=True, names=names))
            if "@" not in states:
                reader.listen_to(states, timeout=CONNECTED)
            if "@" not in commands:
                self._out.connect(commands, timeout=CONNECTED)
            self.axis_names = self._wait(axis_names)
            self._resources = resources.pop_all()
        sliding = [name in prismatic for name in self.axis_names]
        self.axis_types = ["prismatic" if one else "revolute" for one in sliding]
        self._units = [_MILLIMETRE if one else _DEGREE for one in sliding]
        self.position_limits = [
            (limits or {}).get(name, (-180.0, 180.0)) for name in self.axis_names
        ]
        self.reference_speeds = [_SPEED] * len(sliding)
        self._goals: list[float | None] = [None] * len(sliding)
        self._mode = "pos" if form == "trajectory" else "posd"

    def encoders(self) -> list[float]:
        """Degrees, or millimetres. Raises Timeout."""
        return [found * unit for found, unit in zip(self._column(0), self._units, strict=True)]

    def encoder_speeds(self) -> list[float]:
        """Degrees or millimetres per second. Raises Timeout."""
        return [found * unit for found, unit in zip(self._column(1), self._units, strict=True)]

    def torques(self) -> list[float]:
        """Nm, or N. Raises Timeout."""
        return self._column(2)

    def timestamps(self) -> list[float]:
        """The time of the last message, seconds."""
        return [self._time] * len(self.axis_names)

    def motion_done(self) -> list[bool]:
        """Return which joints are at their goals. Raises Timeout."""
        pairs = zip(self._goals, self.encoders(), strict=True)
        return [goal is None or abs(goal - at) <= DONE for goal, at in pairs]

    def control_modes(self) -> list[str]:
        return [self._mode] * len(self.axis_names)

    def switch_control_modes(self, joints: Sequence[int], modes: Sequence[str]) -> None:
        """A controller of ROS has its mode. Raises ValueError for another."""
        allowed = {"pos", "posd"} if self._form == "trajectory" else {"posd"}
        if not {*modes} <= allowed:
            raise ValueError(f"this controller of ROS has the mode {' and '.join(sorted(allowed))}")

    def position_move(self, joints: Sequence[int], positions: Sequence[float]) -> None:
        """Go there, all at the reference speeds or slower. Raises Timeout; NotImplementedError for
        a controller that knows no time."""
        if self._form != "trajectory":
            raise NotImplementedError(
                "a controller of positions goes there at once: use position_direct, or a "
                "controller of trajectories"
            )
        self._go(joints, positions, range(len(self.axis_names)))

    def position_direct(self, joints: Sequence[int], positions: Sequence[float]) -> None:
        """Go there at once. Raises Timeout."""
        others = [joint for joint in range(len(self.axis_names)) if joint not in {*joints}]
        self._go(joints, positions, others)

    def stop(self, joints: Sequence[int]) -> None:
        """Stay where they are. Raises Timeout."""
        at = self.encoders()
        self.position_direct(joints, [at[joint] for joint in joints])

    def _go(self, joints: Sequence[int], positions: Sequence[float], timed: Sequence[int]) -> None:
        """Send all joints to their goals, so slowly that those of `timed` keep their speeds."""
        at = self.encoders()
        for joint, position in zip(joints, positions, strict=True):
            lowest, highest = self.position_limits[joint]
            self._goals[joint] = min(max(position, lowest), highest)
        goals = [at[n] if goal is None else goal for n, goal in enumerate(self._goals)]
        told = [goal / unit for goal, unit in zip(goals, self._units, strict=True)]
        if self._form == "positions":
            self._out.write(Vector(told))
            return
        speeds = [max(speed, _SLOWEST) for speed in self.reference_speeds]
        seconds = max([DIRECT, *(abs(goals[n] - at[n]) / speeds[n] for n in timed)])
        whole, rest = divmod(round(seconds * 1e9), 1_000_000_000)
        point = {"positions": told, "time_from_start": [whole, rest]}
        self._out.write({"joint_names": self.axis_names, "points": [point]}, _AT_ONCE)

    def _column(self, number: int) -> list[float]:
        with self._changed:
            if time.monotonic() - self._came > self._timeout:
                raise Timeout(f"nothing came from {self._states} for {self._timeout} s")
            found = [self._joints[name][number] for name in self.axis_names]
        there = [one for one in found if one is not None]
        if len(there) < len(found):
            raise NotImplementedError(f"{self._states} does not say it of all joints")
        return there

    def _take(self, message: Message) -> None:
        try:
            _, called, *columns = message.as_(Bottle)
            columns = [*columns, (), (), ()][:3]
            rows = {
                str(name): [float(one[row]) if row < len(one) else None for one in columns]
                for row, name in enumerate(called)
            }
        except (DecodeError, TypeError, ValueError) as error:
            self._complain(self._states, ValueError(f"this is no JointState: {error}"))
            return
        stamp = message.stamp
        with self._changed:
            for name, row in rows.items():
                if row[0] is not None and (name in self._joints or len(self._joints) < MOST):
                    self._joints[name] = row
            self._time = stamp.time if stamp is not None and stamp.time else time.time()
            self._came = time.monotonic()
            self._changed.notify_all()

    def _wait(self, wanted: Sequence[str]) -> list[str]:
        """Return the names of the joints, once all of them have come. Raises Timeout."""
        with self._changed:
            there = lambda: bool(self._joints) and self._joints.keys() >= {*wanted}  # noqa: E731
            if not self._changed.wait_for(there, FIRST):
                missing = ", ".join(one for one in wanted if one not in self._joints)
                raise Timeout(
                    f"{self._states} said nothing of {missing or 'any joint'} within {FIRST} s: is "
                    "the robot on, and is its ROS_DOMAIN_ID or ROS_MASTER_URI the one here?"
                )
            return [*wanted] or [*self._joints]


def ros_board(options: Property, *, names: NameClient | None = None) -> object:
    """The joints of a robot of ROS, by its topics. Raises ValueError, YarpError."""
    states, commands = (str(options.find(key, "") or "") for key in ("states", "commands"))
    if not states or not commands:
        raise ValueError(
            "it needs the parameters states, as ros2+dds://joint_states, and commands, as "
            "ros2+dds://arm_controller/joint_trajectory~trajectory_msgs/msg/JointTrajectory"
        )
    axes = [str(one) for one in values(options, "AxisName")]
    lowest, highest = ([*map(float, values(options, f"jntPos{end}"))] for end in ("Min", "Max"))
    if (lowest or highest) and not len(axes) == len(lowest) == len(highest):
        raise ValueError("jntPosMin and jntPosMax have a number for each joint of AxisName")
    name = str(options.find("name", "") or "")
    return TopicBoard(
        states,
        commands,
        form=str(options.find("form", FORMS[0])),
        axis_names=axes,
        prismatic=[str(one) for one in values(options, "prismatic")],
        limits=dict(zip(axes, zip(lowest, highest, strict=True), strict=False)),
        local=f"{name}/topics" if name else "",
        names=names,
    )
