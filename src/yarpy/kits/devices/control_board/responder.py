"""The server side of a control board's RPC port: carries out requests of `grammar` on a device.

    get encs          [is] encs (0.0 3.5) [tsta] 5 1795217570.38 [ok]
    set pos 1 45      [ok]
    get bogus         [fail]
    help              [nak]         (everything has at least two words)

Rules: one reply for every request, even a nonsensical one, which never touches the device. Element
1 decides first, so `[set] [icmd] ...` and `[set] [vel] ...` never collide. The count in [tsta]
includes failed requests. Extra elements are ignored, as in C++.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from itertools import count
from reprlib import repr as shown
from typing import Any, Final

from yarpy import clock
from yarpy.data.bottle import Bottle
from yarpy.data.value import Vocab
from yarpy.kits.devices.access import Access
from yarpy.kits.devices.control_board import grammar
from yarpy.kits.devices.control_board.board import TARGETS, Board
from yarpy.kits.devices.control_board.grammar import INTERFACES, PID, PLAIN, Form, Interface, Row
from yarpy.kits.devices.kind import FLAG, NOTHING, items, number, whole, word
from yarpy.kits.devices.refusal import Refused
from yarpy.log import logger

log = logger("yarpy.devices")

OK: Final = Vocab("ok")
IS: Final = Vocab("is")
FAIL: Final = Vocab("fail")
NAK: Final = Vocab("nak")
MANY: Final = Vocab("many")

# Modes that the old form of [set] [icmd] may name.
_LEGACY_MODES: Final = frozenset(("pos", "posd", "vel", "torq", "ipwm", "icur", "mix", "fidl"))

_GET: Final = {i.word: grammar.lookup(i.get) for i in (*INTERFACES.values(), PID)}
_SET: Final = {i.word: grammar.lookup(i.set) for i in (*INTERFACES.values(), PID)}

Request = Sequence[Any]


class Responder:
    """Answers requests to one board. Any thread may call `answer`."""

    def __init__(self, board: Board) -> None:
        self._board = board
        self._count = count()
        # Element 1 -> handler; anything not listed is an item without an interface.
        self._special: dict[str, Callable[[str, Request], list[Any]]] = {
            "prot": self._version,
            "icmd": self._control_mode,
            "ivar": self._variables,
            "reca": self._calibrator,
            "pid": self._pid,
        }
        self._calls: dict[str, Callable[[Request], None]] = {
            "calj": lambda request: self._calibrate_joint(request, 3),
            "cljp": lambda request: self._calibrate_joint(request, 4),
            "cald": self._calibration_done,
            "cal": lambda request: board.apply("calibrate", self._all, None),
            "park": self._park,
        }

    def answer(self, request: Request) -> Bottle:
        """The reply to a request; `[fail]` for what cannot be done."""
        if len(request) < 2:
            return Bottle([NAK])
        try:
            return Bottle([*self._reply(word(request[0]), word(request[1]), request), OK])
        except Refused as refusal:
            log.info("%s: %s: %s", self._board.name, shown([*request]), refusal)
            return Bottle([FAIL])
        except Exception:
            log.exception("%s: %s", self._board.name, shown([*request]))
            return Bottle([FAIL])

    def _reply(self, verb: str, what: str, request: Request) -> list[Any]:
        special = self._special.get(what)
        if special is not None:
            return special(verb, request)
        interface = INTERFACES.get(what)
        if interface is not None and interface is not PLAIN:
            return self._interface(interface, verb, request)
        if verb == "get":
            return self._stamped(lambda: self._plain(what, request))
        if verb == "set":
            self._change(self._board, _SET[""], what, request[2:])
            return []
        if verb == "help":
            return _usage(details=request[1] == "more")
        call = self._calls.get(verb)
        if call is None:
            raise Refused(f"{verb!r} is neither get nor set")
        call(request)
        return []

    # -- rows of the table --------------------------------------------------------------------

    def _plain(self, what: str, request: Request) -> list[Any]:
        lead = [IS, request[1]]
        if what == "axes":
            return [*lead, self._board.count]
        if what in ("mnum", "mtnm"):
            return [*lead, self._motors(what)]
        form, row = _row(_GET[""], what)
        return [*lead, *self._values(self._board, form, row, request[2:])]

    def _motors(self, what: str) -> int:
        """The number of motors: one for each joint, if the device has motors at all."""
        members = {
            "mnum": ("motor_encoders", "motor_speeds", "counts_per_revolution"),
            "mtnm": ("motor_temperatures", "temperature_limits", "gearbox_ratios"),
        }
        if not self._board.offers(members[what]):
            raise Refused("the device has no data about its motors")
        return self._board.count

    def _interface(self, interface: Interface, verb: str, request: Request) -> list[Any]:
        board, name = self._board, interface.word
        if not board.offers(_members(interface)):
            raise Refused(f"the device has no members of {name}")
        what, rest = _word_at(request, 2), request[3:]
        if verb == "set":
            self._change(board, _SET[name], what, rest)
            return []
        if verb != "get":
            raise Refused(f"{verb!r} is neither get nor set")

        def reply() -> list[Any]:
            form, row = _row(_GET[name], what)
            values = self._values(board, form, row, rest)
            if interface is grammar.FAULTS:
                return [IS, *values]
            return [IS, request[1], *values] if interface.echo else values

        return self._stamped(reply) if interface.stamped else reply()

    def _values(self, part: Access, form: Form, row: Row, rest: Request) -> list[Any]:
        kind = row.kind
        values = part.values(row.member, kind)
        if form is Form.ALL:
            return kind.write_all(values)
        if form is Form.ONE:
            return kind.write(values[_joint(rest, part.count)])
        joints = _joints(rest, part.count)
        return kind.write_all([values[joint] for joint in joints])

    def _change(
        self, part: Access, rows: dict[str, tuple[Form, Row]], what: str, rest: Request
    ) -> None:
        form, row = _row(rows, what)
        kind, joints, values = row.kind, self._all, None
        if form is Form.ONE:
            joints = [_joint(rest, part.count)]
            if len(rest) < 1 + kind.count:
                raise Refused(f"expected {kind.count} values")
            values = [kind.read(rest[1 : 1 + kind.count])]
        elif form is Form.ALL:
            if kind.count == 0:
                values = [kind.read(())] * part.count
            else:
                values = kind.read_all(_at(rest, 0), part.count)
        else:
            joints = _joints(rest, part.count)
            if kind.count:
                values = kind.read_all(_at(rest, 2), len(joints))
        part.apply(row.member, joints, None if kind is NOTHING else values)

    @property
    def _all(self) -> list[int]:
        return [*range(self._board.count)]

    def _stamped(self, reply: Callable[[], list[Any]]) -> list[Any]:
        number = next(self._count) & 0x7FFFFFFF  # counted even if the request fails
        return [*reply(), Vocab("tsta"), number, clock.now()]

    # -- interfaces with their own form -------------------------------------------------------

    def _version(self, verb: str, request: Request) -> list[Any]:
        if verb != "get":
            raise Refused("the version can only be read")
        return [Vocab("prot"), *grammar.VERSION]

    def _control_mode(self, verb: str, request: Request) -> list[Any]:
        """Like other interfaces, except that replies contain the joint or the item where others
        repeat the request."""
        board, interface = self._board, grammar.CONTROL_MODE
        if not board.offers(interface.members):
            raise Refused("the device has no control modes")
        what, rest = _word_at(request, 2), request[3:]
        if verb == "set" and what not in _SET["icmd"]:
            mode = _word_at(rest, 1)
            if mode not in _LEGACY_MODES:
                raise Refused(f"{mode!r} is not a control mode")
            board.apply("switch_control_modes", [_joint(rest, board.count)], [mode])
            return []
        if verb == "set":
            self._change(board, _SET["icmd"], what, rest)
            return []
        if verb != "get":
            raise Refused(f"{verb!r} is neither get nor set")

        def reply() -> list[Any]:
            if what not in _GET["icmd"]:
                return []  # C++ accepts this
            form, row = _GET["icmd"][what]
            values = self._values(board, form, row, rest)
            return [IS, _joint(rest, board.count) if form is Form.ONE else Vocab(what), *values]

        return self._stamped(reply)

    def _pid(self, verb: str, request: Request) -> list[Any]:
        if verb not in ("get", "set"):
            raise Refused(f"{verb!r} is neither get nor set")
        what, rest = _word_at(request, 2), request[4:]
        part = self._board.pid(_word_at(request, 3))
        if verb == "set":
            self._change(part, _SET["pid"], what, rest)
            return []
        form, row = _row(_GET["pid"], what)
        return [IS, request[1], *self._values(part, form, row, rest)]

    def _variables(self, verb: str, request: Request) -> list[Any]:
        what, board = _word_at(request, 2), self._board
        if not board.has("variables"):
            raise Refused("the device has no variables")
        if (verb, what) == ("get", "lvar"):
            return [IS, request[1], board.use("variables", lambda found: Bottle(map(str, found)))]
        key = _at(request, 3)
        if what != "mvar" or verb not in ("get", "set") or not isinstance(key, str):
            raise Refused("variables are listed by [get] [ivar] [lvar], others need [mvar] name")
        name = str.__str__(key)

        def known(found: Any) -> Any:
            if name not in found:
                raise Refused(f"no variable is called {shown(name)}")
            return found

        def fetch(found: Any) -> Bottle:
            value = known(found)[name]
            return Bottle(value if isinstance(value, (list, tuple)) else [value])

        if verb == "set":
            values = [*request[4:]]
            board.use("variables", lambda found: known(found).__setitem__(name, values))
            return []
        return [IS, request[1], board.use("variables", fetch)]

    def _calibrator(self, verb: str, request: Request) -> list[Any]:
        what, board = _word_at(request, 2), self._board
        if not board.offers(("calibrate", "home", "park")):
            raise Refused("the device has no calibrator")
        if (verb, what) == ("get", "isca"):
            return [IS, request[1], *FLAG.write(board.has("calibrate"))]
        if verb == "set" and what in grammar.QUITTING:
            board.ask(grammar.QUITTING[what])
            return []
        if verb != "set" or what not in grammar.CALIBRATOR:
            raise Refused(f"{what!r} is not a calibrator command")
        member, form = grammar.CALIBRATOR[what]
        joints = self._all if form is Form.ALL else [_joint(request[3:], board.count)]
        board.apply(member, joints, None)
        return []

    # -- calibration without an interface -----------------------------------------------------

    def _calibrate_joint(self, request: Request, parameters: int) -> None:
        joint = _joint(request[1:], self._board.count)
        values = [number(_at(request, 3 + index)) for index in range(parameters)]
        self._board.ask("calibrate_joint", joint, whole(_at(request, 2)), values)

    def _calibration_done(self, request: Request) -> None:
        joint = _joint(request[1:], self._board.count)
        if not self._board.ask("calibration_done", joint):
            raise Refused(f"joint {joint} is not calibrated yet")

    def _park(self, request: Request) -> None:
        if not self._board.has("park"):
            raise Refused("the device has no park")
        try:
            self._board.apply("park", self._all, None)
        except Refused:
            pass  # C++ clients wait forever for [ok], so that is always the answer


def _members(interface: Interface) -> set[str]:
    """A device has an interface if it has any of these: its members, or commands that set them."""
    return {*interface.members, *(TARGETS[name] for name in interface.members if name in TARGETS)}


def _usage(details: bool) -> list[Any]:
    lines: list[Any] = [MANY]
    for request, comment in grammar.usage():
        if details:
            lines += (Bottle.from_text(request), f"   {comment}")
        else:
            lines.append(request)
    return lines


def _row(rows: dict[str, tuple[Form, Row]], what: str) -> tuple[Form, Row]:
    found = rows.get(what)
    if found is None:
        raise Refused(f"{what!r} is not an item")
    return found


def _at(elements: Request, index: int) -> Any:
    if index >= len(elements):
        raise Refused("the request is incomplete")
    return elements[index]


def _word_at(request: Request, index: int) -> str:
    return word(request[index]) if index < len(request) else ""


def _joint(rest: Request, count: int) -> int:
    joint = whole(_at(rest, 0))
    if not 0 <= joint < count:
        raise Refused(f"no joint {joint} (there are 0 to {count - 1})")
    return joint


def _joints(rest: Request, count: int) -> list[int]:
    """The joints of the form `count (joints)`."""
    listed = items(_at(rest, 1), whole(_at(rest, 0)))
    return [_joint([joint], count) for joint in listed]
