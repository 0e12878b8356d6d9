"""Decorated methods at a broker of mosquitto, beside mosquitto's own programs."""

from __future__ import annotations

import subprocess
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import numpy as np
import pytest
from support.broker import Broker
from support.wait import HANG, wait_until

import yarpy
from yarpy.kits import wrap

pytestmark = [pytest.mark.usefixtures("names"), pytest.mark.peer("mosquitto")]


class Arm:
    @wrap.on("arm/state", "mqtt://{place}", reliable=True, keep="all")
    def state(self) -> dict:
        return {"angle": 45.0}

    @wrap.on("arm/camera", "mqtt://{place}")
    def camera(self) -> np.ndarray:
        return np.arange(24, dtype="u1").reshape(2, 4, 3)

    @wrap.on("arm/rpc", "mqtt://{place}")
    def turn(self, angle: float, by: np.ndarray | None = None) -> float:
        if angle > 90:
            raise ValueError("too far")
        return angle + (0.0 if by is None else float(by.sum()))


@pytest.fixture
def broker(tmp_path: Path) -> Iterator[Broker]:
    found = Broker(tmp_path)
    yield found
    found.stop()


def test_clients_of_the_broker_take_part(broker: Broker) -> None:
    here, place = Arm(), f"mqtt://127.0.0.1:{broker.port}"
    options = ["-h", "127.0.0.1", "-p", str(broker.port), "-t", "arm/state"]
    with wrap.listen(here.state, middleware=place):
        subprocess.run(["mosquitto_pub", *options, "-q", "1", "-m", '{"angle": 1}'], check=True)
        assert here.state(timeout=HANG) == {"angle": 1}
    with wrap.publish(here.state, middleware=place, carrier="retain") as handle:
        here.state()
        wait_until(lambda: handle.stats[0]["outputs"][0]["unacknowledged"] == 0)
        words = ["mosquitto_sub", *options, "-C", "1"]
        said = subprocess.run(words, capture_output=True, text=True, timeout=HANG)
        assert said.stdout == '{"angle": 45.0}\n'


def test_arrays_and_questions(broker: Broker) -> None:
    here, there, place = Arm(), Arm(), f"mqtt://127.0.0.1:{broker.port}"
    with wrap.listen(there.camera, middleware=place), wrap.publish(here.camera, middleware=place):
        here.camera()
        assert np.array_equal(there.camera(timeout=HANG), here.camera())
        with pytest.raises(yarpy.Timeout):
            there.camera(timeout=HANG)
            there.camera(timeout=0.05)
    with wrap.call(there.turn, middleware=place):
        with pytest.raises(yarpy.UnknownName, match="nobody has subscribed to arm/rpc"):
            there.turn(1)
        with wrap.serve(here.turn, middleware=place):
            assert there.turn(1, timeout=HANG) == 1
            assert there.turn(1, np.ones(3), timeout=HANG) == 4
            with pytest.raises(wrap.RemoteError, match="ValueError: too far"):
                there.turn(91, timeout=HANG)


def test_a_server_that_comes_later(broker: Broker) -> None:
    here, there, place = Arm(), Arm(), f"mqtt://127.0.0.1:{broker.port}"
    with wrap.call(there.turn, middleware=place), ThreadPoolExecutor(1) as other:
        answer = other.submit(there.turn, 1, timeout=HANG)
        with pytest.raises(TimeoutError):
            answer.result(0.3)
        with wrap.serve(here.turn, middleware=place):
            assert answer.result(HANG) == 1


def test_broker_that_is_not_there(broker: Broker) -> None:
    broker.stop()
    with pytest.raises(yarpy.LinkClosed):
        wrap.publish(Arm().state, middleware=f"mqtt://127.0.0.1:{broker.port}")
    broker.start()


def test_options() -> None:
    for wrong in ({"middleware": "mqtt"}, {"keep": 3}, {"qos": yarpy.Qos(packets="HIGH")}):
        with pytest.raises(ValueError):
            wrap.on("x", **({"middleware": "mqtt://here"} | wrong))(lambda: 1)  # type: ignore[arg-type]
    with pytest.raises(ValueError, match="mqtt://HOST"):
        wrap.on("x", "mqtt://here/x")(lambda: 1)
    with pytest.raises(yarpy.LocalProtocolError, match=r'no "\+retian"'):
        wrap.on("x", "mqtt://here", carrier="retian")(lambda: 1)
