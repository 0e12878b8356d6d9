"""yarpy: YARP in Python. Named ports, plug-in wire protocols, no lock-in.

    import yarpy

    with yarpy.Port("/listener") as port:
        for message in port:
            print(message.value)

Everything public is here; nothing is imported before it is used.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

__version__ = "0.1.0"

_WHERE = {
    "Port": "yarpy.port.port",
    "BufferedPort": "yarpy.port.port",
    "RpcServer": "yarpy.port.rpc",
    "RpcClient": "yarpy.port.rpc",
    "Connection": "yarpy.port.connection",
    "ConnectionEvent": "yarpy.port.connection",
    "Message": "yarpy.wire.message",
    "Module": "yarpy.module",
    "ResourceFinder": "yarpy.resource",
    "Page": "yarpy.carriers.http.page",
    "Contact": "yarpy.contact",
    "Qos": "yarpy.qos",
    "NameServer": "yarpy.nameserver.server",
    "LocalNames": "yarpy.nameserver.local",
    "NameClient": "yarpy.names.base",
    "YarpNameClient": "yarpy.names.client",
    "ZenohNames": "yarpy.names.zenoh",
    "Bottle": "yarpy.data.bottle",
    "Property": "yarpy.data.bottle",
    "Vocab": "yarpy.data.value",
    "Int8": "yarpy.data.value",
    "Int16": "yarpy.data.value",
    "Int64": "yarpy.data.value",
    "Float32": "yarpy.data.value",
    "Stamp": "yarpy.data.stamp",
    "Vector": "yarpy.data.vector",
    "Matrix": "yarpy.data.matrix",
    "Image": "yarpy.data.image",
    "FlexImage": "yarpy.data.image",
    "Sound": "yarpy.data.sound",
    "PointCloud": "yarpy.data.pointcloud",
    "connect": "yarpy.network.remote",
    "disconnect": "yarpy.network.connection",
    "is_connected": "yarpy.network.connection",
    "exists": "yarpy.network.connection",
    "query": "yarpy.network.connection",
    "ping": "yarpy.network.connection",
    "wait_for": "yarpy.network.connection",
    "admin": "yarpy.network.connection",
    "realtime": "yarpy.realtime",
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
}

__all__ = ["__version__", *_WHERE]

if TYPE_CHECKING:
    from yarpy.carriers.http.page import Page as Page
    from yarpy.contact import Contact as Contact
    from yarpy.data.bottle import Bottle as Bottle
    from yarpy.data.bottle import Property as Property
    from yarpy.data.image import FlexImage as FlexImage
    from yarpy.data.image import Image as Image
    from yarpy.data.matrix import Matrix as Matrix
    from yarpy.data.pointcloud import PointCloud as PointCloud
    from yarpy.data.sound import Sound as Sound
    from yarpy.data.stamp import Stamp as Stamp
    from yarpy.data.value import Float32 as Float32
    from yarpy.data.value import Int8 as Int8
    from yarpy.data.value import Int16 as Int16
    from yarpy.data.value import Int64 as Int64
    from yarpy.data.value import Vocab as Vocab
    from yarpy.data.vector import Vector as Vector
    from yarpy.errors import AccessRefused as AccessRefused
    from yarpy.errors import AddressError as AddressError
    from yarpy.errors import DecodeError as DecodeError
    from yarpy.errors import LinkClosed as LinkClosed
    from yarpy.errors import LocalProtocolError as LocalProtocolError
    from yarpy.errors import LoginRefused as LoginRefused
    from yarpy.errors import MissingFile as MissingFile
    from yarpy.errors import NoNameServer as NoNameServer
    from yarpy.errors import NotAllowed as NotAllowed
    from yarpy.errors import PortClosed as PortClosed
    from yarpy.errors import RemoteError as RemoteError
    from yarpy.errors import RemoteProtocolError as RemoteProtocolError
    from yarpy.errors import Timeout as Timeout
    from yarpy.errors import Truncated as Truncated
    from yarpy.errors import UnknownName as UnknownName
    from yarpy.errors import UnknownPlugin as UnknownPlugin
    from yarpy.errors import UnknownType as UnknownType
    from yarpy.errors import WrongPort as WrongPort
    from yarpy.errors import YarpError as YarpError
    from yarpy.module import Module as Module
    from yarpy.names.base import NameClient as NameClient
    from yarpy.names.client import YarpNameClient as YarpNameClient
    from yarpy.names.zenoh import ZenohNames as ZenohNames
    from yarpy.nameserver.local import LocalNames as LocalNames
    from yarpy.nameserver.server import NameServer as NameServer
    from yarpy.network.connection import admin as admin
    from yarpy.network.connection import disconnect as disconnect
    from yarpy.network.connection import exists as exists
    from yarpy.network.connection import is_connected as is_connected
    from yarpy.network.connection import ping as ping
    from yarpy.network.connection import query as query
    from yarpy.network.connection import wait_for as wait_for
    from yarpy.network.remote import connect as connect
    from yarpy.port.connection import Connection as Connection
    from yarpy.port.connection import ConnectionEvent as ConnectionEvent
    from yarpy.port.port import BufferedPort as BufferedPort
    from yarpy.port.port import Port as Port
    from yarpy.port.rpc import RpcClient as RpcClient
    from yarpy.port.rpc import RpcServer as RpcServer
    from yarpy.qos import Qos as Qos
    from yarpy.realtime import realtime as realtime
    from yarpy.resource import ResourceFinder as ResourceFinder
    from yarpy.wire.message import Message as Message


def __getattr__(name: str) -> Any:
    module = _WHERE.get(name)
    if module is None:
        if name in ("aio", "devices", "idl", "ros", "wrap"):
            from importlib import import_module

            return import_module(f"yarpy.{name}")
        raise AttributeError(f"module 'yarpy' has no attribute {name!r}")
    from importlib import import_module

    value = getattr(import_module(module), name)
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    return sorted(__all__)
