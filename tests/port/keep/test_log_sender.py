"""A port that tells whoever reads it, also late, what was put into it.

test_log_forwarding.py has the log of a program.
"""

from functools import partial

from support.wait import HANG, wait_until

import yarpy
from yarpy.nameserver.local import LocalNames
from yarpy.port.assembly import open_hub
from yarpy.port.keep.log_sender import LogSender
from yarpy.wire.message import Packet


def test_all_lines_come_in_order_and_the_end_waits_for_them() -> None:
    names = LocalNames()
    sender = LogSender(
        partial(open_hub, names=names), "/log", lambda lost: Packet(-lost), "/logger", 10_000
    )
    with yarpy.BufferedPort("/logger", strict=True, names=names) as logger:
        assert sender.ident is None
        sender.open()
        assert logger.wait_for_inputs(timeout=HANG)
        sender.put([Packet(number) for number in range(5000)])
        sender.close(HANG)
        assert [logger.read(HANG).value for _ in range(5000)] == [*range(5000)]
    assert names.query("/log") is None


def test_nobody_has_to_be_there() -> None:
    names = LocalNames()
    sender = LogSender(partial(open_hub, names=names), "/log", Packet, "/nobody", 2)
    sender.put([Packet(1), Packet(2), Packet(3)])
    wait_until(lambda: names.query("/log"))
    sender.close()
    assert names.query("/log") is None
