"""Controllers of simulated joints: what they remember, and what they measure."""

import pytest

from yarpy.kits.devices.control_board.interface import Gains
from yarpy.kits.devices.refusal import Refused
from yarpy.kits.devices.simulated.pids import SimulatedPids


def test_what_is_set_is_remembered() -> None:
    pids = SimulatedPids(2, lambda: [0.5, 0.25], lambda: [1.0, 2.0])
    assert pids.targets == [0.0, 0.0] and pids.enabled == [False, False]
    pids.targets = [1.0, 2.0]
    pids.gains = [Gains(kp=1.0), Gains(kp=2.0)]
    pids.offsets = [3.0, 4.0]
    pids.reset([0])
    assert pids.targets == [1.0, 2.0] and pids.offsets == [3.0, 4.0]
    assert pids.gains == [Gains(kp=1.0, offset=3.0), Gains(kp=2.0, offset=4.0)]
    assert pids.errors() == [0.5, 0.25] and pids.outputs() == [1.0, 2.0]


def test_what_follows_a_board_cannot_be_set() -> None:
    pids = SimulatedPids(1, lambda: [0.5], lambda: [1.0], lambda: [7.0])
    assert pids.targets == [7.0] and pids.enabled == [True]
    with pytest.raises(Refused, match="move its joints"):
        pids.targets = [1.0]
