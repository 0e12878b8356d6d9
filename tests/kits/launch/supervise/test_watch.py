"""Files that change while an application runs."""

from collections.abc import Iterator
from pathlib import Path

import pytest
from support.commands import PYTHON, SLEEP
from support.wait import wait_until

import yarpy
from yarpy.kits.launch.application.application import Module
from yarpy.kits.launch.application.load import load
from yarpy.kits.launch.supervise.supervisor import Supervisor
from yarpy.kits.launch.supervise.watch import Watch, named

SCRIPT = f"name = 'app'\n[programs]\nscript = {{command = [{PYTHON}, 'run.py']}}\n"
TEXT = f"{SCRIPT}other = {SLEEP}\n"


def sleeping(seconds: int) -> str:
    return f"import time; time.sleep({seconds})"


class Running:
    """An application from a file, which is looked at when the test says so."""

    def __init__(self, folder: Path, names: yarpy.LocalNames) -> None:
        self.path = folder / "app.toml"
        self.script = folder / "run.py"
        self.script.write_text(sleeping(600))
        self.path.write_text(TEXT)
        self.news: list[str] = []
        self.supervisor = Supervisor(load(self.path), grace=1.0, names=names)
        self.supervisor.start()
        self.watch = Watch(
            self.supervisor, lambda: load(self.path), lambda who, text: self.news.append(text)
        )
        self.watch.look()
        self.settle()

    def settle(self) -> None:
        units = self.supervisor.units
        wait_until(lambda: all(one.state == "running" for one in units.values()))

    def pids(self) -> dict[str, int]:
        return {label: one.handle.pid for label, one in self.supervisor.units.items() if one.handle}

    def change(self, path: Path, text: str) -> None:
        path.write_text(text, encoding="utf-8")
        self.watch.look()  # it may still be written to
        self.watch.look()


@pytest.fixture
def running(
    tmp_path: Path, network: yarpy.LocalNames, monkeypatch: pytest.MonkeyPatch
) -> Iterator[Running]:
    monkeypatch.chdir(tmp_path)
    found = Running(tmp_path, network)
    yield found
    found.supervisor.stop()


def test_a_script_that_changes_starts_again_and_nothing_else(running: Running) -> None:
    before = running.pids()
    running.change(running.script, sleeping(6001))  # of another size
    assert running.news == ["starts again: run.py has changed"]
    wait_until(lambda: running.pids()["script"] != before["script"])
    running.settle()
    assert running.pids()["other"] == before["other"]


def test_a_file_that_is_still_written_is_waited_for(running: Running) -> None:
    running.script.write_text(sleeping(60))
    running.watch.look()
    running.script.write_text(sleeping(6000))
    running.watch.look()
    assert running.news == []
    running.watch.look()
    assert running.news


def test_the_description_changes(running: Running) -> None:
    before = running.pids()
    running.change(running.path, f"{SCRIPT}third = {SLEEP}\n")
    assert running.news == ["third is new", "other is no longer in the file"]
    running.settle()
    after = running.pids()
    assert after.keys() == {"script", "third"} and after["script"] == before["script"]
    assert not running.supervisor.over.is_set()


def test_a_description_with_errors_changes_nothing(running: Running) -> None:
    before = running.pids()
    running.change(running.path, TEXT + "[programs.x]\ncommand = 'a'\nafter = ['nobody']\n")
    assert running.news[-1] == "all runs on as it was" and "nobody" in running.news[0]
    running.change(running.path, "this is = = nothing")
    assert running.news[-1].endswith("all runs on as it was")
    assert running.pids() == before
    running.path.unlink()
    running.watch.look()
    running.watch.look()
    assert running.pids() == before


def test_which_files_a_command_line_names(tmp_path: Path) -> None:
    for name in ("run.py", "conf.ini"):
        (tmp_path / name).touch()
    words = ("python3", "run.py", "--from=conf.ini", "x\0y", "z" * 5000, "")
    module = Module("a", "python3", words=words, workdir=str(tmp_path))
    assert [path.name for path in named(module)] == ["run.py", "conf.ini"]
    assert named(Module("a", "python3", words=words, workdir=str(tmp_path), node="/n")) == []
