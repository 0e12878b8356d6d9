"""Property: values by name.

Rules: it wraps a yarpy.Property. Groups that `addGroup` made stay in it as they are filled.
"""

from __future__ import annotations

import shlex
from collections.abc import Sequence
from typing import Any, Self

import yarpy
from yarp._portable import Portable
from yarp._searchable import Searchable
from yarp._value import MISSING, Value, copied, number, parsed, text
from yarpy.config.command_line import parse_options
from yarpy.config.ini import parse_ini, read_ini
from yarpy.data.text import plain_text


class Property(Portable, Searchable):
    """Named values. `Property("(device grabber) (width 320)")` reads text."""

    _values: yarpy.Property
    _groups: dict[str, Property]

    def __init__(self, txt: str | Property | int = "") -> None:
        self._groups = {}
        if isinstance(txt, Property):
            self._values = copied(txt._native)
        else:
            self._values = yarpy.Property()
            if txt and not isinstance(txt, int):
                self.fromString(txt)

    @classmethod
    def _of(cls, native: Any) -> Self:
        self = cls.__new__(cls)
        self._groups = {}
        self._values = native
        return self

    @property
    def _native(self) -> yarpy.Property:
        for key, group in self._groups.items():
            inner = yarpy.Bottle(group._native.group(name) for name in sorted(group._native))
            self._values.update(yarpy.Property.from_bottle([yarpy.Bottle([key, *inner])]))
        return self._values

    def _outgoing(self) -> Any:
        return self._native

    def _take(self, message: yarpy.Message) -> None:
        self._become(message.as_(yarpy.Property))

    def _become(self, values: yarpy.Property, wipe: bool = True) -> None:
        if wipe:
            self.clear()
        self._values.update(values)

    def _find(self, key: str) -> Any:
        values = self._native
        if key not in values:
            return MISSING
        found = values[key]
        return MISSING if found is None else found

    def _group(self, key: str) -> yarpy.Bottle | None:
        return self._native.group(key)

    def put(self, key: str, value: Any) -> None:
        """Set a value: a string, a number or a Value."""
        self._groups.pop(key, None)
        if isinstance(value, Value):
            self._values[text(key)] = copied(value._native)
        elif isinstance(value, str):
            self._values[text(key)] = value
        elif hasattr(value, "__index__") and -(1 << 31) <= value.__index__() < 1 << 31:
            self._values[text(key)] = int(value)
        else:
            self._values[text(key)] = number(value)

    def unput(self, key: str) -> None:
        """Remove a key."""
        self._groups.pop(key, None)
        self._values.pop(key, None)

    def addGroup(self, key: str) -> Property:
        """An empty group under a key, to be filled."""
        self._groups[text(key)] = Property()
        return self._groups[key]

    def clear(self) -> None:
        """Remove everything."""
        self._groups.clear()
        self._values.clear()

    def toString(self) -> str:
        """YARP's notation, sorted by key."""
        return self._native.to_text()

    def __repr__(self) -> str:
        return f"<yarp.Property {self.toString()}>"

    def fromString(self, txt: str, wipe: bool = True) -> None:
        """Read `(key value) (key value)`."""
        self._become(yarpy.Property.from_bottle(parsed(txt)), wipe)

    def fromCommand(self, argc: Sequence[str], skipFirst: bool = True, wipe: bool = True) -> None:
        """Read a command line, such as `sys.argv`."""
        if isinstance(argc, str | int):
            raise TypeError(f"a command line is a list of words, not {argc!r}")
        self._become(parse_options(argc[1:] if skipFirst else argc), wipe)

    def fromArguments(self, arguments: str, wipe: bool = True) -> None:
        """Read a command line in one string."""
        try:
            words = shlex.split(arguments)
        except ValueError:  # a quote that does not end
            words = arguments.split()
        self._become(parse_options(words), wipe)

    def fromConfig(self, txt: str, env: Any = None, wipe: bool = True) -> None:
        """Read the text of a configuration file."""
        env, wipe = _arguments(env, wipe)
        self._become(parse_ini(txt, None, env), wipe)

    def fromConfigFile(self, fname: str, env: Any = None, wipe: bool = True) -> bool:
        """Read a configuration file; False if it is not there."""
        env, wipe = _arguments(env, wipe)
        try:
            found = read_ini(fname, None, env)
        except OSError:
            from yarp._log import say

            say("ERROR", f"|yarp.os.Property| cannot read from {fname}")
            return False
        self._become(found, wipe)
        return True

    def fromConfigDir(self, dirname: str, section: str = "", wipe: bool = True) -> bool:
        """Read all configuration files of a directory."""
        return self.fromConfigFile(dirname, wipe)

    def fromQuery(self, url: str, wipe: bool = True) -> None:
        """Read the arguments of a URL."""
        from urllib.parse import parse_qsl, urlsplit

        pairs = parse_qsl(urlsplit(url).query, keep_blank_values=True)
        found = yarpy.Property()
        for key, value in pairs:
            found[key] = Value.makeValue(value)._native
        self._become(found, wipe)


def _arguments(env: Any, wipe: bool) -> tuple[dict[str, Any], bool]:
    """`env` and `wipe` of the overloads: the second argument is either."""
    if isinstance(env, bool):
        return {}, env
    native = {} if env is None else env._native
    if isinstance(native, dict):
        return {key: plain_text(value) for key, value in native.items()}, wipe
    return {}, wipe
