"""The parts of a robot from a MuJoCo model, named like those of the simulated head.

joints            hinges and slides with actuators: a control board
cam/NAME          its cameras; `cam/free` if it has none
inertial          gyroscopes, accelerometers, magnetometers, orientations and positions of frames,
                  forces with torques
laser...          sites of such a name (`scanner.py`)
odometry, localization    of the first body that moves freely (`base.py`)
frames            its bodies and cameras (`frames.py`)

Rules: a folder of MuJoCo Menagerie's layout is its `scene.xml`; without one, its only model.
"""

from __future__ import annotations

import re
from collections.abc import Callable
from pathlib import Path

from yarpy.clock import now
from yarpy.errors import UnknownPlugin
from yarpy.kits.sim.board import Board
from yarpy.kits.sim.body import Clock
from yarpy.kits.sim.mujoco.base import base_of
from yarpy.kits.sim.mujoco.camera import FREE, Camera, Painter
from yarpy.kits.sim.mujoco.frames import ModelFrames
from yarpy.kits.sim.mujoco.model import load
from yarpy.kits.sim.mujoco.scanner import scanners
from yarpy.kits.sim.mujoco.sensor import Sensors
from yarpy.kits.sim.robot import SIZE, Parts


def mujoco_robot(
    path: str | Path,
    size: tuple[int, int] = SIZE,
    clock: Clock = now,
    warn: Callable[[str], object] = lambda line: None,
) -> tuple[str, Parts]:
    """A name for the robot and its parts.

    size: width and height of pictures. warn: called if pictures cannot be drawn. Raises
    UnknownPlugin (no MuJoCo), ValueError (not a model, or nothing to serve in it), OSError.
    """
    model = load(scene_in(Path(path)), clock)
    board, sensors, cameras = Board(model), Sensors(model), {}
    names = [model.name_of("camera", number) for number in range(model.model.ncam)]
    try:
        painter = Painter(model, *size)
        numbers = {_plain(name): number for number, name in enumerate(names)} or {"free": FREE}
        cameras = {
            f"cam/{name}": Camera(painter, model.model, number) for name, number in numbers.items()
        }
    except UnknownPlugin as error:
        warn(f"no cameras: {error}")
    boards = {"joints": board} if board.axis_names else {}
    lasers = {_plain(name): laser for name, laser in scanners(model).items()}
    if not (boards or cameras or sensors.count or lasers):
        raise ValueError(f"{path}: no joint with an actuator, no camera, no inertial sensor")
    felt = {"inertial": sensors} if sensors.count else {}
    views = {f"cam/{_plain(name)}": number for number, name in enumerate(names)}
    frames = ModelFrames(model, views)
    return _plain(model.name), Parts(boards, cameras, felt, lasers, base_of(model), frames)


def scene_in(path: Path) -> Path:
    """Return the model in a folder, or a file as it is. Raises ValueError for a folder with none,
    or several and no scene.xml."""
    if not path.is_dir():
        return path
    models = sorted(path.glob("*.xml"))
    scene = path / "scene.xml"
    if scene in models:
        return scene
    if len(models) != 1:
        there = ", ".join(each.name for each in models) or "none"
        raise ValueError(f"{path}: say which model it is, there is no scene.xml; models: {there}")
    return models[0]


def _plain(name: str) -> str:
    """A name made suitable for port names."""
    return re.sub(r"[^A-Za-z0-9_.\-/]+", "_", name).strip("/") or "_"
