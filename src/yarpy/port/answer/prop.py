"""`prop get` and `prop set` of a port: its process, its threads, the priority of its connections.

Rules: the shapes are those of C++ YARP. Settings apply to the first
connection with that peer.
"""

from __future__ import annotations

import os
import sys
import threading
from typing import Any, Final

from yarpy.data.bottle import Bottle, Property
from yarpy.data.text import plain_text
from yarpy.errors import LocalProtocolError
from yarpy.link.qos import grant_sched, grant_tos, thread_of
from yarpy.link.receive.inbound import Inbound
from yarpy.link.send.outbound import Outbound
from yarpy.monitors.chain import Chain
from yarpy.port.hub import Hub
from yarpy.qos import Qos, Sched, policy_of, schedule, scheduled, tos_of

TIMING: Final = ("deadline", "rate", "late")


def get_self(hub: Hub) -> Bottle:
    """Scheduling of the accepting thread, the process, the platform, the port's kind."""
    import platform  # which is not small, for one word

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
                        is_output=int(hub.outputs.admitted),
                        is_rpc=int(hub.outputs.rpc),
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


def set_self(hub: Hub, request: Bottle) -> None:
    """`(process ((priority N) (policy P)))`: every thread of the process. Raises as `set_peer`."""
    if request.group("process") is None:
        return
    sched = _sched(_group(request, "process"), Sched(0, 0))
    for thread in threading.enumerate():
        if thread.native_id is not None:
            schedule(thread.native_id, sched)


def set_peer(hub: Hub, name: str, request: Bottle) -> None:
    """`(sched ((priority N) (policy P))) (qos ((priority HIGH))) (timing ((deadline S) (rate HZ)
    (late drop))) (monitor ((KEY VALUE)))` on the first connection.

    Raises ValueError for what makes no sense and C++ refuses, too; LocalProtocolError for the rest.
    """
    keys = ("sched", "qos", "timing", "monitor")
    wanted = [key for key in keys if request.group(key) is not None]
    links = _links(hub, name)
    if not links:
        if wanted:
            raise ValueError(f"cannot find any connection to/from {name}")
        return
    link = links[0]
    if "sched" in wanted:
        grant_sched(link, _sched(_group(request, "sched"), Sched()))
    if "qos" in wanted:
        grant_tos(link, _tos(_group(request, "qos")))
    if "timing" in wanted:
        try:
            link.expect(Qos(**_wishes(_group(request, "timing"))))
        except ValueError as error:
            raise LocalProtocolError(str(error)) from error
    if "monitor" in wanted:
        group, chain = _group(request, "monitor"), _chain(link)
        if chain is None or not chain.configure(Property.from_bottle(group)):
            raise LocalProtocolError("there is no monitor here that takes parameters")


def _chain(link: Inbound | Outbound) -> Chain | None:
    """The monitors that ride on our end of a connection."""
    return link.own_chain if isinstance(link, Inbound) else link.chain


def _links(hub: Hub, name: str) -> list[Inbound | Outbound]:
    out: list[Inbound | Outbound] = [x for x in hub.outputs.links if x.route.target == name]
    return [*out, *(x for x in hub.inputs.links if x.route.source == name)]


def _group(request: Bottle, key: str) -> Bottle:
    """The list of lists behind `key`; a dict is refused, as C++ does."""
    value = request.find(key)
    if not isinstance(value, Bottle) or not value:
        raise ValueError(f"{key} is followed by a list of lists: ({key} ((KEY VALUE)))")
    return value


def _sched(group: Bottle, default: Sched) -> Sched:
    policy, priority = group.find("policy"), group.find("priority")
    whole = isinstance(priority, int) or (isinstance(priority, float) and priority.is_integer())
    if priority is not None and not whole:
        raise ValueError(f"the priority of a thread is a whole number, not {priority!r:.40}")
    if policy is not None and not isinstance(policy, int | str):
        raise ValueError(f"a scheduling policy is a name or a number, not {policy!r:.40}")
    return Sched(
        default.policy if policy is None or policy == -1 else policy_of(policy),
        default.priority if priority is None or priority == -1 else int(priority),
    )


def _tos(group: Bottle) -> int:
    level, dscp, tos = group.find("priority"), group.find("dscp"), group.find("tos")
    if isinstance(level, str):
        return tos_of(level)
    if isinstance(dscp, int | str):
        return tos_of(dscp)
    if isinstance(tos, int) and 0 <= tos < 256:
        return tos
    raise ValueError("a packet priority is a level, a DSCP class or a TOS byte")


def _wishes(group: Bottle) -> dict[str, Any]:
    """Return the timing that is asked for; a word that is misspelt is refused and not passed
    over."""
    found: dict[str, Any] = {}
    for item in group:
        key = plain_text(item[0]) if isinstance(item, Bottle) and len(item) == 2 else ""
        if key not in TIMING:
            raise ValueError(
                f'"{key:.40}" is none of ((deadline SECONDS) (rate HZ) (late drop)), which timing '
                "takes; a deadline or a rate of 0 ends it"
            )
        found[key] = _plain(item[1])
    return found


def _plain(value: Any) -> Any:
    return str(value) if isinstance(value, str) else value


def _timing(wanted: Qos) -> Property:
    found = ((key, getattr(wanted, key)) for key in TIMING)
    return Property((key, value) for key, value in found if value is not None)


def _dict(**values: Any) -> Property:
    return Property(**values)
