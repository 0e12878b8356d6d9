import pytest
from support.board import Bare, FakeBoard

import yarpy
from yarpy import Bottle
from yarpy.devices.control_board_server import ControlBoardServer
from yarpy.devices.watch import Watch
from yarpy.errors import DecodeError, LocalProtocolError, Timeout, UnknownName

PATIENCE = 20.0


def test_the_newest_counts(names):
    device = FakeBoard()
    device.timestamps = lambda: [4.5, 5.0, 5.5]
    with (
        ControlBoardServer("/head", device, 0.005, names=names),
        Watch("/head/stateExt:o", "/me", "tcp", PATIENCE, names) as watch,
    ):
        assert watch.values("currents") == [3300.0, 3400.0, 3500.0]
        assert watch.time() == 5.0
        device.where = [1.0, 2.0, 3.0]
        for _ in range(1000):
            if watch.values("encoders") == [1.0, 2.0, 3.0]:
                break
            yarpy.wait_for("/nobody", timeout=0.01, names=names)
        assert watch.values("encoders") == [1.0, 2.0, 3.0]
        watch.values("encoders").append(4.0)  # the caller's own list
        assert len(watch.values("encoders")) == 3


def test_what_is_not_measured(names):
    with (
        ControlBoardServer("/head", Bare(), 0.005, names=names),
        Watch("/head/stateExt:o", "/me", "tcp", PATIENCE, names) as watch,
        pytest.raises(LocalProtocolError, match="does not measure motor speeds"),
    ):
        watch.values("motor_speeds")


def test_silence(names):
    with (
        yarpy.Port("/head/stateExt:o", names=names),
        Watch("/head/stateExt:o", "/me", "tcp", 0.05, names) as watch,
        pytest.raises(Timeout, match="nothing came"),
    ):
        watch.values("encoders")


def test_old_messages_do_not_count(names):
    with (
        ControlBoardServer("/head", Bare(), 0.005, names=names) as server,
        Watch("/head/stateExt:o", "/me", "tcp", 1.0, names) as watch,
    ):
        assert watch.values("encoders") == [1.5, -2.0]
        server.close()
        with pytest.raises(Timeout, match="nothing comes from"):
            for _ in range(1000):
                watch.values("encoders")
                yarpy.wait_for("/nobody", timeout=0.01, names=names)


def test_a_board_that_comes_back_is_heard_again(names):
    with ControlBoardServer("/head", Bare(), 0.005, names=names) as server:
        watch = Watch("/head/stateExt:o", "/me", "tcp", 2.0, names)
        with watch:
            assert watch.values("encoders") == [1.5, -2.0]
            server.close()
            device = FakeBoard(2)
            device.where = [7.0, 8.0]
            with ControlBoardServer("/head", device, 0.005, names=names):
                for _ in range(2000):
                    if watch.values("encoders") == [7.0, 8.0]:
                        break
                    yarpy.wait_for("/nobody", timeout=0.01, names=names)
                assert watch.values("encoders") == [7.0, 8.0]


def test_no_states(names):
    with (
        yarpy.Port("/head/stateExt:o", names=names) as port,
        Watch("/head/stateExt:o", "/me", "tcp", PATIENCE, names) as watch,
    ):
        port.write(Bottle([1, 2, 3]), wait=True)
        with pytest.raises(DecodeError, match="22"):
            watch.values("encoders")
        port.write(FakeState(), "no stamp", wait=True)
        assert watch.values("encoders") == [1.0]
        assert watch.time() > 1e9  # when it arrived


class FakeState:
    def to_wire(self):
        from yarpy.devices.state import State

        return (State(1, {"encoders": [1.0]}).to_bottle().to_bytes(),)


def test_nobody_there(names):
    with pytest.raises(UnknownName):
        Watch("/nobody", "/me", "tcp", 1.0, names)
    assert names.query("/me") is None
