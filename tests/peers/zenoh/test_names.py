"""Names on Zenoh: ports that tell their own, through real routers."""

from __future__ import annotations

import time
from collections.abc import Iterator
from dataclasses import replace
from typing import Any

import pytest
from support.port import free_port
from support.wait import HANG, wait_until

import yarpy
from yarpy.config.configuration import configuration
from yarpy.contact import Contact
from yarpy.errors import AddressError, NoNameServer
from yarpy.names.base import NameClient
from yarpy.names.default import default_client
from yarpy.peers.zenoh import key as zenoh_key
from yarpy.peers.zenoh.names import ZenohNames, on_zenoh
from yarpy.peers.zenoh.router import open_router

pytest.importorskip("zenoh", reason='Zenoh: pip install "yarpy[zenoh]"')


@pytest.fixture(autouse=True)
def _nothing_configured(monkeypatch: pytest.MonkeyPatch) -> None:
    for name in ("YARPY_ZENOH", "YARPY_TLS", "YARPY_BIND", "ZENOH_CONFIG_OVERRIDE"):
        monkeypatch.delenv(name, raising=False)


@pytest.fixture
def routers() -> Iterator[list[str]]:
    """The addresses of two routers that are joined."""
    where = [f"tcp/127.0.0.1:{free_port()}" for _ in range(2)]
    opened = [open_router([where[0]]), open_router([where[1]], [where[0]])]
    yield where
    for one in opened:
        one.close()


@pytest.fixture
def near(routers: list[str]) -> Iterator[ZenohNames]:
    names = ZenohNames(routers[0])
    yield names
    names.close()


@pytest.fixture
def far(routers: list[str], near: ZenohNames) -> Iterator[ZenohNames]:
    """Names as seen from the other router, which is joined with the first by now."""
    names = ZenohNames(routers[1])
    near.register("/first", "tcp", "127.0.0.1", 1)
    wait_until(lambda: names.query("/first"))
    near.unregister("/first")
    yield names
    names.close()


def test_it_is_a_name_client(near: ZenohNames) -> None:
    assert isinstance(near, NameClient) and near.alive() and on_zenoh(near) is near


def test_ports_find_each_other_over_two_routers(near: ZenohNames, far: ZenohNames) -> None:
    with (
        yarpy.Port("/here", names=near) as here,
        yarpy.BufferedPort("/far/in", names=far, port_type="yarp/image") as there,
    ):
        wait_until(lambda: near.query("/far/in") and far.query("/here"))
        found = near.query("/far/in")
        assert found == there.contact
        here.connect("/far/in")
        here.write("over tcp")
        assert there.read(timeout=HANG).value == "over tcp"
        assert [contact.name for contact in near.list()] == ["/far/in", "/here"]
        assert [contact.name for contact in far.list("/far")] == ["/far/in"]
        assert near.get("/far/in", "process") and near.get("/far/in", "nothing") == []
        assert yarpy.exists("/far/in", names=near)
        assert near.query("/nobody") is None and near.query("no name") is None
    wait_until(lambda: far.list() == [] and far.query("/here") is None)


def test_a_name_belongs_to_the_port_that_has_it(near: ZenohNames, far: ZenohNames) -> None:
    with yarpy.Port("/mine", names=near):
        wait_until(lambda: far.query("/mine"))
        with pytest.raises(AddressError, match=r'"/mine" is in use by this program'):
            yarpy.Port("/mine", names=far)


def test_of_two_that_came_at_once_the_newer_one_stays(near: ZenohNames, far: ZenohNames) -> None:
    near.register("/twice", "tcp", "127.0.0.1", 1001)
    wait_until(lambda: far.query("/twice"))
    far.register("/twice", "tcp", "127.0.0.1", 1002)
    wait_until(lambda: near.query("/twice") == far.query("/twice") != None)  # noqa: E711
    assert near.query("/twice").port == 1002  # type: ignore[union-attr]
    near.unregister("/twice")
    assert near.query("/twice").port == 1002  # type: ignore[union-attr]


def test_two_that_did_not_see_each_other_are_told_by_who_asks(
    near: ZenohNames, far: ZenohNames, monkeypatch: pytest.MonkeyPatch
) -> None:
    with monkeypatch.context() as patch:
        patch.setattr(ZenohNames, "_claim", lambda *_: None)
        near.register("/twice", "tcp", "127.0.0.1", 1001)
        far.register("/twice", "tcp", "127.0.0.1", 1002)
        third = ZenohNames(near.where)
        wait_until(lambda: third.query("/twice").port == 1002)  # type: ignore[union-attr]
        assert len(near.list()) == 1
    assert third.query("/twice").port == 1002  # type: ignore[union-attr]
    wait_until(lambda: "/twice" not in near._own)
    third.close()


def test_what_is_not_registered_here_cannot_be_taken_away(
    near: ZenohNames, far: ZenohNames
) -> None:
    near.register("/kept", "tcp", "127.0.0.1", 1)
    far.unregister("/kept")
    wait_until(lambda: far.query("/kept"))
    assert far.set("/kept", "place", "lab") == []
    assert near.set("/kept", "place", "lab", "room") == ["lab", "room"]
    assert far.get("/kept", "place") == near.get("/kept", "place") == ["lab", "room"]
    assert far.get("/kept", "pl*ce") == far.get("/nobody", "place") == []


def test_other_things_have_names_too(near: ZenohNames, far: ZenohNames) -> None:
    near.register("/webcam", "mjpeg", "198.51.100.9", 8080)
    wait_until(lambda: far.query("/webcam"))
    assert far.query("/webcam") == Contact("mjpeg", "/webcam", "198.51.100.9", 8080)
    one, two = (near.register("...", "mcast", None, 11000) for _ in range(2))
    assert one.name != two.name and one.host.startswith("239.") and one.host != two.host
    with pytest.raises(AddressError, match="port number"):
        near.register("/x")


def test_names_of_another_space_are_not_seen(near: ZenohNames) -> None:
    other = ZenohNames(near.where, "/lab")
    near.register("/x", "tcp", "127.0.0.1", 1)
    assert other.query("/x") is None and other.list() == []
    other.close()


def test_no_router() -> None:
    names = ZenohNames(f"tcp/127.0.0.1:{free_port()}")
    assert not names.alive()
    with pytest.raises(NoNameServer, match="yarpy router"):
        names.query("/x")
    with pytest.raises(NoNameServer):
        yarpy.Port("/x", names=names)


def test_a_router_that_was_restarted_knows_the_names_again() -> None:
    where = f"tcp/127.0.0.1:{free_port()}"
    router = open_router([where])
    names, other = ZenohNames(where), ZenohNames(where, "/lab")
    names.register("/stays", "tcp", "127.0.0.1", 1)
    reader = ZenohNames(where + ",")  # the same place, and so the same session
    router.close()
    wait_until(lambda: not names.alive())
    with pytest.raises(NoNameServer, match="any more"):
        other.list()
    router = open_router([where])
    wait_until(names.alive)
    assert reader.query("/stays")
    for one in (names, other, reader):
        one.close()
    router.close()


# -- strangers ------------------------------------------------------------------------------------


def answer(session: Any, key: str, payload: bytes, times: int = 1) -> Any:
    def reply(query: Any) -> None:
        for _ in range(times):
            query.reply(key, payload)

    return session.declare_queryable(key, reply)


def test_strangers_who_tell_nonsense_are_not_believed(near: ZenohNames, far: ZenohNames) -> None:
    session = far._open().session
    base = far.base
    good = far.register("/good", "tcp", "127.0.0.1", 7)
    entry = far.entry("/good")
    assert entry is not None
    lies = [
        answer(session, f"{base}/name/good", b"registration name /good ip x port 1 type tcp"),
        answer(session, f"{base}/name/good", b"\xff" * 100_000),
        answer(session, f"{base}/node/0/1", b"\0" * 1000, times=500),
        answer(session, f"{base}/node/1/1", zenoh_key.encode([entry]), times=500),
        session.liveliness().declare_token(f"{base}/port/zz/yy/xx"),
    ]
    wait_until(lambda: near.query("/good") == good)
    assert near.list() == [good]
    for lie in lies:
        lie.undeclare()


def test_a_name_from_the_future_is_not_let_go(near: ZenohNames, far: ZenohNames) -> None:
    near.register("/mine", "tcp", "127.0.0.1", 1)
    wait_until(lambda: far.query("/mine"))
    entry = far.entry("/mine")
    assert entry is not None
    tomorrow = replace(entry, start=time.time_ns() + 10**14)
    far._claim(far._open().session, tomorrow)
    for said in (b"nonsense", zenoh_key.encode([replace(entry, start=1)])):
        key = zenoh_key.name_key(far.base, "/mine")
        assert list(far._open().session.get(key, payload=said, timeout=HANG)) == []
    assert far.query("/mine")


# -- configuration --------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("said", "where"),
    [
        ("zenoh", ""),
        ("zenoh+tcp://robot:7447", "tcp/robot:7447"),
        ("zenoh+tls://robot", "tls/robot"),
        ("zenoh+lan", "lan"),
        ("zenoh+file:///etc/z.json5", "file:///etc/z.json5"),
    ],
)
def test_the_environment_chooses_it(said: str, where: str) -> None:
    (server,) = configuration({"YARPY_SERVER": said}).servers
    names = default_client(server)
    assert isinstance(names, ZenohNames) and names.where == where


def test_a_file_chooses_it(tmp_path: Any) -> None:
    (tmp_path / "yarp.conf").write_text("robot.lab 7447 zenoh\n")
    (server,) = configuration({}, tmp_path).servers
    names = default_client(server)
    assert isinstance(names, ZenohNames) and names.where == "robot.lab:7447"


def test_two_of_one_session_lose_names_to_each_other(near: ZenohNames) -> None:
    twin = ZenohNames(near.where)
    lost: list[str] = []
    near.on_lost = lost.append
    try:
        near.register("/twin", "tcp", "127.0.0.1", 1001)
        twin.register("/twin", "tcp", "127.0.0.1", 1002)
        wait_until(lambda: lost == ["/twin"])
        assert near.query("/twin") == twin.query("/twin")
        assert twin.query("/twin").port == 1002  # type: ignore[union-attr]
    finally:
        twin.close()
