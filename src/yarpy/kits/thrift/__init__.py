"""Interfaces of Thrift, as YARP uses them: structs, enums and services as Python classes.

    load, loads            a `.thrift` file, or its text, to a module
    Struct, Union, Error, Enum, Service    what the classes in it are made from
    i32, Float64s ...      what their annotations say
    describe               a service, a struct or an enum as plain data

Rules: a module that `yarpy idl thrift` has written needs nothing but what is here.
"""

from __future__ import annotations

from yarpy.kits.thrift.describe import describe
from yarpy.kits.thrift.key import frozen
from yarpy.kits.thrift.kind import (
    Bools,
    External,
    Float32s,
    Float64s,
    Int8s,
    Int16s,
    Int32s,
    Int64s,
    Nested,
    UInt8s,
    UInt16s,
    UInt32s,
    UInt64s,
    float32,
    i8,
    i16,
    i32,
    i64,
    size_t,
    ui8,
    ui16,
    ui32,
    ui64,
    vocab,
)
from yarpy.kits.thrift.library import load, loads
from yarpy.kits.thrift.method import method, oneway
from yarpy.kits.thrift.service import Service
from yarpy.kits.thrift.structure import Enum, Struct, new
from yarpy.kits.thrift.union import Error, Union

__all__ = [
    "Bools",
    "Enum",
    "Error",
    "External",
    "Float32s",
    "Float64s",
    "Int8s",
    "Int16s",
    "Int32s",
    "Int64s",
    "Nested",
    "Service",
    "Struct",
    "UInt8s",
    "UInt16s",
    "UInt32s",
    "UInt64s",
    "Union",
    "describe",
    "float32",
    "frozen",
    "i8",
    "i16",
    "i32",
    "i64",
    "load",
    "loads",
    "method",
    "new",
    "oneway",
    "size_t",
    "ui8",
    "ui16",
    "ui32",
    "ui64",
    "vocab",
]
