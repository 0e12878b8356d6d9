"""Report: how every connection of a port is doing - the answer to the administrative word [stat].

Rules: our own word; C++ ports do not know it. One list per connection, of `(key value)` pairs, so
that a person at a text prompt can read it too. Times in seconds, rates per second; a number that
nobody measured is missing. What was written and is lost with the connections that have ended, or
since there was none, comes last, without a target. `[stat] [in] NAME` and `[stat] [out] NAME` tell
of one connection.
"""

from __future__ import annotations

from yarpy.data.bottle import Bottle, Property
from yarpy.link.inbound import Inbound
from yarpy.link.outbound import Outbound
from yarpy.link.qos import effective
from yarpy.port.hub import Hub
from yarpy.port.monitoring import Side, monitored

COUNTED = ("messages", "bytes", "drops", "unconfirmed")
MEASURED = ("rate", "jitter", "latency")  # of these a zero says: not known


def report(hub: Hub) -> Bottle:
    """Every connection of `hub` with another port; passing visitors have no rooted name."""
    found = Bottle(connection(link) for link in hub.outputs)
    found += [connection(link) for link in hub.inputs if link.route.source.startswith("/")]
    past = hub.past["outputs"].as_dict()
    if hub.unconnected or past["drops"] or past["unconfirmed"]:
        found.append(
            Property(side="out", source=hub.name, target="", unconnected=hub.unconnected, **past)
        )
    return found


def report_one(hub: Hub, side: Side, peer: str) -> Bottle:
    """The connection with `peer` on that side, if there is one."""
    if side == "in":
        return Bottle(connection(link) for link in hub.inputs if link.route.source == peer)
    return Bottle(connection(link) for link in hub.outputs if link.route.target == peer)


def connection(link: Inbound | Outbound) -> Property:
    """One connection."""
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
    if qos.policy is not None:
        found["policy"], found["priority"] = qos.policy, qos.priority
    monitors = monitored(link)
    if monitors:
        chain = link.own_chain if isinstance(link, Inbound) else link.chain
        found["monitors"] = Bottle(monitors)
        if chain is not None:
            found["parameters"], found["state"] = chain.parameters(), chain.state()
    return found
