"""A remote store of frames: of yarpy, of C++ as it spells things, and what it refuses."""

import numpy as np
import pytest

import yarpy
from yarpy import Bottle
from yarpy.data.yarp4 import is_yarp4, to_yarp4
from yarpy.errors import LocalProtocolError, RemoteProtocolError, UnknownName
from yarpy.kits.devices.transforms.client import TransformClient
from yarpy.kits.devices.transforms.server import TransformServer
from yarpy.wire.message import Encoded

SET = "/store/frameTransformSet_nws_yarp/thrift"
GET = "/store/frameTransformGet_nws_yarp/thrift"


def test_of_yarpy(names):
    with TransformServer("/store", names=names), TransformClient("/store", names=names) as frames:
        frames.place("head", "base", (0.5, 1.5, 2.5), constant=True)
        frames.place("eye", "head", (0.25, 0, 0), constant=True)
        assert frames.frames() == ["base", "eye", "head"]
        assert np.allclose(frames.pose("eye", "base")[:3, 3], (0.75, 1.5, 2.5))
        with pytest.raises(LocalProtocolError, match="refuses setTransformRPC"):
            frames.place("base", "eye")
        with pytest.raises(ValueError, match="finite"):
            frames.place("a", "b", (float("inf"), 0, 0))
        frames.remove("eye", "head")
        with pytest.raises(LocalProtocolError, match="refuses deleteTransformRPC"):
            frames.remove("eye", "head")
        with pytest.raises(LookupError, match='no frame "eye"'):
            frames.pose("eye", "base")
        frames.clear()
        assert frames.all() == []


@pytest.mark.parametrize(
    ("version", "status"),
    [("", "[ok]"), ("0000 0300 0c00 0000", "0"), ("0000 0400 0000 0000", "()")],
)
def test_of_cpp(names, version, status):
    """3.9, 3.12 and 4.0, each with its status, and 4.0 with its floats."""
    newer = "0400" in version
    heard = []

    def answer(message):
        data = bytes(message.to_bytes())
        if b"getRemoteProtocolVersion" in data:
            if not version:
                return Bottle.from_text("[fail]")
            return Encoded(bytes.fromhex("0001000001000000" + version))
        heard.append(data)
        if b"getTransforms" not in data:
            return Bottle.from_text("[ok]")
        found = Bottle.from_text(f"{status} ((base eye 1.5 1 1.0 2.0 3.0 0.0 0.0 0.0 1.0))")
        if newer:
            found[0] = Bottle.from_text("[ok]")
        return Encoded(to_yarp4(found.to_bytes())) if newer else found

    with (
        yarpy.RpcServer(SET, answer, names=names),
        yarpy.RpcServer(GET, answer, names=names),
        TransformClient("/store", names=names) as frames,
    ):
        frames.place("eye", "base", (1, 2, 3))
        assert is_yarp4(heard[0]) is newer
        assert heard[0].count(bytes.fromhex("20000000 00")) == 1  # the flag is an int8
        assert frames.pose("eye", "base")[:3, 3].tolist() == [1, 2, 3]


def test_what_is_no_store(names):
    with pytest.raises(UnknownName):
        TransformClient("/nobody", names=names)
    answers = ["[fail]", "[ok] ((base eye))", "[ok] 5"]

    def answer(message):
        return Bottle.from_text(answers[0])

    with (
        yarpy.RpcServer(SET, answer, names=names),
        yarpy.RpcServer(GET, answer, names=names),
        TransformClient("/store", names=names) as frames,
    ):
        with pytest.raises(LocalProtocolError, match="tells no transforms"):
            frames.all()
        for _ in range(2):
            answers.pop(0)
            with pytest.raises(RemoteProtocolError, match="tells no transforms"):
                frames.all()
