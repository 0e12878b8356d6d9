"""A router of Zenoh for the tests of one file, and a name service for their ports."""

from collections.abc import Iterator

import pytest
from support.ros2_peer import ros2_router
from support.wrapping import no_settings

import yarpy
from yarpy.names.default import DEFAULT

__all__ = ["names", "no_settings", "router"]


@pytest.fixture(scope="module")
def router() -> Iterator[int]:
    """Its number; this process finds it, and nothing of ROS 2 that is installed."""
    pytest.importorskip("zenoh", reason='Zenoh: pip install "yarpy[zenoh]"')
    with ros2_router() as port, pytest.MonkeyPatch.context() as patch:
        patch.setenv("YARPY_ZENOH", f"127.0.0.1:{port}")
        patch.delenv("ROS_DOMAIN_ID", raising=False)
        patch.delenv("ZENOH_SESSION_CONFIG_URI", raising=False)
        yield port


@pytest.fixture
def names(router: int) -> Iterator[yarpy.LocalNames]:
    """Names within this process."""
    found = yarpy.LocalNames()
    DEFAULT.push(found)
    try:
        yield found
    finally:
        DEFAULT.pop(found)
