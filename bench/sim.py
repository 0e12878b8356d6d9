"""A MuJoCo model as a YARP robot: how much faster than real time it runs, beside plain MuJoCo.

"plain" steps the model; "robot" steps it with its joints on trajectories, all sensors read 100
times a simulated second, and the state of its control board encoded as often.

    python bench/sim.py [MODEL] [--seconds 20]      seconds of simulated time
"""

import argparse
import time
from collections.abc import Sequence
from pathlib import Path

from yarpy.kits.devices.control_board.board import Board as Served
from yarpy.kits.devices.control_board.state import State
from yarpy.kits.devices.multi_sensor.interface import KINDS
from yarpy.kits.sim.board import Board
from yarpy.kits.sim.mujoco.model import load, mujoco
from yarpy.kits.sim.mujoco.robot import scene_in
from yarpy.kits.sim.mujoco.sensor import Sensors

ARM = Path(__file__).parents[1] / "tests" / "support" / "arm.xml"
STEP = 0.01


def plain(path: Path, seconds: float) -> float:
    """Return how many times faster than real time the model alone is."""
    engine = mujoco()
    model = engine.MjModel.from_xml_path(str(path))
    data = engine.MjData(model)
    steps, start = round(seconds / model.opt.timestep), time.perf_counter()
    for _ in range(steps):
        engine.mj_step(model, data)
    return seconds / (time.perf_counter() - start)


def robot(path: Path, seconds: float) -> float:
    """Return how many times faster than real time the robot is."""
    now = 0.0
    model = load(path, lambda: now)
    sensors, board = Sensors(model), Served(Board(model), "/bench")
    goals = [(axis.lowest + axis.highest) / 2 for axis in (joint.axis for joint in model.joints)]
    with model.present() as joints:
        for joint, goal in zip(joints, goals, strict=True):
            joint.reference.move_to(goal)
    kinds = [getattr(sensors, kind) for kind in KINDS if hasattr(sensors, kind)]
    start = time.perf_counter()
    for _ in range(round(seconds / STEP)):
        now += STEP
        State.of(board.count, board.values).to_bytes()
        for read in kinds:
            read()
    return seconds / (time.perf_counter() - start)


def main(arguments: Sequence[str] | None = None) -> None:
    """Print both."""
    parser = argparse.ArgumentParser(description="A MuJoCo model as a YARP robot.")
    parser.add_argument("model", type=Path, nargs="?", default=ARM)
    parser.add_argument("--seconds", type=float, default=20.0)
    options = parser.parse_args(arguments)
    path = scene_in(options.model)
    alone, whole = plain(path, options.seconds), robot(path, options.seconds)
    print("| | times real time |\n|---|---|")
    print(f"| plain MuJoCo | {alone:.1f} |\n| robot | {whole:.1f} |")


if __name__ == "__main__":
    main()
