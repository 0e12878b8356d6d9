"""Sessions of Zenoh: where they go, that they are shared, and what is said when they fail."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest
from support.wait import wait_until
from support.zenoh_session import ask, listening

from yarpy.peers.zenoh.transport import share

pytest.importorskip("zenoh", reason='Zenoh: pip install "yarpy[zenoh]"')


pytestmark = pytest.mark.usefixtures("unconfigured")


def test_a_session_is_shared_until_the_last_gives_it_back(lone_router: str) -> None:
    first, second = share(lone_router), share(lone_router)
    assert first.session is second.session and first.zid == second.zid
    first.close()
    first.close()
    assert not second.session.is_closed()
    session = second.session
    second.close()
    assert session.is_closed()
    with share(lone_router) as third:
        assert third.session is not session


@pytest.mark.skipif(sys.platform != "linux", reason="looks into /proc")
def test_sessions_meet_at_a_router_and_open_no_socket(lone_router: str, tmp_path: Path) -> None:
    file = tmp_path / "client.json5"
    scouting = "scouting: {multicast: {enabled: false}}"
    file.write_text(f'{{mode: "client", connect: {{endpoints: ["{lone_router}"]}}, {scouting}}}')
    before = listening()
    with share(lone_router) as one, share(str(file)) as other:
        assert one.zid != other.zid
        queryable = one.session.declare_queryable("a/b", lambda query: query.reply("a/b", b"yes"))
        wait_until(lambda: ask(other.session, "a/b") == [b"yes"])
        assert ask(other.session, "a/c") == []
        queryable.undeclare()
        assert listening() == before
        assert [str(link.dst) for link in one.session.info.links()] == [lone_router]


PROGRAM = """
import sys
from zenoh.handlers import Callback
from yarpy.peers.zenoh.transport import share
shared = share(sys.argv[1])
session = shared.session
subscriber = session.declare_subscriber("a", Callback(print, indirect=False))
queryable = session.declare_queryable("b", Callback(print, indirect=False))
token = session.liveliness().declare_token("c")
"""


def test_a_program_ends_by_itself(lone_router: str) -> None:
    subprocess.run([sys.executable, "-c", PROGRAM, lone_router], check=True, timeout=30)


FORKING = """
import os, sys
from yarpy.errors import LocalProtocolError
from yarpy.peers.zenoh.transport import share
shared = share(sys.argv[1])
child = os.fork()
if not child:
    try:
        share(sys.argv[1])
    except LocalProtocolError as error:
        print(error)
    sys.exit()
os.waitpid(child, 0)
print(len(list(shared.session.get("nothing"))))
"""


@pytest.mark.skipif(not hasattr(os, "fork"), reason="there is no fork here")
def test_a_forked_process_is_told_that_it_cannot(lone_router: str) -> None:
    command = [sys.executable, "-c", FORKING, lone_router]
    said = subprocess.run(command, check=True, timeout=30, capture_output=True, text=True).stdout
    assert "forked" in said and said.endswith("0\n")
