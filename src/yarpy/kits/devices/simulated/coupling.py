"""SimulatedCoupling: joints that motors move together, without hardware; fakeJointCoupling in C++.

Rules: the first two joints are axes; the third axis is the sum of the last two joints, which share
it equally. Results are those of C++, which adds positions to speeds and both to accelerations, so
that tests see whether all arguments arrive. It has no torques.
"""

from __future__ import annotations

from collections.abc import Sequence

from yarpy.errors import LocalProtocolError

Numbers = Sequence[float]


class SimulatedCoupling:
    """The device behind `viewIJointCoupling` of `import yarp`, in degrees and seconds. Raises
    LocalProtocolError for a wrong number of values."""

    joint_names = ("phys_joint_0", "phys_joint_1", "phys_joint_2", "phys_joint_3")
    axis_names = ("act_axes_0", "act_axes_1", "act_axes_2")
    joint_limits = ((-30.0, 30.0), (-10.0, 10.0), (-32.0, 33.0), (0.0, 120.0))
    coupled_joints = (2, 3)
    coupled_axes = (2,)

    def axis_positions(self, joints: Numbers) -> list[float]:
        """Positions of axes."""
        return self._axes(joints)

    def axis_speeds(self, joints: Numbers, speeds: Numbers) -> list[float]:
        """Speeds of axes."""
        return self._axes(speeds, joints)

    def axis_accelerations(
        self, joints: Numbers, speeds: Numbers, accelerations: Numbers
    ) -> list[float]:
        """Accelerations of axes."""
        return self._axes(accelerations, joints, speeds)

    def joint_positions(self, axes: Numbers) -> list[float]:
        """Positions of joints."""
        return self._joints(axes)

    def joint_speeds(self, axes: Numbers, speeds: Numbers) -> list[float]:
        """Speeds of joints."""
        return self._joints(axes, speeds)

    def joint_accelerations(
        self, axes: Numbers, speeds: Numbers, accelerations: Numbers
    ) -> list[float]:
        """Accelerations of joints."""
        return self._joints(axes, speeds, accelerations)

    def _axes(self, *given: Numbers) -> list[float]:
        """Return the first of these for axes, and in the third axis all of them."""
        if any(len(each) != len(self.joint_names) for each in given):
            raise LocalProtocolError(f"there are {len(self.joint_names)} joints")
        return [given[0][0], given[0][1], sum(each[2] + each[3] for each in given)]

    def _joints(self, axes: Numbers, *changes: Numbers) -> list[float]:
        """Return the last of these for joints, and in the last two all of them."""
        if any(len(each) != len(self.axis_names) for each in (axes, *changes)):
            raise LocalProtocolError(f"there are {len(self.axis_names)} axes")
        shift = sum(each[2] for each in changes)
        last = (axes, *changes)[-1]
        return [last[0], last[1], (axes[2] - shift) / 2, (axes[2] + shift) / 2]
