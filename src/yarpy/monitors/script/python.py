"""Python scripts for a portmonitor: a file with some of these functions, or with a class Monitor.

    create(options)        False: refuse the connection; options says between which ports
    accept(message)        whether it may pass
    update(message)        what replaces it: a value, a Message, or yarpy.monitors.DROP;
                           None: the message unchanged
    update_reply(message)  the same for the reply to a call
    trig()                 another connection of the port let a message pass, or the timer is due
    setparam(parameters)   new parameters, a Property
    getparam()             their values, a dict or Property
    destroy()              the connection ends

Messages are yarpy's. The names of C++ YARP 4 (acceptData, updateData, updateReply, setParams,
getParams) work too. `portmonitor` needs no import: see Control.

Rules: each connection has its own module, and so its own variables. The script runs with all the
rights of the program and without limits.
"""

from __future__ import annotations

import inspect
import itertools
import sys
import traceback
from collections.abc import Callable
from pathlib import Path
from types import ModuleType
from typing import Any, Final

from yarpy import scope
from yarpy.data.bottle import Property
from yarpy.monitors.base import FAILURES
from yarpy.monitors.script.control import Control
from yarpy.monitors.script.script import CALLBACK_TIMEOUT, ScriptError
from yarpy.threads import Thread
from yarpy.wire.message import Message

_NAMES: Final = {
    "create": ("create",),
    "accept": ("accept", "acceptData"),
    "update": ("update", "updateData"),
    "update_reply": ("update_reply", "updateReply"),
    "trig": ("trig",),
    "setparam": ("setparam", "setParams"),
    "getparam": ("getparam", "getParams"),
    "destroy": ("destroy",),
}
_numbers = itertools.count()

Callback = Callable[..., Any]


class PythonScript:
    """The script of one connection. Raises ScriptError if the file cannot be run."""

    def __init__(self, path: Path, source: bytes, control: Control) -> None:
        self._path = str(path)
        module = ModuleType(f"yarpy_portmonitor_{next(_numbers)}_{path.stem}")
        module.__file__ = self._path
        vars(module).update(portmonitor=control, PortMonitor=control)
        self._module = module
        sys.modules[module.__name__] = module  # dataclasses, among others, look up their module
        try:
            exec(compile(source, self._path, "exec"), vars(module))
            kind = getattr(module, "Monitor", None)
            owner = kind() if isinstance(kind, type) else module
        except FAILURES as error:
            sys.modules.pop(module.__name__, None)
            raise self._failed(error) from error
        found = {key: self._find(owner, names) for key, names in _NAMES.items()}
        self._create, self._destroy = found["create"], found["destroy"]
        self._accept, self._update = found["accept"], found["update"]
        self._update_reply, self._trig = found["update_reply"], found["trig"]
        self._setparam, self._getparam = found["setparam"], found["getparam"]

    @staticmethod
    def _find(owner: object, names: tuple[str, ...]) -> Callback | None:
        for name in names:
            found: Callback | None = getattr(owner, name, None)
            if callable(found):
                return found
        return None

    def _failed(self, error: BaseException) -> ScriptError:
        """The error, with the line of the script."""
        line: int | None = None
        if isinstance(error, SyntaxError) and error.filename == self._path:
            line = error.lineno
        else:
            for frame, number in traceback.walk_tb(error.__traceback__):
                if frame.f_code.co_filename == self._path:
                    line = number
        where = self._path if line is None else f"{self._path}:{line}"
        what = error.msg if isinstance(error, SyntaxError) else str(error)
        return ScriptError(f"{where}: {type(error).__name__}: {what}")

    # -- callbacks --------------------------------------------------------------------------------

    def create(self, options: Property) -> bool:
        if self._create is None:
            return True
        return self._call(self._create, options) is not False

    def accept(self, message: Message) -> bool:
        if self._accept is None:
            return True
        try:
            return bool(self._accept(message))
        except FAILURES as error:
            raise self._failed(error) from error

    def update(self, message: Message) -> object:
        if self._update is None:
            return None
        try:
            return self._update(message)
        except FAILURES as error:
            raise self._failed(error) from error

    def update_reply(self, message: Message) -> object:
        return None if self._update_reply is None else self._call(self._update_reply, message)

    def trigger(self) -> None:
        if self._trig is not None:
            self._call(self._trig)

    def configure(self, parameters: Property) -> None:
        if self._setparam is not None:
            self._call(self._setparam, parameters)

    def parameters(self) -> Property:
        if self._getparam is None:
            return Property()
        filled = Property()  # scripts of C++ YARP 4 fill one
        found = self._call(self._getparam, filled)
        try:
            return Property.from_bytes(Property(filled if found is None else found).to_bytes())
        except (TypeError, ValueError) as error:
            raise ScriptError(f"{self._path}: getparam returns no dict: {error}") from error

    def close(self) -> None:
        try:
            if self._destroy is not None:
                self._part(self._destroy)
        finally:
            sys.modules.pop(self._module.__name__, None)

    def _part(self, destroy: Callback) -> None:
        """The last callback, in a thread of its own: if it never returns, nobody else waits."""
        failed: list[ScriptError] = []

        def run() -> None:
            try:
                self._call(destroy)
            except ScriptError as error:
                failed.append(error)

        thread = Thread(target=run, name=f"yarpy destroy {self._path}", daemon=True)
        try:
            thread.start()
        except RuntimeError:  # Python is ending, and starts no more threads
            run()
        else:
            thread.join(max(0.0, min(CALLBACK_TIMEOUT, scope.remaining())))
        if thread.is_alive():
            raise ScriptError(f"{self._path}: destroy still runs, and nothing can end it")
        for error in failed:
            raise error

    def _call(self, callback: Callback, *arguments: object) -> Any:
        """Call it with as many of the arguments as it takes."""
        try:
            return callback(*arguments[: _taken(callback)])
        except FAILURES as error:
            raise self._failed(error) from error


def _taken(callback: Callback) -> int | None:
    """Return how many positional arguments a function takes; None if any number, or unknown."""
    try:
        parameters = inspect.signature(callback).parameters.values()
    except (TypeError, ValueError):
        return None
    if any(one.kind is one.VAR_POSITIONAL for one in parameters):
        return None
    return sum(one.kind in (one.POSITIONAL_ONLY, one.POSITIONAL_OR_KEYWORD) for one in parameters)
