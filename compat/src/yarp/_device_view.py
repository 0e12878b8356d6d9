"""IAnalogSensor, IJointCoupling, IFrameWriterImage and IControlDebug: views of a device in the same
program, an object of Python (`PolyDriver.give`). Nothing of them goes over a network.

    channels()                          a number for each channel; states(), calibrate(values) and
                                        calibrate_channel(channel, value) if it has them
    joint_names, axis_names,            of a coupling, with joint_limits, and what turns positions
    coupled_joints, coupled_axes        into others: axis_positions(joints), joint_speeds(axes, ...)
    show(image)                         shows a picture
    load_boot_memory(), save_boot_memory()
                                        of a motor's board; print_function takes what it prints

Rules: as `_view`: what a device does not have is False, or AS_ERROR.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from yarp._numbers import store
from yarp._view import FAILURES, View


class IAnalogSensor(View):
    """Channels of a sensor: the six of a force sensor, say."""

    AS_OK, AS_ERROR, AS_OVF, AS_TIMEOUT = range(4)

    def read(self, out: Any) -> int:
        """Store the values of all channels; AS_OK, or why not."""
        found: list[float] = []
        if not self._tell(lambda: found.extend(map(float, self._board.channels()))):
            return self.AS_ERROR
        if not found:
            return self.AS_TIMEOUT
        out.resize(len(found))
        out._store(found)
        return self.AS_OK

    def getState(self, ch: int) -> int:
        """Return the state of a channel: AS_OK, AS_ERROR, AS_OVF or AS_TIMEOUT."""
        states: list[str] = []
        told = getattr(self._board, "states", None)
        if told is None:
            return self.AS_OK if 0 <= ch < self.getChannels() else self.AS_ERROR
        ok = self._tell(lambda: states.extend(told())) and 0 <= ch < len(states)
        return _STATES.index(states[ch]) if ok and states[ch] in _STATES else self.AS_ERROR

    def getChannels(self) -> int:
        """Return how many channels there are; 0 while nothing has come."""
        try:
            return len(self._board.channels())
        except FAILURES:
            return 0

    def calibrateSensor(self, value: Any = None) -> int:
        """Let the present values be zero, or these."""
        values = None if value is None else [*value]
        return self._calibrate(lambda: self._board.calibrate(values))

    def calibrateChannel(self, ch: int, value: float | None = None) -> int:
        """Let the present value of a channel be zero, or this."""
        return self._calibrate(lambda: self._board.calibrate_channel(ch, value))

    def _calibrate(self, action: Callable[[], object]) -> int:
        return self.AS_OK if self._tell(action) else self.AS_ERROR


#: By their numbers.
_STATES = ("ok", "error", "overflow", "timeout")


class IJointCoupling(View):
    """Joints that several motors move together: from joints to axes of motors, and back."""

    def getNrOfPhysicalJoints(self) -> int:
        return self._count("joint_names")

    def getNrOfActuatedAxes(self) -> int:
        return self._count("axis_names")

    def getPhysicalJointName(self, physicalJointIndex: int) -> str:
        return self._named("joint_names", physicalJointIndex)

    def getActuatedAxisName(self, actuatedAxisIndex: int) -> str:
        return self._named("axis_names", actuatedAxisIndex)

    def getPhysicalJointLimits(self, physicalJointIndex: int, min: Any, max: Any) -> bool:
        """Store how far a joint goes."""

        def fill() -> None:
            low, high = self._board.joint_limits[_index(physicalJointIndex)]
            store(min, [low])
            store(max, [high])

        return self._tell(fill)

    def getCoupledPhysicalJoints(self, coupPhysJointsIndexes: Any) -> bool:
        """Store the numbers of the joints that are coupled."""
        return self._tell(lambda: _fill(coupPhysJointsIndexes, self._board.coupled_joints))

    def getCoupledActuatedAxes(self, coupActAxesIndexes: Any) -> bool:
        """Store the numbers of the axes that are coupled."""
        return self._tell(lambda: _fill(coupActAxesIndexes, self._board.coupled_axes))

    def _count(self, member: str) -> int:
        try:
            return len(getattr(self._board, member))
        except FAILURES:
            return 0

    def _named(self, member: str, index: int) -> str:
        names = getattr(self._board, member, ())
        return str(names[index]) if 0 <= index < len(names) else ""

    def _turn(self, member: str, arguments: tuple[Any, ...]) -> bool:
        """Give a member what goes in, and store what comes out in the last argument."""
        *given, out = arguments
        return self._tell(lambda: _fill(out, getattr(self._board, member)(*map(list, given))))

    def convertFromPhysicalJointsToActuatedAxesPos(self, *arguments: Any) -> bool:
        """`(positions of joints, positions of axes)`."""
        return self._turn("axis_positions", arguments)

    def convertFromPhysicalJointsToActuatedAxesVel(self, *arguments: Any) -> bool:
        """`(positions, speeds of joints, speeds of axes)`."""
        return self._turn("axis_speeds", arguments)

    def convertFromPhysicalJointsToActuatedAxesAcc(self, *arguments: Any) -> bool:
        """`(positions, speeds, accelerations of joints, accelerations of axes)`."""
        return self._turn("axis_accelerations", arguments)

    def convertFromPhysicalJointsToActuatedAxesTrq(self, *arguments: Any) -> bool:
        """`(positions, torques of joints, torques of axes)`."""
        return self._turn("axis_torques", arguments)

    def convertFromActuatedAxesToPhysicalJointsPos(self, *arguments: Any) -> bool:
        """`(positions of axes, positions of joints)`."""
        return self._turn("joint_positions", arguments)

    def convertFromActuatedAxesToPhysicalJointsVel(self, *arguments: Any) -> bool:
        """`(positions, speeds of axes, speeds of joints)`."""
        return self._turn("joint_speeds", arguments)

    def convertFromActuatedAxesToPhysicalJointsAcc(self, *arguments: Any) -> bool:
        """`(positions, speeds, accelerations of axes, accelerations of joints)`."""
        return self._turn("joint_accelerations", arguments)

    def convertFromActuatedAxesToPhysicalJointsTrq(self, *arguments: Any) -> bool:
        """`(positions, torques of axes, torques of joints)`."""
        return self._turn("joint_torques", arguments)


class IFrameWriterImage(View):
    """A device that shows pictures."""

    def putImage(self, image: Any) -> bool:
        """Show a picture."""
        return self._tell(lambda: self._board.show(image._image()))


class IControlDebug(View):
    """The memory of a motor's board, from which it starts."""

    def setPrintFunction(self, f: Callable[[str], object]) -> bool:
        """Let the device print by a function of yours, which is given text."""
        return self._tell(lambda: setattr(self._board, "print_function", f))

    def loadBootMemory(self) -> bool:
        """Let the board work with what is in its memory."""
        return self._tell(lambda: self._board.load_boot_memory())

    def saveBootMemory(self) -> bool:
        """Keep in the memory how the board is set now."""
        return self._tell(lambda: self._board.save_boot_memory())


def _index(number: int) -> int:
    if number < 0:
        raise IndexError(f"no joint {number}")
    return number


def _fill(place: Any, values: Any) -> None:
    found = [*values]
    if hasattr(place, "resize"):
        place.resize(len(found))
    store(place, found)
