"""priority: of several connections into a port, let one at a time through.

    yarpy connect /ball /eye tcp+recv.priority+st.10+tc.1+bs.20

Rules: put it at the receiving end of every connection that takes part; connections without it
always get through. Only these parameters are sent to the receiver, as in C++:

    tc       seconds that a message keeps its connection active (1)
    tr       seconds that it rests after having been active; above 0 it behaves as a neuron (0)
    st       what one message adds, 10 makes it active immediately (10)
    bs       its strength: the strongest active connection wins (10)
    ex       links to others, `(/source weight)`: above 0 excite, below 0 inhibit it
    virtual  it never gets through, it only excites and inhibits

In the carrier string, 10 in `st`, `bs` and weights stands for 1. Later, `set in` takes `st` and
`bs` unscaled, but weights still in tenths, as in C++.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Iterable
from math import isfinite
from typing import Any, Final

from yarpy.data.bottle import Bottle, Property
from yarpy.data.text import plain_text
from yarpy.errors import LocalProtocolError
from yarpy.log import logger
from yarpy.monitors.arbitration import Competitor, Contest, Inconsistent, Outcome
from yarpy.monitors.base import Place
from yarpy.wire.message import Message

log = logger("yarpy.monitors")

_SCALE: Final = 10.0
_MOST: Final = 1e9  # larger numbers are mistakes, and would overflow the equations
_LINKS: Final = 1000  # of one connection


class Priority:
    """The monitor of one connection; it finds the others in `place.group`."""

    def __init__(self, place: Place, clock: Callable[[], float] = time.monotonic) -> None:
        if place.sending:
            raise LocalProtocolError(
                "priority decides at the receiving end: connect with +recv.priority"
            )
        self._place = place
        self._group = place.group
        self._clock = clock
        self._told = False
        self._links = _links(place.find("ex"))
        self.competitor = Competitor(
            place.source,
            fade=abs(_number(place, "tc", 1.0)),
            rest=abs(_number(place, "tr", 0.0)),
            strength=abs(_number(place, "st", _SCALE) or _SCALE) / _SCALE,
            bias=_number(place, "bs", _SCALE) / _SCALE,
            weights=_weights(self._links),
            virtual=place.flag("virtual"),
        )

    def _contest(self) -> Contest:
        """The contest of all at this port; call with the group's lock held."""
        members = self._group.members
        known: tuple[object, Contest] | None = self._group.shared.get(Priority)
        if known is None or known[0] is not members:
            ours = [one.competitor for one in members if isinstance(one, Priority)]
            # A port's own monitor belongs to no group.
            contest = Contest(ours if self.competitor in ours else [self.competitor])
            self._group.shared[Priority] = known = members, contest
        return known[1]

    def accept(self, message: Message) -> bool:
        """Return whether this connection is the one that may deliver now."""
        with self._group.lock:
            try:
                return self._contest().decide(self.competitor, self._clock())
            except Inconsistent:
                if not self._told:
                    self._told = True
                    log.warning(
                        "%s: the weights of the connections contradict each other, no message "
                        'passes; change their "ex" with `set in`',
                        self._place,
                    )
                return False

    def configure(self, parameters: Property) -> None:
        """`tc tr st bs virtual ex`, any of them. If it raises LocalProtocolError, nothing has
        changed."""
        one = self.competitor
        tc = _setting(parameters, "tc", one.fade)
        tr = _setting(parameters, "tr", one.rest)
        st = _setting(parameters, "st", one.strength)
        bs = _setting(parameters, "bs", one.bias)
        virtual = _setting(parameters, "virtual", one.virtual)
        links = _links(parameters.group("ex")) if "ex" in parameters else self._links
        weights = _weights(links)
        with self._group.lock:
            one.fade, one.rest, one.strength, one.bias = abs(tc), abs(tr), abs(st), bs
            one.weights, self._links = weights, links
            one.virtual = bool(virtual)
            self._contest().changed()

    def parameters(self) -> dict[str, Any]:
        """As C++ returns them: `ex` as one text."""
        one = self.competitor
        return {
            "bs": one.bias,
            "ex": self._links.to_text(),
            "st": one.strength,
            "tc": one.fade,
            "tr": one.rest,
            "virtual": int(one.virtual),
        }

    def state(self) -> dict[str, Any]:
        """The state of the contest: our stimulation and output, and the winner ("": none)."""
        with self._group.lock:
            one, now = self.competitor, self._clock()
            try:
                outcome = self._contest().outcome(now)
            except Inconsistent:
                outcome = Outcome(None, {})
            return {
                "active": one.active,
                "output": outcome.outputs.get(one.source, 0.0),
                "stimulation": one.stimulation(now),
                "winner": outcome.winner.source if outcome.winner is not None else "",
            }


def _number(place: Place, key: str, default: float) -> float:
    return place.number(key, default, -_MOST, _MOST)


def _setting(parameters: Property, key: str, before: float) -> float:
    value = parameters.get(key)
    if value is None:
        return float(before)
    try:
        return _finite(value)
    except (TypeError, ValueError):
        text = Bottle([value]).to_text()
        raise LocalProtocolError(f'"{key}" takes a number, not {text}') from None


def _finite(value: Any) -> float:
    number = float(value)
    if not isfinite(number) or abs(number) > _MOST:
        raise ValueError
    return number


def _links(value: str | Bottle | None) -> Bottle:
    """`ex` as C++ keeps it, `ex (/source weight) ...`; empty if there are none.

    In a shell, where a carrier string cannot hold blanks, use commas: `ex.(/a,-10)(/b,10)`.
    """
    if value is None or len(value) == 0:
        return Bottle()
    if isinstance(value, str):
        value = Bottle.from_text(value.replace(",", " ").replace(")(", ") ("))
    # A group begins with its own key.
    return Bottle(["ex", *(item for item in value if item not in ("ex", ""))])


def _weights(links: Iterable[Any]) -> tuple[tuple[str, float], ...]:
    """The links with their weights. Raises LocalProtocolError."""
    found = []
    for link in links:
        if link == "ex":
            continue
        try:
            if not isinstance(link, list):
                raise TypeError
            target, weight = link[:2]
            found.append((plain_text(target), _finite(weight) / _SCALE))
        except (TypeError, ValueError):
            raise LocalProtocolError(
                f'"ex" takes links (/source weight), not {Bottle([link]).to_text()}'
            ) from None
    if len(found) > _LINKS:
        raise LocalProtocolError(f'"ex" takes at most {_LINKS} links')
    return tuple(found)
