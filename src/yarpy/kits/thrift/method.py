"""Method: how the call of one method and its answer are written and read.

    request    256 n, the words of the name, the arguments, structs spliced in
    answer     256 n, the result, a struct spliced in; nothing for void

    get_long_method_name    the words [get] [long] method [name]: vocabs up to four letters
    set_on([ok])            [set] on [ok]: the last is a string before an argument that is a vocab

Rules: pure functions of bytes, made on first use. Only trailing arguments that have a default may
be missing. A result that is External is the whole answer. Requests and answers of YARP 4.0, where
floats have other tags, are read if they can be read no other way.
"""

from __future__ import annotations

import inspect
from collections.abc import Callable, Mapping, Sequence
from functools import cached_property
from struct import Struct as Packing
from typing import Any, Final, TypeVar, overload

from yarpy.data import codec
from yarpy.data.value import LIST, STRING, VOCAB32, Buffer, vocab_code
from yarpy.data.yarp4 import to_yarp3, to_yarp4
from yarpy.errors import DecodeError
from yarpy.kits.thrift.kind import (
    External,
    Kind,
    Part,
    Scalar,
    flat,
    has_floats,
    has_narrow,
    is_enum,
    kind_of,
    name_of,
)
from yarpy.kits.thrift.structure import _New
from yarpy.kits.thrift.wire import fast_reader, fast_writer, reader
from yarpy.kits.thrift.wire.cursor import pair, spread
from yarpy.kits.thrift.wire.extent import Ending, ending_of, yarp4_ending_of
from yarpy.kits.thrift.word import SERVICE, original

F = TypeVar("F", bound=Callable[..., Any])

_PAIR: Final = Packing("<ii").pack


@overload
def method(function: F) -> F: ...
@overload
def method(
    *, name: str = "", numbers: tuple[int, ...] = (), throws: Mapping[int, Any] | None = None
) -> Callable[[F], F]: ...
def method(function: Any = None, **facts: Any) -> Any:
    """Mark a method of a service that others can call.

    `@thrift.method(...)` says what only Apache's protocols know: the `numbers` of its arguments,
    where they are not 1, 2, 3 ..., and which exceptions it `throws`, by their numbers. `name`: its
    name in Thrift, where that begins with `_`.
    """
    return _marked(function, False, facts)


@overload
def oneway(function: F) -> F: ...
@overload
def oneway(
    *, name: str = "", numbers: tuple[int, ...] = (), throws: Mapping[int, Any] | None = None
) -> Callable[[F], F]: ...
def oneway(function: Any = None, **facts: Any) -> Any:
    """Mark one whose caller does not wait for an answer; see `method`."""
    return _marked(function, True, facts)


def _marked(function: Any, is_oneway: bool, facts: Mapping[str, Any]) -> Any:
    def mark(found: Any) -> Any:
        found._thrift_oneway = is_oneway
        found._thrift_facts = facts
        return found

    return mark if function is None else mark(function)


class Method:
    """A method of a service. `names`: those that its annotations may mention."""

    def __init__(
        self, attribute: str, function: Any, names: Callable[[], Mapping[str, Any]]
    ) -> None:
        self.attribute = attribute
        facts: Mapping[str, Any] = function._thrift_facts
        self.name: str = facts.get("name") or original(attribute, SERVICE)
        self._numbers: tuple[int, ...] = facts.get("numbers", ())
        self._throws: Mapping[int, Any] = facts.get("throws") or {}
        self.function = function
        self.oneway: bool = function._thrift_oneway
        self.doc = inspect.cleandoc(function.__doc__ or "")
        self.words = self.name.split("_")
        self._names = names

    @cached_property
    def signature(self) -> inspect.Signature:
        return inspect.signature(self.function)

    @cached_property
    def parts(self) -> list[Part]:
        """The arguments."""
        names = self._names()
        found = []
        for each in [*self.signature.parameters.values()][1:]:
            if each.kind is not each.POSITIONAL_OR_KEYWORD or each.annotation is each.empty:
                raise TypeError(
                    f"{self.name}: the argument {each} needs a type: {each.name}: float"
                )
            kind, nested = kind_of(each.annotation, names)
            found.append(Part(original(each.name), kind, nested))
        return found

    @cached_property
    def numbers(self) -> tuple[int, ...]:
        """The numbers of the arguments, as Apache's protocols have them."""
        given = self._numbers
        return (*given, *range(len(given) + 1, len(self.parts) + 1))

    @cached_property
    def throws(self) -> dict[int, type[Any]]:
        """The exceptions that it may throw, by their numbers."""
        names = self._names()
        found = {number: kind_of(each, names)[0] for number, each in self._throws.items()}
        return {
            number: kind
            for number, kind in found.items()
            if isinstance(kind, type) and issubclass(kind, BaseException)
        }

    @cached_property
    def defaults(self) -> list[Callable[[], Any]]:
        """The functions that make the defaults of the last arguments."""
        found: list[Callable[[], Any]] = []
        for each in [*self.signature.parameters.values()][1:]:
            if each.default is not each.empty:
                found.append(_maker(each.default))
        return found

    @cached_property
    def result(self) -> Kind | None:
        """The kind of its result; None for no result."""
        annotation = self.signature.return_annotation
        if annotation is None or annotation is inspect.Signature.empty or annotation == "None":
            return None
        return kind_of(annotation, self._names())[0]

    # -- requests ---------------------------------------------------------------------------------

    @cached_property
    def head(self) -> bytes:
        """The name as it is sent: the count of the list counts arguments, too."""
        pieces = []
        for at, word in enumerate(self.words):
            data = word.encode()
            last = at == len(self.words) - 1
            if len(data) <= 4 and not (last and self.parts and _begins_with_vocab(self.parts[0])):
                pieces.append(_PAIR(VOCAB32, vocab_code(data)))
            else:
                pieces.append(_PAIR(STRING, len(data)) + data)
        count = len(self.words) + sum(1 if p.nested else flat(p.kind) for p in self.parts)
        return _PAIR(LIST, count) + b"".join(pieces)

    @cached_property
    def ask(self) -> fast_writer.Dump:
        """The request for these arguments, all of them. TypeError, OverflowError."""
        return fast_writer.dump(self.name, self.parts, self.head)

    @cached_property
    def read_arguments(self) -> fast_reader.Load:
        """The arguments that begin at a place. DecodeError."""
        return fast_reader.load(self.name, self.parts, self.defaults)

    @cached_property
    def asks_floats(self) -> bool:
        """True if there are fractions among the arguments: YARP 4.0 writes them otherwise."""
        return has_floats(part.kind for part in self.parts)

    def yarp4_arguments(self, data: Buffer, at: int, error: DecodeError) -> tuple[Any, ...]:
        """The arguments that begin at a place, as YARP 4.0 spells them; `error` if they are not
        that either."""
        if not self.asks_floats:
            raise error
        try:
            return self.read_arguments(data, at, True)
        except DecodeError:
            raise error from None

    # -- answers ----------------------------------------------------------------------------------

    @cached_property
    def answer(self) -> Callable[[Any], bytes]:
        """The answer with a result. TypeError, OverflowError."""
        result = self.result
        if result is None:
            empty = _PAIR(LIST, 0)
            return lambda value: empty
        if isinstance(result, External):
            return lambda value: b"".join(codec.encode(value))
        path = f"the result of {self.name}"
        return fast_writer.dump(path, [Part("", result)], _PAIR(LIST, flat(result)))

    def bottle_answer(self, value: Any) -> bytes:
        """The same as a Bottle, whatever C++ would make of it."""
        result = self.result
        if result is None or isinstance(result, External):
            return self.answer(value)
        head = _PAIR(LIST, flat(result))
        path = f"the result of {self.name}"
        return fast_writer.slow_dump(path, [Part("", result)], [value], head, bottle=True)

    @cached_property
    def _load_result(self) -> fast_reader.Load:
        assert self.result is not None
        return fast_reader.load(f"the result of {self.name}", [Part("", self.result)])

    @cached_property
    def answers_floats(self) -> bool:
        """True if there are fractions in the result."""
        return self.result is not None and has_floats([self.result])

    def read_answer(self, data: Buffer) -> Any:
        """The result in an answer. DecodeError."""
        result = self.result
        if result is None:
            return None
        if isinstance(result, External):
            return codec.decode_as(data, reader.class_of(result))
        try:
            return self._load_result(spread(data), 8)[0]
        except DecodeError as error:
            if not self.answers_floats:
                raise
            try:
                if pair(data, 0)[0] == LIST:
                    return self._load_result(data, 8, True)[0]
                return self._load_result(spread(to_yarp3(data)), 8)[0]
            except DecodeError:
                raise error from None

    @cached_property
    def ending(self) -> Ending | None:
        """The function that finds the end of its answers, where they are no Bottles."""
        return ending_of(self.result)

    @cached_property
    def yarp4_ending(self) -> Ending | None:
        """The same for answers of YARP 4.0."""
        return yarp4_ending_of(self.result)

    @cached_property
    def minds_version(self) -> bool:
        """True if the server's version has to be known: for fractions among the arguments, or for
        a float32 in the result."""
        return self.asks_floats or (self.result is not None and has_narrow([self.result]))

    def yarp4_ask(self, values: Sequence[Any]) -> Buffer:
        """The request as YARP 4.0 spells it; lists of lists as 4.0.1 does."""
        found = fast_writer.slow_dump(self.name, self.parts, values, self.head, bottle=True)
        return to_yarp4(found)

    def yarp4_answer(self, result: Any) -> Buffer:
        """The answer as YARP 4.0 spells it; lists of lists as 4.0.1 does."""
        return to_yarp4(self.bottle_answer(result))

    # -- for people -------------------------------------------------------------------------------

    @property
    def prototype(self) -> str:
        """As it is written in a `.thrift` file, without the numbers."""
        result = "void" if self.result is None else name_of(self.result)
        arguments = []
        first = len(self.parts) - len(self.defaults)
        for at, part in enumerate(self.parts):
            text = f"{name_of(part.kind)} {part.name}"
            if at >= first:
                text += f" = {shown(self.defaults[at - first]())}"
            arguments.append(text)
        return f"{'oneway ' if self.oneway else ''}{result} {self.name}({', '.join(arguments)})"


def shown(value: Any) -> str:
    """A default as Thrift spells it."""
    if isinstance(value, bool):
        return "true" if value else "false"
    name = getattr(value, "name", None)
    if name is not None and hasattr(value, "_thrift"):
        return f"{type(value).__name__}.{name}"
    if isinstance(value, str):
        return f'"{value}"'
    if hasattr(value, "__array_interface__"):
        return repr(value.tolist())
    return repr(value)


def _begins_with_vocab(part: Part) -> bool:
    """Return whether an argument begins with a vocab, which C++ before 3.7 takes for one more
    word of a name that ends in a vocab."""
    kind = part.kind
    while isinstance(kind, type) and not is_enum(kind) and not part.nested:
        fields = kind._specs()
        if not fields or fields[0].nested:
            return False
        kind = fields[0].kind
    if isinstance(kind, type) and is_enum(kind):
        return bool(kind._base.code == VOCAB32)
    return isinstance(kind, Scalar) and kind.code == VOCAB32


def _maker(default: Any) -> Callable[[], Any]:
    if isinstance(default, _New):
        return default.make
    return lambda: default


def first_word(data: bytes, at: int) -> tuple[str, int, int]:
    """The word that begins at a place, the place behind it, and its tag. DecodeError."""
    tag, length = pair(data, at)
    if tag == VOCAB32:
        word = length.to_bytes(4, "little", signed=True).rstrip(b"\0").decode("utf-8", "replace")
        return word, at + 8, tag
    if tag != STRING or length < 0 or at + 8 + length > len(data):
        raise DecodeError("the name of a method is a word, or several")
    end = at + 8 + length
    return data[at + 8 : end].decode("utf-8", "replace").rstrip("\0"), end, tag
