"""Findings about this computer; test_examination.py has the fault."""

from pathlib import Path

from support.doctor import made_up

from yarpy.kits.doctor.kernel import find


def test_no_such_folder_is_no_fault() -> None:
    assert [*find(made_up(directory=Path("/no/such/folder")))] == []
