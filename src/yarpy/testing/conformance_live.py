"""Tests of a carrier between two real ports of this process: messages, calls, goodbyes.

Rules: the ports find each other by `LocalNames`, without a server; a carrier that is not installed
is registered for the duration of a test.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any
from unittest import SkipTest

from yarpy import network, registry
from yarpy.nameserver.local import LocalNames
from yarpy.port.port import Port
from yarpy.port.rpc import RpcClient, RpcServer
from yarpy.testing.conformance_case import ConformanceCase
from yarpy.wire.message import Message


class LiveConformance(ConformanceCase):
    """The carrier on connections as a user makes them."""

    def test_live_messages(self) -> None:
        """Real ports connected by the carrier's name; both sides count every message."""
        with self._offered(), _ports() as (names, sender, receiver):
            self._connect(names, sender, receiver)
            for number, value in enumerate(self.values):
                envelope = f"{number} 0.5" if self.carries_envelopes else None
                assert sender.write(value, envelope) == 1
                message = self._read(receiver)
                self._check(message, value)
                assert message.envelope == (envelope or "")
            # A sender counts when its send returns, which may be after the message has arrived.
            for end in (sender.outputs[0], receiver.inputs[0]):
                _await(
                    lambda end=end: end.stats.messages == len(self.values),  # type: ignore[misc]
                    self.timeout,
                    f"the count differs from the {len(self.values)} messages sent",
                )
            assert sender.outputs[0].stats.drops == receiver.inputs[0].stats.drops == 0

    def test_live_sizes(self) -> None:
        """Real ports, messages of every size."""
        with self._offered(), _ports() as (names, sender, receiver):
            self._connect(names, sender, receiver)
            for size in self.sizes:
                value = self.of_size(size)
                sender.write(value)
                self._check(self._read(receiver), value)

    def test_live_calls(self) -> None:
        """A server and a client that call each other over this carrier."""
        if not self.carrier.replies or not self.carrier.push:
            raise SkipTest(f"{self.carrier.name} carries no calls")
        with self._offered():
            names = LocalNames()
            echo: Callable[[Message], Any] = lambda message: message.value  # noqa: E731
            with (
                RpcServer("/receiver", echo, names=names),
                RpcClient(name="/sender", names=names) as client,
            ):
                client.connect("/receiver", self.carrier.name + self.modifiers)
                for value in self.values:
                    reply = client.ask(value, timeout=self.timeout)
                    assert reply is not None, "no reply came"
                    self._check(reply, value)

    def test_live_goodbye(self) -> None:
        """Disconnecting reaches the other side, and connecting again works."""
        with self._offered(), _ports() as (names, sender, receiver):
            for _ in range(2):
                self._connect(names, sender, receiver)
                sender.write(self.values[0])
                self._read(receiver)
                assert network.disconnect("/sender", "/receiver", names=names)
                if self.carrier.push:
                    assert not sender.outputs, "the sender keeps its output"
                else:  # the dialled side must notice
                    _await(lambda: not sender.outputs, self.timeout, "the sender keeps its output")
                _await(lambda: not receiver.inputs, self.timeout, "the receiver keeps its input")

    def test_live_sender_vanishes(self) -> None:
        """A sender that closes leaves nothing behind at its receiver."""
        with self._offered(), _ports() as (names, sender, receiver):
            self._connect(names, sender, receiver)
            sender.write(self.values[0])
            self._read(receiver)
            sender.close()
            _await(lambda: not receiver.inputs, self.timeout, "the receiver keeps its input")

    # -- inside -----------------------------------------------------------------------------------

    @contextmanager
    def _offered(self) -> Iterator[None]:
        """The carrier can be found by its name, installed or not."""
        if self.missing:
            raise SkipTest(self.missing)
        name = self.carrier.name
        if name in registry.carriers.names():
            yield
            return
        registry.carriers.add(name, self.carrier)
        try:
            yield
        finally:
            registry.carriers.remove(name)

    def _connect(self, names: LocalNames, sender: Port, receiver: Port) -> None:
        name = self.carrier.name + self.modifiers
        network.connect("/sender", "/receiver", name, names=names)
        assert sender.wait_for_outputs(timeout=self.timeout), "the sender has no output"
        if self._greets():
            _await(lambda: receiver.inputs, self.timeout, "the receiver has no input")
        assert sender.outputs[0].carrier == name
        if self.names_sender:
            assert receiver.inputs[0].carrier.startswith(self.carrier.name)

    def _read(self, receiver: Port) -> Message:
        message = receiver.read(timeout=self.timeout)
        if message.wants_reply:  # if every message is a call, the connection waits for this
            message.reply([])
        return message

    def _greets(self) -> bool:
        """Return whether the acceptor knows of the connection before the first message."""
        return bool(self._greeted().traffic)


@contextmanager
def _ports() -> Iterator[tuple[LocalNames, Port, Port]]:
    names = LocalNames()
    with Port("/sender", names=names) as sender, Port("/receiver", names=names) as receiver:
        yield names, sender, receiver


def _await(condition: Callable[[], object], timeout: float, problem: str) -> None:
    deadline = time.monotonic() + timeout
    while not condition():
        assert time.monotonic() < deadline, problem
        time.sleep(0.005)
