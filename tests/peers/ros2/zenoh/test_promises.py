"""The quality of service over Zenoh: nobody is kept out, and what we say of it others see. The
other side is zenoh-ros2-sdk.
"""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest
from support.process import Process
from support.ros2_peer import peer_command, peer_environment
from support.wait import wait_until

import yarpy
from yarpy.peers import ros2
from yarpy.peers.ros2.zenoh.participant import take_part

TYPE = "std_msgs/msg/String"
TABLE: dict[str, tuple[dict[str, Any], str]] = {
    "default": ({}, "::,10:,:,:,,"),
    "reliability": ({"reliability": "best_effort"}, "2::,10:,:,:,,"),
    "durability": ({"durability": "transient_local"}, ":1:,10:,:,:,,"),
    "history": ({"history": "keep_all"}, "::2,10:,:,:,,"),
    "depth": ({"depth": 3}, "::,3:,:,:,,"),
    "deadline": ({"deadline": 0.5}, "::,10:0,500000000:,:,,"),
    "lifespan": ({"lifespan": 2}, "::,10:,:2,0:,,"),
    "liveliness": ({"liveliness": "manual_by_topic", "lease": 1}, "::,10:,:,:3,1,0"),
}


def test_publishers_of_all_kinds_are_heard(
    names: yarpy.LocalNames, router: int, tmp_path: Path
) -> None:
    with Process(
        peer_command(router, "hear", "/promised"), env=peer_environment(tmp_path)
    ) as hears:
        hears.wait_line("ready", stream="out")
        part = take_part(0)
        try:
            for name, (said, text) in TABLE.items():
                with ros2.Node("/promises") as node:
                    writer = node.publisher("/promised", TYPE, qos=ros2.qos_profile(**said))
                    (ours,) = part.graph.endpoints("/promised", "MP")
                    assert str(ours.qos) == text

                    def heard(writer: Any = writer, name: str = name) -> bool:
                        writer.write(name)
                        return json.dumps(name) in hears.stdout.splitlines()

                    wait_until(heard)
                wait_until(lambda: not part.graph.endpoints("/promised", "MP"))
        finally:
            part.close()


@pytest.mark.parametrize("theirs", ["2::,5:,:,:,,", "::,10:,:,:,,"])
def test_subscribers_of_all_kinds_hear(
    names: yarpy.LocalNames, router: int, tmp_path: Path, theirs: str
) -> None:
    command = peer_command(router, "say", "/told", f"qos={theirs}")
    heard: dict[str, list[str]] = {name: [] for name in TABLE}
    with (
        Process(command, env=peer_environment(tmp_path)) as says,
        ros2.Node("/promises") as node,
    ):
        for name, (said, _) in TABLE.items():

            def hear(message: Any, name: str = name) -> None:
                heard[name].append(message.data)

            node.subscriber("/told", TYPE, hear, qos=ros2.qos_profile(**said))
        says.wait_line("ready", stream="out")

        def all_heard() -> bool:
            says.write_line("hello")
            return all(heard.values())

        wait_until(all_heard)


def test_what_is_lost_is_an_event(names: yarpy.LocalNames) -> None:
    import zenoh

    from yarpy.peers.ros2.zenoh.attachment import attachment
    from yarpy.peers.ros2.zenoh.subscriber import MOST_PUBLISHERS

    events: list[ros2.Event] = []

    class Sample:
        payload = zenoh.ZBytes(b"")

    with ros2.Node("/promises") as node:
        made: Any = node.subscriber("/lost", TYPE, print, on_event=events.append)
        for number in (1, 2, 6):
            sample: Any = Sample()
            sample.attachment = zenoh.ZBytes(attachment(number, 1, bytes(16)))
            made._heard(sample)
        assert events == [("message_lost", 3, "")]
        assert made.events.counts["message_lost"] == 3
        # A publisher that flaps has another identity each time: the last ones are followed.
        for at in range(2 * MOST_PUBLISHERS):
            sample = Sample()
            sample.attachment = zenoh.ZBytes(attachment(1, 1, at.to_bytes(16, "big")))
            made._heard(sample)
        assert len(made._numbers) == MOST_PUBLISHERS
        sample.attachment = zenoh.ZBytes(attachment(4, 1, at.to_bytes(16, "big")))
        made._heard(sample)
        assert made.events.counts["message_lost"] == 5
