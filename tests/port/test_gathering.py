"""A port that keeps what many connections send: one thread reads them while they send little."""

from __future__ import annotations

import threading

from support.wait import wait_until

from yarpy.link.receive.gather import ABLE
from yarpy.nameserver.local import LocalNames
from yarpy.port.assembly import open_hub
from yarpy.port.gathering import Gathering
from yarpy.port.port import MessagePort, Port
from yarpy.wire.message import Message


def test_every_message_comes_in_the_order_of_its_sender(names: LocalNames) -> None:
    heard: dict[str, list[int]] = {}
    threads: set[str] = set()

    def take(message: Message) -> None:
        heard.setdefault(message.source, []).append(message.value[0])
        threads.add(threading.current_thread().name)

    with MessagePort(open_hub("/in", Gathering(take), names)) as in_:
        outs = [Port(f"/out/{number}", names=names) for number in range(8)]
        for out in outs:
            out.connect("/in")
        for number in range(200):
            for out in outs:
                out.write([number, "x" * (number % 40) ** 3], wait=True)
        assert heard == {out.name: [*range(200)] for out in outs}
        assert ("yarpy gather" in threads) == ABLE
        outs[0].close()
        wait_until(lambda: len(in_.inputs) == 7)
        outs[1].write([200], wait=True)
        assert heard["/out/1"][-1] == 200
        assert sum(one.stats.drops for one in in_.inputs) == 0
        in_.close()
        for out in outs[1:]:
            wait_until(lambda out=out: not out.outputs)  # type: ignore[misc]
            out.close()
