"""Waiting for what a program needs: others that start first, ports and their answers, its node.

Rules: in the thread of the program that waits, which `stop` wakes. A need without a timeout is
waited for `PORT_TIMEOUT` seconds, as is the server of a computer that boots; one of 0 is looked at
once. What it is waited for is in the unit meanwhile.
"""

from __future__ import annotations

import threading
import time
from collections.abc import Callable
from functools import partial
from typing import Final

import yarpy
from yarpy.data.bottle import Bottle
from yarpy.data.text import plain_text
from yarpy.errors import YarpError
from yarpy.kits.launch.application.application import Need
from yarpy.kits.launch.supervise.unit import FINAL, Unit
from yarpy.names.base import NameClient
from yarpy.network import connection
from yarpy.network.asking import query

PORT_TIMEOUT: Final = 60.0  # seconds that a port is waited for
_PERIOD: Final = 0.1  # seconds between looks
_ANSWER: Final = 2.0  # seconds that a port may take to answer


class Waiting:
    """Waits for units by `find` (a unit by its label), and for ports at `names`."""

    def __init__(
        self,
        find: Callable[[str], Unit],
        usual: float = PORT_TIMEOUT,
        names: NameClient | None = None,
    ) -> None:
        self._find = find
        self._usual = usual
        self._names = names

    def wait(self, unit: Unit, stop: threading.Event) -> str:
        """Return "" as soon as all is there, or why it is not; also if `stop` is set."""
        for label in unit.module.after:
            other = self._find(label)
            unit.detail = f"for {label}"
            while other.state != "running":
                if other.state in FINAL and other.state != "ended":
                    return f'"{label}", after which it starts, has {other.state}'
                if other.state == "ended" or stop.wait(_PERIOD):
                    break
        for need in unit.module.needs:
            if stop.is_set():
                break
            unit.detail = f"for {need.port}"
            if why := self.wait_for(need, stop):
                return why
        if node := unit.module.node:
            unit.detail = f"for {node}: is `yarpy run --server {node}` running there?"
            return _until(partial(self._unknown, node), self._usual, stop)
        return ""

    def wait_for(self, need: Need, stop: threading.Event) -> str:
        """Return "" as soon as a port is there, or why it is not."""
        seconds = self._usual if need.timeout is None else need.timeout
        return _until(partial(self._missing, need), seconds, stop)

    def _unknown(self, node: str) -> str:
        """Return why no server of programs is known as `node`, "" if one is, silent or not."""
        try:
            if query(node, self._names) is not None:
                return ""
        except YarpError as error:
            return f'"{node}": {error}'
        return f'no server of programs is called "{node}" (`yarpy run --server {node}`)'

    def _missing(self, need: Need) -> str:
        """Return why a need is not fulfilled, "" if it is."""
        try:
            if not connection.exists(need.port, names=self._names):
                return f'"{need.port}" is not there'
            if not need.request:
                return ""
            with yarpy.RpcClient(need.port, timeout=_ANSWER, names=self._names) as client:
                answer = client.call(Bottle.from_text(need.request))
        except YarpError as error:
            return f'"{need.port}": {error}'
        said = answer.to_text() if isinstance(answer, Bottle) else plain_text(answer)
        if said.strip().lower() != need.reply.strip().lower():
            return f'"{need.port}" answers "{said[:80]}", not "{need.reply}"'
        return ""


def _until(missing: Callable[[], str], seconds: float, stop: threading.Event) -> str:
    """Return "" as soon as nothing is missing, or what still is after `seconds`."""
    until = time.monotonic() + seconds
    while why := missing():
        if time.monotonic() >= until:
            return f"{why} after {seconds:g} s"
        if stop.wait(_PERIOD):
            return ""
    return ""
