"""What is asked of servers in wrong words; contexts and shares have their limits."""

import pytest
from support.wait import wait_until

from yarpy.data.bottle import Bottle
from yarpy.data.value import Vocab
from yarpy.kits.devices import CartesianServer, GazeServer, SimulatedArm, SimulatedHead
from yarpy.port.port import Port
from yarpy.port.rpc import RpcClient


@pytest.mark.parametrize(
    ("server", "device", "port"),
    [(CartesianServer, SimulatedArm, "rpc:i"), (GazeServer, SimulatedHead, "rpc")],
)
def test_wrong_words(names, server, device, port):
    wrong = [
        *([], ["get"], ["get", "pose"], ["set", "time"], ["set", "tip", 5], ["rest", 77]),
        *(["del", 3], ["look", "3D", Bottle(["a"])], ["bind", "pitch"], ["even", "regi", "ogoi"]),
        *(["go", "full", 1.0, Bottle([1.0])], ["ask"], ["get", "2D", Bottle([])], [Bottle()]),
    ]
    with server("/s", device(), 0.05, names=names), RpcClient(f"/s/{port}", names=names) as client:
        for words in wrong:
            found = client.ask(Bottle(words), 20.0).as_(Bottle)
            assert found == [Vocab("nack")], words
        kept = [client.ask(Bottle([Vocab("stor")]), 20.0).as_(Bottle) for _ in range(100)]
        assert kept[0] == [Vocab("ack"), 1] and kept[-1] == [Vocab("nack")]
        assert client.ask(Bottle([Vocab("del"), Bottle(range(1, 100))]), 20.0).as_(Bottle)
        assert client.ask(Bottle([Vocab("stor")]), 20.0).as_(Bottle) == [Vocab("ack"), 1]


def test_wrong_commands_change_nothing(names):
    arm = SimulatedArm()
    with (
        CartesianServer("/s", arm, 0.05, names=names),
        Port("/out", names=names) as out,
        RpcClient("/s/rpc:i", names=names) as client,
    ):
        out.connect("/s/command:i")
        before = arm.joints()
        for words in (["go"], ["tvel", Bottle([1.0])], ["dance"], []):
            out.write(Bottle(words))
        out.write(Bottle(["go", "xyz", 0.01, Bottle([0.1, 0.0, -0.3])]))
        wait_until(lambda: arm.motion_done() and arm.joints() != before)
        done = client.ask(Bottle(["get", "done"]), 20.0).as_(Bottle)
        assert done == [Vocab("ack"), Vocab("true")]
