"""`prop get` and `prop set` of a port: its process, its threads, the priority of its connections.

Rules: the shapes are those of C++ YARP. Settings apply to the first
connection with that peer.
"""

from __future__ import annotations

import os
import platform
import sys
import threading
from typing import Any

from yarpy.data.bottle import Bottle, Property
from yarpy.link.inbound import Inbound
from yarpy.link.outbound import Outbound
from yarpy.link.qos import grant_sched, grant_tos, thread_of
from yarpy.monitors.chain import Chain
from yarpy.port.hub import Hub
from yarpy.qos import Qos, Sched, policy_of, schedule, scheduled, tos_of


def get_self(hub: Hub) -> Bottle:
    """Scheduling of the accepting thread, the process, the platform, the port's kind."""
    argv = sys.orig_argv
    thread = hub.reception.thread_id
    own, process = scheduled(thread), scheduled(os.getpid())
    return Bottle(
        [
            Bottle(["sched", _dict(policy=own.policy, priority=own.priority, tid=thread)]),
            Bottle(
                [
                    "process",
                    _dict(
                        arguments=" ".join(argv[1:])[:256],
                        name=argv[0] if argv else "unknown",
                        pid=os.getpid(),
                        policy=process.policy,
                        priority=process.priority,
                    ),
                ]
            ),
            Bottle(["platform", _dict(hostname=hub.contact.host, os=platform.system())]),
            Bottle(
                [
                    "port",
                    _dict(
                        is_input=1,
                        is_output=int(hub.admits_outputs),
                        is_rpc=int(hub.rpc),
                        type=hub.registration.type,
                    ),
                ]
            ),
        ]
    )


def get_peer(hub: Hub, name: str) -> Bottle | None:
    """Scheduling and packet priority of each connection with `name`; None if there is none."""
    reply = Bottle()
    for link in _links(hub, name):
        chain = _chain(link)
        thread = thread_of(link)
        sched = scheduled(thread) if thread >= 0 else link.sched
        reply += [
            Bottle(["sched", _dict(policy=sched.policy, priority=sched.priority, tid=thread)]),
            Bottle(["qos", _dict(tos=link.tos)]),
        ]
        if link.wanted is not None:
            reply.append(Bottle(["timing", _timing(link.wanted)]))
        if chain is not None:
            reply.append(Bottle(["monitor", chain.parameters()]))
            state = chain.state()
            if state:
                reply.append(Bottle(["state", state]))
    return reply or None


def set_self(hub: Hub, request: Bottle) -> bool:
    """`(process ((priority N) (policy P)))`: every thread of the process."""
    if request.group("process") is None:
        return True
    group = _group(request, "process")
    if group is None:
        return False
    sched = _sched(group, Sched(0, 0))
    for thread in threading.enumerate():
        if thread.native_id is not None:
            schedule(thread.native_id, sched)
    return True


def set_peer(hub: Hub, name: str, request: Bottle) -> bool:
    """`(sched ((priority N) (policy P))) (qos ((priority HIGH))) (timing ((deadline S) (rate HZ)
    (late drop))) (monitor ((KEY VALUE)))` on the first connection."""
    keys = ("sched", "qos", "timing", "monitor")
    wanted = [key for key in keys if request.group(key) is not None]
    links = _links(hub, name)
    if not links:
        return not wanted
    link = links[0]
    if "sched" in wanted:
        group = _group(request, "sched")
        if group is None:
            return False
        grant_sched(link, _sched(group, Sched()))
    if "qos" in wanted:
        group = _group(request, "qos")
        if group is None:
            return False
        grant_tos(link, _tos(group))
    if "timing" in wanted:
        group = _group(request, "timing")
        if group is None:
            return False
        told = {key: _plain(group.find(key)) for key in ("deadline", "rate", "late")}
        link.expect(Qos(**told))
    if "monitor" in wanted:
        group, chain = _group(request, "monitor"), _chain(link)
        if group is None or chain is None or not chain.configure(Property.from_bottle(group)):
            return False
    return True


def _chain(link: Inbound | Outbound) -> Chain | None:
    """The monitors that ride on our end of a connection."""
    return link.own_chain if isinstance(link, Inbound) else link.chain


def _links(hub: Hub, name: str) -> list[Inbound | Outbound]:
    out: list[Inbound | Outbound] = [x for x in hub.outputs if x.route.target == name]
    return [*out, *(x for x in hub.inputs if x.route.source == name)]


def _group(request: Bottle, key: str) -> Bottle | None:
    """The list of lists behind `key`; a dict is refused, as C++ does."""
    value = request.find(key)
    return value if isinstance(value, Bottle) and value else None


def _sched(group: Bottle, default: Sched) -> Sched:
    policy, priority = group.find("policy"), group.find("priority")
    return Sched(
        default.policy if policy is None or policy == -1 else policy_of(policy),
        default.priority if priority is None or priority == -1 else int(priority),
    )


def _tos(group: Bottle) -> int:
    level, dscp, tos = group.find("priority"), group.find("dscp"), group.find("tos")
    if isinstance(level, str):
        return tos_of(level)
    if dscp is not None:
        return tos_of(dscp)
    if isinstance(tos, int) and 0 <= tos < 256:
        return tos
    raise ValueError("a packet priority is a level, a DSCP class or a TOS byte")


def _plain(value: Any) -> Any:
    return str(value) if isinstance(value, str) else value


def _timing(wanted: Qos) -> Property:
    found = {"deadline": wanted.deadline, "rate": wanted.rate, "late": wanted.late}
    return Property((key, value) for key, value in found.items() if value is not None)


def _dict(**values: Any) -> Property:
    return Property(**values)
