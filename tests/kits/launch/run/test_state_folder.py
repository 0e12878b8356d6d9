"""The files in which a server keeps what it has started."""

import json
from pathlib import Path

import pytest
from support.system import NO_RUN_SERVER

from yarpy.errors import AddressError
from yarpy.kits.launch.run.state_folder import Entry, StateFolder, default_folder

pytestmark = pytest.mark.skipif(bool(NO_RUN_SERVER), reason=NO_RUN_SERVER)


def test_entries_come_back(tmp_path: Path) -> None:
    state = StateFolder("/node", tmp_path)
    assert state.folder.stat().st_mode & 0o777 == 0o700
    entry = Entry(state.fresh(), "tag", "sleep 60", "A=b", "/tmp", 7, 99, "/log/x", "/l", "/u")
    state.write(entry)
    assert state.path(entry.id, "json").stat().st_mode & 0o777 == 0o600
    state.set_place(entry.id, 12)
    state.close()
    state = StateFolder("/node", tmp_path)
    [found] = state.entries()
    assert (found.tag, found.command, found.pid, found.uuid) == ("tag", "sleep 60", 7, "/u")
    assert state.place(entry.id) == 12 and state.place("other") == 0
    state.remove(entry.id)
    assert [*state.entries()] == [] and [*state.folder.glob("*.*")] == []
    state.close()


def test_one_server_at_a_time(tmp_path: Path) -> None:
    state = StateFolder("/node", tmp_path)
    with pytest.raises(AddressError, match="runs already"):
        StateFolder("/node", tmp_path)
    StateFolder("/other", tmp_path).close()
    state.close()


def test_what_is_no_entry_any_more_is_removed(tmp_path: Path) -> None:
    state = StateFolder("/node", tmp_path)
    entry = Entry(state.fresh(), "tag", "sleep", pid=7)
    for change in ({"boot": "another"}, {"pid": "7"}, {"id": "../x"}, {"tag": None}):
        state.write(entry)
        path = state.path(entry.id, "json")
        path.write_text(json.dumps(json.loads(path.read_text()) | change))
        assert [*state.entries()] == [] and not path.exists()
    path.write_text("{")
    assert [*state.entries()] == []
    state.close()


def test_a_folder_that_cannot_be(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "file").touch()
    with pytest.raises(AddressError, match="cannot be used"):
        StateFolder("/node", tmp_path / "file")
    monkeypatch.setenv("XDG_STATE_HOME", "/s")
    assert default_folder() == Path("/s/yarpy/run")
