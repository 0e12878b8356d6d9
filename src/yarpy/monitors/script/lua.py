"""Lua scripts for a portmonitor: those of C++ YARP, with the callbacks in the table PortMonitor.

Rules: every script has its own Lua state, whose calls are limited in instructions and seconds, and
whose memory in bytes (`limit.py`, binding/sandbox.lua), so that whoever writes or closes comes
back. Scripts see YARP's classes (the rest of binding).
Between the languages pass only numbers and strings, and once the functions of `_Host`: for speed,
and because lupa (2.8) loses an object that is passed again while Lua collects garbage.
"""

from __future__ import annotations

import sys
import time
from collections.abc import Callable
from functools import cache, partial
from pathlib import Path
from typing import Any, Final

from yarpy.data.bottle import Bottle, Property
from yarpy.data.sig.image import Image
from yarpy.data.sig.matrix import Matrix
from yarpy.data.sig.pixel import pixel_of
from yarpy.data.sig.vector import Vector
from yarpy.limit import SCRIPT_INSTRUCTIONS, SCRIPT_MEMORY, SCRIPT_SECONDS, SCRIPT_UNWATCHED
from yarpy.monitors.extra import needed
from yarpy.monitors.script.control import Control
from yarpy.monitors.script.script import ScriptError, read_script
from yarpy.wire.message import Message

_CALLBACKS: Final = (
    *("create", "destroy", "accept", "update", "update_reply", "trig", "setparam", "getparam"),
)
_FORMATS: Final = {"<u1": b"<B", "<u2": b"<I2", "<i4": b"<i4", "<i1": b"<i1", "<f4": b"<f"}


def lupa() -> Any:
    """The library. If it is missing, LocalProtocolError says what to install."""
    return needed("lupa.lua54", "lua", "a portmonitor with a Lua script")


@cache
def _source(name: str) -> bytes:
    return (Path(__file__).parent / "binding" / f"{name}.lua").read_bytes()


def _text(data: object) -> str:
    if isinstance(data, bytes):
        return data.decode("utf-8", "surrogateescape")
    raise TypeError("expected a string")


def _data(text: str) -> bytes:
    return text.encode("utf-8", "surrogateescape")


class _Host:
    """The Python functions that Lua calls. They raise; `given` turns that into error texts."""

    def __init__(self, control: Control) -> None:
        self.message: Message | None = None  # the current one
        self._control = control

    def given(self) -> dict[bytes, Callable[..., object]]:
        """Each as Lua calls it: returns an error text or None, then its results."""
        names = [name for name in dir(type(self)) if not name.startswith("_")]
        names = [name for name in names if name not in ("given", "message", "fetch_bottle")]
        found = {name.encode(): partial(_guarded, getattr(self, name)) for name in names}
        return {b"fetch_bottle": self.fetch_bottle, **found}

    # -- the message ------------------------------------------------------------------------------

    def _there(self) -> Message:
        if self.message is None:
            raise LookupError("there is no current message")
        return self.message

    def fetch_bottle(self) -> tuple[object, ...]:
        # Nearly every script calls this, so it skips the detour through `_guarded`.
        try:
            return None, bytes(self._there().to_bytes())
        except Exception as error:
            return (_data(str(error)),)

    def fetch_vector(self) -> bytes:
        vector = self._there().as_(Vector)
        return b"".join((vector if vector.kind == "float64" else Vector(list(vector))).to_wire())[
            8:
        ]

    def fetch_matrix(self) -> tuple[int, int, bytes]:
        matrix = self._there().as_(Matrix)
        return matrix.rows, matrix.cols, matrix.array.tobytes()

    def fetch_image(self, wanted: bytes) -> tuple[bytes, int, int, bytes, int, bytes]:
        image = self._there().as_(Image)
        if wanted:
            image = image.converted(_text(wanted))
        kind = pixel_of(image.code.code)
        size = image.width, image.height
        return _data(image.code), *size, _FORMATS[kind.dtype], kind.channels, image.array.tobytes()

    # -- text, time, printing ---------------------------------------------------------------------

    def text_of(self, data: bytes) -> bytes:
        return _data(Bottle.from_bytes(data).to_text())

    def bytes_of(self, text: bytes) -> bytes:
        return Bottle.from_text(text).to_bytes()

    def now(self) -> float:
        return time.time()

    def say(self, text: bytes) -> None:
        print(text.decode("utf-8", "replace"), file=sys.stdout, flush=True)

    # -- events and the like ----------------------------------------------------------------------

    def setEvent(self, name: bytes, lifetime: float | None = None) -> None:  # noqa: N802
        self._control.set_event(_text(name), lifetime)

    def unsetEvent(self, name: bytes) -> None:  # noqa: N802
        self._control.unset_event(_text(name))

    def setConstraint(self, text: bytes) -> None:  # noqa: N802
        self._control.set_constraint(_text(text))

    def getConstraint(self) -> bytes:  # noqa: N802
        return _data(self._control.get_constraint())

    def setTrigInterval(self, seconds: float) -> None:  # noqa: N802
        self._control.set_trig_interval(seconds)

    def unsetTrigInterval(self) -> None:  # noqa: N802
        self._control.unset_trig_interval()


def _guarded(function: Callable[..., object], *arguments: object) -> tuple[object, ...]:
    try:
        found = function(*arguments)
    except Exception as error:
        return (_data(str(error) or type(error).__name__),)
    return (None, *found) if isinstance(found, tuple) else (None, found)


def _module(path: bytes) -> bytes:
    return read_script(Path(_text(path)))


class LuaScript:
    """The script of one connection. Raises ScriptError if the file cannot be run."""

    def __init__(
        self,
        path: Path,
        source: bytes,
        control: Control,
        limit: int = SCRIPT_INSTRUCTIONS,
        memory: int = SCRIPT_MEMORY,
        system: bool = False,
    ) -> None:
        self._path = path
        self._host = _Host(control)
        self._closed = False
        lua = lupa().LuaRuntime(
            encoding=None,
            register_eval=False,
            register_builtins=False,
            unpack_returned_tuples=True,
            max_memory=memory,
        )
        self._lua = lua
        folder = b"%s/?.lua;" % _data(str(path.parent))
        lua.globals()[b"package"][b"path"] = folder + lua.globals()[b"package"][b"path"]
        # Without `system`, scripts can load only the modules in their own folder.
        reach = None if system else _data(str(path.parent))
        run, fail, guard, charge, afford = self._load(
            "sandbox",
            limit,
            SCRIPT_SECONDS,
            SCRIPT_UNWATCHED,
            time.thread_time,
            partial(_guarded, _module),
            reach,
        )
        kit = self._load("element", lua.table_from(self._host.given()), fail, charge)
        for name in ("value", "list", "number", "image"):
            self._load(name, kit)
        self._inside = self._load("thing", kit, run)
        self._load("pattern", charge, fail, afford)
        guard()
        self._call("load", source, b"@%s" % _data(str(path)))
        # As in C++, callbacks that a script defines later are not used.
        self._has = {name for name in _CALLBACKS if self._call("has", name.encode())}
        self._accept = self._inside[b"accept"] if "accept" in self._has else None
        self._update = "update" in self._has
        self._touched = False  # changed by `accept`, where there is no `update`

    def _load(self, name: str, *arguments: object) -> Any:
        return self._lua.execute(_source(name), *arguments, name=f"={name}".encode(), mode="t")

    def _call(self, name: str, *arguments: object) -> Any:
        return self._done(self._inside[name.encode()], *arguments)

    def _done(self, function: Any, *arguments: object) -> Any:
        """The result of a Lua function; of several results a tuple."""
        try:
            done = function(*arguments)
        except Exception as error:  # out of memory outside a script
            raise ScriptError(f"{self._path}: {str(error) or 'not enough memory'}") from error
        if done is True:
            return None
        if done[0] is True:
            return done[1] if len(done) == 2 else done[1:]
        text = _text(done[1])
        raise ScriptError(text if str(self._path) in text else f"{self._path}: {text}")

    # -- callbacks --------------------------------------------------------------------------------

    def create(self, options: Property) -> bool:
        return "create" not in self._has or bool(self._call("create", options.to_bytes()))

    def accept(self, message: Message) -> bool:
        if self._accept is None:
            return True
        self._host.message = message
        found = self._done(self._accept)
        self._touched = found == 2
        return bool(found)

    def update(self, message: Message) -> object:
        seen = self._accept is not None and self._host.message is message
        if not self._update and not (seen and self._touched):
            return None
        self._host.message = message
        name = "result" if not self._update else "update" if seen else "update_unseen"
        return self._made(message, self._call(name))

    def update_reply(self, message: Message) -> object:
        if "update_reply" not in self._has:
            return None
        self._host.message = message
        return self._made(message, self._call("update_reply"))

    def _made(self, message: Message, found: Any) -> object:
        """The result of a script for a message, from what Lua returns."""
        self._host.message = None
        if found is None:
            return None
        kind, data, *rest = found
        if kind == b"message":
            return message.replaced(data, binary=True)
        code, width, height = rest
        return message.replaced(_image(_text(code), width, height, data))

    def trigger(self) -> None:
        if "trig" in self._has:
            self._call("trig")

    def configure(self, parameters: Property) -> None:
        if "setparam" in self._has:
            self._call("setparam", parameters.to_bytes())

    def parameters(self) -> Property:
        if "getparam" not in self._has:
            return Property()
        found = self._call("getparam")
        return Property() if found is None else Property.from_bytes(found)

    def close(self) -> None:
        if not self._closed:
            self._closed = True
            if "destroy" in self._has:
                self._call("destroy")


def _image(code: str, width: int, height: int, data: bytes) -> Image:
    import numpy as np

    kind = pixel_of(code)
    shape = (height, width) if kind.channels == 1 else (height, width, kind.channels)
    return Image(np.frombuffer(data, kind.dtype).reshape(shape), code)
