"""A network of any size that exists on paper: for pages and tables that show one."""

from __future__ import annotations

from yarpy.contact import Contact
from yarpy.network.traffic import End, Flow, PortState, Snapshot


def large(ports: int, links: int) -> Snapshot:
    """A network of programs with ten ports each."""
    found = Snapshot(1.0)
    for number in range(ports):
        name = f"/robot{number % 7}/module{number // 10}/port{number % 10}"
        found.ports[name] = PortState(
            name,
            Contact("tcp", name, f"10.0.0.{number % 5}", 10000 + number),
            "answers" if number % 50 else "silent",
            ours=True,
            pid=number // 10 + 1,
            program=f"python module{number // 10}.py",
            host=f"host{number // 10 % 5}",
        )
    known = list(found.ports)
    for number in range(links):
        pair = known[number * 7 % ports], known[(number * 13 + number // ports * 29 + 5) % ports]
        end = End("tcp", messages=number, drops=0, rate=number % 40)
        found.flows[pair] = Flow(*pair, sender=end, rate=float(number % 40), speed=1e3 * number)
    return found
