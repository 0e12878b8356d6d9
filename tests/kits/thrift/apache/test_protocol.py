"""Sorts of values, and faults."""

import pytest
from support.thrift_module import apache

from yarpy.errors import RemoteProtocolError
from yarpy.kits.thrift import kind as kinds
from yarpy.kits.thrift.apache import protocol


def test_each_kind_has_its_sort() -> None:
    m = apache()
    found = {spec.name: protocol.sort_of(spec.kind) for spec in m.All._specs()}
    assert [found[name] for name in "abcdefgh"] == [2, 3, 6, 8, 10, 4, 11, 11]
    assert [found[name] for name in "ijklm"] == [15, 14, 13, 8, 12]
    assert protocol.sort_of(kinds.UI16) == protocol.I16
    assert protocol.sort_of(kinds.FLOAT) == protocol.DOUBLE


def test_a_type_of_yarp_has_none() -> None:
    with pytest.raises(TypeError, match="yarp::sig::Vector is a type of YARP"):
        protocol.sort_of(kinds.External("yarp::sig::Vector"))


def test_a_fault_is_an_error_of_the_other_side() -> None:
    fault = protocol.Fault(protocol.UNKNOWN_METHOD, "no method")
    assert isinstance(fault, RemoteProtocolError)
    assert (fault.kind, fault.text, str(fault)) == (1, "no method", "no method")
