"""A method as a service of ROS: its type, and arguments and results as messages.

    "/add~example_interfaces/srv/AddTwoInts"   the type that the topic names; parameters have the
                                               names of its fields
    () -> None, () -> tuple[bool, str],        std_srvs: Empty, Trigger
    (data: bool) -> tuple[bool, str]           SetBool
    everything else                            a type made of the hints: a field for each parameter;
                                               `result`, or the fields of a dataclass

Rules: fields are numbers, texts, lists of them, and messages; what is none of these travels as a
string with JSON. Hints that do not fit the type are a TypeError that names the parameter.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping, Sequence
from hashlib import sha256
from typing import Any, Final, NamedTuple

from yarpy.data.sig.image import Image
from yarpy.data.value import Vocab
from yarpy.errors import DecodeError, RemoteError
from yarpy.kits.wrap.middleware import Binding, Failure, Item, Signature
from yarpy.kits.wrap.value.array import Picture
from yarpy.kits.wrap.value.shape import ANY, Nothing, Record, Row, Scalar, Several, Shape, Wired
from yarpy.kits.wrap.value.tree import from_text, to_text
from yarpy.peers.ros.message.convert.native import to_message, to_value
from yarpy.peers.ros.message.message import Message as RosMessage
from yarpy.peers.ros.message.model import ListOf, Primitive, Struct, Type

_PACKAGE: Final = "yarpy_wrap"
_SCALARS: Final = {str: "string", int: "int64", float: "float64", bool: "bool", bytes: "uint8[]"}
_MESSAGES: Final = {"Image": "sensor_msgs/Image", "PointCloud": "sensor_msgs/PointCloud2"}
_FAILURE: Final = re.compile(r"(?:[^:\n]*: )??([A-Z][A-Za-z0-9_]*): (.*)", re.DOTALL)


class HintSource:
    """A source of the services that were made of hints."""

    def __init__(self) -> None:
        self.texts: dict[str, str] = {}

    def find(self, name: str, kind: str) -> str | None:
        return self.texts.get(name) if kind == "srv" else None

    def __str__(self) -> str:
        return "the hints of methods"


class Types:
    """The types of a library, which is opened when it is needed, and those that hints make.

    field: what names of fields are like. sources: where the library looks for definitions.
    """

    def __init__(
        self, field: str, library: Callable[[], Any], sources: Callable[[Any], list[Any]]
    ) -> None:
        self.field = re.compile(field)
        self._library, self._sources = library, sources
        self._made: HintSource | None = None

    def message(self, name: str) -> Any:
        """The class of a message. Raises UnknownType."""
        return self._library().message(name)

    def service(self, name: str) -> Any:
        """A service. Raises UnknownType."""
        return self._library().service(name)

    def add(self, name: str, text: str) -> None:
        """Make a service known, by its text."""
        if self._made is None:
            self._made = HintSource()
            self._sources(self._library()).append(self._made)
        self._made.texts[name] = text


class Field(NamedTuple):
    """A field of a request or of an answer. `json`: a string that holds any other value."""

    name: str
    type: str
    shape: Shape
    json: bool = False


def topic_and_type(topic: str) -> tuple[str, str]:
    """The topic, and the type behind a tilde; "" for none."""
    name, _, type_ = topic.partition("~")
    return name, type_.replace("/srv/", "/")


class Service:
    """A method's service over `types`. `kind` is its type."""

    def __init__(self, binding: Binding, types: Types) -> None:
        assert binding.signature is not None
        self.signature = binding.signature
        self._types = types
        self.topic, named = topic_and_type(binding.topic)
        if self.signature.variable:
            raise self._wrong(self.signature.variable, "a service has a fixed number of fields")
        named = named or _standard(self.signature)
        if not named:
            self._asked = [_field(one.name, one.shape) for one in self.signature.parameters]
            self._told = _told(self.signature.result)
            self._check_names()
            named = self._make()
        self.kind = types.service(named)
        if not named.startswith(_PACKAGE):
            self._fit(named)

    def _wrong(self, parameter: str, why: str) -> TypeError:
        return TypeError(f'{self.signature.name}: the parameter "{parameter}": {why}')

    # -- types ------------------------------------------------------------------------------------

    def _check_names(self) -> None:
        for field in (*self._asked, *self._told):
            if not self._types.field.fullmatch(field.name):
                raise self._wrong(
                    field.name, f"no name of a field: {self._types.field.pattern} is needed"
                )

    def _make(self) -> str:
        """The name of a type of these fields."""
        halves = ["".join(f"{one.type} {one.name}\n" for one in half) for half in self._halves]
        text = "---\n".join(halves)
        words = re.split(r"[^A-Za-z0-9]+", self.signature.name)
        name = "".join(word[:1].upper() + word[1:] for word in words)
        name = f"{_PACKAGE}/{name[:80]}{sha256(text.encode()).hexdigest()[:8].upper()}"
        self._types.add(name, text)
        return name

    @property
    def _halves(self) -> tuple[list[Field], list[Field]]:
        return self._asked, self._told

    def _fit(self, named: str) -> None:
        """The fields of a type that is there already. Raises TypeError if hints say otherwise."""
        shapes = {one.name: one.shape for one in self.signature.parameters}
        request, response = (
            {field.name: field.type for field in half._definition.struct.fields}
            for half in (self.kind.Request, self.kind.Response)
        )
        for name in (*shapes, *request):
            if name not in request:
                raise self._wrong(name, f"{named} has {_listed(request)}")
            if name not in shapes:
                raise TypeError(
                    f'{self.signature.name} has no parameter "{name}", and {named} has that field'
                )
        self._asked = [Field(name, str(type_), shapes[name]) for name, type_ in request.items()]
        for field in self._asked:
            if not _fits(field.shape, request[field.name]):
                raise self._wrong(
                    field.name, f"{field.type} in {named}, and its hint says {field.shape.name}"
                )
        self._told = [
            Field(name, str(response[name]), shape)
            for name, shape in self._results(named, list(response)).items()
        ]
        for field in self._told:
            if not _fits(field.shape, response[field.name]):
                raise TypeError(
                    f"{self.signature.name}: {field.name} of {named} is {field.type}, and what it "
                    f"returns is {field.shape.name}"
                )

    def _results(self, named: str, names: Sequence[str]) -> dict[str, Shape]:
        """The shape for each field of an answer."""
        result = self.signature.result
        if isinstance(result, Record) and [*result.fields] == [*names]:
            return dict(result.fields)
        if isinstance(result, Row) and len(result.items) == len(names):
            return dict(zip(names, result.items, strict=True))
        if type(result) is Shape:
            return dict.fromkeys(names, ANY)
        if len(names) == 1:
            return {names[0]: result}
        if not names and isinstance(result, Nothing):
            return {}
        raise TypeError(
            f"{self.signature.name} returns {result.name}, and {named} answers with "
            f"{_listed(names)}: a tuple, or a dataclass with these fields"
        )

    # -- values -----------------------------------------------------------------------------------

    def request(self, args: Sequence[Any], kwargs: Mapping[str, Any]) -> Any:
        """The question of a call with these arguments, which are plain values."""
        given = dict(kwargs)
        for one, value in zip(self.signature.positional, args, strict=False):
            given[one.name] = value
        for one in self.signature.parameters:
            if one.name not in given:
                given[one.name] = one.shape.dump(one.default)
        return self._filled(self.kind.Request, self._asked, given)

    def arguments(self, request: Any) -> tuple[list[Any], dict[str, Any]]:
        """The arguments that a question has. Raises DecodeError."""
        found = self._read(self._asked, request)
        args = [found.pop(one.name) for one in self.signature.positional]
        return args, found

    def response(self, item: Item) -> Any:
        """The answer that has what the method returned."""
        plain = item.plain
        if isinstance(plain, dict) and isinstance(self.signature.result, Record):
            values = dict(plain)
        elif len(self._told) == 1 and not isinstance(self.signature.result, Row):
            values = {self._told[0].name: plain}
        elif isinstance(plain, (tuple, list)) and len(plain) == len(self._told):
            values = dict(zip((one.name for one in self._told), plain, strict=True))
        elif not self._told:
            values = {}
        else:
            raise TypeError(
                f"{self.signature.name} returns {type(plain).__name__}, and {self.kind.name} "
                f"answers with {_listed([one.name for one in self._told])}"
            )
        return self._filled(self.kind.Response, self._told, values)

    def value(self, response: Any) -> Any:
        """Return the result of the method. Raises DecodeError."""
        found = self._read(self._told, response)
        result = self.signature.result
        if isinstance(result, Record):
            return result.load(found)
        values = [*found.values()]
        if isinstance(result, Row) or (type(result) is Shape and len(values) > 1):
            return result.load(tuple(values))
        return result.load(values[0] if values else None)

    def _filled(self, half: Any, fields: Sequence[Field], values: Mapping[str, Any]) -> Any:
        return half(**{field.name: self._spelled(field, values[field.name]) for field in fields})

    def _spelled(self, field: Field, plain: Any) -> Any:
        if field.json:
            return to_text(plain)
        if field.type == "uint8[]" and isinstance(plain, (bytes, bytearray, memoryview)):
            import numpy as np

            return np.frombuffer(plain, "u1")
        if "/" in field.type and not field.type.endswith("]") and not isinstance(plain, RosMessage):
            return to_message(plain, self._types.message(field.type))
        return list(plain) if isinstance(plain, tuple) else plain

    def _read(self, fields: Sequence[Field], half: Any) -> dict[str, Any]:
        return {field.name: _plain(field, getattr(half, field.name)) for field in fields}


def _plain(field: Field, value: Any) -> Any:
    """A field's value as plain Python. Raises DecodeError."""
    shape = field.shape
    if field.json:
        return from_text(value)
    if isinstance(value, RosMessage):
        if isinstance(shape, Wired) and not issubclass(shape.kind, RosMessage):
            return to_value(value, shape.kind)
        return to_value(value, Image) if isinstance(shape, Picture) else value
    if isinstance(shape, Scalar) and shape.kind is bytes:
        return bytes(value)
    return value.tolist() if hasattr(value, "tolist") and isinstance(shape, Several) else value


def _standard(signature: Signature) -> str:
    """The type of std_srvs that a method has; "" for none."""
    asked = [(one.name, one.shape) for one in signature.parameters]
    result = signature.result
    if not asked and isinstance(result, Nothing):
        return "std_srvs/Empty"
    said = isinstance(result, Row) and [getattr(one, "kind", None) for one in result.items] == [
        bool,
        str,
    ]
    if not said or len(asked) > 1:
        return ""
    if not asked:
        return "std_srvs/Trigger"
    name, shape = asked[0]
    return "std_srvs/SetBool" if name == "data" and _kind(shape) is bool else ""


def _kind(shape: Shape) -> Any:
    return shape.kind if isinstance(shape, Scalar) else None


def _field(name: str, shape: Shape) -> Field:
    """The field of a type that is made."""
    if isinstance(shape, Scalar):
        return Field(name, _SCALARS[shape.kind], shape)
    if isinstance(shape, Several) and shape.kind in (list, tuple):
        item = _SCALARS.get(_kind(shape.item), "")
        if item and not item.endswith("]"):
            return Field(name, f"{item}[]", shape)
    if isinstance(shape, Picture):
        compressed = shape.image.jpeg is not None
        return Field(name, f"sensor_msgs/{'CompressedImage' if compressed else 'Image'}", shape)
    if isinstance(shape, Wired):
        if issubclass(shape.kind, RosMessage):
            return Field(name, shape.kind._type, shape)
        if shape.kind.__name__ in _MESSAGES:
            return Field(name, _MESSAGES[shape.kind.__name__], shape)
    return Field(name, "string", shape, json=True)


def _told(result: Shape) -> list[Field]:
    """The fields of an answer."""
    if isinstance(result, Nothing):
        return []
    if isinstance(result, Record) and result.needed == result.fields.keys():
        return [_field(name, shape) for name, shape in result.fields.items()]
    if isinstance(result, Row):
        return [_field(f"result{number}", one) for number, one in enumerate(result.items)]
    return [_field("result", result)]


def _fits(shape: Shape, type_: Type) -> bool:
    """Return whether values of a hint fit into a field."""
    if type(shape) is Shape:
        return True
    if isinstance(type_, ListOf):
        if isinstance(shape, Several):
            return shape.kind in (list, tuple) and _fits(shape.item, type_.element)
        return str(type_).startswith("uint8[") and _kind(shape) is bytes
    if isinstance(type_, Struct):
        name = _field("", shape).type
        return name == type_.name
    assert isinstance(type_, Primitive)
    wanted = {"string": str, "bool": bool, "float32": float, "float64": float}.get(type_.name)
    if wanted is None and type_.is_number:
        wanted = int
    return wanted is not None and _kind(shape) is wanted


def _listed(names: Any) -> str:
    return ", ".join(names) or "no fields"


# ------------------------------------------------------------------------------------ failures


def failed(failure: Failure) -> list[Any]:
    """The answer of a service whose method raised an exception."""
    return [Vocab("fail"), f"{failure.type}: {failure.text}"]


def error_of(text: str) -> RemoteError:
    """Return the error for a text with which a server reports a failure."""
    match = _FAILURE.fullmatch(text)
    return RemoteError(match[2], match[1]) if match else RemoteError(text)


def handled(service: Service, request: Any, answer: Any) -> Any:
    """Call `answer` with the arguments of a request; return the response of the server."""
    try:
        found = answer(*service.arguments(request))
        if isinstance(found, Failure):
            return failed(found)
        return service.response(found)
    except (DecodeError, TypeError, ValueError, LookupError) as error:
        return failed(Failure.of(error))
