"""The suite for middlewares, on a broker of ZeroMQ."""

from __future__ import annotations

from collections.abc import Iterator

import pytest
from support.port import free_block

from yarpy.peers.zmq.middleware import ZeroMq
from yarpy.testing import MiddlewareConformance

pytest.importorskip("zmq")


@pytest.fixture(autouse=True)
def _place() -> Iterator[None]:
    TestZeroMq.place = f"127.0.0.1:{free_block(2)}"
    yield


class TestZeroMq(MiddlewareConformance):
    middleware = ZeroMq
