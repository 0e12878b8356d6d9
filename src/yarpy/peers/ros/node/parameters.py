"""The parameters of a node: those of the master, asked each time, or kept until they change.

    node.set_param("~gain", 1.5)
    node.get_param_cached("/camera/rate", 30)              # no question, while nobody changes it
    node.subscribe_param("/camera/rate", lambda rate: print("now", rate))

Rules: the master tells a node which parameter has changed, but not who sets it itself. What it
tells is no more than the reason to ask again, for the next reader or for the callbacks: so values
are always those of an answer, and nobody but the master can set one here. Callbacks have a thread
of their own, begun with the first.
"""

from __future__ import annotations

import threading
from collections.abc import Callable
from typing import Any, Final

from yarpy.errors import LocalProtocolError, UnknownName, YarpError
from yarpy.log import log_failure, logger
from yarpy.monitors.base import FAILURES
from yarpy.peers.ros.master import RosMaster

log = logger("yarpy.ros")

UNSET: Final = object()  # what is kept of a parameter that there is not
Told = Callable[[Any], object]


class Followed:
    """The parameters of the master that a node is told of. `uri` is the address of the node."""

    def __init__(self, node: str, master: RosMaster, uri: str) -> None:
        self._node, self._master, self._uri = node, master, uri
        self._keys: set[str] = set()  # the master knows that we want to hear of them
        self._values: dict[str, Any] = {}  # of those that have not changed since they were asked
        self._callbacks: list[tuple[str, Told, list[Any]]] = []  # with what each was told last
        self._changes = 0
        self._changed = threading.Event()
        self._ended = False
        self._lock = threading.Lock()

    def __bool__(self) -> bool:
        return bool(self._keys)

    def get(self, key: str) -> Any:
        """The value, UNSET if there is none. Raises as `RosMaster.call`."""
        with self._lock:
            if key in self._values:
                return self._values[key]
            changes = self._changes
            self._keys.add(key)
        found = self._master.call("subscribeParam", self._node, self._uri, key)
        value = UNSET if found == {} else found
        with self._lock:
            if changes == self._changes:  # else it may be old already
                self._values[key] = value
        return value

    def tell(self, key: str, callback: Told) -> None:
        """Call back with the value, None if there is none, now and after each change."""
        with self._lock:
            self._callbacks.append((key, callback, []))
            if len(self._callbacks) == 1:
                name = f"yarpy parameters {self._node}"
                threading.Thread(target=self._run, name=name, daemon=True).start()
        self._changed.set()

    def change(self, key: str) -> bool:
        """A parameter, and so whatever is above and below it, has another value. Return whether any
        of these is followed."""
        changed = _parts(key)
        with self._lock:
            self._changes += 1
            found = [
                each
                for each in self._keys
                for own in (_parts(each),)
                if own[: len(changed)] == changed[: len(own)]
            ]
            for each in found:
                self._values.pop(each, None)
        if found:
            self._changed.set()
        return bool(found)

    def forget(self) -> None:
        """Forget all values: there is another master, or the same one has been away."""
        self.change("/")

    def end(self) -> None:
        """Tell the master that nothing is followed any more; one that does not answer is told no
        more, since each question may take its whole time."""
        self._ended = True
        self._changed.set()
        for key in tuple(self._keys):
            try:
                self._master.call("unsubscribeParam", self._node, self._uri, key, timeout=2.0)
            except YarpError as error:
                log.info("%s: its parameters stay subscribed: %s", self._node, error)
                return

    def _run(self) -> None:
        while True:
            self._changed.wait()
            self._changed.clear()
            for key, callback, last in [*self._callbacks]:
                if self._ended:
                    return
                try:
                    value = self.get(key)
                except YarpError as error:  # the node asks for the master, and begins anew here
                    log.info("%s: what %s is now cannot be asked: %s", self._node, key, error)
                    continue
                if last != [value]:
                    last[:] = [value]
                    try:
                        callback(None if value is UNSET else value)
                    except FAILURES as error:
                        log_failure(log, error, "%s: the callback of %s failed", self._node, key)


def _parts(key: str) -> list[str]:
    return [part for part in key.split("/") if part]


class Parameters:
    """The part of a node that knows its parameters."""

    name: str
    master: RosMaster

    def resolve(self, name: str) -> str:
        """The full name."""
        raise NotImplementedError

    @property
    def _followed(self) -> Followed:
        raise NotImplementedError

    def get_param(self, name: str, default: Any = UNSET) -> Any:
        """A parameter, or all below a name as a dict. Without a default, LookupError (UnknownName)
        if there is none."""
        try:
            return self.master.call("getParam", self.name, self.resolve(name))
        except LocalProtocolError as error:
            if default is not UNSET:
                return default
            raise UnknownName(str(error)) from error

    def get_param_cached(self, name: str, default: Any = UNSET) -> Any:
        """As `get_param`, but the master is asked only once, and after each change, of which it
        tells the node. An empty dict counts as none. Do not change what is returned."""
        value = self._followed.get(self.resolve(name))
        if value is UNSET and default is UNSET:
            raise UnknownName(f"no parameter {self.resolve(name)} at {self.master.uri}")
        return default if value is UNSET else value

    def subscribe_param(self, name: str, callback: Told) -> None:
        """Call `callback(value)` soon, and each time the parameter, or anything below it, has
        changed; None while there is none. Of changes that follow each other quickly it may see the
        last alone."""
        self._followed.tell(self.resolve(name), callback)

    def set_param(self, name: str, value: Any) -> None:
        """Set a parameter: bool, int of 32 bits, float, str, list, or a dict of them."""
        key = self.resolve(name)
        self.master.call("setParam", self.name, key, value)
        self._followed.change(key)  # the master tells the others

    def has_param(self, name: str) -> bool:
        """Return whether there is such a parameter."""
        return bool(self.master.call("hasParam", self.name, self.resolve(name)))

    def delete_param(self, name: str) -> None:
        """Delete a parameter. LookupError (UnknownName) if there is none."""
        key = self.resolve(name)
        try:
            self.master.call("deleteParam", self.name, key)
        except LocalProtocolError as error:
            raise UnknownName(str(error)) from error
        self._followed.change(key)
