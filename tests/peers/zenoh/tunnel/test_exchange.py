"""Calling and being called through a real router of Zenoh."""

from __future__ import annotations

import contextlib
import threading
from collections.abc import Iterator
from typing import Any

import pytest
from support.port import free_port
from support.wait import HANG, wait_until

from yarpy.peers.zenoh.address import host_zid, zid_host
from yarpy.peers.zenoh.router import open_router
from yarpy.peers.zenoh.transport import SharedSession, close, share
from yarpy.peers.zenoh.tunnel import exchange as zenoh_exchange
from yarpy.peers.zenoh.tunnel.exchange import Exchange, dial_inside, join, know, leave
from yarpy.peers.zenoh.tunnel.pipe import ZenohPipe

pytest.importorskip("zenoh", reason='Zenoh: pip install "yarpy[zenoh]"')


class Net:
    """A router, and two sessions on it, each with its exchange."""

    def __init__(self) -> None:
        self.number = free_port()
        self.start()
        # Two ways to write one place, so two sessions.
        self.sessions: list[SharedSession] = [share(f"{host}:{self.number}") for host in HOSTS]
        self.near, self.far = (join(shared) for shared in self.sessions)
        wait_until(lambda: knows(self.near, self.far) and knows(self.far, self.near))

    def start(self) -> None:
        self.router = open_router([f"tcp/127.0.0.1:{self.number}"])

    def stop(self) -> None:
        close(self.router)


def knows(one: Exchange, other: Exchange) -> bool:
    """Whether the router has told the one how to call the other."""
    try:
        one.call(other.zid, 1, 5)
    except ConnectionRefusedError:
        return True
    except OSError:
        return False
    raise AssertionError("who answers there?")


HOSTS = ("127.0.0.1", "localhost")


@pytest.fixture
def net() -> Iterator[Net]:
    made = Net()
    yield made
    leave(made.near)
    leave(made.far)
    for shared in made.sessions:
        shared.close()
    made.stop()
    wait_until(lambda: not zenoh_exchange._open)  # the far end of a pipe ends by itself


def echo(pipe: ZenohPipe) -> None:
    view = memoryview(bytearray(1000))
    while count := pipe.recv_into(view):
        with contextlib.suppress(OSError):
            pipe.send([bytes(view[:count])])
    pipe.close()


def ask(pipe: ZenohPipe, data: bytes) -> bytes:
    pipe.send([data])
    view = memoryview(bytearray(1000))
    return bytes(view[: pipe.recv_into(view)])


def test_hosts() -> None:
    assert (host_zid("a1b2.zenoh"), host_zid("10.0.0.1"), zid_host("ab")) == (
        "a1b2",
        "",
        "ab.zenoh",
    )


def test_there_and_back(net: Net) -> None:
    net.far.listen(10_002, echo)
    pipe = net.near.call(net.far.zid, 10_002, 5)
    assert (pipe.local, pipe.remote) == (
        (zid_host(net.near.zid), 0),
        (zid_host(net.far.zid), 10_002),
    )
    assert ask(pipe, b"hello") == b"hello"
    pipe.close()
    wait_until(lambda: not (net.near._pipes or net.far._pipes or net.near._peers))
    wait_until(lambda: net.near.users == net.far.users == 1)


def test_an_address_inside_zenoh_is_enough(net: Net) -> None:
    stop = net.far.listen(5, echo)
    know(net.far.zid, net.near.zid)
    pipe = dial_inside(zid_host(net.far.zid), 5, 5)
    assert pipe.local[0] == zid_host(net.near.zid) and ask(pipe, b"x") == b"x"
    pipe.close()
    stop()
    with pytest.raises(ConnectionRefusedError):
        dial_inside(zid_host(net.far.zid), 5, 5)


def test_the_two_ends_may_be_of_one_program(net: Net) -> None:
    net.near.listen(5, echo)
    pipe = net.near.call(net.near.zid, 5, 5)
    assert ask(pipe, b"x") == b"x"
    pipe.close()


def test_nobody_there(net: Net) -> None:
    with pytest.raises(ConnectionRefusedError, match="nobody listens"):
        net.near.call(net.far.zid, 1, 5)
    with pytest.raises(OSError, match="no such program"):
        net.near.call("abcdef", 1, 5)
    assert not net.near._pipes and not net.near._peers


def test_there_are_not_too_many(net: Net, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(zenoh_exchange, "MOST", 1)
    net.far.listen(5, echo)
    pipe = net.near.call(net.far.zid, 5, 5)
    with pytest.raises(ConnectionRefusedError, match="full"):
        net.near.call(net.far.zid, 5, 5)
    pipe.close()


def test_the_end_of_a_router_breaks_both_ends(net: Net) -> None:
    came: list[ZenohPipe] = []
    net.far.listen(5, came.append)
    pipe = net.near.call(net.far.zid, 5, 5)
    wait_until(lambda: came)
    pipe.send([b"x"])  # whose token has come by now
    wait_until(lambda: came[0].try_recv_into(memoryview(bytearray(1))) == 1)
    net.stop()
    wait_until(lambda: pipe.ended() and came[0].ended())
    with pytest.raises(BrokenPipeError, match="gone"):
        pipe.send([b"x"])
    with pytest.raises(OSError, match=r"does not answer|no such"):
        net.near.call(net.far.zid, 5, 1)
    pipe.close()
    came[0].close()
    net.start()


def test_the_end_of_a_program_breaks_its_pipes(net: Net) -> None:
    with share(f"tcp/127.0.0.1:{net.number}#iface=lo") as shared:
        third = join(shared)
        third.listen(5, lambda pipe: None)
        wait_until(lambda: knows(net.near, third))
        pipe = net.near.call(third.zid, 5, 5)
        shared.session.close()  # type: ignore[no-untyped-call]
        wait_until(pipe.ended)
        for one in list(third._pipes.values()):
            one.close()
        leave(third)
    pipe.close()


def test_the_other_end_of_a_pipe_that_was_broken_is_told(net: Net) -> None:
    came: list[ZenohPipe] = []
    net.far.listen(5, came.append)
    pipe = net.near.call(net.far.zid, 5, 5)
    wait_until(lambda: came)
    came[0].break_off("for a test")  # so that it says no goodbye
    came[0].close()
    wait_until(pipe.ended)
    pipe.close()


@pytest.mark.parametrize(
    "hello",
    [b"", b"x", b"a b c", b"\xff" * 100, b"*" * 16, b"ab " + b"0" * 16 + b" */" + b"0" * 14],
)
def test_strange_calls_are_refused(net: Net, hello: bytes) -> None:
    called = threading.Event()
    net.far.listen(5, lambda pipe: called.set())
    for number in ("5", "99999", "x"):
        answers: list[Any] = [
            *net.near.session.get(f"@yarp/open/{net.far.zid}/{number}", payload=hello, timeout=HANG)
        ]
        assert [answer.ok for answer in answers] == [None]
    assert not called.is_set()


def test_one_exchange_for_a_session(net: Net) -> None:
    again = join(net.sessions[0])
    assert again is net.near and isinstance(again, Exchange)
    leave(again)
    assert not net.sessions[0].session.is_closed()
