"""QoS in the words of DDS, there and back."""

import pytest

from yarpy.peers.ros2.dds.qos import dds_qos, promises_of
from yarpy.peers.ros2.key import NO_HASH
from yarpy.peers.ros2.qos import BEST_EFFORT, KEEP_ALL, MANUAL, TRANSIENT_LOCAL, Qos

HASH = "RIHS01_" + 64 * "a"
TABLE = {
    "default": Qos(),
    "best effort": Qos(BEST_EFFORT),
    "transient local": Qos(durability=TRANSIENT_LOCAL),
    "deadline": Qos(deadline=(1, 500)),
    "lifespan": Qos(lifespan=(0, 250_000_000)),
    "liveliness": Qos(liveliness=MANUAL, lease=(2, 0)),
    "lease": Qos(lease=(3, 0)),
}


@pytest.mark.parametrize("name", TABLE)
def test_there_and_back(name: str) -> None:
    wanted = TABLE[name]
    assert promises_of(dds_qos(wanted, HASH, writes=True)) == (HASH, wanted)


def test_how_much_is_kept() -> None:
    def kept(qos: Qos, room: int = 0) -> str:
        found = dds_qos(qos, HASH, room, writes=False)
        return next(repr(item) for item in found if type(item).__name__.startswith("History"))

    assert kept(Qos(depth=7)) == "Policy.History.KeepLast(depth=7)"
    assert kept(Qos(depth=7), 100) == "Policy.History.KeepLast(depth=100)"
    assert kept(Qos(history=KEEP_ALL)).startswith("Policy.History.KeepAll")


def test_a_duration_of_zero_asks_for_nothing() -> None:
    assert promises_of(dds_qos(Qos(deadline=(0, 0)), HASH, writes=True)) == (HASH, Qos())


def test_who_says_no_hash() -> None:
    assert promises_of(dds_qos(Qos(), "x", writes=False))[0] == NO_HASH
