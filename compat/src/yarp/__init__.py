"""`import yarp` without C++: the names of YARP's own Python bindings, on top of yarpy.

Rules: spelling only. Nothing is imported before it is used, no thread is started by the import, so
a program may fork afterwards. A name that is not here says so, and what to do.
"""

from __future__ import annotations

from importlib import import_module
from typing import Any

from yarp._table import CLASSES, WHERE

YARP_VERSION = "3.9.1"
YARP_VERSION_SHORT = "3.9.1"
YARP_VERSION_MAJOR = 3
YARP_VERSION_MINOR = 9
YARP_VERSION_PATCH = 1
YARP_VERSION_HEX = 0x30901


def __getattr__(name: str) -> Any:
    module = WHERE.get(name)
    if module is not None:
        value = getattr(import_module(f"yarp.{module}"), name)
    elif name.startswith("__"):
        raise AttributeError(f"module 'yarp' has no attribute {name!r}")
    else:
        value = _constant(name)
        if value is None:
            value = _flat(name)
        if value is None:
            raise AttributeError(_missing(name))
    globals()[name] = value
    return value


def _constant(name: str) -> int | None:
    from yarp._constants import CONSTANTS

    return CONSTANTS.get(name)


def _flat(name: str) -> Any:
    """`Network_connect` is `Network.connect`."""
    owner, _, member = name.partition("_")
    if not member or owner not in CLASSES:
        return None
    return getattr(__getattr__(owner), member, None)


def _missing(name: str) -> str:
    from difflib import get_close_matches

    known = [*WHERE]
    near = get_close_matches(name, known, n=3, cutoff=0.7)
    owner, _, member = name.partition("_")
    if member and owner in CLASSES:  # a flat alias; Python itself suggests members of classes
        members = get_close_matches(member, dir(__getattr__(owner)), n=3, cutoff=0.7)
        near = [f"{owner}_{each}" for each in members]
    hint = f"; did you mean {' or '.join(near)}?" if near else ""
    return (
        f"module 'yarp' has no attribute {name!r}{hint} "
        "(newer bindings of C++ YARP may have it; this is yarpy-compat, which offers "
        f"{len(known)} names: see its README for the table, and open an issue of yarpy if you need "
        "this one)"
    )


def __dir__() -> list[str]:
    from yarp._constants import CONSTANTS

    return sorted({*globals(), *WHERE, *CONSTANTS})
