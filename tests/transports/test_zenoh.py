"""Sessions of Zenoh: where they go, that they are shared, and what is said when they fail."""

from __future__ import annotations

import os
import subprocess
import sys
import threading
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from support import tls
from support.port import free_port
from support.wait import wait_until

from yarpy.errors import (
    AddressError,
    LinkClosed,
    LocalProtocolError,
    MissingFile,
    RemoteProtocolError,
    UnknownPlugin,
)
from yarpy.transports import zenoh
from yarpy.transports.zenoh import Place, endpoint, open_router, place, share

pytest.importorskip("zenoh", reason='Zenoh: pip install "yarpy[zenoh]"')


@pytest.fixture(autouse=True)
def _nothing_configured(monkeypatch: pytest.MonkeyPatch) -> None:
    for name in ("YARPY_ZENOH", "YARPY_TLS", "YARPY_TLS_DIR", "ZENOH_CONFIG_OVERRIDE"):
        monkeypatch.delenv(name, raising=False)


@pytest.fixture
def router() -> Iterator[str]:
    """The address of a router."""
    where = f"tcp/127.0.0.1:{free_port()}"
    session = open_router([where])
    yield where
    session.close()


def ask(session: Any, key: str) -> list[bytes]:
    return [reply.ok.payload.to_bytes() for reply in session.get(key, timeout=5)]


def listening() -> set[str]:
    """The listening sockets of this process, as numbers of the system."""
    own = {link for fd in Path("/proc/self/fd").glob("*") if (link := linked(fd))}
    found = set()
    for table in ("tcp", "tcp6", "udp"):
        for line in Path(f"/proc/self/net/{table}").read_text().splitlines()[1:]:
            words = line.split()
            if words[3] in ("0A", "07") and f"socket:[{words[9]}]" in own:
                found.add(f"{table} {words[1]}")
    return found


def linked(path: Path) -> str:
    try:
        return os.readlink(path)
    except OSError:  # closed meanwhile
        return ""


# -- places ---------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("text", "found"),
    [
        ("", Place(("tcp/127.0.0.1:7447",))),
        ("robot", Place(("tcp/robot:7447",))),
        ("tcp/robot:7448", Place(("tcp/robot:7448",))),
        ("tls/a,b:1", Place(("tls/a:7447", "tcp/b:1"))),
        ("tcp/[::1]:7447", Place(("tcp/[::1]:7447",))),
        ("[::1]", Place(("tcp/[::1]:7447",))),
        ("tcp/a:7447#iface=eth0", Place(("tcp/a:7447#iface=eth0",))),
        ("udp/a:7447?rel=0", Place(("udp/a:7447?rel=0",))),
        ("lan", Place()),
        ("/etc/z.json5", Place(file="/etc/z.json5")),
        ("file:///etc/z.json5", Place(file="/etc/z.json5")),
    ],
)
def test_places(text: str, found: Place) -> None:
    assert place(text) == found


@pytest.mark.parametrize("text", ["tcp/", "ftp/a:1", "a:b", "a:70000", "a/b/c", "::1", "tcp/a:-1"])
def test_no_places(text: str) -> None:
    with pytest.raises(AddressError, match="YARPY_ZENOH"):
        endpoint(text)


def test_the_environment_says_where(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("YARPY_ZENOH", "tls/robot.lab")
    assert place() == Place(("tls/robot.lab:7447",))
    assert place("tcp/other") == Place(("tcp/other:7447",))


def test_where_tls_is_required_there_is_nothing_else(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("YARPY_TLS", "require")
    assert place("robot") == Place(("tls/robot:7447",))
    for text in ("tcp/robot", "lan", "udp/robot:1"):
        with pytest.raises(LocalProtocolError, match="YARPY_TLS requires TLS"):
            place(text)


# -- sessions -------------------------------------------------------------------------------------


def test_a_session_is_shared_until_the_last_gives_it_back(router: str) -> None:
    first, second = share(router), share(router)
    assert first.session is second.session and first.zid == second.zid
    first.close()
    first.close()
    assert not second.session.is_closed()
    session = second.session
    second.close()
    assert session.is_closed()
    with share(router) as third:
        assert third.session is not session


@pytest.mark.skipif(sys.platform != "linux", reason="looks into /proc")
def test_sessions_meet_at_a_router_and_open_no_socket(router: str, tmp_path: Path) -> None:
    file = tmp_path / "client.json5"
    scouting = "scouting: {multicast: {enabled: false}}"
    file.write_text(f'{{mode: "client", connect: {{endpoints: ["{router}"]}}, {scouting}}}')
    before = listening()
    with share(router) as one, share(str(file)) as other:
        assert one.zid != other.zid
        queryable = one.session.declare_queryable("a/b", lambda query: query.reply("a/b", b"yes"))
        wait_until(lambda: ask(other.session, "a/b") == [b"yes"])
        assert ask(other.session, "a/c") == []
        queryable.undeclare()
        assert listening() == before
        assert [str(link.dst) for link in one.session.info.links()] == [router]


def test_a_router_of_a_chain_passes_on_what_the_next_one_has(router: str) -> None:
    second = f"tcp/127.0.0.1:{free_port()}"
    chained = open_router([second], [router])
    try:
        with share(router) as one, share(second) as other:
            queryable = one.session.declare_queryable("x/y", lambda q: q.reply("x/y", b"far"))
            wait_until(lambda: ask(other.session, "x/y") == [b"far"])
            queryable.undeclare()
    finally:
        chained.close()


def test_an_override_comes_last(router: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("ZENOH_CONFIG_OVERRIDE", f'connect/endpoints=["{router}"]')
    with share(f"tcp/127.0.0.1:{free_port()}") as lease:
        assert not lease.session.is_closed()
    monkeypatch.setenv("ZENOH_CONFIG_OVERRIDE", "no/such=1")
    with pytest.raises(AddressError, match="ZENOH_CONFIG_OVERRIDE"):
        share(router)


PROGRAM = """
import sys
from yarpy.transports.zenoh import share
lease = share(sys.argv[1])
session = lease.session
subscriber = session.declare_subscriber("a", print)
queryable = session.declare_queryable("b", print)
token = session.liveliness().declare_token("c")
"""


def test_a_program_ends_by_itself(router: str) -> None:
    subprocess.run([sys.executable, "-c", PROGRAM, router], check=True, timeout=30)


def test_the_end_of_a_program_waits_for_those_who_wait_in_zenoh() -> None:
    calls, woken = zenoh.Calls(), threading.Event()
    inside = threading.Event()
    calls.waking.append(woken.set)

    def wait() -> None:
        with calls:
            inside.set()
            woken.wait(20)

    thread = threading.Thread(target=wait)
    thread.start()
    inside.wait(20)
    calls.refuse()
    calls.wait()
    assert woken.is_set() and not calls._waiting
    thread.join(20)
    with pytest.raises(ConnectionAbortedError), calls:
        raise AssertionError("it is over")


def test_the_end_of_a_program_waits_for_the_seats_that_are_taken() -> None:
    calls = zenoh.Calls()
    seat, _ = calls.seat(), calls.seat()
    seat.acquire()
    threading.Timer(0.05, seat.release).start()
    calls.refuse()
    calls.wait()
    assert calls.over and not seat.locked()


FORKING = """
import os, sys
from yarpy.errors import LocalProtocolError
from yarpy.transports.zenoh import share
lease = share(sys.argv[1])
child = os.fork()
if not child:
    try:
        share(sys.argv[1])
    except LocalProtocolError as error:
        print(error)
    sys.exit()
os.waitpid(child, 0)
print(len(list(lease.session.get("nothing"))))
"""


@pytest.mark.skipif(not hasattr(os, "fork"), reason="there is no fork here")
def test_a_forked_process_is_told_that_it_cannot(router: str) -> None:
    command = [sys.executable, "-c", FORKING, router]
    said = subprocess.run(command, check=True, timeout=30, capture_output=True, text=True).stdout
    assert "forked" in said and said.endswith("0\n")


# -- what goes wrong ------------------------------------------------------------------------------


def test_no_router() -> None:
    with pytest.raises(LinkClosed, match=r"no Zenoh router .* refused.*`yarpy router`"):
        share(f"tcp/127.0.0.1:{free_port()}")


def test_not_installed(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "zenoh", None)
    with pytest.raises(UnknownPlugin, match=r"pip install .*yarpy\[zenoh\]"):
        share("tcp/127.0.0.1:1")


def test_files_that_are_none(tmp_path: Path) -> None:
    with pytest.raises(MissingFile, match="no configuration file"):
        share(str(tmp_path / "none.json5"))
    (tmp_path / "bad.json5").write_text("{mode: ")
    with pytest.raises(AddressError, match="no configuration of Zenoh"):
        share(str(tmp_path / "bad.json5"))


def test_two_routers_cannot_have_one_address(router: str) -> None:
    with pytest.raises(LinkClosed, match="no router can listen"):
        open_router([router])


# -- TLS ------------------------------------------------------------------------------------------


def test_tls_both_ways(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    tls.prepare(tmp_path / "tls", monkeypatch, "mutual")
    where = f"127.0.0.1:{free_port()}"
    router = open_router([where])
    try:
        with share(where) as lease:
            assert [str(link.dst) for link in lease.session.info.links()] == [f"tls/{where}"]
        monkeypatch.setenv("YARPY_TLS", "")
        with pytest.raises(LinkClosed, match=r"wants TLS"):
            share(f"tcp/{where}")
        (tmp_path / "strangers").mkdir()
        (tmp_path / "strangers" / "ca.pem").write_bytes((tmp_path / "tls" / "ca.pem").read_bytes())
        monkeypatch.setenv("YARPY_TLS_DIR", str(tmp_path / "strangers"))
        with pytest.raises(RemoteProtocolError, match="refuses our certificate"):
            share(f"tls/{where}")
        tls.prepare(tmp_path / "others", monkeypatch)
        with pytest.raises(RemoteProtocolError, match="certificate is not valid"):
            share(f"tls/{where}")
    finally:
        router.close()


@pytest.mark.skipif(sys.platform != "linux", reason="looks into /proc")
def test_a_file_changes_what_it_mentions(tmp_path: Path) -> None:
    port = free_port()
    file = tmp_path / "router.json5"
    file.write_text(f'{{listen: {{endpoints: ["tcp/127.0.0.1:{port}"]}}}}')
    before = listening()
    router = open_router(file=str(file))
    assert len(listening() - before) == 1  # and nothing for scouting
    zenoh.close(router)
    router = open_router([f"tcp/127.0.0.1:{free_port()}"], file=str(file))
    with pytest.raises(LinkClosed):
        share(f"tcp/127.0.0.1:{port}")
    zenoh.close(router)


def test_a_router_without_a_certificate(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("YARPY_TLS_DIR", str(tmp_path))
    with pytest.raises(MissingFile, match="yarpy cert"):
        open_router([f"tls/127.0.0.1:{free_port()}"])


def test_what_zenoh_says_is_told_without_its_sources() -> None:
    error = RuntimeError("Invalid key!  at /root/zenoh/src/key.rs:12.")
    assert zenoh._plain(error) == "Invalid key"
