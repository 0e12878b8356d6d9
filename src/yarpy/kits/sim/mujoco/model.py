"""A MuJoCo model as a robot: joints with actuators, in the time of `Body`.

A joint follows its reference whatever kind of actuator drives it: position and velocity actuators
get the setpoint, motors the torque computed by a critically damped, model-based controller. Angles
are degrees outside and radians in MuJoCo, lengths millimetres outside and metres there.

Rules: only `load` imports MuJoCo.
"""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any, Final, Literal

from yarpy.clock import now
from yarpy.errors import UnknownPlugin
from yarpy.kits.sim.axis import Axis
from yarpy.kits.sim.body import Body, Clock
from yarpy.kits.sim.joint import Joint

MISSING: Final = "this needs MuJoCo: pip install 'yarpy[sim]' (or pip install mujoco)"
STIFFNESS: Final = 20.0  # rad/s, of the controllers for motors and speeds
LONGEST: Final = 0.1  # most simulated seconds per catch-up; beyond that the model falls behind
ENDLESS: Final = 1e6  # the range of a joint without limits

Drive = Literal["position", "velocity", "motor"]


def mujoco() -> Any:
    """The module, set up to render without a display. Raises UnknownPlugin."""
    import importlib
    import os
    import sys

    if sys.platform == "linux":
        from ctypes.util import find_library

        # MuJoCo reads this when it is imported. EGL draws without a display, in any thread.
        if find_library("EGL"):
            os.environ.setdefault("MUJOCO_GL", "egl")
        elif not os.environ.get("DISPLAY"):
            os.environ.setdefault("MUJOCO_GL", "disable")
    try:
        return importlib.import_module("mujoco")
    except ImportError as error:
        raise UnknownPlugin(MISSING) from error
    except Exception as error:  # from the graphics libraries that MUJOCO_GL chose
        raise UnknownPlugin(
            f"MuJoCo cannot be imported with MUJOCO_GL={os.environ.get('MUJOCO_GL')}: {error}"
        ) from error


class ModelJoint(Joint):
    """A joint of a model, and the actuator that drives it."""

    def __init__(self, axis: Axis, model: Any, joint: int, actuator: int, drive: Drive) -> None:
        super().__init__(axis)
        self._drive = drive
        self._actuator = actuator
        self._place = int(model.jnt_qposadr[joint])
        self._freedom = int(model.jnt_dofadr[joint])
        self._gear = float(model.actuator_gear[actuator, 0]) or 1.0
        self._gain = float(model.actuator_gainprm[actuator, 0]) or 1.0
        self._inertia = float(model.dof_M0[self._freedom])
        self._unit = 1000.0 if axis.kind == "prismatic" else math.degrees(1.0)

    @property
    def done(self) -> bool:
        """True when a trajectory is over and the joint rests; weak actuators may not quite
        arrive."""
        return self.reference.done and abs(self.speed) < 1.0

    def read(self, data: Any) -> None:
        """Take the joint's state from the model."""
        self.position = float(data.qpos[self._place]) * self._unit
        self.speed = float(data.qvel[self._freedom]) * self._unit
        self.acceleration = float(data.qacc[self._freedom]) * self._unit

    def command(self, data: Any, dt: float) -> None:
        """Set the actuator's command for the next `dt` seconds."""
        reference, unit = self.reference, self._unit
        position, speed = float(data.qpos[self._place]), float(data.qvel[self._freedom])
        if reference.mode == "idl":
            reference.place(position * unit)
            there, then, push = position, speed, 0.0
        else:
            reference.step(dt)
            there, then = reference.position / unit, reference.speed / unit
            push = self._inertia * (
                STIFFNESS**2 * (there - position)
                + 2 * STIFFNESS * (then - speed)
                + reference.acceleration / unit
            ) + float(data.qfrc_bias[self._freedom])
        if self._drive == "position":
            control = self._gear * there
        elif self._drive == "velocity":
            control = self._gear * (then + STIFFNESS * (there - position))
        else:
            control = push / (self._gear * self._gain)
        data.ctrl[self._actuator] = control


class _Views:
    """The arrays of the data that joints read and write, looked up once: MuJoCo makes a new object
    of Python for each look, several a joint and step."""

    def __init__(self, data: Any) -> None:
        self.qpos, self.qvel, self.qacc = data.qpos, data.qvel, data.qacc
        self.qfrc_bias, self.ctrl = data.qfrc_bias, data.ctrl


class Model(Body[ModelJoint]):
    """A running model; `joints` are those driven by an actuator."""

    def __init__(self, model: Any, name: str, clock: Clock = now) -> None:
        self._engine = mujoco()
        self.model, self.data = model, self._engine.MjData(model)
        self.name = name
        if model.nkey:
            self._engine.mj_resetDataKeyframe(model, self.data, 0)
        self._engine.mj_forward(model, self.data)
        self._views = _Views(self.data)
        self._behind = 0.0  # seconds not simulated yet
        super().__init__(self._actuated(), clock)
        for joint in self.joints:
            joint.read(self._views)
            joint.reference.place(joint.position)

    def elapse(self, seconds: float) -> None:
        step = float(self.model.opt.timestep)
        self._behind = min(self._behind + seconds, max(LONGEST, step))
        while self._behind >= step:
            for joint in self.joints:
                joint.command(self._views, step)
            self._engine.mj_step(self.model, self.data)
            self._behind -= step
        for joint in self.joints:
            joint.read(self._views)

    def name_of(self, kind: str, number: int) -> str:
        """The name of an object, or a generated one."""
        which = getattr(self._engine.mjtObj, f"mjOBJ_{kind.upper()}")
        return self._engine.mj_id2name(self.model, which, number) or f"{kind}{number}"

    def _actuated(self) -> list[ModelJoint]:
        """The hinges and slides that have an actuator, in the order of actuators."""
        engine, model = self._engine, self.model
        found: dict[int, ModelJoint] = {}
        along = (int(engine.mjtTrn.mjTRN_JOINT), int(engine.mjtTrn.mjTRN_JOINTINPARENT))
        kinds = {
            int(engine.mjtJoint.mjJNT_HINGE): "revolute",
            int(engine.mjtJoint.mjJNT_SLIDE): "prismatic",
        }
        for actuator in range(model.nu):
            joint = int(model.actuator_trnid[actuator, 0])
            drive = self._drive(actuator)
            transmission = int(model.actuator_trntype[actuator])
            if transmission not in along or drive is None or joint in found:
                continue
            kind = kinds.get(int(model.jnt_type[joint]))
            if kind is not None:
                axis = self._axis(joint, kind)
                found[joint] = ModelJoint(axis, model, joint, actuator, drive)
        return [*found.values()]

    def _drive(self, actuator: int) -> Drive | None:
        """The kind of command that an actuator takes; None for muscles and other unknown kinds."""
        engine, model = self._engine, self.model
        if int(model.actuator_gaintype[actuator]) != int(engine.mjtGain.mjGAIN_FIXED):
            return None
        affine = int(model.actuator_biastype[actuator]) == int(engine.mjtBias.mjBIAS_AFFINE)
        _, of_position, of_speed = model.actuator_biasprm[actuator, :3].tolist()
        if affine and of_position:
            return "position"
        return "velocity" if affine and of_speed else "motor"

    def _axis(self, joint: int, kind: str) -> Axis:
        unit, speed = (1000.0, 200.0) if kind == "prismatic" else (math.degrees(1.0), 60.0)
        lowest, highest = -ENDLESS, ENDLESS
        if self.model.jnt_limited[joint]:
            lowest, highest = (self.model.jnt_range[joint] * unit).tolist()
        name = self.name_of("joint", joint)
        return Axis(name, lowest, highest, speed, 10 * speed, 12 * speed, kind=kind)


def load(path: str | Path, clock: Clock = now) -> Model:
    """The model in an XML (MJCF, URDF) or MJB file. Raises UnknownPlugin (no MuJoCo), ValueError
    (not a model), OSError."""
    engine, path = mujoco(), Path(path)
    path.open("rb").close()  # gives a better error than MuJoCo's
    binary = path.suffix.lower() == ".mjb"
    read = engine.MjModel.from_binary_path if binary else engine.MjModel.from_xml_path
    model = read(str(path))
    name = bytes(model.names).partition(b"\0")[0].decode("utf-8", "replace")
    return Model(model, path.stem if name in ("", "MuJoCo Model") else name, clock)
