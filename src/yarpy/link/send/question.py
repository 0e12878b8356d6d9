"""A question: a message whose sender waits for the reply, over the same connection.

Rules: the sender's lock is held, and nothing is left to be sent. The question waits until every
message before it was acknowledged; nothing else is sent until its answer is there. One that does
not get it in time, or whose port is interrupted or closed, ends the connection: a late reply must
not answer the next question.
"""

from __future__ import annotations

import time
from typing import TYPE_CHECKING

from yarpy.data.codec import LISTS
from yarpy.errors import Timeout, YarpError
from yarpy.link.send.sender import interrupts

if TYPE_CHECKING:
    from yarpy.link.receive.incoming import Incoming
    from yarpy.link.send.sender import Sender
    from yarpy.wire.message import Message, Packet


def exchange(
    sender: Sender, incoming: Incoming, packet: Packet, until: float | None
) -> Message | None:
    """Send a question and return its reply; None if the peer has none to give. Raises Timeout,
    LinkClosed, PortClosed."""
    driver, carrier, counter = sender.driver, sender.carrier, sender.counter
    stream, started = driver.stream, time.perf_counter()
    allowed = 0.0 if until is None else round(until - time.monotonic(), 2)
    counted = False
    try:
        sender.asking = True
        if sender.ending.reason:  # behind that: who ends the port looks the other way round
            sender.ending.check()
        if sender.window.open and not sender.window.collect(wait=True, until=until):
            raise Timeout("the messages before it were not acknowledged")
        value = packet.value
        end = None if type(value) in LISTS else getattr(value, "reply_end", None)
        carrier.reply_end = end
        newest = sender.route.yarp4 and sender.respells
        carrier.encode(stream, packet.newest if newest else packet)
        if (sender.gathered or not driver.push()) and not sender.flush(until):
            raise Timeout("the peer does not read what is sent")
        # What need not be done before the question leaves is done while the peer works on it.
        counter.count(started)
        counted = True
        counter.bytes = driver.bytes_out
        if carrier.limits.ping_interval:
            sender.listen(True)
        if stream.head == stream.tail:
            driver.fill(until)
        reply = carrier.parse_reply(stream) if end is None else None
        if reply is None:
            reply = driver.run(carrier.expect_reply(stream), until, incoming)
        if carrier.acks and not carrier.parse_acks(stream, 1):
            driver.run(carrier.expect_ack(stream), until)
        counter.measure(time.perf_counter() - started)
        return reply
    except BaseException as error:
        if counted:
            counter.messages -= 1
        if interrupts(error):
            sender.give_up()
        if isinstance(error, YarpError):
            sender.ending.check()
        if isinstance(error, Timeout):
            peer = sender.route.target
            raise Timeout(
                f'"{peer}" did not reply within {allowed:g} s; is its program stuck?'
            ) from None
        raise
    finally:
        sender.asking = False
        if sender.listens:
            sender.listen(False)
        if until is not None:
            driver.disarm()
        if sender.broken:
            incoming.leave()
