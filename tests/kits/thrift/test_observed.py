"""Requests of Thrift as those see them who watch a connection."""

from types import ModuleType

import pytest
from support.thrift import CALLS

from yarpy.data.bottle import Bottle
from yarpy.kits.thrift.observed import Interface


def test_recorded_requests(capt: ModuleType) -> None:
    interface = Interface(capt)
    request = bytes.fromhex(CALLS["tcp_get_long_method_name"]["request"])
    assert interface.request(request) == ("Capt", "get_long_method_name", [10, "abc"])
    request = bytes.fromhex(CALLS["raw_underscored_name"]["request"])
    assert interface.request(request) == ("Capt", "get_long_method_name", [10, "abc"])
    assert interface.request(bytes.fromhex(CALLS["tcp_nothing"]["request"])) == (
        "Capt",
        "nothing",
        [],
    )


@pytest.mark.parametrize("items", [[], [1], ["unknown", 1], ["a"] * 100, [["add"]]])
def test_others(items: list[object], capt: ModuleType) -> None:
    assert Interface(capt).request(Bottle(items).to_bytes()) is None
    assert Interface(capt).request(b"rubbish") is None
