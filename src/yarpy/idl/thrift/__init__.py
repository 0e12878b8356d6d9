"""Interfaces of Thrift, as YARP uses them: structs, enums and services as Python classes.

    load, loads            a `.thrift` file, or its text, to a module
    Struct, Enum, Service  what the classes in it are made from
    i32, Float64s ...      what their annotations say

Rules: a module that `yarpy idl thrift` has written needs nothing but what is here.
"""

from __future__ import annotations

from yarpy.idl.thrift.kind import (
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
from yarpy.idl.thrift.library import load, loads
from yarpy.idl.thrift.method import method, oneway
from yarpy.idl.thrift.service import Service
from yarpy.idl.thrift.structure import Enum, Struct, new

__all__ = [
    "Bools",
    "Enum",
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
    "float32",
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
