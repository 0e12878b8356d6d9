"""The interface of a control board: the methods and attributes of a group of joints.

    class Head:
        axis_names = ["pitch", "yaw"]                 # needed
        reference_speeds = [10.0, 10.0]

        def encoders(self):                           # needed
            return self.read_them_somehow()

        def position_move(self, joints, positions):
            for joint, degrees in zip(joints, positions):
                ...

    ControlBoardServer("/robot/head", Head())

Rules. Your class inherits nothing and defines only what it supports; all other requests are
answered with `[fail]`.

- A measurement is a method without arguments that returns one value for each joint.
- A setting is an attribute, a list with one entry for each joint. To change an entry the server
  assigns a whole new list; make it a property if an action is needed then, without a setter if it
  cannot be changed.
- An action takes joints (valid indices) and as many values (finite floats).

Any exception is answered with `[fail]` and logged. Your class is used by one thread at a time, with
one exception: `calibrate`, `calibrate_joint`, `home`, `park` and their `quit_` may take long and
run concurrently with everything else.

Angles are in degrees (`prismatic` joints: whatever unit the robot uses, mostly mm), speeds
in degrees per second, torques in Nm, currents in A, duty cycles in percent, temperatures in degrees
Celsius.

Source: interfaces of YARP 3.x behind controlBoard_nws_yarp, protocol 1.9.0.
"""

from __future__ import annotations

from collections.abc import Mapping, MutableMapping, Sequence
from enum import StrEnum
from typing import Any, NamedTuple, Protocol


class ControlMode(StrEnum):
    """The control mode of a joint, in YARP's words. Equal to the word: `mode == "pos"`."""

    POSITION = "pos"  # trajectories between targets
    POSITION_DIRECT = "posd"
    VELOCITY = "vel"
    VELOCITY_DIRECT = "veld"  # of YARP 4
    MIXED = "mix"  # position and velocity
    TORQUE = "torq"
    PWM = "ipwm"
    CURRENT = "icur"
    IDLE = "idl"
    FORCE_IDLE = "fidl"  # can only be set: become idle and clear faults
    FAULT = "hwfa"  # this and the next ones can only be reported
    CALIBRATING = "cal"
    CALIBRATED = "cald"
    NOT_CONFIGURED = "cfgn"
    CONFIGURED = "cfgy"
    UNKNOWN = "unkw"


class InteractionMode(StrEnum):
    """The interaction of a joint with people: it resists a push, or yields to it."""

    STIFF = "stif"
    COMPLIANT = "comp"
    UNKNOWN = "unkn"


class Gains(NamedTuple):
    """The ten numbers of a PID controller, in the order of the protocol."""

    kp: float = 0.0
    kd: float = 0.0
    ki: float = 0.0
    max_integral: float = 0.0
    max_output: float = 0.0
    offset: float = 0.0
    scale: float = 0.0
    stiction_up: float = 0.0
    stiction_down: float = 0.0
    feed_forward: float = 0.0


class MotorTorqueParameters(NamedTuple):
    """The parameters by which a motor produces torque, in the order of the protocol."""

    bemf: float = 0.0
    bemf_scale: float = 0.0
    ktau: float = 0.0
    ktau_scale: float = 0.0
    viscous_positive: float = 0.0
    viscous_negative: float = 0.0
    coulomb_positive: float = 0.0
    coulomb_negative: float = 0.0
    velocity_threshold: float = 0.0


class Joints(Protocol):
    """The minimum for a control board; `ControlBoardLike` lists the rest."""

    @property
    def axis_names(self) -> Sequence[str]:
        """The names of the joints; their number is the number of joints."""

    def encoders(self) -> Sequence[float]:
        """Return the positions of the joints."""


class PidController(Protocol):
    """The controllers of one kind, one for each joint. As above, define what you support."""

    gains: Sequence[Sequence[float]]  # ten each, see `Gains`
    targets: Sequence[float]
    error_limits: Sequence[float]
    offsets: Sequence[float]  # added to the output
    enabled: Sequence[bool]
    #: texts for programs of YARP 4: `description`, `input`, `output`, and units by names of `Gains`
    details: Sequence[Mapping[str, str]]

    def errors(self) -> Sequence[float]:
        """Target minus measurement."""

    def outputs(self) -> Sequence[float]:
        """The present outputs of the controllers."""

    def reset(self, joints: Sequence[int]) -> object:
        """Reset the integral."""


class ControlBoardLike(Joints, Protocol):
    """Everything a control board can have. For reading; classes need not inherit it.

    `ControlBoard`, the client of a remote one, has all of it.
    """

    # -- what is measured ---------------------------------------------------------------------

    def timestamps(self) -> Sequence[float]:
        """Return the times when the encoders were read, in seconds; default: the time of the
        call."""

    def encoder_speeds(self) -> Sequence[float]:
        """Return the speeds of the joints."""

    def encoder_accelerations(self) -> Sequence[float]:
        """Return the accelerations of the joints, deg/s^2."""

    def motor_encoders(self) -> Sequence[float]:
        """Return the positions of the motors."""

    def motor_speeds(self) -> Sequence[float]:
        """Return the speeds of the motors."""

    def motor_accelerations(self) -> Sequence[float]:
        """Return the accelerations of the motors, deg/s^2."""

    def torques(self) -> Sequence[float]:
        """Torque of each joint."""

    def currents(self) -> Sequence[float]:
        """Current of each motor."""

    def duty_cycles(self) -> Sequence[float]:
        """PWM of each motor."""

    def supply_voltages(self) -> Sequence[float]:
        """Volts at each amplifier."""

    def motor_temperatures(self) -> Sequence[float]:
        """Temperature of each motor."""

    def amplifier_status(self) -> Sequence[int]:
        """A number for each amplifier; its meaning depends on the robot."""

    def braked(self) -> Sequence[bool]:
        """Return for each joint whether its brake holds it. Only YARP 4 has brakes."""

    def faults(self) -> Sequence[tuple[int, str]]:
        """The last fault of each joint: its code and its text. `(0, "")` for none."""

    def control_modes(self) -> Sequence[str]:
        """The mode of each joint: see `ControlMode`."""

    def interaction_modes(self) -> Sequence[str]:
        """Stiff or compliant: see `InteractionMode`."""

    def motion_done(self) -> Sequence[bool]:
        """Return for each joint whether it has arrived where `position_move` sent it."""

    # -- what acts ----------------------------------------------------------------------------

    def position_move(self, joints: Sequence[int], positions: Sequence[float]) -> object:
        """Move to these positions along a trajectory."""

    def relative_move(self, joints: Sequence[int], distances: Sequence[float]) -> object:
        """Move by these angles; default: `position_move` relative to the encoders."""

    def position_direct(self, joints: Sequence[int], positions: Sequence[float]) -> object:
        """Go directly to these positions, the next points of the caller's trajectory."""

    def velocity_direct(self, joints: Sequence[int], speeds: Sequence[float]) -> object:
        """Move at these speeds at once, without an acceleration. Only YARP 4 has it."""

    def apply_brakes(self, joints: Sequence[int], active: Sequence[bool]) -> object:
        """Brake these joints, or release them."""

    def velocity_move(self, joints: Sequence[int], speeds: Sequence[float]) -> object:
        """Move at these speeds until told otherwise."""

    def apply_torques(self, joints: Sequence[int], torques: Sequence[float]) -> object:
        """Make the joints exert these torques."""

    def apply_currents(self, joints: Sequence[int], currents: Sequence[float]) -> object:
        """Drive the motors with these currents."""

    def apply_duty_cycles(self, joints: Sequence[int], duty_cycles: Sequence[float]) -> object:
        """Drive the motors with these duty cycles."""

    def stop(self, joints: Sequence[int]) -> object:
        """Stop moving."""

    def switch_control_modes(self, joints: Sequence[int], modes: Sequence[str]) -> object:
        """Change how joints are controlled. The word is unchecked: `ControlMode(mode)` raises for
        one that YARP does not know."""

    def switch_interaction_modes(self, joints: Sequence[int], modes: Sequence[str]) -> object:
        """Make joints stiff or compliant."""

    def preset_encoders(self, joints: Sequence[int], positions: Sequence[float]) -> object:
        """Reset the encoders: these are the positions of the joints now."""

    def preset_motor_encoders(self, joints: Sequence[int], positions: Sequence[float]) -> object:
        """Reset the encoders: these are the positions of the motors now."""

    def enable_amplifiers(self, joints: Sequence[int]) -> object:
        """Power on."""

    def disable_amplifiers(self, joints: Sequence[int]) -> object:
        """Power off."""

    def calibrate_joint(self, joint: int, kind: int, parameters: Sequence[float]) -> object:
        """Start calibrating one joint; `kind` and its 3 or 4 parameters depend on the robot."""

    def calibration_done(self, joint: int) -> bool:
        """Return whether the calibration is finished."""

    def calibrate(self, joints: Sequence[int]) -> object:
        """Calibrate joints in the robot's own way."""

    def home(self, joints: Sequence[int]) -> object:
        """Move to the home position."""

    def park(self, joints: Sequence[int]) -> object:
        """Move to where the robot can be switched off."""

    def quit_calibration(self) -> object:
        """Abort calibrating."""

    def quit_parking(self) -> object:
        """Abort parking."""

    # -- last commands; without these the server remembers what it passed on ------------------

    def position_targets(self) -> Sequence[float]:
        """Targets of `position_move`."""

    def direct_targets(self) -> Sequence[float]:
        """The last `position_direct`."""

    def velocity_targets(self) -> Sequence[float]:
        """The last `velocity_move`."""

    def direct_velocity_targets(self) -> Sequence[float]:
        """The last `velocity_direct`."""

    def torque_targets(self) -> Sequence[float]:
        """The last `apply_torques`."""

    def current_targets(self) -> Sequence[float]:
        """The last `apply_currents`."""

    def duty_cycle_targets(self) -> Sequence[float]:
        """The last `apply_duty_cycles`."""

    # -- what is adjusted ---------------------------------------------------------------------

    axis_types: Sequence[str]  # "revolute" (the default), "prismatic" or "unknown"
    reference_speeds: Sequence[float]  # of position moves
    reference_accelerations: Sequence[float]  # deg/s^2
    position_limits: Sequence[tuple[float, float]]  # (lowest, highest)
    velocity_limits: Sequence[tuple[float, float]]
    torque_ranges: Sequence[tuple[float, float]]
    current_ranges: Sequence[tuple[float, float]]
    max_currents: Sequence[float]
    nominal_currents: Sequence[float]
    peak_currents: Sequence[float]
    pwm_limits: Sequence[float]
    temperature_limits: Sequence[float]
    gearbox_ratios: Sequence[float]
    counts_per_revolution: Sequence[float]  # of motor encoders
    automatic_brakes: Sequence[bool]  # the robot brakes by itself
    motor_torque_parameters: Sequence[Sequence[float]]  # nine each, see `MotorTorqueParameters`
    impedances: Sequence[tuple[float, float]]  # (stiffness Nm/deg, damping Nm s/deg)
    impedance_offsets: Sequence[float]  # Nm
    impedance_ranges: Sequence[tuple[float, float, float, float]]  # stiffness, damping: min, max

    pids: Mapping[str, PidController]
    """Controllers by kind: `pos`, `vel`, `trq`, `cur`."""

    variables: MutableMapping[str, Any]
    """Further variables of the robot, by name; a dict will do. Clients can change existing ones but
    not add any. What they set is the list of values that they sent."""
