"""The journal: what a killed agent leaves."""

from __future__ import annotations

from pathlib import Path

import pytest

from yarpy.errors import LocalProtocolError
from yarpy.kits.autoqos.change import Change
from yarpy.kits.autoqos.journal import Journal, path

FIRST = Change("/a", "/b", "packets", "AF42", "CS0")
AGAIN = Change("/a", "/b", "packets", "CS0", "AF42")
OTHER = Change("/a", "/a", "limit", 3.0, None)


def test_the_next_one_finds_what_a_killed_one_left(tmp_path: Path) -> None:
    journal = Journal(tmp_path / "deep" / "journal")
    for change in (FIRST, OTHER, AGAIN):
        journal.write(change)
    journal.close()
    after = Journal(journal.where)
    assert after.left() == [OTHER.undone, FIRST.undone]  # the last first, the origin of each
    after.clear()
    after.close()
    last = Journal(journal.where)
    assert last.left() == []
    last.close()


def test_damage_is_passed_over(tmp_path: Path) -> None:
    where = tmp_path / "journal"
    journal = Journal(where)
    journal.write(FIRST)
    journal.close()
    with where.open("ab") as file:
        file.write(b'\xff\n{"port": 3}\n[[[[\n{"port": "/x", "pee')
    damage = where.read_bytes()
    after = Journal(where)
    assert after.left() == [FIRST.undone]
    assert after.damaged == 3  # not what a crash leaves at the end, which was never done
    assert after.copy.read_bytes() == damage
    after.clear()
    after.close()
    last = Journal(where)
    assert last.damaged == 0
    last.close()


def test_what_a_crash_leaves_is_no_damage(tmp_path: Path) -> None:
    where = tmp_path / "journal"
    where.write_bytes(b'{"port": "/x", "pee')
    journal = Journal(where)
    assert (journal.left(), journal.damaged) == ([], 0)
    assert not journal.copy.exists()
    journal.close()


def test_a_journal_that_is_too_large(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    where = tmp_path / "journal"
    monkeypatch.setattr("yarpy.kits.autoqos.journal.JOURNAL", 100)
    where.write_bytes(b"{}" * 100)
    journal = Journal(where)
    assert journal.damaged
    journal.close()


def test_one_agent_at_a_time(tmp_path: Path) -> None:
    journal = Journal(tmp_path / "journal")
    with pytest.raises(LocalProtocolError, match="another autoqos is running"):
        Journal(tmp_path / "journal")
    journal.close()


def test_a_place_that_cannot_be_written(tmp_path: Path) -> None:
    (tmp_path / "file").write_text("")
    with pytest.raises(LocalProtocolError, match="cannot be written"):
        Journal(tmp_path / "file" / "journal")


def test_where_it_is(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.setenv("YARP_DATA_HOME", str(tmp_path))
    assert path() == tmp_path / "autoqos.journal"
