"""The frames of a MuJoCo model: its bodies, each below the one that it hangs on, and its cameras.

Rules: the root is `world`. A body without a name is called by its number. A camera of MuJoCo looks
along -z with y up; its frame here is as for every camera.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, Final

from yarpy.kits.sim import rotation as of
from yarpy.kits.sim.frame import Frame
from yarpy.kits.sim.mujoco.model import Model, mujoco
from yarpy.kits.sim.rotation import Rotation, Vector

_CAMERA: Final = ((1.0, 0.0, 0.0), (0.0, -1.0, 0.0), (0.0, 0.0, -1.0))


class ModelFrames:
    """The frames of `model`; `cameras`: the numbers of cameras by the names of their frames."""

    def __init__(self, model: Model, cameras: Mapping[str, int]) -> None:
        self._engine = mujoco()
        self._model = model
        self._cameras = cameras
        self._names = [model.name_of("body", number) for number in range(model.model.nbody)]

    def frames(self) -> tuple[float, list[Frame]]:
        """Return the time, in seconds, and the frames as they are then."""
        model, names = self._model, self._names
        with model.present():
            when, data = model.time, model.data
            self._engine.mj_kinematics(model.model, data)  # a step leaves them as before it
            self._engine.mj_camlight(model.model, data)
            bodies = list(zip(data.xpos.tolist(), map(_rows, data.xmat.tolist()), strict=True))
            cameras = [
                (data.cam_xpos[number].tolist(), _rows(data.cam_xmat[number].tolist()))
                for number in self._cameras.values()
            ]
        parents = model.model.body_parentid.tolist()
        found = [
            _within(names[number], names[parents[number]], bodies[parents[number]], *bodies[number])
            for number in range(1, len(names))
        ]
        holders = model.model.cam_bodyid.tolist()
        for (name, number), (place, turned) in zip(self._cameras.items(), cameras, strict=True):
            holder = holders[number]
            looking = of.after(turned, _CAMERA)
            found.append(_within(name, names[holder], bodies[holder], place, looking))
        return when, found


def _rows(matrix: list[float]) -> Rotation:
    a, b, c, d, e, f, g, h, i = matrix
    return (a, b, c), (d, e, f), (g, h, i)


def _within(
    name: str, parent: str, outer: tuple[list[float], Rotation], place: Any, turned: Rotation
) -> Frame:
    """Return a frame, given in the world, below its parent, whose place and rotation `outer` is."""
    at, around = outer
    away: Vector = (place[0] - at[0], place[1] - at[1], place[2] - at[2])
    orientation = of.quaternion(of.after(of.inverse(around), turned))
    return Frame(name, parent, of.seen_from(around, away), orientation)
