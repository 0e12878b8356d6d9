"""Words: how programs of YARP 3 ask for the members that have some, instead of by Thrift.

    WORDS = "is"    [visd] [get] [fov]            [visd] [fov] [is] 57.0 43.0
                    [visd] [set] [fov] 60.0 45.0  [visd] [set] 1
                    [fgc] [has] [feat] 3          [fgc] [has] [feat] 1952540006 1
                    [fgc] [set] [feat] 3 0.5      [nak]
    WORDS = "ok"    [ijpc] [get] [butn] [val] 2   [ok] 0.5
    WORDS = "list"  [irob] [get] [all]            [ok] (eye frameGrabber arm controlBoard)

Rules: pure functions of lists. The second word is the verb: `get`, `set` or `has`. What fails is
`[fail]`, or `[visd] [set] 0`; C++ answers `ok` by nothing then. A struct is its fields, the first
`SPOKEN` if it says so; a list of structs is how many there are, then all fields (`list`: one list
of all fields; `ok`: the fields alone, and what is left of them is not read); a table of properties
is one list. Results that are not sent have their defaults.

Source: RGBDSensor_nws_yarp, JoypadControlServer and RobotDescriptionServer of YARP 3.9.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import Annotated, Any, Final, get_args, get_origin

from yarpy.data.bottle import Bottle, Property
from yarpy.data.sig.matrix import Matrix
from yarpy.data.value import Vocab, vocab_code
from yarpy.data.writer import dict_elements
from yarpy.errors import DecodeError
from yarpy.kits.devices.kind import word
from yarpy.kits.devices.network.model import Member
from yarpy.kits.thrift.structure import Struct

_IS: Final = Vocab("is")
_OK: Final = Vocab("ok")
FAIL: Final = Vocab("fail")
_NAK: Final = Vocab("nak")


def asked(members: Iterable[Member], request: Sequence[Any]) -> Member | None:
    """Return the member that a request is about; None if that is none."""
    said = tuple(word(each) for each in request[:4])
    found = [each for each in members if each.words and said[: len(each.words)] == each.words]
    return max(found, key=lambda each: len(each.words), default=None)


def fixed(told: Mapping[str, Sequence[int]], request: Sequence[Any]) -> Bottle | None:
    """Return the answer to a request that is about no member: `[rgdb] [get] [prot]`; None if
    `told`, the numbers by such words, has none."""
    words = [word(each) for each in request]
    numbers = told.get(" ".join(words))
    if numbers is None:
        return None
    return Bottle([Vocab(words[0]), *map(Vocab, words[2:]), _IS, *numbers])


def arguments(each: Member, request: Sequence[Any]) -> tuple[Any, ...]:
    """Return the arguments in a request for a member. DecodeError."""
    elements = _Elements(request[len(each.words) :])
    takes = [*each.signature.parameters.values()][1:]
    if not each.choice:
        return tuple(elements.take(one.annotation) for one in takes)
    chosen = word(elements.take(str))
    if chosen not in each.choice:
        raise DecodeError(f"expected one of {' '.join(each.choice)}, got {chosen[:40]!r}")
    first = (elements.take(one.annotation) for one in takes[:-1])
    return (*first, each.choice.index(chosen))


def question(each: Member, values: Sequence[Any]) -> Bottle:
    """Return the request for a member."""
    if each.choice:
        *values, chosen = values
        values = [Vocab(each.choice[chosen]), *values]
    return Bottle([*map(Vocab, each.words), *_flat(values)])


def answer(each: Member, form: str, results: Sequence[Any] | None) -> Bottle:
    """Return what is answered; `results` is None where it failed."""
    verb = each.words[1]
    head = [Vocab(one) for one in each.words]
    if form == "list":
        return Bottle([FAIL] if results is None else [_OK, *(Bottle(_flat(e)) for e in results)])
    if form == "ok":
        return Bottle([FAIL] if results is None else [_OK, *_flat(_uncounted(results))])
    if verb == "set":
        if head[0] == "fgc":
            return Bottle([FAIL if results is None else _NAK])
        return Bottle([*head[:2], int(results is not None)])
    if results is None:
        return Bottle([FAIL])
    if verb == "has":
        return Bottle([*head[:3], vocab_code(each.words[2].encode()), *_flat(results)])
    return Bottle([head[0], *head[2:], _IS, *_flat(results)])


def results(each: Member, form: str, found: Sequence[Any]) -> tuple[Any, ...] | None:
    """Return the results in an answer; None if it failed. DecodeError."""
    verb = each.words[1]
    first = word(found[0]) if found else ""
    if first == "fail" or (form == "ok" and first != "ok"):
        return None
    if form == "list":
        return tuple(_listed(one, found[at:]) for at, one in enumerate(each.results, 1))
    if form == "ok":
        begin = 1
    elif verb == "set":
        return None if first != "nak" and (len(found) < 3 or not found[2]) else ()
    else:
        begin = 4 if verb == "has" else len(each.words)
    elements = _Elements(found[begin:])
    if form == "ok" and get_origin(each.results[0]) is list:
        return (elements.rest(*get_args(each.results[0])),)
    return tuple(elements.take(annotation, True) for annotation in each.results)


def _uncounted(values: Iterable[Any]) -> Iterable[Any]:
    """The values, lists as their elements."""
    return (one for each in values for one in (each if isinstance(each, list) else [each]))


def _flat(values: Iterable[Any]) -> list[Any]:
    """Values as elements of a Bottle."""
    found: list[Any] = []
    for each in values:
        if isinstance(each, bool):
            found.append(int(each))
        elif isinstance(each, Struct):
            found += _flat(getattr(each, name) for name in _spoken(type(each)))
        elif isinstance(each, Matrix):
            found += Bottle.from_bytes(b"".join(each.to_wire()))
        elif isinstance(each, dict):
            found.append(Bottle(dict_elements(Property(each))))
        elif isinstance(each, list):
            found += [len(each), *_flat(each)]
        else:
            found.append(each)
    return found


def _spoken(struct: type[Struct]) -> tuple[str, ...]:
    """The fields that programs of YARP 3 know."""
    return struct._attributes[: getattr(struct, "SPOKEN", None)]


def _listed(annotation: Any, found: Sequence[Any]) -> list[Any]:
    """The structs whose fields are the first element, a list. DecodeError."""
    if not found or not isinstance(found[0], list):
        raise DecodeError(f"expected a list, got {[*found]!r:.40}")
    [kind] = get_args(annotation)
    elements = _Elements(found[0])
    return [elements.take(kind) for _ in range(0, len(found[0]), len(_spoken(kind)))]


class _Elements:
    """Elements of a Bottle, one after the other."""

    def __init__(self, elements: Sequence[Any]) -> None:
        self._elements = [*elements]

    def take(self, annotation: Any, may_miss: bool = False) -> Any:
        """Take the value of an annotation; may_miss: its default if nothing is left."""
        while get_origin(annotation) is Annotated:
            annotation = get_args(annotation)[0]
        if get_origin(annotation) is list:
            return [self.take(get_args(annotation)[0]) for _ in range(self._count())]
        if isinstance(annotation, type) and issubclass(annotation, Struct):
            if may_miss and not self._elements:
                return annotation()
            made = annotation()
            for name in _spoken(annotation):
                setattr(made, name, self._like(getattr(made, name)))
            return made
        if annotation is Matrix:
            rows, columns, values = (self._next() for _ in range(3))
            return Matrix.from_wire(Bottle([rows, columns, values]).to_bytes())
        if may_miss and not self._elements:
            return annotation()
        if annotation is Property:
            pairs = self._next()
            return Property.from_bytes(Bottle(pairs if isinstance(pairs, list) else []).to_bytes())
        return self._like(annotation())

    def rest(self, struct: Any) -> list[Any]:
        """Take as many structs as are left."""
        count = len(self._elements) // len(_spoken(struct))
        return [self.take(struct) for _ in range(count)]

    def _like(self, default: Any) -> Any:
        """Take a value of the kind of this one."""
        found = self._next()
        if isinstance(default, str):
            return str.__str__(found) if isinstance(found, str) else str(found)
        if isinstance(default, bool):
            return bool(found) and word(found) != "fail"
        if isinstance(found, str):
            if isinstance(default, int) and isinstance(found, Vocab):
                return found.code
            raise DecodeError(f"expected a number, got {found[:40]!r}")
        try:
            return type(default)(found)
        except (TypeError, ValueError, OverflowError):
            raise DecodeError(f"expected a number, got {found!r:.40}") from None

    def _count(self) -> int:
        count = self._like(0)
        if not 0 <= count <= len(self._elements):
            raise DecodeError(f"{count} are announced, {len(self._elements)} elements are there")
        return int(count)

    def _next(self) -> Any:
        if not self._elements:
            raise DecodeError("the request or answer is incomplete")
        return self._elements.pop(0)
