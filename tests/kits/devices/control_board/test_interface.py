from yarpy.data.value import Vocab
from yarpy.kits.devices.control_board.interface import (
    ControlMode,
    Gains,
    InteractionMode,
    MotorTorqueParameters,
)

# Spec: the numbers that travel in stateExt.
MODES = {
    "pos": 7565168, "posd": 1685286768, "vel": 7103862, "mix": 7891309, "torq": 1903325044,
    "ipwm": 1836544105, "icur": 1920295785, "idl": 7103593, "fidl": 1818519910,
    "hwfa": 1634105192, "cal": 7102819, "cald": 1684824419, "cfgn": 1852270179,
    "cfgy": 2036819555, "unkw": 2003529333, "veld": 1684825462,
}  # fmt: skip
INTERACTIONS = {"stif": 1718187123, "comp": 1886220131, "unkn": 1852534389}


def test_modes_are_the_words_of_the_protocol():
    assert {mode: Vocab(mode).code for mode in ControlMode} == MODES
    assert {mode: Vocab(mode).code for mode in InteractionMode} == INTERACTIONS


def test_numbers_have_the_order_of_the_protocol():
    assert Gains._fields.index("ki") == 2 and len(Gains()) == 10
    assert MotorTorqueParameters._fields[-1] == "velocity_threshold"
    assert len(MotorTorqueParameters()) == 9
