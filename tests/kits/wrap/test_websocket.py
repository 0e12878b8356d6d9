"""Ports that are connected by WebSocket."""

from __future__ import annotations

import numpy as np
import pytest
from support.wait import HANG, wait_until

from yarpy.kits import wrap


class Eye:
    @wrap.on("/eye", "websocket", keep="all")
    def look(self) -> np.ndarray:
        return np.arange(24, dtype="u1").reshape(2, 4, 3)

    @wrap.on("/eye/rpc", "websocket")
    def blink(self, times: int) -> str:
        return f"{times} times"


@pytest.mark.usefixtures("names")
def test_there_and_back() -> None:
    here, there = Eye(), Eye()
    with wrap.listen(there.look) as into, wrap.publish(here.look) as out:
        wait_until(lambda: out.stats[0]["outputs"] and into.stats[0]["inputs"])
        assert out.stats[0]["outputs"][0]["carrier"] == "websocket"
        sent = here.look()
        assert np.array_equal(there.look(timeout=HANG), sent)
    with wrap.serve(here.blink), wrap.call(there.blink):
        assert there.blink(3, timeout=HANG) == "3 times"


def test_the_carrier_is_said_already() -> None:
    with pytest.raises(ValueError, match="carrier='udp' on websocket: it is websocket"):
        wrap.on("/eye", "websocket", carrier="udp")(lambda: 1)
