"""`yarpy merge PORT...`: concatenate what several ports send.

    merge P1 P2 ...
    merge --input P1 P2 ... --output PORT --worker PREFIX --carrier C

Whenever one of them sends, the elements of the newest message of each, in order, leave from
/portsMerge/o0 (PORT) as one message, with an envelope that counts from 0. They come in at
/portsMerge/i0, i1 ... (PREFIX0 ...) over udp (C). Runs until interrupted.
Exit codes: 255 without ports, or when one cannot be connected.
"""

from __future__ import annotations

import os
import threading
import time
from collections.abc import Callable
from contextlib import ExitStack
from typing import Any

import click

import yarpy
from yarpy.cli.output import print_line
from yarpy.cli.ports import hear_from, open_port
from yarpy.cli.stderr import complain
from yarpy.platform import waiting

OUTPUT = "/portsMerge/o0"
WORKER = "/portsMerge/i"
FAILED = 255


class Merger:
    """The newest message of each source, and how many went out."""

    def __init__(self, count: int, send: Callable[[Any, Any], object]) -> None:
        self._newest: list[Any] = [[] for _ in range(count)]
        self._send = send
        self._sent = 0
        self._lock = threading.Lock()  # sources report from threads of their own

    def take(self, number: int, elements: Any) -> None:
        """Source `number` sent `elements`: send all that is known."""

        with self._lock:
            self._newest[number] = elements
            merged = yarpy.Bottle(item for part in self._newest for item in part)
            self._send(merged, yarpy.Stamp(self._sent, time.time()))
            self._sent = (self._sent + 1) & 0x7FFFFFFF  # what a stamp can count to


@click.command()
@click.argument("ports", nargs=-1)
@click.option("--input", "first", metavar="PORT...", help="The ports to read from.")
@click.option("-o", "--output", default=OUTPUT, metavar="PORT", help="Where it leaves.")
@click.option("--worker", default=WORKER, metavar="PREFIX", help="Where it arrives.")
@click.option("--carrier", default="udp", help="How the ports are connected.")
def command(
    ports: tuple[str, ...], first: str | None, output: str, worker: str, carrier: str
) -> int:
    """Concatenate what PORTS send."""

    sources = [first, *ports] if first else list(ports)
    if any(map(os.path.isfile, sources)):
        complain("ports are merged here; recordings are by `yarpy convert A B -o NAME`")
        return FAILED
    if not sources:
        complain("which ports? `yarpy merge /port1 /port2`")
        return FAILED
    with ExitStack() as stack:
        out = stack.enter_context(open_port(yarpy.Port, output, callback=lambda message: None))
        merger = Merger(len(sources), out.write)
        for number, source in enumerate(sources):

            def take(message: yarpy.Message, number: int = number) -> None:
                merger.take(number, message.as_(yarpy.Bottle))

            port = stack.enter_context(open_port(yarpy.Port, f"{worker}{number}", callback=take))
            try:
                hear_from(port, source, carrier)
            except yarpy.YarpError as error:
                complain(str(error))
                return FAILED
        print_line(f"Ready. Output goes to {output}")
        waiting.wait()
    return 0
