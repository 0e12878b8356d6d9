"""Types of other systems: their languages are read, their values are Python objects.

    load("camera.thrift")     the classes of a file, or of a type that is known by its name
    thrift.describe(Camera)   the module of a language: what else it can do

Rules: the languages are plug-ins (registry kind `idls`, the entry point group `yarpy.idls`), by the
ending of their files. Each has a module, whose function `load` is the plug-in.
"""

from __future__ import annotations

import os
from typing import TYPE_CHECKING, Any, Final

from yarpy import registry
from yarpy.errors import UnknownType

_BY_NAME: Final = "name"  # the plug-in for types without a file


def load(what: str | os.PathLike[str]) -> Any:
    """Return the type that `what` names: "sensor_msgs/JointState", a file "msgs/robot/msg/Arm.msg",
    or the module of a file "camera.thrift".

    A message is a class, a service (`.srv`) has two: `Request` and `Response`. Names are looked
    for in the packages of ROS_PACKAGE_PATH and of an installed ROS, then among those that the
    package rosbags brings. Raises UnknownType (nobody has it), DecodeError (a definition that is
    wrong), OSError (no such file), UnknownPlugin (a library that this takes is missing).
    """
    ending = os.path.splitext(os.fspath(what))[1].removeprefix(".")
    known = registry.idls.names()
    if ending not in known and os.path.isfile(what):
        endings = ", ".join(f".{one}" for one in known if one != _BY_NAME)
        raise UnknownType(
            f"no plug-in reads .{ending} files: known are {endings}; others come with a package "
            "that has the entry point group yarpy.idls"
        )
    language = ending if ending in known else _BY_NAME
    if language not in known:
        raise UnknownType(f'nobody knows the type "{os.fspath(what)}": no plug-in has its language')
    return registry.idls.load(language)(what)


if not TYPE_CHECKING:  # type checkers do not see it: with it every name would be right

    def __getattr__(name):
        from importlib import import_module

        if name.startswith("_") or name not in registry.idls.names():
            raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
        found = import_module(registry.idls.load(name).__module__)
        return import_module(found.__package__ or found.__name__)
