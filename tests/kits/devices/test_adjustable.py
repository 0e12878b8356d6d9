import pytest

from yarpy.kits.devices.adjustable import Adjustable
from yarpy.kits.devices.control_board.interface import Gains


class Remote:
    axes = 2

    def __init__(self):
        self.values = {"speeds": [1.0, 2.0], "gains": [range(10), range(10)]}

    def read(self, member):
        return self.values[member]

    def write(self, member, joints, values):
        assert joints == [0, 1]
        self.values[member] = values


class Client:
    speeds = Adjustable[float]("deg/s")
    gains = Adjustable[Gains]("", Gains._make)

    def __init__(self):
        self._ask = Remote()


def test_reading_asks_and_assigning_sets():
    client = Client()
    assert client.speeds == (1.0, 2.0)
    client.speeds = (3.0, 4.0)
    assert client.speeds == (3.0, 4.0)
    assert client.gains[1].max_output == 4
    with pytest.raises(TypeError):
        client.speeds[0] = 5.0  # it would change nothing at the other end
    with pytest.raises(ValueError, match="speeds: 1 values for 2 joints"):
        client.speeds = [1.0]


def test_it_says_what_it_is():
    assert Client.speeds.__doc__ == "deg/s"
    assert Client.gains.__doc__ == "One for each joint."
