"""A connection's priority: give its thread and packets what was asked, read back what was granted.

Rules: everything is checked before anything is changed; what the system refuses changes nothing,
but stays known as what was asked. An output that is scheduled gets a thread of its own, which sends
from then on.
"""

from __future__ import annotations

from dataclasses import replace

from yarpy.errors import LocalProtocolError
from yarpy.link.receive.inbound import Inbound
from yarpy.link.send.outbound import Outbound
from yarpy.qos import Qos, Sched, check, packets_name, schedule, scheduled


def grant_sched(link: Inbound | Outbound, wanted: Sched) -> None:
    """Schedule a link's thread; what is -1 stays as it is.

    Raises ValueError for what no kernel takes, LocalProtocolError if this one refuses.
    """
    now = link.sched
    sched = Sched(
        now.policy if wanted.policy < 0 else wanted.policy,
        now.priority if wanted.priority < 0 else wanted.priority,
    )
    if wanted.policy == 0 and wanted.priority < 0:
        sched = Sched(0, 0)
    check(sched)
    asked = Qos.of(sched, -1)
    link.asked = replace(link.asked, policy=asked.policy, priority=asked.priority)
    own = sched.policy > 0
    if own and isinstance(link, Outbound) and thread_of(link) < 0:
        link.start_background()
    thread = thread_of(link)
    if thread >= 0 and sched.policy >= 0:
        schedule(thread, sched)
    link.sched = sched
    if own and isinstance(link, Inbound):
        link.turn.end()  # from now on the link's thread reads, not the one that wants a message


def grant_tos(link: Inbound | Outbound, tos: int) -> None:
    """Mark what a link sends (an input sends acknowledgements and replies).

    Raises LocalProtocolError if the system refuses.
    """
    if not 0 <= tos < 256:
        raise ValueError(f"a TOS byte lies between 0 and 255, not {tos}")
    link.asked = replace(link.asked, packets=packets_name(tos))
    try:
        link.driver.transport.set_dscp(tos)
    except OSError as error:
        raise LocalProtocolError(
            f"the system refuses to mark packets with TOS {tos} ({error.strerror})"
        ) from error
    link.tos = tos


def grant(link: Inbound | Outbound, qos: Qos) -> None:
    """Give a connection what `qos` says. Raises ValueError, LocalProtocolError."""
    if qos.policy is not None or qos.priority is not None:
        grant_sched(link, qos.sched)
    if qos.packets is not None:
        grant_tos(link, qos.tos)
    if qos.timed:
        link.expect(qos)


def effective(link: Inbound | Outbound) -> Qos:
    """Return the scheduling and packet priority that a connection really has; without a thread of
    its own, no scheduling."""
    thread = thread_of(link)
    sched = scheduled(thread) if thread >= 0 else Sched()
    found = Qos.of(sched, link.driver.transport.tos())
    wanted = link.wanted
    if wanted is None:
        return found
    return replace(found, deadline=wanted.deadline, rate=wanted.rate, late=wanted.late)


def thread_of(link: Inbound | Outbound) -> int:
    """The kernel's id of a link's thread, -1 if it has none of its own."""
    thread = link.thread
    return thread.native_id if thread is not None and thread.native_id is not None else -1
