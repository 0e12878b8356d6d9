"""Report: how every connection of a port is doing - the answer to the administrative word [stat].

Rules: our own word; C++ ports do not know it. One list per connection, of `(key value)` pairs, so
that a person at a text prompt can read it too. Times in seconds, rates per second; a number that
nobody measured is missing. What was written and is lost with the connections that have ended, or
since there was none, comes last, without a target. `[stat] [in] NAME` and `[stat] [out] NAME` tell
of one connection.

An input also tells what `yarpy doctor` asks for: `delivered` messages went on to the program,
`waiting` of all inputs it has not taken yet, `lost` ones were lost on the way, `failure` is what it
said last of one that it could not use; an output: how many messages are `unacknowledged`. `asked`
are priorities that are not what the system does, `timing` what is expected of the messages, and
how often that was `missed`. Behind `monitors` stand what each has `dropped`,
and their `failures`; `port_monitor` is the one of the port itself.
"""

from __future__ import annotations

from typing import Any

from yarpy.data.bottle import Bottle, Property
from yarpy.link.qos import effective
from yarpy.link.receive.inbound import Inbound
from yarpy.link.send.outbound import Outbound
from yarpy.port.answer.monitoring import Side, monitored
from yarpy.port.hub import Hub
from yarpy.qos import Qos

LONGEST = 300  # characters of an error that is passed on
COUNTED = ("messages", "bytes", "replaced", "drops", "unconfirmed")
MEASURED = ("rate", "jitter", "latency")  # of these a zero says: not known


def report(hub: Hub) -> Bottle:
    """Every connection of `hub` with another port; passing visitors have no rooted name."""
    found = Bottle(connection(hub, link) for link in hub.outputs.links)
    found += [
        connection(hub, link) for link in hub.inputs.links if link.route.source.startswith("/")
    ]
    past = hub.outputs.past.as_dict()
    if hub.outputs.unconnected or past["drops"] or past["unconfirmed"]:
        found.append(
            Property(
                side="out", source=hub.name, target="", unconnected=hub.outputs.unconnected, **past
            )
        )
    return found


def report_one(hub: Hub, side: Side, peer: str) -> Bottle:
    """The connection with `peer` on that side, if there is one."""
    if side == "in":
        return Bottle(
            connection(hub, link) for link in hub.inputs.links if link.route.source == peer
        )
    return Bottle(connection(hub, link) for link in hub.outputs.links if link.route.target == peer)


def connection(hub: Hub, link: Inbound | Outbound) -> Property:
    """One connection of `hub`."""
    stats, qos, route = link.snapshot(), effective(link), link.route
    found = Property(
        side="in" if isinstance(link, Inbound) else "out",
        source=route.source,
        target=route.target,
        carrier=route.carrier,
        packets=str(qos.packets),
        **{key: stats[key] for key in COUNTED},
        **{key: float(stats[key]) for key in MEASURED if stats[key]},
    )
    if isinstance(link, Inbound):  # what its sender need not count as lost
        found["received"] = link.counter.messages + link.lost
        found["delivered"] = link.counter.messages - link.counter.replaced - link.counter.drops
        found["waiting"], found["lost"] = hub.inputs.mailbox.waiting, link.lost
        if link.failure:
            found["failure"] = link.failure[:LONGEST]
    else:
        found["unacknowledged"] = stats["unacknowledged"]
    if isinstance(link, Inbound) and link.timing is not None:
        found["timing"] = Property(link.timing.as_dict())
    elif isinstance(link, Outbound) and link.wanted is not None:
        found["timing"] = Property(dropped=link.late, **_given(link.wanted))
    asked = _unfulfilled(link.asked, qos)
    if asked:
        found["asked"] = asked
    if qos.policy is not None:
        found["policy"], found["priority"] = qos.policy, qos.priority
    monitors = monitored(link)
    if monitors:
        chain = link.own_chain if isinstance(link, Inbound) else link.chain
        found["monitors"] = Bottle(monitors)
        if chain is not None:
            found["parameters"], found["state"] = chain.parameters(), chain.state()
            found["dropped"], found["failures"] = Bottle(chain.dropped), _short(chain.failures)
    own = hub.monitoring.input if isinstance(link, Inbound) else hub.monitoring.output
    if own is not None:
        found["port_monitor"] = type(own.monitors[0]).__name__
        found["port_dropped"], found["port_failures"] = own.dropped[0], _short(own.failures)
    return found


def _given(wanted: Qos) -> dict[str, Any]:
    told = {"deadline": wanted.deadline, "rate": wanted.rate, "late": wanted.late}
    return {key: value for key, value in told.items() if value is not None}


def _short(texts: list[str]) -> Bottle:
    return Bottle(text[:LONGEST] for text in texts)


def _unfulfilled(asked: Qos, granted: Qos) -> Property:
    """Return what was asked for and not granted."""
    return Property(
        (key, value)
        for key in ("policy", "priority", "packets")
        if (value := getattr(asked, key)) is not None and value != getattr(granted, key)
    )
