import threading

import pytest
from support.board import Bare, FakeBoard
from support.wait import HANG, wait_until

import yarpy
from yarpy import Bottle
from yarpy.errors import DecodeError, Timeout, UnknownName
from yarpy.kits.devices.control_board.server import ControlBoardServer
from yarpy.kits.devices.control_board.state import State
from yarpy.kits.devices.latest_message import LatestMessage


def watch_of(timeout, names, source="/head/stateExt:o"):
    decode = lambda message: State.from_bottle(message.as_(Bottle)).values  # noqa: E731
    return LatestMessage(source, "/me", "tcp", timeout, names, decode)


def test_the_newest_counts(names):
    device = FakeBoard()
    device.timestamps = lambda: [4.5, 5.0, 5.5]
    with (
        ControlBoardServer("/head", device, 0.005, names=names),
        watch_of(HANG, names) as watch,
    ):
        assert watch.value()["currents"] == [3300.0, 3400.0, 3500.0]
        assert watch.time() == 5.0
        device.where = [1.0, 2.0, 3.0]
        for _ in range(1000):
            if watch.value()["encoders"] == [1.0, 2.0, 3.0]:
                break
            yarpy.wait_for("/nobody", timeout=0.01, names=names)
        assert watch.value()["encoders"] == [1.0, 2.0, 3.0]
        assert watch.value()["encoders"] == [1.0, 2.0, 3.0]


def test_renewing(names):
    with (
        yarpy.Port("/head/stateExt:o", names=names) as port,
        watch_of(HANG, names) as watch,
    ):
        renewed = threading.Event()
        thread = threading.Thread(target=lambda: (watch.renew(), renewed.set()), daemon=True)
        thread.start()
        assert not renewed.wait(0.05)
        port.write(FakeState(), wait=True)
        assert not renewed.wait(0.05)
        while not renewed.wait(0.01):
            port.write(FakeState(), wait=True)
        assert watch.value() == {"encoders": [1.0]}
    with (
        yarpy.Port("/head/stateExt:o", names=names),
        watch_of(0.01, names) as watch,
    ):
        watch.renew()  # not for ever


def test_silence(names):
    with (
        yarpy.Port("/head/stateExt:o", names=names),
        watch_of(0.05, names) as watch,
        pytest.raises(Timeout, match="nothing came"),
    ):
        watch.value()["encoders"]


def test_old_messages_do_not_count(names):
    with (
        ControlBoardServer("/head", Bare(), 0.005, names=names) as server,
        watch_of(HANG, names) as watch,
    ):
        assert watch.value()["encoders"] == [1.5, -2.0]
        server.close()
        wait_until(lambda: not watch._port.inputs)
        assert watch.value()["encoders"] == [1.5, -2.0]
        watch._timeout = 0.0
        with pytest.raises(Timeout, match="nothing comes from"):
            watch.value()


def test_a_board_that_comes_back_is_heard_again(names):
    with ControlBoardServer("/head", Bare(), 0.005, names=names) as server:
        watch = watch_of(HANG, names)
        with watch:
            assert watch.value()["encoders"] == [1.5, -2.0]
            server.close()
            device = FakeBoard(2)
            device.where = [7.0, 8.0]
            with ControlBoardServer("/head", device, 0.005, names=names):
                for _ in range(2000):
                    if watch.value()["encoders"] == [7.0, 8.0]:
                        break
                    yarpy.wait_for("/nobody", timeout=0.01, names=names)
                assert watch.value()["encoders"] == [7.0, 8.0]


def test_no_states(names):
    with (
        yarpy.Port("/head/stateExt:o", names=names) as port,
        watch_of(HANG, names) as watch,
    ):
        port.write(Bottle([1, 2, 3]), wait=True)
        with pytest.raises(DecodeError, match="22"):
            watch.value()["encoders"]
        port.write(FakeState(), "no stamp", wait=True)
        assert watch.value()["encoders"] == [1.0]
        assert watch.time() > 1e9  # when it arrived


class FakeState:
    def to_wire(self):
        return (State(1, {"encoders": [1.0]}).to_bytes(),)


def test_nobody_there(names):
    with pytest.raises(UnknownName):
        watch_of(1.0, names, "/nobody")
    assert names.query("/me") is None
