"""The suite for middlewares, on a broker of mosquitto."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest
from support.broker import Broker

from yarpy.peers.mqtt.middleware import Mqtt
from yarpy.testing import MiddlewareConformance

pytestmark = pytest.mark.peer("mosquitto")


@pytest.fixture(autouse=True)
def _broker(tmp_path: Path) -> Iterator[None]:
    broker = Broker(tmp_path)
    TestMqtt.place = f"127.0.0.1:{broker.port}"
    yield
    broker.stop()


class TestMqtt(MiddlewareConformance):
    middleware = Mqtt
    topic = "suite/topic"
    service = "suite/service"
