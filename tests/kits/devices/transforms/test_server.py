"""The store on ports: the bytes of several versions."""

import pytest
from support.wait import HANG

import yarpy
from yarpy.data.bottle import Bottle
from yarpy.data.value import Int8, Vocab
from yarpy.data.yarp4 import is_yarp4
from yarpy.kits.devices.transforms.functions import (
    FrameTransformStorageGetRPC,
    FrameTransformStorageSetRPC,
    Transform,
)
from yarpy.kits.devices.transforms.server import TransformServer, plain
from yarpy.kits.thrift.client import client_class

SET = "/frameTransformServer/frameTransformSet_nws_yarp/thrift"
GET = "/frameTransformServer/frameTransformGet_nws_yarp/thrift"
STREAM = "/frameTransformServer/frameTransformGet_nws_yarp/tf:o"
CAMERA = [*("base", "cam"), 5.0, Int8(1), *(1.0, 2.0, 3.0), *(0.0, 0.0, 0.0, 1.0)]


@pytest.fixture
def server(names):
    with TransformServer(period=0.01, names=names) as server:
        yield server


def test_as_3_9_has_it(server, names):
    """The spelling that was recorded of frameTransformServer 3.9.1."""
    with (
        yarpy.RpcClient(SET, names=names) as put,
        yarpy.RpcClient(GET, names=names) as get,
        yarpy.BufferedPort("/me", names=names) as port,
    ):
        assert put.call(Bottle(["setTransformRPC", CAMERA]), timeout=HANG) == "ok"
        answer = get.call(Bottle(["getTransformsRPC"]), timeout=HANG)
        assert answer.to_text() == "[ok] ((base cam 5.0 1 1.0 2.0 3.0 0.0 0.0 0.0 1.0))"
        assert type(answer[1][0][3]) is Int8
        port.listen_to(STREAM)
        assert port.read(HANG).value == answer
        nothing = Bottle(["deleteTransformRPC", "base", "nobody"])
        assert put.call(nothing, timeout=HANG) == "err5"
        assert put.call(Bottle(["deleteTransformRPC", "base", "cam"]), timeout=HANG) == "ok"
        assert get.call(Bottle(["getTransformsRPC"]), timeout=HANG) == [Vocab("ok"), []]
        # The client of C++ names the frame first; a star is any.
        for first, second in (("cam", "base"), ("base", "*"), ("*", "cam"), ("*", "*")):
            assert put.call(Bottle(["setTransformRPC", CAMERA]), timeout=HANG) == "ok"
            question = Bottle(["deleteTransformRPC", first, second])
            assert put.call(question, timeout=HANG) == "ok"
            assert get.call(Bottle(["getTransformsRPC"]), timeout=HANG) == [Vocab("ok"), []]
        assert put.call(Bottle(["setTransformRPC", CAMERA[:5]]), timeout=HANG)[0] == "fail"


def test_as_4_has_it(server, names, monkeypatch):
    monkeypatch.setattr("yarpy.port.port.MessagePort._is_yarp4", lambda port, target: True)
    with (
        yarpy.RpcClient(SET, names=names) as put,
        yarpy.RpcClient(GET, name="/get/thrift", names=names) as get,
        yarpy.BufferedPort("/get/tf:i", names=names) as port,
    ):
        setter = client_class(FrameTransformStorageSetRPC)(put, HANG)
        assert setter.setTransformsRPC([Transform("base", "cam", 5.0, 1)]).code == "ok"
        assert setter.setTransformRPC(Transform("x", "x")).code == "err5"
        port.listen_to(STREAM)
        data = bytes(port.read(HANG).payload)
        head = "0001000002000000" + "0001000001000000090000006f6b0000"
        assert data.hex().startswith(head) and is_yarp4(data)
        answer = get.ask(Bottle(["getTransformsRPC"]), HANG)
        assert bytes(answer.to_bytes()) == data
        getter = client_class(FrameTransformStorageGetRPC)(get, HANG)
        assert getter.getTransformsRPC().transforms == [Transform("base", "cam", 5.0, 1)]
        assert setter.clearAllRPC().code == "ok"
        assert server.frames.all() == []


def test_the_plain_status():
    other = Bottle(["fail"]).to_bytes()
    assert plain(other) == other
