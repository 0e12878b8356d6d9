"""Calls and answers between the carrier and a service."""

import pickle

import pytest
from support.thrift_module import SPELLINGS, apache, call, returned

from yarpy.data.bottle import Bottle
from yarpy.errors import DecodeError
from yarpy.kits.thrift.apache import message
from yarpy.kits.thrift.apache.protocol import EXCEPTION
from yarpy.wire.message import CALL, DATA


@pytest.mark.parametrize("spelling", SPELLINGS)
def test_a_call_is_read_by_a_service_alone(spelling: str) -> None:
    found = call("add", spelling)
    assert found.key == CALL and call("fire", spelling).key == DATA
    for read in (lambda: found.value, found.to_bytes, lambda: found.as_(Bottle)):
        with pytest.raises(DecodeError, match='a call of "add" in a protocol of Apache Thrift'):
            read()
    found.request = lambda: bytes(apache().Test._methods["add"].ask(1, -2))
    assert found.value == ["add", 1, -2] and found.as_(Bottle) == ["add", 1, -2]
    copy = pickle.loads(pickle.dumps(found))
    assert (copy.head, copy.thrift, copy.at) == (found.head, spelling, found.at)


@pytest.mark.parametrize("spelling", SPELLINGS)
def test_a_fault_there_and_back(spelling: str) -> None:
    fault = message.fault_of(returned("unknown", spelling))
    assert (fault.kind, fault.text) == (1, "no method")
    answer = message.faulty(spelling, 1, "no method")
    found = returned("unknown", spelling)
    assert answer.kind == EXCEPTION and answer.body == found.natural()
    assert Bottle.from_bytes(b"".join(answer.to_wire())) == ["fail", "no method"]


def test_a_call_leaves_over_its_carrier_alone() -> None:
    with pytest.raises(TypeError, match="over the carrier thrift alone"):
        message.Asked("binary", 1, "add", b"").to_wire()
    assert Bottle.from_bytes(b"".join(message.NOTHING.to_wire())) == []
