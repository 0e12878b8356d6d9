"""Ports that send to us are asked to leave, so that they do not take our end for a failure."""

import threading
import time

import pytest
from support.wait import HANG, wait_until

import yarpy
from yarpy.port.connect import goodbye


class Silent(yarpy.LocalNames):
    """A name service that does not answer."""

    asked = 0

    def query(self, name: str) -> yarpy.Contact | None:
        self.asked += 1
        raise yarpy.NoNameServer("it does not answer")


def test_a_sender_leaves_and_does_not_dial_again(names: yarpy.LocalNames) -> None:
    with yarpy.Port("/out", names=names) as out, yarpy.BufferedPort("/in", names=names) as in_:
        out.connect("/in")
        wait_until(lambda: in_.inputs)
        goodbye.ask_to_leave(in_._hub.registration, "/out")
        wait_until(lambda: not out.outputs and not in_.inputs)


@pytest.mark.parametrize("source", ["", "somebody", "/in", "/gone", "/dead"])
def test_who_cannot_be_asked_is_left_alone(names: yarpy.LocalNames, source: str) -> None:
    names.register("/dead", "tcp", "127.0.0.1", 1)
    with yarpy.BufferedPort("/in", names=names) as in_:
        goodbye.ask_to_leave(in_._hub.registration, source)


def test_a_name_service_that_does_not_answer_is_asked_once(names: yarpy.LocalNames) -> None:
    with yarpy.BufferedPort("/in", names=names) as in_:
        registration = in_._hub.registration
        assert goodbye.ask_all_to_leave(registration, ["/a", "/b"])
        registration.names = silent = Silent()
        try:
            assert not goodbye.ask_all_to_leave(registration, ["/a", "/b", "/c"])
            assert silent.asked == 1
        finally:
            registration.names = names


class Slow(yarpy.LocalNames):
    """A name service that becomes too slow to tell where others are."""

    slow = False

    def query(self, name: str) -> yarpy.Contact | None:
        if self.slow and name == "/out":
            raise yarpy.NoNameServer("silent for a moment") from TimeoutError()
        return super().query(name)


def test_a_name_goes_back_to_a_name_service_that_was_silent_for_a_moment() -> None:
    names = Slow()
    with yarpy.Port("/out", names=names) as out, yarpy.BufferedPort("/in", names=names) as in_:
        out.connect(f"/{in_.address}")
        wait_until(lambda: in_.inputs)
        names.slow = True
        in_.close()
        names.slow = False
        assert "/in" not in [one.name for one in names.list()]


def test_who_asked_for_a_connection_is_answered_by_a_port_that_closes(
    names: yarpy.LocalNames,
) -> None:
    """As by a program that waits for a reader, writes one message, and ends."""
    closing = threading.Event()

    def slow(event: yarpy.ConnectionEvent) -> None:
        if event.created and event.target == "/in":
            closing.set()
            wait_until(lambda: port.closed)
            time.sleep(0.02)  # the answer has not left yet

    with yarpy.BufferedPort("/in", names=names) as in_:
        port = yarpy.Port("/out", names=names, on_connection=slow)
        asking = threading.Thread(target=lambda: (closing.wait(HANG), port.close()))
        asking.start()
        in_.listen_to("/out")
        asking.join(HANG)
        assert closing.is_set()
