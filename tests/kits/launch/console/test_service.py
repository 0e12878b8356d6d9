"""What a running application answers."""

import os
import sys

import pytest

from yarpy.errors import LocalProtocolError, UnknownName
from yarpy.kits.launch.application.application import Application, Module
from yarpy.kits.launch.console.service import answer
from yarpy.kits.launch.supervise.supervisor import Supervisor
from yarpy.limit import CONTROL_REPLY


@pytest.fixture
def supervisor() -> Supervisor:
    return Supervisor(Application("app", modules=[Module("a", sys.executable)]))


def test_status(supervisor: Supervisor) -> None:
    told = answer(supervisor, {"do": "status"})
    assert (told["application"], told["pid"], told["connections"]) == ("app", os.getpid(), [])
    assert [(one["name"], one["state"]) for one in told["programs"]] == [("a", "waiting")]


def test_logs_are_no_longer_than_a_reply(supervisor: Supervisor) -> None:
    lines = supervisor.units["a"].lines
    lines.extend((n, "x" * 8000) for n in range(1000))
    found = answer(supervisor, {"do": "logs", "most": 1000})["lines"]
    assert found[-1][0] == 999 and 1 < len(found) < 1000
    assert sum(len(line) for _, _, line in found) < CONTROL_REPLY // 6
    assert answer(supervisor, {"do": "logs", "name": "a", "since": 999})["lines"] == []


def test_down(supervisor: Supervisor) -> None:
    assert answer(supervisor, {"do": "down"}) == {"ok": True} and supervisor.over.is_set()


def test_what_cannot_be_done(supervisor: Supervisor) -> None:
    with pytest.raises(LocalProtocolError, match='"dance" is none of status'):
        answer(supervisor, {"do": "dance"})
    with pytest.raises(UnknownName):
        answer(supervisor, {"do": "restart", "name": "b"})


def test_start_and_stop_by_hand(supervisor: Supervisor) -> None:
    supervisor.rest()
    assert answer(supervisor, {"do": "start", "name": "a"}) == {"ok": True}
    for word in ("stop", "kill"):
        assert answer(supervisor, {"do": word, "name": "a"}) == {"ok": True}
    with pytest.raises(UnknownName, match="has no connection /x -> /y"):
        answer(supervisor, {"do": "connect", "from": "/x", "to": "/y"})
    supervisor.stop()
    assert supervisor.units["a"].state == "stopped"
