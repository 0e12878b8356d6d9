"""Ports that send to us are asked to leave, so that they do not take our end for a failure."""

import pytest
from support.wait import wait_until

import yarpy
from yarpy.port import farewell


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
        farewell.ask_to_leave(in_._hub.registration, "/out")
        wait_until(lambda: not out.outputs and not in_.inputs)


@pytest.mark.parametrize("source", ["", "somebody", "/in", "/gone", "/dead"])
def test_who_cannot_be_asked_is_left_alone(names: yarpy.LocalNames, source: str) -> None:
    names.register("/dead", "tcp", "127.0.0.1", 1)
    with yarpy.BufferedPort("/in", names=names) as in_:
        farewell.ask_to_leave(in_._hub.registration, source)


def test_a_name_service_that_does_not_answer_is_asked_once(names: yarpy.LocalNames) -> None:
    with yarpy.BufferedPort("/in", names=names) as in_:
        registration = in_._hub.registration
        assert farewell.ask_all_to_leave(registration, ["/a", "/b"])
        registration.names = silent = Silent()
        try:
            assert not farewell.ask_all_to_leave(registration, ["/a", "/b", "/c"])
            assert silent.asked == 1
        finally:
            registration.names = names
