"""`yarpy info`; tests/kits/record/test_report.py has what it says."""

import json

from support.recordings import recorded


def test_for_people_and_programs(here, tmp_path) -> None:
    path = recorded(tmp_path / "x.mcap")
    said = here("info", str(path))
    assert said.code == 0 and "messages:  10" in said.out
    told = json.loads(here("info", "--json", "--check", str(path)).out)
    assert [port["messages"] for port in told["ports"]] == [5, 5]


def test_what_is_damaged_is_exit_code_1(here, tmp_path) -> None:
    path = recorded(tmp_path / "x.mcap")
    path.write_bytes(path.read_bytes()[:200])
    said = here("info", str(path))
    assert said.code == 1 and "damaged:" in said.out
    assert "cannot be read" in here("info", str(tmp_path / "gone")).err
