"""Structs and enums of Thrift as Python classes.

    class Point(thrift.Struct):             class Mode(thrift.Enum):
        x: thrift.i32 = 3                       FREE = 0
        tags: list[str] = thrift.new(list)      HELD = 7

Rules: the fields are the annotations, in their order; what has no default begins as 0, "" or empty.
`thrift.new(make)` makes a default anew for each object. A struct is a message: `port.write(point)`,
`message.as_(Point)`. Values are checked when they are sent. Annotations are looked at when a class
is first used, so they may name classes that come later.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from enum import IntEnum
from functools import partial
from inspect import get_annotations
from typing import Any, ClassVar, Final, Self, dataclass_transform, get_origin

from yarpy.data.bottle import Bottle
from yarpy.data.generated import Code
from yarpy.data.value import Blocks, Buffer, Vocab
from yarpy.errors import DecodeError
from yarpy.kits.thrift.editor import Editor, editor_of
from yarpy.kits.thrift.key import fingerprint
from yarpy.kits.thrift.kind import (
    BINARY,
    BOOL,
    I32,
    TEXT,
    VOCAB,
    External,
    Kind,
    ListOf,
    MapOf,
    Part,
    Scalar,
    SetOf,
    flat,
    is_enum,
    kind_of,
    namespace_of,
    without_none,
)
from yarpy.kits.thrift.wire import fast_reader, fast_writer, reader
from yarpy.kits.thrift.wire.cursor import pair, spread
from yarpy.kits.thrift.word import ERROR, STRUCT, original
from yarpy.limit import THRIFT_VALUES

#: elements of an array that `repr` still shows
_SHOWN: Final = 16


class _New:
    """The default of a field that is made anew for each object."""

    def __init__(self, make: Callable[[], Any]) -> None:
        self.make = make


def new(make: Callable[[], Any]) -> Any:
    """A default that each object gets its own of: `tags: list[str] = thrift.new(list)`."""
    return _New(make)


@dataclass(frozen=True, slots=True)
class Spec:
    """A field: its name in Thrift and in Python, and what it is.

    default: makes its first value, `first` one of its kind, which stands on YARP's wire for None;
    that an `optional` one may be. `number` and `required` count for Apache's protocols alone.
    """

    name: str
    attribute: str
    kind: Kind
    nested: bool
    default: Callable[[], Any]
    number: int = 0
    optional: bool = False
    required: bool = False

    def first(self) -> Any:
        """Return the value of its kind that is empty, 0 or False."""
        return default_of(self.kind)()


class _EditorOf:
    """`Settings.Editor`: the editor of each class, made when it is first asked for."""

    def __get__(self, struct: object, owner: type[Struct]) -> type[Editor]:
        return editor_of(owner)


@dataclass_transform(eq_default=True)
class Struct:
    """The base of all structs."""

    _thrift: ClassVar[str] = "struct"
    _attributes: ClassVar[tuple[str, ...]] = ()
    _defaults: ClassVar[dict[str, Any]] = {}
    _namespace: ClassVar[Mapping[str, Any] | None] = None
    _sort: ClassVar[str] = "struct"  # or union, or exception
    #: the numbers of the fields, where they are not 1, 2, 3 ...
    _numbers: ClassVar[tuple[int, ...]] = ()
    #: the fields that Apache's protocols have to bring
    _required: ClassVar[tuple[str, ...]] = ()
    #: the names in Thrift of those whose name in Python does not tell it
    _names: ClassVar[Mapping[str, str]] = {}
    #: lets others set the fields of an object
    Editor: ClassVar[_EditorOf] = _EditorOf()

    def __init_subclass__(cls, **kwargs: Any) -> None:
        super().__init_subclass__(**kwargs)
        annotations = get_annotations(cls)
        own = [
            name
            for name, annotation in annotations.items()
            if not name.startswith("_") and not _is_class_var(annotation)
        ]
        cls._attributes = (*cls._attributes, *(name for name in own if name not in cls._attributes))
        cls._defaults = {**cls._defaults, **{n: vars(cls)[n] for n in own if n in vars(cls)}}
        setattr(cls, "__match_args__", cls._attributes)  # noqa: B010
        cls.__init__ = _initialiser(cls)  # type: ignore[method-assign]

    # -- what it is on the wire -------------------------------------------------------------------

    @classmethod
    def _specs(cls) -> tuple[Spec, ...]:
        """The fields."""
        found: tuple[Spec, ...] | None = cls.__dict__.get("_specs_")
        if found is None:
            found = cls._specs_ = tuple(_specs(cls))  # type: ignore[attr-defined]
        return found

    @classmethod
    def _flat(cls) -> int:
        """Return how many elements of a Bottle it takes."""
        found: int | None = cls.__dict__.get("_flat_")
        if found is None:
            if cls.__dict__.get("_counting_"):
                why = "contains itself, which YARP's wire cannot say: put it into a list"
                raise TypeError(f"{cls.__name__} {why}")
            cls._counting_ = True  # type: ignore[attr-defined]
            found = sum(1 if spec.nested else flat(spec.kind) for spec in cls._specs())
            cls._counting_ = False  # type: ignore[attr-defined]
            if found > THRIFT_VALUES:
                raise TypeError(f"{cls.__name__} has {found} values, more than {THRIFT_VALUES}")
            cls._flat_ = found  # type: ignore[attr-defined]
        return found

    def _dump(self) -> bytes:
        cls = type(self)
        found = cls.__dict__.get("_dumps_")
        if found is None:
            found = cls._dumps_ = fast_writer.dump_struct(cls)  # type: ignore[attr-defined]
        data: bytes = found(self)
        return data

    @classmethod
    def _load(cls, data: Buffer, at: int, size: int) -> tuple[Self, int]:
        found = cls.__dict__.get("_loads_")
        if found is None:
            found = cls._loads_ = fast_reader.load_struct(cls)  # type: ignore[attr-defined]
        result: tuple[Self, int] = found(data, at, size)
        return result

    def to_wire(self) -> Blocks:
        """The message, as C++ YARP writes it. TypeError or OverflowError names the field that does
        not fit."""
        return (self._dump(),)

    @classmethod
    def from_wire(cls, view: Buffer) -> Self:
        """The struct in a message. Arrays look at the bytes, without a copy. DecodeError names the
        field that is another."""
        loads = cls.__dict__.get("_whole_")
        if loads is None:
            parts = [Part("", cls)]
            loads = cls._whole_ = fast_reader.load(cls.__name__, parts)  # type: ignore[attr-defined]
        count = pair(view, 0)[1]
        if count != cls._flat():
            names = " ".join(cls._attributes)
            raise DecodeError(
                f"{cls.__name__} has {cls._flat()} elements ({names}), here are {count}"
            )
        found: Self = loads(spread(view), 8)[0]
        return found

    def to_bottle(self) -> Bottle:
        """The fields as the elements of a list, those of structs within in place."""
        part = Part("", type(self), nested=True)
        return Bottle.from_bytes(
            fast_writer.slow_dump(type(self).__name__, [part], [self], bottle=True)
        )

    @classmethod
    def from_bottle(cls, items: Any) -> Self:
        """The struct of a list as `to_bottle` makes it. DecodeError names the field."""
        return cls.from_wire(Bottle(items).to_bytes())

    def to_text(self) -> str:
        """The same in YARP's notation, as C++ prints it."""
        return self.to_bottle().to_text()

    # -- what it is in Python ---------------------------------------------------------------------

    def to_dict(self) -> dict[str, Any]:
        """The fields by their names in Thrift, structs within as dicts. Arrays stay arrays."""
        return {self._original(name): _plain(getattr(self, name)) for name in self._attributes}

    @classmethod
    def _original(cls, name: str) -> str:
        """The name in Thrift of a field."""
        taken = ERROR if cls._sort == "exception" else STRUCT
        return cls._names.get(name) or original(name, taken)

    def __eq__(self, other: object) -> bool:
        if type(other) is not type(self):
            return NotImplemented
        return all(same(getattr(self, name), getattr(other, name)) for name in self._attributes)

    def __hash__(self) -> int:
        """For structs that are keys, which must not be changed while they are some."""
        return fingerprint([getattr(self, name) for name in self._attributes])

    def __repr__(self) -> str:
        fields = (f"{name}={_shown(getattr(self, name))}" for name in self._attributes)
        return f"{type(self).__name__}({', '.join(fields)})"


class Enum(IntEnum):
    """The base of all enums: `class Mode(thrift.Enum, base=thrift.i8)`. A number that no constant
    has comes as an int."""

    _thrift: ClassVar[str]
    _base: ClassVar[Scalar]

    def __init_subclass__(cls, base: Any = None, **kwargs: Any) -> None:
        super().__init_subclass__(**kwargs)
        kind = I32 if base is None else kind_of(base, {})[0]
        assert isinstance(kind, Scalar)
        cls._base = kind

    @property
    def word(self) -> Vocab:
        """The value as a vocab, for enums that are some."""
        return Vocab.from_code(self.value)


# Members of an enum, if they were in its body.
Enum._thrift = "enum"
Enum._base = I32


def default_of(kind: Kind) -> Callable[[], Any]:
    """Return a function that makes the first value of a field."""
    if isinstance(kind, type) and not is_enum(kind):
        return kind
    if is_enum(kind):
        members = list(kind)  # type: ignore[call-overload]
        return lambda: members[0] if members else 0
    if isinstance(kind, (ListOf, SetOf)):
        return set if isinstance(kind, SetOf) else array_maker(kind, list)
    if isinstance(kind, MapOf):
        return dict
    if isinstance(kind, External):
        cls = reader.class_of(kind)
        return Bottle if cls is object else cls
    assert isinstance(kind, Scalar)
    if kind is VOCAB:
        return Vocab
    value: Any = {BOOL: False, TEXT: "", BINARY: b""}.get(kind, 0.0 if kind.letter in "fd" else 0)
    return lambda: value


def array_maker(kind: Kind, make: Callable[[], Any]) -> Callable[[], Any]:
    """Return a function that makes an array where `make` makes a list of numbers."""
    element = kind.element if isinstance(kind, ListOf) else None
    if not isinstance(element, Scalar) or not (element.is_number or element is BOOL):
        return make
    letter = "?" if element is BOOL else "<" + element.letter

    def made() -> Any:
        import numpy as np

        return np.array(make(), letter)

    return made


def _is_class_var(annotation: Any) -> bool:
    if isinstance(annotation, str):
        return annotation.startswith(("ClassVar", "typing.ClassVar"))
    return annotation is ClassVar or get_origin(annotation) is ClassVar


def _specs(cls: type[Struct]) -> list[Spec]:
    found = []
    annotations: dict[str, tuple[Any, Mapping[str, Any]]] = {}
    for base in reversed(cls.__mro__):
        for name, annotation in get_annotations(base).items():
            annotations[name] = annotation, namespace_of(base)
    numbers = cls._numbers
    for at, name in enumerate(cls._attributes):
        annotation, optional = without_none(*annotations[name])
        kind, nested = kind_of(annotation, annotations[name][1])
        given = cls._defaults.get(name, _NOTHING)
        if given is _NOTHING:
            default = partial(_given, None) if optional else default_of(kind)
        elif isinstance(given, _New):
            default = array_maker(kind, given.make)
        else:
            default = partial(_given, given)
        number = numbers[at] if at < len(numbers) else at + 1
        required = name in cls._required
        thrift = cls._original(name)
        found.append(Spec(thrift, name, kind, nested, default, number, optional, required))
    return found


def _given(value: Any) -> Any:
    return value


_NOTHING: Final = object()


def _initialiser(cls: type[Struct]) -> Callable[..., None]:
    code = Code()
    arguments = ["self"]
    code.globals.update(_nothing=_NOTHING, _cls=cls, _begin=_begin)
    for at, name in enumerate(cls._attributes):
        given = cls._defaults.get(name, _NOTHING)
        if given is _NOTHING or isinstance(given, _New):
            arguments.append(f"{name}=_nothing")
            code.line(f"self.{name} = _begin(_cls, {at}) if {name} is _nothing else {name}")
        else:
            arguments.append(f"{name}={code.name(given)}")
            code.line(f"self.{name} = {name}")
    return code.compiled("__init__", ", ".join(arguments))


def _begin(cls: type[Struct], at: int) -> Any:
    return cls._specs()[at].default()


def _plain(value: Any) -> Any:
    if isinstance(value, Struct):
        return value.to_dict()
    if isinstance(value, dict):
        return {key: _plain(item) for key, item in value.items()}
    if isinstance(value, (list, tuple)) and type(value) in (list, tuple):
        return [_plain(item) for item in value]
    return value


def same(mine: Any, other: Any) -> bool:
    """Return whether two values are equal, arrays element by element."""
    if hasattr(mine, "__array_interface__") or hasattr(other, "__array_interface__"):
        import numpy as np

        return np.array_equal(mine, other)
    if isinstance(mine, (list, tuple)) and isinstance(other, (list, tuple)):
        return len(mine) == len(other) and all(map(same, mine, other))
    if isinstance(mine, dict) and isinstance(other, dict):
        return mine.keys() == other.keys() and all(same(mine[key], other[key]) for key in mine)
    return bool(mine == other)


def _shown(value: Any) -> str:
    if hasattr(value, "__array_interface__") and hasattr(value, "tolist"):
        return f"<{value.size} {value.dtype}>" if value.size > _SHOWN else repr(value.tolist())
    if type(value) is list:
        return f"[{', '.join(map(_shown, value))}]"
    if type(value) is dict:
        return f"{{{', '.join(f'{key!r}: {_shown(item)}' for key, item in value.items())}}}"
    return repr(value)
