"""The client side of a control board's RPC port: `grammar` used to write requests.

Rules: a member of the interface becomes the shortest possible request: for all joints where a word
for that exists, else for several, else one joint at a time. `[fail]` is a LocalProtocolError that
shows the request.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from contextlib import ExitStack
from typing import Any, Final

from yarpy.data.bottle import Bottle
from yarpy.data.value import Vocab
from yarpy.errors import LocalProtocolError, RemoteProtocolError, UnknownName
from yarpy.kits.devices.closeable import Closeable
from yarpy.kits.devices.control_board import grammar
from yarpy.kits.devices.control_board.grammar import INTERFACES, PID, Form, Interface, Row
from yarpy.kits.devices.control_board.remote_parts import Asks
from yarpy.kits.devices.kind import FLAG, NOTHING, PAIR, Fixed
from yarpy.names.base import NameClient
from yarpy.port.rpc import RpcClient

#: Seconds to wait for an answer.
TIMEOUT: Final = 10.0


def _by_member(
    interfaces: Sequence[Interface], rows_of: Callable[[Interface], tuple[Row, ...]]
) -> dict[str, tuple[Interface, Row]]:
    found: dict[str, tuple[Interface, Row]] = {}
    for interface in interfaces:
        for row in rows_of(interface):
            if not isinstance(row.kind, Fixed) or row.kind is NOTHING:
                found.setdefault(row.member, (interface, row))
    return found


_READ: Final = _by_member([*INTERFACES.values()], lambda interface: interface.get)
_WRITE: Final = _by_member([*INTERFACES.values()], lambda interface: interface.set)
_PID_READ: Final = _by_member([PID], lambda interface: interface.get)
_PID_WRITE: Final = _by_member([PID], lambda interface: interface.set)


class Requests(Closeable):
    """Sends requests to the board at `remote`."""

    newer = False  # it is of YARP 3

    def __init__(self, remote: str, local: str, names: NameClient | None) -> None:
        self.remote = remote
        self.axes = 0
        self._resources = ExitStack()
        self._client = self._resources.enter_context(
            RpcClient(f"{remote}/rpc:i", name=local, names=names)
        )

    # -- members of the interface -------------------------------------------------------------

    def read(self, member: str) -> list[Any]:
        """The values of all joints."""
        interface, row = _READ[member]
        return self._read(interface, row, ())

    def write(self, member: str, joints: Sequence[int], values: Sequence[Any] | None) -> None:
        """Act on these joints, or change a setting of theirs."""
        if member not in _WRITE:
            raise AttributeError(f"{member} can only be read")
        interface, row = _WRITE[member]
        self._write(interface, row, (), joints, values)

    def read_pid(self, kind: str, member: str) -> list[Any]:
        """The same of the controllers of one kind."""
        interface, row = _PID_READ[member]
        return self._read(interface, row, (Vocab(kind),))

    def write_pid(
        self, kind: str, member: str, joints: Sequence[int], values: Sequence[Any] | None
    ) -> None:
        """The same of the controllers of one kind."""
        if member == "enabled" and values is not None:
            for joint, value in zip(joints, values, strict=True):
                self.tell("set", "pid", "ena" if value else "dis", Vocab(kind), joint)
            return
        if member not in _PID_WRITE:
            raise AttributeError(f"{member} can only be read")
        interface, row = _PID_WRITE[member]
        self._write(interface, row, (Vocab(kind),), joints, values)

    def _read(self, interface: Interface, row: Row, middle: Sequence[Any]) -> list[Any]:
        words = [Vocab("get"), *_prefix(interface)]
        kind = row.kind
        try:
            if row.all and kind is not FLAG:
                payload = self._payload(interface, [*words, Vocab(row.all), *middle])
                if kind is PAIR:
                    return [kind.check(pair) for pair in zip(*payload, strict=True)]
                return self._checked([kind.parse([value]) for value in payload[0]])
            return [
                kind.parse(self._payload(interface, [*words, Vocab(row.one), *middle, joint]))
                for joint in range(self.axes)
            ]
        except (TypeError, ValueError, LookupError) as error:
            raise RemoteProtocolError(
                f'"{self.remote}" returns no {row.member.replace("_", " ")}: {error}'
            ) from error

    def _checked(self, values: list[Any]) -> list[Any]:
        if len(values) != self.axes:
            raise ValueError(f"{len(values)} values for {self.axes} joints")
        return values

    def _write(
        self,
        interface: Interface,
        row: Row,
        middle: Sequence[Any],
        joints: Sequence[int],
        values: Sequence[Any] | None,
    ) -> None:
        words = [Vocab("set"), *_prefix(interface)]
        given = values is not None
        spelled = [row.kind.write(value) for value in values] if values is not None else []
        listed = [Bottle(element for elements in spelled for element in elements)] if given else []
        if row.all and [*joints] == [*range(self.axes)]:
            self.send([*words, Vocab(row.all), *middle, *listed])
        elif row.some and len(joints) > 1:
            some = (len(joints), Bottle(joints))
            self.send([*words, Vocab(row.some), *middle, *some, *listed])
        else:
            for index, joint in enumerate(joints):
                own = spelled[index] if given else []
                self.send([*words, Vocab(row.one), *middle, joint, *own])

    def _payload(self, interface: Interface, request: list[Any]) -> list[Any]:
        """The content of a reply, without its framing."""
        reply = self.send(request)[:-1]
        ends = [at for at, element in enumerate(reply) if isinstance(element, Vocab)]
        end = next((at for at in ends if reply[at] == "tsta"), len(reply))
        start = 0 if not interface.echo else 1 if interface is grammar.FAULTS else 2
        return reply[start:end]

    # -- requests with their own form ---------------------------------------------------------

    def version(self) -> tuple[int, ...]:
        """The version of the protocol; () if unknown."""
        reply = self._client.call(Bottle([Vocab("get"), Vocab("prot")]), timeout=TIMEOUT)
        if isinstance(reply, list) and len(reply) == 5 and reply[0] == "prot":
            return tuple(item for item in reply[1:4] if type(item) is int)
        return ()

    def count_axes(self) -> int:
        """The number of joints."""
        reply = self.tell("get", "axes")
        if len(reply) < 3 or not isinstance(reply[2], int) or reply[2] < 1:
            raise RemoteProtocolError(f'"{self.remote}" does not say how many joints it has')
        self.axes = int(reply[2])
        return self.axes

    def all_done(self) -> bool:
        """Return whether all joints have arrived."""
        return bool(self.tell("get", "dons")[2])

    def calibrate_joint(self, joint: int, kind: int, parameters: Sequence[float]) -> None:
        """See ControlBoard."""
        if len(parameters) not in (3, 4):
            raise ValueError(f"a calibration has 3 or 4 parameters, not {len(parameters)}")
        verb = "calj" if len(parameters) == 3 else "cljp"
        self.send([Vocab(verb), joint, kind, *map(float, parameters)], None)

    def calibration_done(self, joint: int) -> bool:
        """See ControlBoard. A board that cannot calibrate says no as well."""
        try:
            self.tell("cald", joint)
        except LocalProtocolError:
            return False
        return True

    def calibrator(self, member: str, joints: Sequence[int]) -> None:
        """Calibrate, home, park, or abort doing so."""
        if not joints:
            word = next(word for word, name in grammar.QUITTING.items() if name == member)
            self.tell("set", "reca", word)
            return
        form = Form.ALL if [*joints] == [*range(self.axes)] else Form.ONE
        word = next(word for word, row in grammar.CALIBRATOR.items() if row == (member, form))
        for arguments in [[]] if form is Form.ALL else [[joint] for joint in joints]:
            self.send([Vocab("set"), Vocab("reca"), Vocab(word), *arguments], None)

    def variable(self, name: str) -> Any:
        """The value of a variable, as a list."""
        return self.send([Vocab("get"), Vocab("ivar"), Vocab("mvar"), name])[2]

    def store_variable(self, name: str, values: Sequence[Any]) -> None:
        """Set it."""
        self.send([Vocab("set"), Vocab("ivar"), Vocab("mvar"), name, *values])

    def variable_names(self) -> list[str]:
        """Return the names of the variables."""
        return [*map(str, self.tell("get", "ivar", "lvar")[2])]

    def tell(self, *words: Any) -> list[Any]:
        """Send words (as vocabs) and numbers; returns the reply."""
        return self.send([Vocab(word) if type(word) is str else word for word in words])

    def send(self, request: list[Any], timeout: float | None = TIMEOUT) -> list[Any]:
        """Send a request as it is; returns the reply."""
        reply = self._client.call(Bottle(request), timeout=timeout)
        found = reply if isinstance(reply, list) else [reply]
        if found and found[0] == "fail":
            asked = Bottle(request).to_text()
            raise LocalProtocolError(
                f'"{self.remote}" refuses {asked[:100]}: it cannot do this, or not with these '
                "values"
            )
        if not found or found[-1] != "ok":
            raise RemoteProtocolError(f'"{self.remote}" answers {Bottle(found).to_text()[:100]}')
        return found


def _prefix(interface: Interface) -> list[Vocab]:
    return [Vocab(interface.word)] if interface.word else []


def asks_of(remote: str, local: str, names: NameClient | None) -> Asks:
    """Connect to the board at `remote` and return what asks it: in the words of YARP 3, or,
    where nobody listens for those, in the functions of YARP 4. Raises UnknownName, LinkClosed."""
    try:
        return Requests(remote, f"{local}/rpc:o", names)
    except UnknownName as unknown:
        from yarpy.kits.devices.control_board.yarp4.requests import FunctionRequests

        try:
            return FunctionRequests(remote, f"{local}/nwc/rpc:o", names)
        except UnknownName:
            raise unknown from None
