"""Variables of the environment, and the directories that they name: `yarp.yarpdatahome()` ...

Rules: the names and defaults are those of C++ on Linux (the XDG base directories).
"""

from __future__ import annotations

import os
from typing import Any

from yarp._numbers import SVector, store

path_separator = os.pathsep


def get_string(key: str, *more: Any) -> str:
    """Return a variable. `(key)`, `(key, default)`, `(key, other key, default, what follows it)`;
    with a BVector as the second, whether it is set is stored there."""
    found = os.environ.get(key)
    if more and not isinstance(more[0], str):
        store(more[0], [found is not None])
        more = ()
    if found is not None:
        return found
    if len(more) < 2:
        return str(more[0]) if more else ""
    behind = str(more[2]) if len(more) > 2 else ""
    return os.environ.get(more[0], str(more[1])) + behind


def get_path(key: str, *more: Any) -> SVector:
    """Return the directories of a variable, by the arguments of `get_string`."""
    if len(more) > 2 and key not in os.environ:
        return SVector([each + more[2] for each in _split(os.environ.get(more[0], more[1]))])
    return SVector(_split(get_string(key, *more[:2])))


def _split(path: str) -> list[str]:
    return path.split(path_separator) if path else []


def get_bool(key: str, defaultValue: bool = False) -> bool:
    """Return a variable that says 1 or 0, true or false; the default if it says neither."""
    words = {"true": True, "True": True, "TRUE": True, "on": True, "1": True}
    words |= {"false": False, "False": False, "FALSE": False, "off": False, "0": False}
    return words.get(os.environ.get(key, ""), defaultValue)


def is_set(key: str) -> bool:
    """Return whether there is such a variable."""
    return key in os.environ


def set_string(key: str, value: str) -> bool:
    """Set a variable; False if it cannot have this name or value."""
    try:
        os.environ[key] = value
    except (OSError, ValueError):
        return False
    return True


def set_path(key: str, value: Any) -> bool:
    """Set a variable to directories."""
    return set_string(key, path_separator.join(value))


def set_bool(key: str, value: bool) -> bool:
    """Set a variable to 1 or 0."""
    return set_string(key, "1" if value else "0")


def unset(key: str) -> bool:
    """Remove a variable, if it is there."""
    os.environ.pop(key, None)
    return True


getEnvironment = get_string


def setEnvironment(key: str, value: str) -> None:
    set_string(key, value)


def unsetEnvironment(key: str) -> None:
    unset(key)


def home() -> str:
    """The directory of this user."""
    return get_string("HOME")


def tempdir() -> str:
    return get_string("TMPDIR", "/tmp")


def datahome() -> str:
    return get_string("XDG_DATA_HOME", f"{home()}/.local/share")


def datadirs() -> SVector:
    return get_path("XDG_DATA_DIRS", "/usr/local/share:/usr/share")


def confighome() -> str:
    return get_string("XDG_CONFIG_HOME", f"{home()}/.config")


def configdirs() -> SVector:
    return get_path("XDG_CONFIG_DIRS", "/etc/xdg")


def cachehome() -> str:
    return get_string("XDG_CACHE_HOME", f"{home()}/.cache")


def runtimedir() -> str:
    return get_string("XDG_RUNTIME_DIR", f"{tempdir()}/runtime-{get_string('USER')}")


def yarpdatahome() -> str:
    """Where data of this user are."""
    return get_string("YARP_DATA_HOME", "XDG_DATA_HOME", f"{home()}/.local/share", "/yarp")


def yarpdatadirs() -> SVector:
    """Where data for everybody are."""
    return get_path("YARP_DATA_DIRS", "XDG_DATA_DIRS", "/usr/local/share:/usr/share", "/yarp")


def yarpconfighome() -> str:
    """Where configuration files of this user are."""
    return get_string("YARP_CONFIG_HOME", "XDG_CONFIG_HOME", f"{home()}/.config", "/yarp")


def yarpconfigdirs() -> SVector:
    """Where configuration files for everybody are."""
    return get_path("YARP_CONFIG_DIRS", "XDG_CONFIG_DIRS", "/etc/xdg", "/yarp")


def yarpcachehome() -> str:
    return get_string("YARP_CACHE_HOME", "XDG_CACHE_HOME", f"{home()}/.cache", "/yarp")


def yarpruntimedir() -> str:
    behind = f"{tempdir()}/runtime-{get_string('USER')}"
    return get_string("YARP_RUNTIME_DIR", "XDG_RUNTIME_DIR", behind, "/yarp")
