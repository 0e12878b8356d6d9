"""Methods that are decorated: their hints, their decorators, and who has chosen a side.

Rules: a hint that cannot be sent is a TypeError where the method is decorated, which names the
parameter; so is an option that the middleware does not have, as a ValueError. Nothing is stored in
the user's objects: what is active is found by their identity, and ends when they do.
"""

from __future__ import annotations

import inspect
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from difflib import get_close_matches
from typing import (
    Any,
    Final,
    Literal,
    TypeAlias,
    TypedDict,
    get_args,
    get_origin,
    get_type_hints,
)

from yarpy.errors import AddressError, DecodeError, LocalProtocolError
from yarpy.kits.wrap.middleware import (
    ENCODINGS,
    Binding,
    Encoding,
    Keep,
    Middleware,
    Parameter,
    Signature,
)
from yarpy.kits.wrap.value.hint import shape_of
from yarpy.kits.wrap.value.shape import ANY, Shape
from yarpy.qos import Qos
from yarpy.registry import middlewares

Kind: TypeAlias = Literal["function", "coroutine", "generator", "async generator"]
Missing: TypeAlias = Literal["raise", "none", "last"]

MISSING: Final = ("raise", "none", "last")
EVERYBODY: Final = 0  # the key of a mode that was chosen for a function, not for an object
UNDECIDED: Final = -1  # the key that says: the configuration has a word for objects to come


class Changes(TypedDict, total=False):
    """The options that may differ for one object from those of the decorator; a list has one for
    each of several decorators."""

    topic: str | list[str]
    middleware: str | tuple[str, ...] | list[str]
    source: str | list[str]
    carrier: str | list[str]
    qos: Qos | list[Qos]
    keep: Keep | list[Keep]
    reliable: bool
    encoding: Encoding


CHANGES: Final = Changes.__annotations__.keys()


@dataclass(frozen=True, slots=True)
class Output:
    """One decorator: where one value that a method returns goes.

    source: where `relay`, `exchange` and `receive` listen, "" for the topic itself.
    """

    topic: str
    middlewares: tuple[str, ...] = ("yarp",)
    source: str = ""
    carrier: str = ""
    qos: Qos | None = None
    keep: Keep = "latest"
    reliable: bool = False
    encoding: Encoding = "native"

    def __post_init__(self) -> None:
        if not isinstance(self.topic, str) or not self.topic:
            raise AddressError(f'a topic is a text like "/eyes/left", not {self.topic!r}')
        if not self.middlewares:
            raise ValueError(f'no middleware for "{self.topic}"')
        if self.encoding not in ENCODINGS:
            raise ValueError(f"the encoding {self.encoding!r} is none of {', '.join(ENCODINGS)}")
        fitting = self.keep in ("latest", "all") or (type(self.keep) is int and self.keep > 0)
        if not fitting:
            raise ValueError(f'keep={self.keep!r} is neither "latest", "all" nor a number')
        if not isinstance(self.qos, Qos | None):
            raise TypeError(f"qos={self.qos!r} is no Qos: say yarpy.Qos(...)")

    def bindings(self, topic: str, signature: Signature | None = None) -> list[Binding]:
        """Return the binding of each middleware; `topic` is this output's topic or source."""
        return [self._binding(one, topic, signature) for one in self.middlewares]

    def _binding(self, middleware: str, topic: str, signature: Signature | None) -> Binding:
        name, _, place = middleware.partition("://")
        return Binding(
            topic,
            name,
            place,
            self.carrier,
            self.qos,
            self.keep,
            self.reliable,
            self.encoding,
            signature,
        )


class Method:
    """A function with its decorators."""

    def __init__(self, func: Callable[..., Any]) -> None:
        self.func = func
        self.name: str = func.__name__
        self.qualname = func.__qualname__.rpartition("<locals>.")[2]
        self.module = func.__module__
        self.signature = inspect.signature(func)
        parameters = self.signature.parameters.values()
        takes_order = (inspect.Parameter.POSITIONAL_ONLY, inspect.Parameter.POSITIONAL_OR_KEYWORD)
        ordered = all(one.kind in takes_order for one in parameters)
        self._in_order = tuple(self.signature.parameters) if ordered else None
        self.kind = _kind(func)
        self.outputs: list[Output] = []
        self.timeout: float | None = None
        self.missing: Missing = "raise"
        self.wait = 0.0
        self.together = False
        self.active: dict[int, Any] = {}
        self.parameters: dict[str, Shape] = {}
        self.result: Shape = ANY
        self.results: list[Shape] | None = None  # of a tuple with so many elements
        self._exact: tuple[type | None, ...] = ()  # of arguments in order that go as they are
        self._read = False
        self.read_hints(late=True)

    def read_hints(self, late: bool = False) -> None:
        """Find out what parameters and values are. Raises TypeError.

        late: names that are not defined yet are looked up when they are needed.
        """
        if self._read:
            return
        try:
            hints = get_type_hints(self.func, include_extras=True)
        except NameError as error:
            if late:
                return
            raise TypeError(f"{self.qualname}: {error}, which a type hint names") from error
        for name in self.signature.parameters:
            self.parameters[name] = self._shape(hints.get(name, Any), f'the parameter "{name}"')
        hint = hints.get("return", Any)
        if self.kind.endswith("generator") and hint is not Any:
            hint = (*get_args(hint), Any)[0]
        if self._in_order is not None:
            self._exact = tuple(self.parameters[name].exact for name in self._in_order)
        self.result = self._shape(hint, "what it returns")
        if get_origin(hint) is tuple and Ellipsis not in get_args(hint):
            self.results = [self._shape(one, "what it returns") for one in get_args(hint)]
        self._read = True
        self._check_number()

    def _shape(self, hint: Any, what: str) -> Shape:
        try:
            return shape_of(hint)
        except TypeError as error:
            raise TypeError(
                f"{self.qualname}: {what}: {error}. Leave the hint of a parameter out if it never "
                "leaves this program"
                if "parameter" in what
                else f"{self.qualname}: {what}: {error}"
            ) from error

    def add(self, output: Output) -> None:
        """One more decorator, above those that are there. Raises what cannot be."""
        names = [*self.signature.parameters]
        called = self.called(names[:1] in (["self"], ["cls"])) if self._read else None
        for binding in output.bindings(output.topic, called):
            try:
                middleware_of(binding).check(binding)
            except (TypeError, ValueError) as error:
                error.add_note(f"in the decorator of {self.qualname}")
                raise
        self.outputs.insert(0, output)
        self._check_number()

    def _check_number(self) -> None:
        if not self._read or len(self.outputs) < 2 or self.result is ANY:
            return
        if self.results is None or len(self.outputs) > len(self.results):
            raise TypeError(
                f"{self.qualname} has {len(self.outputs)} decorators and returns "
                f"{self.result.name}: each is for one element of a tuple"
            )

    def shapes(self) -> list[Shape]:
        """The shape of what each decorator sends. Raises TypeError."""
        self.read_hints()
        if len(self.outputs) == 1:
            return [self.result]
        if self.results is None:
            return [ANY] * len(self.outputs)
        if len(self.results) != len(self.outputs):
            raise TypeError(
                f"{self.qualname} returns {len(self.results)} values and has "
                f"{len(self.outputs)} decorators"
            )
        return self.results

    def inputs(self, bound: bool) -> list[Shape]:
        """The shapes of the first parameters, which `relay` and `receive` fill."""
        self.read_hints()
        found: list[Shape] = []
        for name, parameter in [*self.signature.parameters.items()][bound:]:
            if parameter.kind is inspect.Parameter.VAR_POSITIONAL:
                found += [self.parameters[name]] * (len(self.outputs) - len(found))
            elif parameter.kind in (
                inspect.Parameter.POSITIONAL_ONLY,
                inspect.Parameter.POSITIONAL_OR_KEYWORD,
            ):
                found.append(self.parameters[name])
        if len(found) < len(self.outputs):
            raise TypeError(
                f"{self.qualname} takes {len(found)} arguments, and gets {len(self.outputs)} values"
            )
        return found[: len(self.outputs)]

    def called(self, bound: bool) -> Signature:
        """Return the method's parameters and result; `bound`: its first parameter is its object."""
        self.read_hints()
        found: list[Parameter] = []
        variable = ""
        for name, parameter in [*self.signature.parameters.items()][bound:]:
            if parameter.kind in (parameter.VAR_POSITIONAL, parameter.VAR_KEYWORD):
                variable = variable or name
                continue
            keyword_only = parameter.kind is parameter.KEYWORD_ONLY
            shape = self.parameters[name]
            found.append(Parameter(name, shape, parameter.default, keyword_only))
        return Signature(self.qualname, tuple(found), self.result, variable)

    def exact(self, bound: bool) -> tuple[type | None, ...]:
        """Return the types of arguments in order that need neither `dump` nor `load`, without the
        object where the method is `bound` to one."""
        self.read_hints()
        return (None,) if self._in_order is None else self._exact[bound:]

    def dump(
        self, instance: Any, args: Sequence[Any], kwargs: Mapping[str, Any]
    ) -> tuple[list[Any], dict[str, Any]]:
        """Arguments as plain Python. Raises TypeError for those that do not fit the signature."""

        def plain(name: str, value: Any) -> Any:
            try:
                return self.parameters[name].dump(value)
            except TypeError as error:
                raise TypeError(f'{self.qualname}: the argument "{name}": {error}') from error

        return self._each(plain, instance, args, kwargs)

    def load(
        self, instance: Any, args: Sequence[Any], kwargs: Mapping[str, Any]
    ) -> tuple[list[Any], dict[str, Any]]:
        """The arguments of a question. Raises TypeError, DecodeError."""

        def loaded(name: str, value: Any) -> Any:
            try:
                return self.parameters[name].load(value)
            except DecodeError as error:
                raise DecodeError(f'the argument "{name}" of {self.qualname}: {error}') from error

        return self._each(loaded, instance, args, kwargs)

    def _each(
        self,
        turn: Callable[[str, Any], Any],
        instance: Any,
        args: Sequence[Any],
        kwargs: Mapping[str, Any],
    ) -> tuple[list[Any], dict[str, Any]]:
        """Arguments without the object, each as `turn(name, argument)`. Raises TypeError."""
        if not self._read:
            self.read_hints()
        first = () if instance is None else (instance,)
        names = self._in_order
        if names is not None and not kwargs and len(first) + len(args) == len(names):
            return [*map(turn, names[len(first) :], args)], {}  # `bind` takes several times longer
        bound = self.signature.bind(*first, *args, **kwargs)
        for name, value in [*bound.arguments.items()][len(first) :]:
            kind = self.signature.parameters[name].kind
            if kind is inspect.Parameter.VAR_POSITIONAL:
                bound.arguments[name] = tuple(turn(name, one) for one in value)
            elif kind is inspect.Parameter.VAR_KEYWORD:
                bound.arguments[name] = {k: turn(name, one) for k, one in value.items()}
            else:
                bound.arguments[name] = turn(name, value)
        return list(bound.args[len(first) :]), bound.kwargs

    def placed(self, instance: Any, changes: Mapping[str, Any]) -> list[Output]:
        """The decorators for an object: its attributes in the topics, and what a caller changes.

        Raises LocalProtocolError for a topic that names an attribute which is not there.
        """
        found = self.outputs
        unknown = sorted(changes.keys() - CHANGES)
        if unknown:
            near = get_close_matches(unknown[0], CHANGES, n=1)
            if near:
                raise TypeError(
                    f'no option "{unknown[0]}" of {self.qualname}: did you mean "{near[0]}"?'
                )
            raise TypeError(
                f"{unknown[0]} of {self.qualname} is a matter of its decorator; for one object "
                f"there are {', '.join(sorted(CHANGES))}"
            )
        if changes:
            found = [replace(one, **_of(index, changes)) for index, one in enumerate(found)]
            for output in found:
                for binding in output.bindings(output.topic):
                    middleware_of(binding).check(binding)
        return [
            replace(
                one,
                topic=self._filled(one.topic, instance),
                source=self._filled(one.source, instance),
            )
            for one in found
        ]

    def _filled(self, topic: str, instance: Any) -> str:
        if "{" not in topic:
            return topic
        try:
            return topic.format(self=instance)
        except (AttributeError, LookupError, ValueError) as error:
            raise LocalProtocolError(
                f'the topic "{topic}" of {self.qualname}: {error}; write {{self.NAME}} for an '
                "attribute"
            ) from error


def _of(index: int, changes: Mapping[str, Any]) -> dict[str, Any]:
    """The changes for one of several decorators: a list has one for each."""
    found = {}
    for name, value in changes.items():
        one = value[index] if isinstance(value, list) and index < len(value) else value
        if name == "middleware":
            found["middlewares"] = (one,) if isinstance(one, str) else tuple(one)
        else:
            found[name] = one
    return found


def _kind(func: Callable[..., Any]) -> Kind:
    if inspect.iscoroutinefunction(func):
        return "coroutine"
    if inspect.isasyncgenfunction(func):
        return "async generator"
    return "generator" if inspect.isgeneratorfunction(func) else "function"


def middleware_of(binding: Binding) -> Middleware:
    """The middleware that a binding names. Raises UnknownPlugin."""
    found: Middleware = middlewares.load(binding.middleware)()
    return found
