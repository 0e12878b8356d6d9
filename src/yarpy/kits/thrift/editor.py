"""Editor: fields of a struct that others see and set, from far away.

    help, help FIELD                        the fields; the type of one
    patch (set FIELD VALUE) ...             set some, as programs write it
    set FIELD VALUE FIELD VALUE ...         the same, as people type it; any word will do

    yarpy.RpcServer("/settings", Settings.Editor(settings))
    Settings.Editor.connect("/settings").set(gain=2.0, region=Region(1, 2))

Rules: a message is read as a whole before anything is set, so a wrong one changes nothing. Structs
in it are lists of their own, unlike in calls. A subclass may have `will_set_FIELD(value)` and
`did_set_FIELD(value)`, which are called around each. Pure: a port is handed in by `connect`.
"""

from __future__ import annotations

from struct import Struct as Packing
from typing import Any, ClassVar, Final, Self

from yarpy import registry
from yarpy.data.bottle import Bottle
from yarpy.data.value import GROUP_MASK, LIST, STRING, VOCAB32, Buffer, Vocab
from yarpy.errors import DecodeError, RemoteProtocolError, Timeout
from yarpy.kits.thrift.kind import flat, is_struct, name_of
from yarpy.kits.thrift.payload import Payload, many, word_at
from yarpy.kits.thrift.wire import reader, writer
from yarpy.kits.thrift.wire.cursor import Cursor, skip, spread
from yarpy.log import logger

log = logger("yarpy.idl")

_PAIR: Final = Packing("<ii").pack
_OK: Final = Packing("<iiii").pack(LIST, 1, VOCAB32, writer.OK)
_HINT: Final = "send `help` for the fields, or a patch: set FIELD VALUE ..."


def editor_of(struct: Any) -> type[Editor]:
    """The editor of a class of structs."""
    found: type[Editor] | None = struct.__dict__.get("_editor_")
    if found is None:
        found = type("Editor", (Editor,), {"_struct": struct, "__qualname__": "Editor"})
        struct._editor_ = found
    return found


class Editor:
    """Lets others set the fields of `value`: the handler of an RpcServer."""

    _struct: ClassVar[Any]

    def __init__(self, value: Any = None) -> None:
        self.value = self._struct() if value is None else value

    def __call__(self, message: Any) -> Any:
        """Answer a message."""
        try:
            return self._answer(spread(message.to_bytes()))
        except DecodeError as error:
            log.warning("%s: message of %s: %s", self._struct.__name__, message.source, error)
            return Bottle([Vocab("fail"), str(error)])

    def _answer(self, view: Buffer) -> Any:
        data = bytes(view)
        cursor = Cursor(data, 8)
        if cursor.at == cursor.end:
            return Bottle([_HINT])
        word = word_at(cursor, "the first word")
        if word == "help":
            name = word_at(cursor, "a field") if cursor.at < cursor.end else ""
            return Payload(many(self.help(name)))
        changes = self._patch(cursor) if word == "patch" else self._pairs(cursor)
        for field, value in changes:
            self._set(field.attribute, value)
        return Payload(_OK)

    def _patch(self, cursor: Cursor) -> list[tuple[Any, Any]]:
        found = []
        while cursor.at < cursor.end:
            start = cursor.at
            if not cursor.tag("a patch") & GROUP_MASK:
                raise DecodeError("a patch has lists of three: (set FIELD VALUE)")
            cursor.at = start
            skip(cursor, "a patch")
            part = Cursor(spread(cursor.data[start : cursor.at]), 4)
            if part.tag("a patch") != 3:
                raise DecodeError("a patch has lists of three: (set FIELD VALUE)")
            word_at(part, "what to do")
            found.append(self._change(part))
            if part.at != part.end:
                raise DecodeError(f"{found[-1][0].name}: something is left over")
        return found

    def _pairs(self, cursor: Cursor) -> list[tuple[Any, Any]]:
        found = []
        while cursor.at < cursor.end:
            found.append(self._change(cursor))
        return found

    def _change(self, cursor: Cursor) -> tuple[Any, Any]:
        name = word_at(cursor, "a field")
        field = next((each for each in self._struct._specs() if each.name == name), None)
        if field is None:
            names = ", ".join(each.name for each in self._struct._specs())
            raise DecodeError(f"{self._struct.__name__} has no field {name!r}; it has {names}")
        path = f"{self._struct.__name__}.{name}"
        return field, reader.get(field.kind, cursor, path, nested=True)

    def _set(self, name: str, value: Any) -> None:
        before = getattr(self, f"will_set_{name}", None)
        if before is not None:
            before(value)
        setattr(self.value, name, value)
        after = getattr(self, f"did_set_{name}", None)
        if after is not None:
            after(value)

    def help(self, name: str = "") -> list[str]:
        """The names of the fields, or the type of one."""
        specs = self._struct._specs()
        if name:
            kinds = [f"{name_of(each.kind)} {name}" for each in specs if each.name == name]
            return kinds or ["Field not found"]
        return ["*** Available fields:", *(each.name for each in specs)]

    @classmethod
    def patch(cls, **values: Any) -> bytes:
        """The message that sets these fields. TypeError, OverflowError name one that does not
        fit."""
        unknown = values.keys() - {each.attribute for each in cls._struct._specs()}
        if unknown:
            raise TypeError(f"{cls._struct.__name__} has no field {min(unknown)!r}")
        parts: list[Buffer] = [_PAIR(LIST, 1 + len(values)), _string("patch")]
        for field in cls._struct._specs():
            if field.attribute in values:
                parts += (_PAIR(LIST, 3), _string("set"), _string(field.name))
                if is_struct(field.kind):
                    parts.append(_PAIR(LIST, flat(field.kind)))
                path = f"{cls._struct.__name__}.{field.name}"
                writer.put(field.kind, values[field.attribute], parts.append, path)
        return b"".join(parts)

    @classmethod
    def connect(
        cls, target: str, *, timeout: float | None = None, carrier: str = "", **options: Any
    ) -> RemoteEditor:
        """Return an editor of the struct that the port `target` has. Parameters as
        `Service.connect`."""
        port = registry.clients.load("rpc")(target, carrier=carrier, timeout=timeout, **options)
        return RemoteEditor(cls, port, timeout)


class RemoteEditor:
    """Sets fields of a struct in another program."""

    def __init__(self, editor: type[Editor], port: Any, timeout: float | None) -> None:
        self._editor = editor
        self._port = port
        self.timeout = timeout

    def set(self, **values: Any) -> None:
        """Set these fields at once. Raises RemoteProtocolError if they are refused, Timeout,
        LinkClosed; TypeError, OverflowError for values that do not fit."""
        data = self._editor.patch(**values)
        names = ", ".join(values)
        try:
            message = self._port.ask(Payload(data), self.timeout)
        except Timeout:
            raise Timeout(f"set {names}: no answer within {self.timeout} s") from None
        answer = Bottle() if message is None else Bottle.from_bytes(message.to_bytes())
        if answer[:1] != ["ok"]:
            why = f": {answer[1]}" if len(answer) > 1 else ""
            raise RemoteProtocolError(f"the other side refuses to set {names}{why}")

    def close(self) -> None:
        """End the connection."""
        self._port.close()

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *details: object) -> None:
        self.close()


def _string(text: str) -> bytes:
    data = text.encode()
    return _PAIR(STRING, len(data)) + data
