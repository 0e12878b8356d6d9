"""portmonitor: run a script on a connection or a port.

    yarpy connect /out /in tcp+recv.portmonitor+type.python+file.gate+context.demo

    type        lua (the default), python, or dll: an installed monitor
    file        the script, with or without its suffix, or the monitor (modifier)
    context     where scripts are looked for besides the usual places
    constraint  events that let messages pass (`not e_ball`): see constraint.py

Rules: as in C++ YARP, each message goes through `accept`; then the other monitors of the port are
triggered; then, at the receiving end of a connection, the constraint; then `update`. If `accept`
fails the message is dropped, if `update` fails it passes unchanged; each different error is logged
once. A script that has changed on disk is loaded again; if the new one does not start, the old one
stays in use. A script that never comes back holds whoever gave it a message, and nobody else: what
other threads want of it fails after CALLBACK_TIMEOUT, and its connection or port is closed without
it.
"""

from __future__ import annotations

import threading
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from functools import partial
from pathlib import Path
from typing import Any, Final

from yarpy import scope
from yarpy.data.bottle import Bottle, Property
from yarpy.data.text_reader import parse_text
from yarpy.errors import LocalProtocolError, YarpError
from yarpy.log import logger
from yarpy.monitors import chain
from yarpy.monitors.base import DROP, Place, read_token
from yarpy.monitors.monitor_list import Series, places
from yarpy.monitors.script.control import Control
from yarpy.monitors.script.permission import SYSTEM, granted
from yarpy.monitors.script.script import (
    CALLBACK_TIMEOUT,
    Load,
    Script,
    ScriptError,
    Watch,
    find_script,
    read_script,
)
from yarpy.wire.message import Message

log = logger("yarpy.monitors")

_MOST_TOLD: Final = 16  # different errors that are logged
_NATIVE: Final = "dll"
_OWN: Final = ("type", "script", "file", "context", "constraint")


def portmonitor(place: Place) -> object:
    """The monitor that a connection asks for. Raises UnknownPlugin, LocalProtocolError."""
    where = places(place)
    if len(where) == 1:
        return _one(place)
    made: list[object] = []
    try:
        made += map(_one, where)
    except YarpError:
        Series(made, place).close()
        raise
    return Series(made, place)


def _one(place: Place) -> object:
    # The oldest C++ versions say `script` for `type`.
    kind = place.text("type") or place.text("script") or "lua"
    file = place.text("file") or "modifier"
    if kind == _NATIVE:
        if file == "portmonitor":
            raise LocalProtocolError("a portmonitor cannot run portmonitor: name another monitor")
        return chain.make(file, place)
    language = _LANGUAGES.get(kind)
    if language is None:
        known = ", ".join((*_LANGUAGES, _NATIVE))
        raise LocalProtocolError(f'portmonitor has no type "{kind}"; use one of {known}')
    load, endings = language
    return PortMonitor(place, load(place), find_script(place, file, place.text("context"), endings))


class PortMonitor:
    """A running script. Raises LocalProtocolError if it does not start."""

    def __init__(self, place: Place, load: Load, path: Path) -> None:
        self._place = place
        self._load = load
        self._path = path
        self._lock = threading.RLock()  # messages, triggers and settings come from several threads
        self._told: set[str] = set()
        self._closed = False
        self._stuck = False  # a callback did not return in time
        self._constrained = not place.sending and place.source != place.target
        self._watch = Watch(path)
        self._script, self.control = self._start(place.text("constraint"))

    def _start(self, constraint: str) -> tuple[Script, Control]:
        control = Control(constraint, self._on_timer, str(self._place))
        try:
            script = self._load(self._path, read_script(self._path), control)
            if not script.create(self._options()):
                script.close()
                raise ScriptError(f"{self._path}: create did not return true")
        except BaseException:
            control.close()
            raise
        return script, control

    def _options(self) -> Property:
        """The arguments of `create`: those of C++, and all parameters that are not ours."""
        place = self._place
        found = Property()
        for token in place.tokens or place.shared:
            name, value = read_token(token)
            if name not in _OWN and name not in ("send", "recv"):
                words = parse_text(value, Bottle) if isinstance(value, str) else [value]
                found[name] = words[0] if len(words) == 1 else value
        found.update(
            filename=str(self._path),
            source=place.source,
            destination=place.target,
            sender_side=int(place.sending),
            receiver_side=int(not place.sending),
            carrier=place.carrier,
        )
        return found

    def _current(self) -> Script:
        """The script, loaded again if its file has changed. Call with the lock held."""
        if self._watch.changed():
            try:
                script, control = self._start(self._place.text("constraint"))
            except LocalProtocolError as error:
                self._complain(error, "the old script stays in use")
            else:
                log.info("%s: %s was loaded again", self._place, self._path)
                self._told.clear()
                self._end()
                self._script, self.control = script, control
        return self._script

    def _complain(self, error: Exception, consequence: str) -> None:
        text = f"{error}"
        if text not in self._told and len(self._told) < _MOST_TOLD:
            self._told.add(text)
            log.warning("%s: %s; %s", self._place, text, consequence)

    # -- what a chain calls -----------------------------------------------------------------------

    def accept(self, message: Message) -> bool:
        with self._lock:
            try:
                return self._current().accept(message)
            except ScriptError as error:
                self._complain(error, "messages are dropped")
                return False

    def update(self, message: Message) -> object:
        with self._lock:
            if self._constrained and not self.control.allows():
                return DROP
            try:
                return self._script.update(message)
            except ScriptError as error:
                self._complain(error, "messages pass as they are")
                return None

    def update_reply(self, message: Message) -> object:
        with self._lock:
            try:
                return self._current().update_reply(message)
            except ScriptError as error:
                self._complain(error, "replies pass as they are")
                return None

    def trigger(self) -> None:
        try:
            with self._holding():
                if not self._closed:
                    self._current().trigger()
        except ScriptError as error:
            self._complain(error, "the next trigger still comes")

    _on_timer = trigger

    def configure(self, parameters: Property) -> None:
        with self._holding():
            self._current().configure(parameters)

    def parameters(self) -> Mapping[str, Any]:
        with self._holding():
            return self._current().parameters()

    def state(self) -> dict[str, Any]:
        """Return the script that runs, and its constraint."""
        constraint = self.control.get_constraint()
        return {"script": str(self._path), **({"constraint": constraint} if constraint else {})}

    def close(self) -> None:
        try:
            with self._holding():
                if not self._closed:
                    self._closed = True
                    self._end()
        except ScriptError as error:
            self._closed = True
            log.warning("%s: %s; it is closed without it", self._place, error)
            self.control.close()

    @contextmanager
    def _holding(self) -> Iterator[None]:
        """Hold the script, for what is no message. Raises ScriptError if a callback does not
        return: no thread can be ended."""
        timeout = 0.0 if self._stuck else max(0.0, min(CALLBACK_TIMEOUT, scope.remaining()))
        if not self._lock.acquire(timeout=timeout):
            self._stuck = True
            raise ScriptError(f"{self._path}: a callback still runs, and nothing can end it")
        self._stuck = False
        try:
            yield
        finally:
            self._lock.release()

    def _end(self) -> None:
        """End the running script."""
        try:
            self._script.close()
        except ScriptError as error:
            self._complain(error, "it was ended anyway")
        self.control.close()


def _python(place: Place) -> Load:
    from yarpy.monitors.script.python import PythonScript

    return PythonScript


def _lua(place: Place) -> Load:
    from yarpy.monitors.script.lua import LuaScript, lupa

    lupa()  # before looking for the file, which is of no use without the library
    return partial(LuaScript, system=granted(SYSTEM))


_LANGUAGES: Final = {
    "lua": (_lua, ("", ".lua")),
    "python": (_python, ("", ".py")),
}
