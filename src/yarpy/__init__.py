"""yarpy: YARP in Python. Named ports, plug-in wire protocols, no lock-in.

    import yarpy

    with yarpy.Port("/listener") as port:
        for message in port:
            print(message.value)

Everything public is here; nothing is imported before it is used. A name stands here three times:
for people and type checkers in `__all__` and among the imports, for Python in `_WHERE`. Packages of
peers and kits are found in `shipped.py`. A test compares them.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

__version__ = "0.1.0"

__all__ = [
    "AccessRefused",
    "AddressError",
    "Bottle",
    "BufferedPort",
    "Connection",
    "ConnectionEvent",
    "ConnectionStats",
    "Contact",
    "DeadlineEvent",
    "DecodeError",
    "FlexImage",
    "Float32",
    "Image",
    "Int8",
    "Int16",
    "Int64",
    "LinkClosed",
    "LocalNames",
    "LocalProtocolError",
    "LoginRefused",
    "Matrix",
    "Message",
    "MissingFile",
    "Module",
    "NameClient",
    "NameServer",
    "NoNameServer",
    "NotAllowed",
    "Page",
    "PastStats",
    "PointCloud",
    "Port",
    "PortClosed",
    "PortStats",
    "Property",
    "Qos",
    "RemoteError",
    "RemoteProtocolError",
    "RemoteStats",
    "ResourceFinder",
    "RpcClient",
    "RpcServer",
    "Sound",
    "Stamp",
    "Timeout",
    "Totals",
    "Truncated",
    "UnknownName",
    "UnknownPlugin",
    "UnknownType",
    "Vector",
    "Vocab",
    "WrongPort",
    "YarpError",
    "YarpNameClient",
    "__version__",
    "admin",
    "connect",
    "disconnect",
    "exists",
    "from_json",
    "is_connected",
    "ping",
    "query",
    "realtime",
    "to_json",
    "wait_for",
]

if TYPE_CHECKING:
    # Modules, and not in `__all__`: some take what not everybody has installed.
    from yarpy import aio as aio
    from yarpy import clock as clock
    from yarpy import idl as idl
    from yarpy.carriers.web.http.page import Page
    from yarpy.contact import Contact
    from yarpy.data.bottle import Bottle, Property
    from yarpy.data.json import from_json, to_json
    from yarpy.data.sig.image import FlexImage, Image
    from yarpy.data.sig.matrix import Matrix
    from yarpy.data.sig.pointcloud import PointCloud
    from yarpy.data.sig.sound import Sound
    from yarpy.data.sig.vector import Vector
    from yarpy.data.stamp import Stamp
    from yarpy.data.value import Float32, Int8, Int16, Int64, Vocab
    from yarpy.errors import (
        AccessRefused,
        AddressError,
        DecodeError,
        LinkClosed,
        LocalProtocolError,
        LoginRefused,
        MissingFile,
        NoNameServer,
        NotAllowed,
        PortClosed,
        RemoteError,
        RemoteProtocolError,
        Timeout,
        Truncated,
        UnknownName,
        UnknownPlugin,
        UnknownType,
        WrongPort,
        YarpError,
    )
    from yarpy.kits import devices as devices
    from yarpy.kits import record as record
    from yarpy.kits import wrap as wrap
    from yarpy.module import Module
    from yarpy.names.base import NameClient
    from yarpy.names.client import YarpNameClient
    from yarpy.nameserver.local import LocalNames
    from yarpy.nameserver.server import NameServer
    from yarpy.network.asking import admin, ping, query
    from yarpy.network.connection import disconnect, exists, is_connected, wait_for
    from yarpy.network.remote import connect
    from yarpy.peers import ros as ros
    from yarpy.peers import ros2 as ros2
    from yarpy.peers import zenoh as zenoh
    from yarpy.port.connection import Connection, ConnectionEvent
    from yarpy.port.deadline import DeadlineEvent
    from yarpy.port.port import BufferedPort, Port
    from yarpy.port.rpc import RpcClient, RpcServer
    from yarpy.port.stats import ConnectionStats, PastStats, PortStats, RemoteStats, Totals
    from yarpy.qos import Qos
    from yarpy.real_time import realtime
    from yarpy.resource import ResourceFinder
    from yarpy.wire.message import Message
else:
    # Type checkers do not see the function below: with it every name would be right.
    _WHERE = {
        "Port": "yarpy.port.port",
        "BufferedPort": "yarpy.port.port",
        "RpcServer": "yarpy.port.rpc",
        "RpcClient": "yarpy.port.rpc",
        "Connection": "yarpy.port.connection",
        "ConnectionEvent": "yarpy.port.connection",
        "ConnectionStats": "yarpy.port.stats",
        "PastStats": "yarpy.port.stats",
        "PortStats": "yarpy.port.stats",
        "RemoteStats": "yarpy.port.stats",
        "Totals": "yarpy.port.stats",
        "Message": "yarpy.wire.message",
        "Module": "yarpy.module",
        "ResourceFinder": "yarpy.resource",
        "Page": "yarpy.carriers.web.http.page",
        "Contact": "yarpy.contact",
        "Qos": "yarpy.qos",
        "NameServer": "yarpy.nameserver.server",
        "LocalNames": "yarpy.nameserver.local",
        "NameClient": "yarpy.names.base",
        "YarpNameClient": "yarpy.names.client",
        "Bottle": "yarpy.data.bottle",
        "Property": "yarpy.data.bottle",
        "Vocab": "yarpy.data.value",
        "Int8": "yarpy.data.value",
        "Int16": "yarpy.data.value",
        "Int64": "yarpy.data.value",
        "Float32": "yarpy.data.value",
        "Stamp": "yarpy.data.stamp",
        "Vector": "yarpy.data.sig.vector",
        "Matrix": "yarpy.data.sig.matrix",
        "Image": "yarpy.data.sig.image",
        "FlexImage": "yarpy.data.sig.image",
        "Sound": "yarpy.data.sig.sound",
        "PointCloud": "yarpy.data.sig.pointcloud",
        "connect": "yarpy.network.remote",
        "disconnect": "yarpy.network.connection",
        "is_connected": "yarpy.network.connection",
        "exists": "yarpy.network.connection",
        "query": "yarpy.network.asking",
        "ping": "yarpy.network.asking",
        "wait_for": "yarpy.network.connection",
        "admin": "yarpy.network.asking",
        "realtime": "yarpy.real_time",
        "YarpError": "yarpy.errors",
        "AddressError": "yarpy.errors",
        "UnknownName": "yarpy.errors",
        "WrongPort": "yarpy.errors",
        "UnknownPlugin": "yarpy.errors",
        "UnknownType": "yarpy.errors",
        "MissingFile": "yarpy.errors",
        "NoNameServer": "yarpy.errors",
        "PortClosed": "yarpy.errors",
        "LinkClosed": "yarpy.errors",
        "Timeout": "yarpy.errors",
        "RemoteError": "yarpy.errors",
        "DecodeError": "yarpy.errors",
        "Truncated": "yarpy.errors",
        "LocalProtocolError": "yarpy.errors",
        "NotAllowed": "yarpy.errors",
        "RemoteProtocolError": "yarpy.errors",
        "AccessRefused": "yarpy.errors",
        "LoginRefused": "yarpy.errors",
        "DeadlineEvent": "yarpy.port.deadline",
        "to_json": "yarpy.data.json",
        "from_json": "yarpy.data.json",
    }
    _ROOMS = {
        "aio": "yarpy.aio",
        "clock": "yarpy.clock",
        "idl": "yarpy.idl",
    }

    def __getattr__(name):
        from importlib import import_module
        from os import path

        if name in _ROOMS:
            return import_module(_ROOMS[name])
        if name not in _WHERE:
            place = path.join(__path__[0], name)
            # What begins so is asked by programs, such as inspect; a part, by `from yarpy import`.
            if name.startswith("__") or path.exists(f"{place}.py") or path.exists(place):
                raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
            packages = import_module("yarpy.shipped").PACKAGES
            if name in packages:
                return import_module(packages[name].target)
            from difflib import get_close_matches

            near = get_close_matches(name, [*_WHERE, *_ROOMS, *packages], 1, 0.7)
            hint = import_module("yarpy.elsewhere").instead(name)
            if not hint and near:
                hint = f'did you mean "{near[0]}"?'
            hint = f": {hint}" if hint else ""
            raise AttributeError(f"module {__name__!r} has no attribute {name!r}{hint}")
        # The package first: a thread that begins with a part may get it half done.
        package, _, part = _WHERE[name].rpartition(".")
        import_module(package)
        value = getattr(import_module(f"{package}.{part}"), name)
        globals()[name] = value
        return value


def __dir__() -> list[str]:
    return sorted(__all__)
