"""A control board with everything, as tests need one: it answers what the recorded one answered.

Rules: positions are reached at once; what acts is also noted in `done`, so that a test can see that
nothing was.
"""

from __future__ import annotations

from typing import Any

from yarpy.kits.devices.control_board.interface import Gains


class Controllers:
    """The controllers of one kind."""

    def __init__(self, count: int) -> None:
        self.gains = [Gains(*(float(value) for value in range(1, 11))) for _ in range(count)]
        self.targets = [0.0] * count
        self.error_limits = [5.0] * count
        self.offsets = [0.0] * count
        self.enabled = [True] * count
        self.was_reset: list[int] = []

    def errors(self) -> list[float]:
        return [0.5] * len(self.targets)

    def outputs(self) -> list[float]:
        return [0.25] * len(self.targets)

    def reset(self, joints: list[int]) -> None:
        self.was_reset += joints


class FakeBoard:
    """Joints that obey at once."""

    def __init__(self, count: int = 3) -> None:
        self.count = count
        self.done: list[tuple[Any, ...]] = []
        self.axis_names = [f"joint{index}" for index in range(count)]
        self.axis_types = ["revolute"] * (count - 1) + ["prismatic"]
        self.where = [0.0] * count
        self.modes = ["pos"] * count
        self.interactions = ["stif"] * count
        self.reference_speeds = [10.0] * count
        self.reference_accelerations = [20.0] * count
        self.position_limits = [(-30.0 - index, 30.0) for index in range(count)]
        self.velocity_limits = [(0.0, 100.0)] * count
        self.torque_ranges = [(-5.0 - index, 5.0) for index in range(count)]
        self.current_ranges = [(-2.0, 2.0 + index) for index in range(count)]
        self.max_currents = [3.0] * count
        self.nominal_currents = [2.0] * count
        self.peak_currents = [4.0] * count
        self.pwm_limits = [100.0] * count
        self.temperature_limits = [80.0] * count
        self.gearbox_ratios = [100.0] * count
        self.counts_per_revolution = [8192.0] * count
        self.automatic_brakes = [False] * count
        self.motor_torque_parameters = [tuple(float(value) for value in range(9))] * count
        self.impedances = [(0.5, 0.25)] * count
        self.impedance_offsets = [0.0] * count
        self.impedance_ranges = [(0.0, 1.0, 0.0, 0.5)] * count
        self.pids = {kind: Controllers(count) for kind in ("pos", "vel", "trq", "cur")}
        self.variables: dict[str, Any] = {"gain": [1.5, "low"], "limit": 7}

    def encoders(self) -> list[float]:
        return self.where

    def timestamps(self) -> list[float]:
        return [0.0] * self.count

    def encoder_speeds(self) -> list[float]:
        return [0.0] * self.count

    def encoder_accelerations(self) -> list[float]:
        return [0.0] * self.count

    def motor_encoders(self) -> list[float]:
        return [10.0 * value for value in self.where]

    def motor_speeds(self) -> list[float]:
        return [0.0] * self.count

    def motor_accelerations(self) -> list[float]:
        return [0.0] * self.count

    def torques(self) -> list[float]:
        return [0.0] * self.count

    def duty_cycles(self) -> list[float]:
        return [33.0 + index for index in range(self.count)]

    def currents(self) -> list[float]:
        return [3300.0 + 100.0 * index for index in range(self.count)]

    def supply_voltages(self) -> list[float]:
        return [24.0] * self.count

    def motor_temperatures(self) -> list[float]:
        return [40.0 + index for index in range(self.count)]

    def amplifier_status(self) -> list[int]:
        return [*range(self.count)]

    def braked(self) -> list[bool]:
        return [index == 1 for index in range(self.count)]

    def apply_brakes(self, joints: list[int], active: list[bool]) -> None:
        self.note("apply_brakes", joints, active)

    def velocity_direct(self, joints: list[int], speeds: list[float]) -> None:
        self.note("velocity_direct", joints, speeds)

    def faults(self) -> list[tuple[int, str]]:
        return [(index, f"test{index} torque" if index else "") for index in range(self.count)]

    def control_modes(self) -> list[str]:
        return self.modes

    def interaction_modes(self) -> list[str]:
        return self.interactions

    def motion_done(self) -> list[bool]:
        return [True] * self.count

    def position_move(self, joints: list[int], positions: list[float]) -> None:
        self.note("position_move", joints, positions)
        for joint, position in zip(joints, positions, strict=True):
            self.where[joint] = position

    def position_direct(self, joints: list[int], positions: list[float]) -> None:
        self.note("position_direct", joints, positions)

    def velocity_move(self, joints: list[int], speeds: list[float]) -> None:
        self.note("velocity_move", joints, speeds)

    def apply_torques(self, joints: list[int], torques: list[float]) -> None:
        self.note("apply_torques", joints, torques)

    def apply_currents(self, joints: list[int], currents: list[float]) -> None:
        self.note("apply_currents", joints, currents)

    def apply_duty_cycles(self, joints: list[int], duty_cycles: list[float]) -> None:
        self.note("apply_duty_cycles", joints, duty_cycles)

    def stop(self, joints: list[int]) -> None:
        self.note("stop", joints)

    def switch_control_modes(self, joints: list[int], modes: list[str]) -> None:
        self.note("switch_control_modes", joints, modes)
        for joint, mode in zip(joints, modes, strict=True):
            self.modes[joint] = mode

    def switch_interaction_modes(self, joints: list[int], modes: list[str]) -> None:
        self.note("switch_interaction_modes", joints, modes)
        for joint, mode in zip(joints, modes, strict=True):
            self.interactions[joint] = mode

    def preset_encoders(self, joints: list[int], positions: list[float]) -> None:
        self.note("preset_encoders", joints, positions)

    def preset_motor_encoders(self, joints: list[int], positions: list[float]) -> None:
        self.note("preset_motor_encoders", joints, positions)

    def enable_amplifiers(self, joints: list[int]) -> None:
        self.note("enable_amplifiers", joints)

    def disable_amplifiers(self, joints: list[int]) -> None:
        self.note("disable_amplifiers", joints)

    def calibrate_joint(self, joint: int, kind: int, parameters: list[float]) -> None:
        self.note("calibrate_joint", joint, kind, parameters)

    def calibration_done(self, joint: int) -> bool:
        return joint == 0

    def calibrate(self, joints: list[int]) -> None:
        self.note("calibrate", joints)

    def home(self, joints: list[int]) -> None:
        self.note("home", joints)

    def park(self, joints: list[int]) -> None:
        self.note("park", joints)

    def quit_calibration(self) -> None:
        self.note("quit_calibration")

    def quit_parking(self) -> None:
        self.note("quit_parking")

    def note(self, *what: Any) -> None:
        self.done.append(what)


class Bare:
    """The least there is."""

    axis_names = ("left", "right")

    def encoders(self) -> tuple[float, float]:
        return (1.5, -2.0)
