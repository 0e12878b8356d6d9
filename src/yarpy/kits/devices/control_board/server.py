"""ControlBoardServer: serve your device on the ports of a YARP control board.

    <name>/rpc:i        requests and replies (`responder`); people may type them
    <name>/nws/rpc:i    the same for programs of YARP 4 (`yarp4`)
    <name>/command:i    streamed commands (`command`), which are never answered
    <name>/stateExt:o   all measurements (`state`), every period
    <name>/state:o      positions only, for tools and older clients

Both outputs are stamped with count and time of the encoders; nothing is read while nobody listens.
Readers of YARP 4 get them as it spells them.

Source: controlBoard_nws_yarp of YARP 3.x, protocol 1.9.0, and of 4.0.
"""

from __future__ import annotations

from contextlib import ExitStack
from typing import Any, Final

from yarpy.data.bottle import Bottle
from yarpy.data.stamp import Stamp
from yarpy.data.yarp4 import to_yarp4
from yarpy.errors import DecodeError
from yarpy.kits.devices.closeable import Closeable, prefix
from yarpy.kits.devices.control_board import command
from yarpy.kits.devices.control_board.board import Board
from yarpy.kits.devices.control_board.interface import Joints
from yarpy.kits.devices.control_board.responder import FAIL, Responder
from yarpy.kits.devices.control_board.state import State
from yarpy.kits.devices.control_board.yarp4.server import Functions
from yarpy.kits.devices.publisher import Publisher
from yarpy.kits.devices.refusal import DeviceErrorLog, Refused
from yarpy.log import logger
from yarpy.names.base import NameClient
from yarpy.port.dialects import Dialects
from yarpy.port.port import BufferedPort, Port
from yarpy.port.rpc import RpcServer
from yarpy.wire.message import Encoded, Lines, Message

log = logger("yarpy.devices")

#: Joints whose encoders were read further apart than this, in seconds, do not make one state.
APART: Final = 1.0


class ControlBoardServer(Closeable):
    """Serves `device` (see `devices.control_board.interface`) to C++ and Python clients.

    name: prefix of the ports, for example `/icub/head`.
    period: seconds between states.
    names: a name client, None for the default.
    Raises AddressError (a name is in use), NoNameServer; ValueError if the device has no joints.
    """

    def __init__(
        self,
        name: str,
        device: Joints,
        period: float = 0.02,
        *,
        names: NameClient | None = None,
    ) -> None:
        self.name = name = prefix(name)
        self.device = device
        self._board = Board(device, name)
        self._responder = Responder(self._board)
        self._complain = DeviceErrorLog(name)
        self._stamp = Stamp()
        with ExitStack() as resources:
            self._rpc = resources.enter_context(
                RpcServer(f"{name}/rpc:i", self._answer, names=names)
            )
            self._functions = resources.enter_context(
                RpcServer(f"{name}/nws/rpc:i", Functions(self._board), names=names)
            )
            self._command = resources.enter_context(
                Port(f"{name}/command:i", callback=self._obey, names=names)
            )
            self._state_ext = resources.enter_context(
                BufferedPort(f"{name}/stateExt:o", names=names)
            )
            self._state = resources.enter_context(BufferedPort(f"{name}/state:o", names=names))
            self._state_ext_readers = Dialects(self._state_ext)
            self._state_readers = Dialects(self._state)
            self._publisher = Publisher(name, period, self._publish)
            resources.callback(self._publisher.close)
            self._resources = resources.pop_all()

    @property
    def axes(self) -> int:
        """The number of joints."""
        return self._board.count

    def __repr__(self) -> str:
        return f"<ControlBoardServer {self.name}, {self.axes} joints>"

    def _answer(self, message: Message) -> object:
        try:
            request = message.as_(Bottle)
        except DecodeError:
            return Bottle([FAIL])
        browsing = message.source == "web"
        if len(request) == 1 and browsing:
            request.append("")  # so that people in a browser get the help they ask for
        reply = self._responder.answer(request)
        if reply[0] == "many" and message.spelling == "text":
            return Lines(_line(element, plain=browsing) for element in reply[1:])
        return reply

    def _obey(self, message: Message) -> None:
        try:
            bottle = message.as_(Bottle)
            method, joints, values = command.read(
                bottle, self._board.count, exact=message.spelling == "binary"
            )
            self._board.apply(method, joints, values)
        except (DecodeError, Refused) as error:
            self._complain(f"command from {message.source}", error)

    def _publish(self) -> None:
        if not (self._state_ext_readers or self._state_readers):
            return
        board = self._board
        state = State.of(board.count, board.values, newer=True)
        times = board.timestamps()
        if max(max(times) - times[0], times[0] - min(times)) > APART:
            raise Refused(f"the encoders were read more than {APART:g} s apart: not published")
        self._stamp = self._stamp.next(sum(times) / len(times))
        self._state_ext_readers.write(
            lambda: Encoded(state.to_bytes()),
            lambda: Encoded(to_yarp4(state.to_bytes(newer=True))),
            self._stamp,
        )
        positions = state.values.get("encoders")
        if positions is not None:
            bottle = Bottle(positions)
            self._state_readers.write(lambda: bottle, lambda: _newer(bottle), self._stamp)


def _newer(bottle: Bottle) -> Encoded:
    """A message as YARP 4 spells it."""
    return Encoded(to_yarp4(bottle.to_bytes()))


def _line(element: Any, plain: bool) -> str:
    """An element as a separate line; `plain`: without the quotes that YARP puts around text."""
    if plain and type(element) is str:
        return element
    return Bottle(element if isinstance(element, list) else [element]).to_text()
