"""What a control board is: the methods and attributes of a group of joints.

    class Head:
        axis_names = ["pitch", "yaw"]                 # needed
        reference_speeds = [10.0, 10.0]

        def encoders(self):                           # needed
            return self.read_them_somehow()

        def position_move(self, joints, positions):
            for joint, degrees in zip(joints, positions):
                ...

    ControlBoardServer("/robot/head", Head())

Rules. Your class inherits nothing; it has what it can do, and whatever else is asked of it answers
`[fail]`.

- What changes by itself is a method without arguments. It gives one value for each joint.
- What is adjusted is an attribute, a list with one entry for each joint. To change an entry the
  server assigns a whole new list; make it a property if something has to happen then, one without
  a setter if it cannot be changed.
- What acts takes the joints (indices that exist) and as many values (finite floats).

Whatever you raise answers `[fail]` and is logged. Your class is used by one thread at a time, with
one exception: `calibrate`, `calibrate_joint`, `home`, `park` and their `quit_` may take long and
are called beside everything else.

Angles are in degrees (joints that are `prismatic`: whatever unit the robot uses, mostly mm), speeds
in degrees per second, torques in Nm, currents in A, duty cycles in percent, temperatures in degrees
Celsius.

Source: interfaces of YARP 3.x behind controlBoard_nws_yarp, protocol 1.9.0.
"""

from __future__ import annotations

from collections.abc import Mapping, MutableMapping, Sequence
from enum import StrEnum
from typing import Any, NamedTuple, Protocol


class ControlMode(StrEnum):
    """How a joint is controlled, in YARP's words. Equal to the word: `mode == "pos"`."""

    POSITION = "pos"  # trajectories between targets
    POSITION_DIRECT = "posd"
    VELOCITY = "vel"
    MIXED = "mix"  # position and velocity
    TORQUE = "torq"
    PWM = "ipwm"
    CURRENT = "icur"
    IDLE = "idl"
    FORCE_IDLE = "fidl"  # only commanded: idle, and forget faults
    FAULT = "hwfa"  # the others are only reported
    CALIBRATING = "cal"
    CALIBRATED = "cald"
    NOT_CONFIGURED = "cfgn"
    CONFIGURED = "cfgy"
    UNKNOWN = "unkw"


class InteractionMode(StrEnum):
    """Whether a joint yields when somebody pushes it."""

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
    """How torque comes about in a motor, in the order of the protocol."""

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
    """The least that a control board has; `ControlBoardLike` lists the rest."""

    @property
    def axis_names(self) -> Sequence[str]:
        """The names of the joints; their number is the number of joints."""

    def encoders(self) -> Sequence[float]:
        """Where the joints are."""


class PidController(Protocol):
    """The controllers of one kind, one for each joint. As above: have what you can do."""

    gains: Sequence[Sequence[float]]  # ten each, see `Gains`
    targets: Sequence[float]
    error_limits: Sequence[float]
    offsets: Sequence[float]  # added to the output
    enabled: Sequence[bool]

    def errors(self) -> Sequence[float]:
        """Target minus measurement."""

    def outputs(self) -> Sequence[float]:
        """What the controllers put out now."""

    def reset(self, joints: Sequence[int]) -> object:
        """Forget the integral."""


class ControlBoardLike(Joints, Protocol):
    """Everything a control board can have. For reading; classes need not inherit it.

    `ControlBoard`, the client of a remote one, has all of it.
    """

    # -- what is measured ---------------------------------------------------------------------

    def timestamps(self) -> Sequence[float]:
        """When the encoders were read, in seconds; without it, the time when they are asked."""

    def encoder_speeds(self) -> Sequence[float]:
        """How fast the joints move."""

    def encoder_accelerations(self) -> Sequence[float]:
        """How fast the speeds change, deg/s^2."""

    def motor_encoders(self) -> Sequence[float]:
        """Where the motors are."""

    def motor_speeds(self) -> Sequence[float]:
        """How fast the motors turn."""

    def motor_accelerations(self) -> Sequence[float]:
        """How fast the motors' speeds change, deg/s^2."""

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
        """A number for each amplifier; what it means is the robot's business."""

    def faults(self) -> Sequence[tuple[int, str]]:
        """The last fault of each joint: its code and what it is. `(0, "")` for none."""

    def control_modes(self) -> Sequence[str]:
        """The mode of each joint: see `ControlMode`."""

    def interaction_modes(self) -> Sequence[str]:
        """Stiff or compliant: see `InteractionMode`."""

    def motion_done(self) -> Sequence[bool]:
        """Whether each joint has arrived where `position_move` sent it."""

    # -- what acts ----------------------------------------------------------------------------

    def position_move(self, joints: Sequence[int], positions: Sequence[float]) -> object:
        """Move to these positions along a trajectory."""

    def relative_move(self, joints: Sequence[int], distances: Sequence[float]) -> object:
        """Move by these angles; without it, `position_move` from where the encoders are."""

    def position_direct(self, joints: Sequence[int], positions: Sequence[float]) -> object:
        """Go to these positions at once: the next points of somebody else's trajectory."""

    def velocity_move(self, joints: Sequence[int], speeds: Sequence[float]) -> object:
        """Move at these speeds until told otherwise."""

    def apply_torques(self, joints: Sequence[int], torques: Sequence[float]) -> object:
        """Make the joints exert these torques."""

    def apply_currents(self, joints: Sequence[int], currents: Sequence[float]) -> object:
        """Drive the motors with these currents."""

    def apply_duty_cycles(self, joints: Sequence[int], duty_cycles: Sequence[float]) -> object:
        """Drive the motors with these duty cycles."""

    def stop(self, joints: Sequence[int]) -> object:
        """Stand still."""

    def switch_control_modes(self, joints: Sequence[int], modes: Sequence[str]) -> object:
        """Change how joints are controlled. The word is as it was sent: `ControlMode(mode)` raises
        for one that YARP does not know."""

    def switch_interaction_modes(self, joints: Sequence[int], modes: Sequence[str]) -> object:
        """Make joints stiff or compliant."""

    def preset_encoders(self, joints: Sequence[int], positions: Sequence[float]) -> object:
        """Count from here: these are the positions of the joints now."""

    def preset_motor_encoders(self, joints: Sequence[int], positions: Sequence[float]) -> object:
        """Count from here: these are the positions of the motors now."""

    def enable_amplifiers(self, joints: Sequence[int]) -> object:
        """Power on."""

    def disable_amplifiers(self, joints: Sequence[int]) -> object:
        """Power off."""

    def calibrate_joint(self, joint: int, kind: int, parameters: Sequence[float]) -> object:
        """Start calibrating one joint; `kind` and its 3 or 4 parameters are the robot's own."""

    def calibration_done(self, joint: int) -> bool:
        """Whether that is over."""

    def calibrate(self, joints: Sequence[int]) -> object:
        """Calibrate joints as the robot wants it."""

    def home(self, joints: Sequence[int]) -> object:
        """Move to the home position."""

    def park(self, joints: Sequence[int]) -> object:
        """Move to where the robot may be switched off."""

    def quit_calibration(self) -> object:
        """Give up calibrating."""

    def quit_parking(self) -> object:
        """Give up parking."""

    # -- what was commanded last; without these the server remembers what it passed on --------

    def position_targets(self) -> Sequence[float]:
        """Where `position_move` goes."""

    def direct_targets(self) -> Sequence[float]:
        """What `position_direct` said."""

    def velocity_targets(self) -> Sequence[float]:
        """What `velocity_move` said."""

    def torque_targets(self) -> Sequence[float]:
        """What `apply_torques` said."""

    def current_targets(self) -> Sequence[float]:
        """What `apply_currents` said."""

    def duty_cycle_targets(self) -> Sequence[float]:
        """What `apply_duty_cycles` said."""

    # -- what is adjusted ---------------------------------------------------------------------

    axis_types: Sequence[str]  # "revolute" (so without it), "prismatic" or "unknown"
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
    motor_torque_parameters: Sequence[Sequence[float]]  # nine each, see `MotorTorqueParameters`
    impedances: Sequence[tuple[float, float]]  # (stiffness Nm/deg, damping Nm s/deg)
    impedance_offsets: Sequence[float]  # Nm
    impedance_ranges: Sequence[tuple[float, float, float, float]]  # stiffness, damping: min, max

    pids: Mapping[str, PidController]
    """Controllers by kind: `pos`, `vel`, `trq`, `cur`."""

    variables: MutableMapping[str, Any]
    """Whatever else the robot wants to show and have changed, by name; a dict does. Clients change
    what is there and add nothing. What they set is a list of what they sent."""
