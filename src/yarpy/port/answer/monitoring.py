"""Monitoring: the monitors of a port and of its connections - who sits where, and their parameters.

Rules: what rides on a connection is named by its carrier string (`+send.NAME`, `+recv.NAME`); what
rides on the port itself is attached by an administrative message, in front of every output or
behind every input. A port without monitors has no chain, and pays nothing.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Literal, Protocol, TypeAlias

from yarpy.config.resource import Search
from yarpy.data.bottle import Bottle, Property
from yarpy.data.text import plain_text
from yarpy.link.begin.admission import SCRIPT, scripts_allowed
from yarpy.link.receive.inbound import Inbound
from yarpy.link.send.outbound import Outbound
from yarpy.monitors.base import Group, Place
from yarpy.monitors.chain import Chain, from_carrier, make
from yarpy.names.base import NameClient
from yarpy.port.answer.guard import Inputs, Outputs
from yarpy.route import Route

Side: TypeAlias = Literal["in", "out"]  # of a port
DEFAULT = "portmonitor"  # the monitor that is attached when none is named


class Monitored(Protocol):
    """The port, as far as monitors need it."""

    @property
    def inputs(self) -> Inputs: ...

    @property
    def outputs(self) -> Outputs: ...

    @property
    def name(self) -> str: ...

    @property
    def limit(self) -> int:
        """The largest message, in bytes."""

    def service(self) -> NameClient | None:
        """The name service to look others up with."""


class Monitoring:
    """The monitors of one port."""

    def __init__(self, port: Monitored) -> None:
        self._port = port
        self.group = Group()
        self.input: Chain | None = None  # the port's own, behind the chain of each input
        self.output: Chain | None = None  # the port's own, in front of the chain of each output

    # -- connections ------------------------------------------------------------------------------

    def outgoing(self, route: Route) -> Chain | None:
        """The sender's chain of a connection that is about to be made. Raises as `make`."""
        if not route.spec.send:
            return None
        monitors = from_carrier(route.spec, self._place(route, sending=True))
        return Chain(monitors, str(route))

    def incoming(self, link: Inbound) -> None:
        """Give a new input its chain. Raises as `make`."""
        route = link.route
        if not route.spec.recv:
            link.join(self.input)
            return
        place = self._place(route, sending=False)
        if link.driver.admission.allows(SCRIPT):
            place = replace(place, scripts=True)
        monitors = from_carrier(route.spec, place)
        for monitor in monitors:
            self.group.add(monitor)
        link.own_chain = Chain(monitors, str(route), self.group)
        link.join(self.input)

    def _place(self, route: Route, sending: bool) -> Place:
        group = Group() if sending else self.group
        end = route.source, route.target, route.carrier, sending
        names = self._port.service()
        return Place(
            *end,
            group=group,
            limit=self._port.limit,
            names=names,
            look=_look,
            foreign=not route.spec.own,
            scripts=route.spec.scripts,
        )

    # -- the port itself --------------------------------------------------------------------------

    def attach(self, side: Side, parameters: Property, own: bool = False) -> None:
        """Let a monitor ride on the port; it replaces the one that did. Raises as `make`.

        `(monitor NAME)` among the parameters says which, else it is a portmonitor; the others are
        its own. `own`: the program says so, not somebody on the network.
        """
        route = Route(self._port.name, "", "") if side == "out" else Route("", self._port.name, "")
        tokens = tuple(_token(parameters, key) for key in parameters if key != "monitor")
        place = replace(
            self._place(route, sending=side == "out"),
            tokens=tokens,
            shared=tokens,
            group=Group(),
            foreign=not own,
            scripts=scripts_allowed(),
        )
        fresh = Chain([make(str(parameters.get("monitor", DEFAULT)), place)], str(place))
        self.detach(side)
        self._set(side, fresh)

    def detach(self, side: Side) -> None:
        """Let nothing ride on the port any more."""
        old = self.input if side == "in" else self.output
        self._set(side, None)
        if old is not None:
            old.close()

    def _set(self, side: Side, chain: Chain | None) -> None:
        if side == "out":
            self.output = chain
            return
        self.input = chain
        for link in self._port.inputs.links:
            link.join(self.input)

    # -- parameters -------------------------------------------------------------------------------

    def chain(self, side: Side, name: str) -> Chain | None:
        """The chain of the connection from or to `name`, or the port's own if that is its name."""
        if name == self._port.name:
            return self.input if side == "in" else self.output
        if side == "in":
            return next(
                (x.own_chain for x in self._port.inputs.links if x.route.source == name), None
            )
        return next((x.chain for x in self._port.outputs.links if x.route.target == name), None)

    def close(self) -> None:
        """The port closes."""
        self.detach("in")
        self.detach("out")


def _look(name: str, contexts: Sequence[str]) -> Iterator[Path]:
    """Return the paths that a monitor's file may have: where configuration files are looked for."""
    return Search(contexts=contexts).candidates(name)


def _token(parameters: Property, key: str) -> str:
    """A parameter as it stands in a carrier string."""
    group = parameters.group(key) or Bottle([key])
    if len(group) == 1:
        return key
    if len(group) > 2 or isinstance(group[1], list):
        return f"({group.to_text()})"
    return f"{key}.{plain_text(group[1])}"


def monitored(link: Inbound | Outbound) -> list[str]:
    """The names of the monitors that ride on our end of a connection."""
    spec = link.route.spec
    return [name for name, _ in (spec.recv if isinstance(link, Inbound) else spec.send)]
