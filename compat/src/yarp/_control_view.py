"""Views that say how joints are controlled: IControlMode, IInteractionMode, and IControlLimits."""

from __future__ import annotations

from typing import Any

import yarpy
from yarp._view import View

#: modes -> what a device has that can be put into them
SELECTABLE = {
    "pos": "position_move",
    "posd": "position_direct",
    "vel": "velocity_move",
    "torq": "apply_torques",
    "ipwm": "apply_duty_cycles",
    "icur": "apply_currents",
}
#: the kinds of controllers: of positions, torques, velocities and currents
PIDS = ("pos", "trq", "vel", "cur")


def word_of(code: Any) -> str:
    """The word of a mode, given as a number or as a word."""
    return str(code) if isinstance(code, str) else str(yarpy.Vocab.from_code(int(code)))


def _codes(words: Any) -> list[int]:
    return [yarpy.Vocab(str(word)).code for word in words]


class _Modes(View):
    """Modes of joints are numbers here, and words there."""

    _member = ""
    _method = ""

    def _get_modes(self, arguments: tuple[Any, ...]) -> bool:
        return self._tell(lambda: self._fill(_codes(self._values(self._member)), arguments, None))

    def _set_modes(self, arguments: tuple[Any, ...]) -> bool:
        def act() -> None:
            joints, modes = self._split(arguments)
            getattr(self._board, self._method)(joints, [word_of(mode) for mode in modes])

        return self._tell(act)

    def _mode(self, joint: int) -> int:
        found = [0]
        self._get_modes((joint, found))
        return found[0]


class IControlMode(_Modes):
    """`VOCAB_CM_POSITION` ... of each joint."""

    _member = "control_modes"
    _method = "switch_control_modes"

    def getControlMode(self, j: int, mode: Any = None) -> int:
        """The mode of a joint; with a second argument, whether it was stored there."""
        return self._mode(j) if mode is None else self._get_modes((j, mode))

    def getControlModes(self, *modes: Any) -> bool:
        return self._get_modes(modes)

    def getAvailableControlModes(self, j: int, avail: Any) -> bool:
        """Store the modes that a joint can be put into, in an IVector."""
        board = self._board
        if not 0 <= j < self.getAxes():
            return False
        found = [word for word, member in SELECTABLE.items() if hasattr(board, member)]
        avail.assign(0, 0)
        for code in _codes([*found, "idl", "fidl"]):
            avail.push_back(code)
        return True

    def setControlMode(self, j: int, mode: int) -> bool:
        return self._set_modes((j, mode))

    def setControlModes(self, *modes: Any) -> bool:
        return self._set_modes(modes)


class IInteractionMode(_Modes):
    """`VOCAB_IM_STIFF` ... of each joint."""

    _member = "interaction_modes"
    _method = "switch_interaction_modes"

    def getInteractionMode(self, axis: int, mode: Any = None) -> int:
        return self._mode(axis) if mode is None else self._get_modes((axis, mode))

    def getInteractionModes(self, *modes: Any) -> bool:
        return self._get_modes(modes)

    def setInteractionMode(self, axis: int, mode: int) -> bool:
        return self._set_modes((axis, mode))

    def setInteractionModes(self, *modes: Any) -> bool:
        return self._set_modes(modes)


class IControlLimits(View):
    """How far and how fast joints may move."""

    def getLimits(self, axis: int, min: Any, max: Any) -> bool:
        return self._get("position_limits", (axis, min), 0) and self._get(
            "position_limits", (axis, max), 1
        )

    def setLimits(self, axis: int, min: float, max: float) -> bool:
        return self._change("position_limits", (axis, (min, max)))

    def getVelLimits(self, axis: int, min: Any, max: Any) -> bool:
        return self._get("velocity_limits", (axis, min), 0) and self._get(
            "velocity_limits", (axis, max), 1
        )

    def setVelLimits(self, axis: int, min: float, max: float) -> bool:
        return self._change("velocity_limits", (axis, (min, max)))

    getPosLimits = getLimits
    setPosLimits = setLimits
