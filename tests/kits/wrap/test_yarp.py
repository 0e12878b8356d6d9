"""YARP as a middleware: beside programs that know nothing of decorators."""

from __future__ import annotations

from typing import Annotated

import numpy as np
import pytest
from support.system import NO_MARKS
from support.wait import HANG, wait_until

import yarpy
from yarpy.kits import wrap
from yarpy.kits.wrap import yarp as module
from yarpy.kits.wrap.value.tree import to_text

Picture = Annotated[np.ndarray, wrap.Image("bgr")]


class Eye:
    @wrap.on("/eye")
    def look(self) -> Picture:
        picture = np.zeros((4, 8, 3), "u1")
        picture[..., 0] = 9  # blue
        return picture

    @wrap.on("/eye/state", keep="all", qos=yarpy.Qos(packets="HIGH"))
    def state(self, open_: bool = True) -> dict:
        return {"open": open_}

    @wrap.on("/eye/rpc")
    def blink(self, times: int, side: str = "left") -> str:
        return f"{side} {times}"

    @wrap.on("/eye/rpc2")
    def mix(self, array: np.ndarray, *, gain: float = 1.0) -> tuple[np.ndarray, float]:
        return array * gain, gain


pytestmark = pytest.mark.usefixtures("names")


def test_a_carrier_that_there_is_not() -> None:
    with pytest.raises(yarpy.UnknownPlugin, match="udp"):
        wrap.on("/x", carrier="udpp")(lambda: 1)


def test_any_port_reads_and_is_read() -> None:
    eye = Eye()
    with yarpy.BufferedPort("/view") as view, wrap.publish(eye.look):
        yarpy.connect("/eye", "/view")
        eye.look()
        message = view.read(timeout=HANG)
        assert message.value.converted("rgb").array[0, 0].tolist() == [0, 0, 9]
        assert message.stamp is not None and message.stamp.count == 0
    with yarpy.Port("/eye") as camera, wrap.listen(eye.look):
        camera.write(yarpy.Image(np.full((4, 8, 3), (1, 2, 3), "u1")))  # rgb
        assert eye.look(timeout=HANG)[0, 0].tolist() == [3, 2, 1]


def test_priorities_reach_the_connections() -> None:
    here, there = Eye(), Eye()
    with wrap.publish(here.state), wrap.listen(there.state) as handle:
        wait_until(lambda: handle.stats[0]["inputs"])
        here.state()
        assert there.state(timeout=HANG) == {"open": True}


@pytest.mark.skipif(bool(NO_MARKS), reason=NO_MARKS)
def test_who_connects_as_soon_as_a_topic_has_its_name_has_the_priority_too() -> None:
    with (
        yarpy.BufferedPort("/eye/state") as port,
        yarpy.Port("/view", callback=lambda message: None),
    ):
        port.connect("/view")
        module._give(port, yarpy.Qos(packets="HIGH"))
        assert port.outputs[0].qos.packets == "AF42"


def test_netcat_may_ask() -> None:
    eye = Eye()
    with wrap.serve(eye.blink), yarpy.RpcClient("/eye/rpc") as client:
        assert client.call("blink", 3) == "left 3"
        assert client.call("blink", 3, "right") == "right 3"
        answer = client.ask(["blink"])
        assert answer is not None
        assert (
            answer.value.to_text()
            == "[fail] \"TypeError: missing a required argument: 'times'\" (raised TypeError)"
        )
        with pytest.raises(yarpy.RemoteError, match="blink"):
            client.call("wink", 3)
        assert client.call(yarpy.Bottle([to_text([(2,), {"side": "both"}])])) == "both 2"
        for wrong in (["yarpy/1", "{}"], ["blink", "often"]):
            with pytest.raises(yarpy.RemoteError):
                client.call(wrong)


def test_server_of_another_kind() -> None:
    eye = Eye()
    answers = {"blink": lambda times, side="left": [yarpy.Vocab("fail"), "no such eye"]}
    handler = lambda message: answers[message.value[0]](*message.value[1:])  # noqa: E731
    with yarpy.RpcServer("/eye/rpc", handler), wrap.call(eye.blink):
        with pytest.raises(wrap.RemoteError, match=r"^no such eye$"):
            eye.blink(1)
        answers["blink"] = lambda times, side="left": times
        with pytest.raises(yarpy.DecodeError, match="expected a string"):
            eye.blink(1)
        answers["blink"] = lambda times, side="left": f"{times} {side}"
        assert eye.blink(1, side="x") == "1 x"


def test_arrays_as_arguments() -> None:
    here, there = Eye(), Eye()
    with wrap.serve(here.mix), wrap.call(there.mix):
        array = np.arange(6, dtype="f4").reshape(2, 3)
        found, gain = there.mix(array, gain=2.0)
        assert found.dtype == array.dtype and np.array_equal(found, array * 2) and gain == 2.0


def test_server_that_goes_away_in_the_middle_of_a_call() -> None:
    eye = Eye()
    server: list[yarpy.RpcServer] = []

    def handler(message: yarpy.Message) -> str:
        for link in server[0]._hub.inputs.links:
            link.close()  # at once; a port's own `close` would let the answer out
        return "too late"

    with yarpy.RpcServer("/eye/rpc", handler) as one, wrap.call(eye.blink):
        server.append(one)
        with pytest.raises(yarpy.LinkClosed):
            eye.blink(1, timeout=HANG)


def test_server_that_says_nothing() -> None:
    eye = Eye()
    quiet = yarpy.Port("/eye/rpc")  # reads nothing, and so answers nothing
    with quiet, wrap.call(eye.blink), pytest.raises(yarpy.Timeout):
        eye.blink(1, timeout=0.1)


def test_nothing_comes_and_why() -> None:
    """Who waits in vain reads what there is to mend: a topic with another name, no name server."""
    eye = Eye()
    with (
        wrap.listen(eye.state),
        pytest.raises(yarpy.Timeout, match=r'"/eye/state" within 0.05 s: .*"/eye/state"'),
    ):
        eye.state(timeout=0.05)
    with yarpy.Port("/eye/state"), wrap.listen(eye.state) as handle:
        wait_until(lambda: handle.stats[0]["inputs"])
        with pytest.raises(yarpy.Timeout, match=r"within 0.05 s$"):
            eye.state(timeout=0.05)
    both = wrap.on("/eye/both", ("yarp", "websocket"))(lambda: 1)
    with wrap.listen(both), pytest.raises(yarpy.Timeout, match='"/eye/both"'):
        both(timeout=0.05)


def test_what_comes_and_is_something_else() -> None:
    eye = Eye()
    with yarpy.Port("/eye/state") as port, wrap.listen(eye.state) as handle:
        wait_until(lambda: handle.stats[0]["inputs"])
        port.write([1, 2])
        with pytest.raises(yarpy.DecodeError):
            eye.state(timeout=HANG)
        port.write({"open": False})
        assert eye.state(timeout=HANG) == {"open": False}
