"""What both controllers' clients have in common: versions, checks, events."""

import pytest

from yarpy.data.bottle import Bottle
from yarpy.data.value import Vocab
from yarpy.errors import LocalProtocolError, RemoteProtocolError
from yarpy.kits.devices import CartesianController
from yarpy.kits.devices.controllers.client import numbers, wait_until_done
from yarpy.port.rpc import RpcServer


def test_numbers_are_counted():
    assert numbers((1, 2), 2, "a pixel") == [1.0, 2.0]
    with pytest.raises(ValueError, match="a pixel has 2 numbers, not 1"):
        numbers((1,), 2, "a pixel")


def test_waiting_ends():
    answers = iter((False, False, True))
    assert wait_until_done(lambda: next(answers), 0.0, 0.0)
    assert not wait_until_done(lambda: False, 0.0, 0.001)


def test_another_version_is_refused(names):
    info = Bottle([Bottle(["server_version", "3.0"])])
    with (
        RpcServer("/new/rpc:i", lambda message: Bottle([Vocab("ack"), info]), names=names),
        pytest.raises(RemoteProtocolError, match=r"speaks version 3\.0, not 2\.0"),
    ):
        CartesianController("/new", names=names)


def test_who_answers_nothing_is_refused(names):
    with (
        RpcServer("/odd/rpc:i", lambda message: Bottle(), names=names),
        pytest.raises(LocalProtocolError, match="refuses"),
    ):
        CartesianController("/odd", names=names)
