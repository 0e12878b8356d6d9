"""Which ports answer, whose they are, what they are connected to; asked while somebody looks."""

from __future__ import annotations

import os
import socket
import threading

from support.listener import listening
from support.port import free_port
from support.wait import HANG, wait_until

import yarpy
from yarpy.contact import Contact
from yarpy.nameserver.survey import Survey, is_port


def test_what_is_told() -> None:
    with (
        yarpy.NameServer() as server,
        yarpy.Port("/out") as out,
        yarpy.Port("/in") as in_,
        socket.create_server(("127.0.0.1", 0)) as silent,
    ):
        out.connect("/in")
        assert in_.wait_for_inputs(timeout=HANG)
        server.client.register("/gone", "tcp", "127.0.0.1", free_port())
        server.client.register("/silent", "tcp", "127.0.0.1", silent.getsockname()[1])
        contacts = {one.name: one for one in server.client.list()}
        survey = Survey(lambda: list(contacts.values()))
        assert survey.told(contacts["/out"]) == {"alive": None}

        def all_have_answered() -> bool:
            survey.want()  # for some seconds, in which a busy port may not answer in time
            return all(survey.told(contacts[name])["alive"] for name in ("/out", "/in"))

        wait_until(all_have_answered)
        told = survey.told(contacts["/out"])
        assert told["process"] == os.getpid()
        assert told["program"]
        [link] = told["links"]
        assert (link["out"], link["peer"], link["carrier"]) == (True, "/in", "tcp")
        [link] = survey.told(contacts["/in"])["links"]
        assert (link["out"], link["peer"]) == (False, "/out")
        assert survey.told(contacts["/gone"]) == {"alive": False}
        assert survey.told(contacts["/silent"]) == {
            "alive": None,
            "silent": "does not answer: stopped, or very busy",
        }
        assert survey.told(contacts["fallback"]) == {"alive": None}
        # Who took the name since is not known yet.
        assert survey.told(Contact("tcp", "/out", "127.0.0.1", 1)) == {"alive": None}
        survey.close()
        wait_until(lambda: not any(t.name == "yarpy survey" for t in threading.enumerate()))


def test_only_a_refusal_proves_that_nobody_is_there() -> None:
    with listening(socket.socket.close) as (port, _):
        contacts = [
            Contact("tcp", "/unreachable", "255.255.255.255", 9),
            Contact("tcp", "/misspelled", "x" * 70, 9),  # no name of a computer is that long
            Contact("tcp", "/hangs/up", "127.0.0.1", port),
        ]
        survey = Survey(lambda: contacts)
        survey.want()
        wait_until(lambda: all("silent" in survey.told(one) for one in contacts))
        found = [survey.told(one) for one in contacts]
        survey.close()
    assert [one["alive"] for one in found] == [None] * 3
    for one, text in zip(
        found, ("nobody answers at 255", "is no host name", "closed"), strict=True
    ):
        assert text in one["silent"]


def test_nobody_is_asked_where_nobody_looks() -> None:
    asked: list[int] = []
    survey = Survey(lambda: asked.append(1) or [])  # type: ignore[func-returns-value]
    assert not asked
    survey.want()
    survey.want()
    wait_until(lambda: asked)
    survey.close()


def test_what_can_be_asked() -> None:
    assert is_port(Contact("tcp", "/x", "h", 1))
    assert not is_port(Contact("mcast", "/x", "h", 1))
    assert not is_port(Contact("tcp", "fallback", "h", 1))
    assert not is_port(Contact("tcp", "/x", "h", 0))
