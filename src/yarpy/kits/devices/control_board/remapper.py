"""Remappers as devices of a robot's file: joints of several control boards as one board.

    <device name="upper" type="controlboardremapper">
      <param name="axesNames">(neck_pitch torso_yaw)</param>
      <action phase="startup" level="5" type="attach">
        <param name="networks">(t h)</param>
        <param name="t">torso</param>
        <param name="h">head</param>
      </action>
      <action phase="shutdown" level="20" type="detach"/>
    </device>

    <device name="upper" type="remotecontrolboardremapper">
      <param name="remoteControlBoards">(/icub/torso /icub/head)</param>
      <param name="axesNames">(neck_pitch torso_yaw)</param>
      <param name="localPortPrefix">/mine</param>
      <group name="REMOTE_CONTROLBOARD_OPTIONS"><param name="carrier">udp</param></group>
    </device>

Rules: without `axesNames` the first has all joints of what is attached, in its order.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from yarpy.data.bottle import Property
from yarpy.kits.devices.control_board.remap import remap, remap_remote
from yarpy.kits.devices.simulated.plugin import values
from yarpy.names.base import NameClient


class Remapper:
    """`controlboardremapper`: `served` is the board, once others are attached."""

    def __init__(self, options: Property, *, names: NameClient | None = None) -> None:
        self._axes = [str(one) for one in values(options, "axesNames")]
        self._board: Any = None

    @property
    def served(self) -> object:
        """The board. Raises ValueError before any is attached."""
        if self._board is None:
            raise ValueError("it has no joints yet: attach control boards to it at a lower level")
        return self._board

    def attach(self, devices: Mapping[str, object]) -> None:
        """Have the joints of these boards; with `all`, of those among the devices. Raises
        ValueError for joints that none of them has, or two."""
        boards = [one for one in devices.values() if hasattr(one, "axis_names")]
        if not boards:
            raise ValueError("it attaches control boards, and none of these is one")
        axes = self._axes or [name for board in boards for name in board.axis_names]
        self._board = remap(boards, axes)

    def detach(self) -> None:
        """Have no joints."""
        self._board = None


def remote_remapper(options: Property, *, names: NameClient | None = None) -> object:
    """Return `remotecontrolboardremapper`. Raises ValueError for joints that no board has,
    YarpError."""
    boards = [str(one) for one in values(options, "remoteControlBoards")]
    axes = [str(one) for one in values(options, "axesNames")]
    for key, found in (("remoteControlBoards", boards), ("axesNames", axes)):
        if not found:
            raise ValueError(f"it needs a parameter {key}, a list of names")
    inner = Property.from_bottle(options.group("REMOTE_CONTROLBOARD_OPTIONS") or ())
    return remap_remote(
        boards,
        axes,
        str(options.find("localPortPrefix", "") or ""),
        carrier=str(inner.find("carrier", "tcp")),
        names=names,
    )
