"""The words of yarpmanager-console, over a manager that only notes what it is asked for."""

from pathlib import Path
from typing import Any

import pytest

from yarpy.kits.launch.application.application import Application
from yarpy.kits.launch.manager.session import Session
from yarpy.kits.launch.manager.words import Console, main

XML = """<application><name>My App</name>
<module><name>yarpdev</name><parameters>--a b</parameters><node>nodeB</node>
<environment>X=1</environment></module>
<module><name>sleep</name><parameters>9</parameters></module>
<connection><from>/a</from><to>/b</to><protocol>udp</protocol></connection>
<conection/>
</application>"""


class Noting(Session):
    """Runs nothing."""

    def __init__(self) -> None:
        super().__init__()
        self.done: list[object] = []
        self.states = {"yarpdev": "running", "sleep": "failed"}

    def run(self, labels: Any) -> list[str]:
        self.done.append(("run", [*labels]))
        return ["Failed to run sleep: killed"] if "sleep" in labels else []

    def stop(self, labels: Any, word: str = "stop") -> list[str]:
        self.done.append((word, [*labels]))
        return []

    def join(self, numbers: Any, word: str) -> list[str]:
        self.done.append((word, [*numbers]))
        return []

    def status(self) -> dict[str, Any]:
        programs = [{"name": name, "state": state} for name, state in self.states.items()]
        links = [{"from": "/a", "to": "/b", "state": "connected"}]
        return {"programs": programs, "connections": links}

    def running(self) -> list[str]:
        return [name for name, state in self.states.items() if state == "running"]


class Said:
    def __init__(self, path: Path) -> None:
        self.lines: list[str] = []
        self.session = Noting()
        self.console = Console(self.session, self.lines.append)
        self.session.add(path)

    def do(self, *lines: str) -> list[str]:
        self.lines.clear()
        for line in lines:
            assert not self.console.do(line)
        return [*self.lines]


@pytest.fixture
def said(tmp_path: Path) -> Said:
    path = tmp_path / "app.xml"
    path.write_text(XML)
    found = Said(path)
    found.do("load app My_App")
    return found


def test_lists_and_what_is_loaded(said: Said) -> None:
    assert said.do("list app")[0].startswith("(0) My_App [")
    found = said.do("load app My_App")
    assert "<conection> in <application> is ignored" in found[0] and found[0].startswith("WARNING:")
    assert "(0) yarpdev [/nodeB] [--a b] [X=1]" in found
    assert "(1) sleep [localhost] [9] []" in found
    assert "(0) /a - /b [udp]" in found
    assert "(0) /nodeB [Computer]" in found and "(1) localhost [Computer]" in found


def test_run_stop_kill(said: Said) -> None:
    states = ["<RUNNING> (0) yarpdev [/nodeB]", "<STOPPED> (1) sleep [localhost]"]
    assert said.do("run") == ["ERROR:   Failed to run sleep: killed", *states]
    assert said.do("stop 1") == states[1:]
    assert said.do("kill 0") == states[:1]
    both = ["yarpdev", "sleep"]
    assert said.session.done == [("run", both), ("stop", ["sleep"]), ("kill", ["yarpdev"])]


def test_connections(said: Said) -> None:
    assert said.do("connect", "disconnect 0") == ["<CONNECTED> (0) /a - /b [udp]"] * 2
    assert said.session.done == [("connect", [0]), ("disconnect", [0])]
    said.do("set auto_connect yes", "run 0")
    assert said.session.done[-1] == ("connect", [0])
    assert said.do("get auto_connect") == ["auto_connect = yes"]


@pytest.mark.parametrize(
    ("line", "answer"),
    [
        ("bogus", "'bogus' is not correct. type \"help\" for more information."),
        ("_run", "'_run' is not correct. type \"help\" for more information."),
        ("run 7", "ERROR:   there is no (7)"),
        ("run -1", "ERROR:   there is no (-1)"),
        ("load app X", "ERROR:   My_App is running: stop it before another one is loaded"),
        ("show mod nobody", "ERROR:   'nobody' not found."),
        (r"show mod C:\a", r"ERROR:   'C:\a' not found."),
        ('run "', "ERROR:   No closing quotation"),
        ("check", "ERROR:   list index out of range"),
    ],
)
def test_what_is_wrong(said: Said, line: str, answer: str) -> None:
    assert said.do(line) == [answer]


def test_nothing_is_loaded() -> None:
    lines: list[str] = []
    console = Console(Noting(), lines.append)
    console.do("which")
    console.do("load app Other")
    assert lines == [
        'ERROR:   No application is loaded: "load app NAME" does that.',
        "ERROR:   Other does not exist.",
    ]
    assert console.do("") is False and console.do("exit") is True


def test_export_and_show(said: Said, tmp_path: Path) -> None:
    said.do(f"export {tmp_path / 'g.dot'}")
    assert (tmp_path / "g.dot").read_text().startswith("digraph G {")
    assert "Node       : /nodeB" in said.do("show mod yarpdev")


def test_a_policy_is_an_option_of_up(said: Said) -> None:
    said.do("set module_failure recover")
    assert said.session.options == ["--restart", "on-failure"]
    said.do("set module_failure terminate")
    assert said.session.options == ["--restart", "no", "--stop-on-failure"]


def test_the_program(tmp_path: Path, monkeypatch, capsys) -> None:
    monkeypatch.chdir(tmp_path)
    (tmp_path / "app.xml").write_text(XML)
    monkeypatch.setenv("YARP_RUNTIME_DIR", str(tmp_path / "run"))
    assert main(["--application", "app.xml", "--exit"]) == 0
    assert "(0) My_App [app.xml]" in capsys.readouterr().out
    assert main(["--version"]) == 0 and capsys.readouterr().out == "Version 1.1\n"
    assert main(["--application", "no.xml", "--exit"]) == 1
    (tmp_path / "ymanager.ini").write_text("apppath ./\nmodule_failure recover\n")
    monkeypatch.setattr("builtins.input", iter(["list app", "exit"]).__next__)
    assert main(["--from", "ymanager.ini"]) == 0
    assert "(0) My_App [" in capsys.readouterr().out


def test_names_that_are_taken_get_numbers(tmp_path: Path) -> None:
    session = Noting()
    for name in ("a.xml", "b.xml"):
        (tmp_path / name).write_text(XML)
        assert isinstance(session.add(tmp_path / name), Application)
    assert [*session.files] == ["My_App", "My_App(1)"]
