"""A case for the doctor, made up instead of asked for: what ports would say at two looks.

    case = made_up(Flow("/a", "/b", End(messages=3)), Flow("/a", "/b", End(messages=9)))

Two flows of the same ends are the two looks; one alone is both.
"""

from __future__ import annotations

import threading
from pathlib import Path

from yarpy.config.configuration import Configuration, Server
from yarpy.contact import Contact
from yarpy.kits.doctor.case import Case
from yarpy.kits.doctor.peek import Peek
from yarpy.network.traffic import Flow, PortState, Snapshot


def made_up(
    *flows: Flow,
    wanted: tuple[str, ...] = ("/a", "/b"),
    ports: tuple[PortState, ...] = (),
    peeks: dict[str, Peek] | None = None,
    servers: tuple[Server, ...] = (),
    directory: Path = Path("/nonexistent"),
) -> Case:
    """See above. Ports that are not given answer, and are of yarpy."""
    case = Case.__new__(Case)
    case.wanted, case.environment = wanted, {}
    case.shared_memory = directory
    case.problem = case.names = None
    case.before, case.now, case.seconds = Snapshot(0.0), Snapshot(1.0), 1.0
    for flow in flows:
        key = flow.source, flow.target
        case.before.flows.setdefault(key, flow)
        case.now.flows[key] = flow
    given = {port.name: port for port in ports}
    for name in {*wanted, *(end for flow in flows for end in (flow.source, flow.target))}:
        case.now.ports[name] = given.pop(name, None) or answering(name)
    case.now.ports.update(given)
    case.contacts = {name: port.contact for name, port in case.now.ports.items()}
    case.configuration = Configuration(servers, (), directory)
    case._peeks = {**dict.fromkeys(case.now.ports, Peek()), **(peeks or {})}
    case._lock = threading.RLock()
    return case


def answering(name: str, **facts: object) -> PortState:
    """A port that answers, and cannot be reached."""
    state = PortState(name, Contact("tcp", name, "192.0.2.1", 9), "answers", ours=True)
    for key, value in facts.items():
        setattr(state, key, value)
    return state
