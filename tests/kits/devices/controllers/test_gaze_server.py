"""A GazeServer's answers, word by word, as the C++ client reads them."""

from yarpy.data.bottle import Bottle
from yarpy.kits.devices import GazeServer, SimulatedHead
from yarpy.port.rpc import RpcClient


def test_answers(names):
    with (
        GazeServer("/s", SimulatedHead(), 0.05, names=names),
        RpcClient("/s/rpc", names=names) as client,
    ):

        def ask(text):
            return client.ask(Bottle.from_text(text), 20.0).as_(Bottle).to_text()

        assert ask("get Tneck") == "[ack] 0.75"
        assert ask("get track") == "[ack] 0" and ask("set track 1") == "[ack]"
        assert ask("get track") == "[ack] 1"
        assert ask("get pitch") == "[ack] -40.0 30.0"
        assert ask("bind pitch -5.0 5.0") == "[ack]" and ask("get pitch") == "[ack] -5.0 5.0"
        assert ask("clear pitch") == "[ack]" and ask("get pitch") == "[ack] -40.0 30.0"
        assert ask("get eyes") == "[ack] -1.0"
        assert ask("look mono (left 160.0 120.0 1.0)") == "[ack]"
        assert ask("look mono (left 160.0 120.0 ver 5.0)") == "[ack]"
        assert ask("look ang (abs 0.0 0.0 5.0)") == "[ack]"
        assert ask("register ongoing 0.5") == "[ack]" and ask("unregister ongoing 0.5") == "[ack]"
        assert ask("get 3D ang (abs 0.0 0.0 5.0)").startswith("[ack] (-0.77")
        assert ask("stor") == "[ack] 1" and ask("del (1)") == "[ack]"
