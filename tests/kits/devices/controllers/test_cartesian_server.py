"""A CartesianServer's answers, word by word, as the C++ client reads them."""

from yarpy.data.bottle import Bottle
from yarpy.kits.devices import CartesianServer, SimulatedArm
from yarpy.port.rpc import RpcClient


def test_answers(names):
    with (
        CartesianServer("/s", SimulatedArm(), 0.05, names=names),
        RpcClient("/s/rpc:i", names=names) as client,
    ):

        def ask(text):
            return client.ask(Bottle.from_text(text), 20.0).as_(Bottle).to_text()

        assert ask("[get] [mode]") == "[ack] [shot]"
        assert ask("[get] [ison]") == "[ack] [true]"
        assert ask("[set] [dof] (1 1 1 1 1 0 0)") == "[ack] (1.0 1.0 1.0 1.0 1.0 0.0 0.0)"
        assert ask("[get] [lim] 3") == "[ack] -150.0 150.0"
        assert ask("[get] [info]") == '[ack] ((server_version "2.0"))'
        asked = client.ask(
            Bottle.from_text("[ask] ([xd] (0.1 0.0 -0.3)) ([pose] [xyz])"), 20.0
        ).as_(Bottle)
        assert [str(each[0]) for each in asked[1:]] == ["x", "q"]
        assert [len(each[1]) for each in asked[1:]] == [7, 7]
        place = client.ask(Bottle.from_text("[get] [pose] 6"), 20.0).as_(Bottle)
        assert len(place[1]) == 7 and len(place[2]) == 2
        assert ask("[even] [regi] [ogoi] 0.5") == "[ack]"
        assert ask("[even] [regi] [ogoi] 7.5") == "[nack]"
