"""A simulated joypad, alone and with a program of YARP 3."""

import pytest
from support.wait import wait_until

import yarpy
from yarpy.kits.devices import Joypad
from yarpy.kits.devices.interfaces.joypad import Point
from yarpy.kits.devices.refusal import Refused
from yarpy.kits.devices.simulated.joypad import SimulatedJoypad
from yarpy.nameserver.local import LocalNames


def test_state() -> None:
    pad = SimulatedJoypad()
    pad.state.sticks[1] = Point(0.0, 0.5)
    pad.state.buttons[3] = 1.0
    assert pad.stick(1) == (Point(0.0, 0.5), 1)
    assert pad.stick(1, 0)[0].x == 0.5 and 1.57 < pad.stick(1, 0)[0].y < 1.58
    assert pad.button(3) == 1.0 and pad.axis_count() == 6 and pad.touch(0) == []
    assert pad.everything() == pad.state
    for ask in (pad.button, pad.axis, pad.hat, pad.trackball, pad.stick_freedom):
        with pytest.raises(Refused):
            ask(100)


def test_readers_of_yarp_3_get_vectors(names: LocalNames) -> None:
    pad = SimulatedJoypad()
    pad.state.axes[2] = 0.25
    pad.state.sticks[0] = Point(0.5, -0.5)
    found: dict[str, yarpy.Message] = {}
    with (
        Joypad.serve("/pad", pad, 0.01, names=names),
        yarpy.BufferedPort("/axes", callback=lambda m: found.update(axes=m), names=names) as axes,
        yarpy.BufferedPort("/sticks", callback=lambda m: found.update(st=m), names=names) as sticks,
    ):
        axes.listen_to("/pad/axis:o", "text")  # text is not asked for its version
        sticks.listen_to("/pad/stick:o", "text")
        wait_until(lambda: {*found} == {"axes", "st"})
    assert found["axes"].value == [0.0, 0.0, 0.25, 0.0, 0.0, 0.0]
    assert found["st"].value == [0.5, -0.5, 0.0, 0.0]
