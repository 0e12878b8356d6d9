"""A manager's applications, which run in the background."""

import json
import subprocess
import sys
from pathlib import Path

import pytest
from support.wait import HANG, wait_until

from yarpy.kits.launch.console import control
from yarpy.kits.launch.manager.session import Session
from yarpy.kits.launch.supervise import process

pytestmark = pytest.mark.skipif(not process.known(), reason="this system has no /proc to look at")

PROGRAM = (
    "import sys; from yarpy.kits.launch.manager.words import main; sys.exit(main(sys.argv[1:]))"
)


@pytest.mark.timeout(10 * HANG)  # it starts eight programs, one after the other
def test_what_it_started_goes_on_and_is_found_again(cli) -> None:
    file = cli.home / "m.xml"
    file.write_text(
        f"""<application><name>managed</name>
<module><name>{sys.executable}</name><parameters>-m yarpy read /m/in</parameters></module>
<module><name>{sys.executable}</name><parameters>-c "import time, yarpy; p = yarpy.Port('/m/out');
time.sleep(600)"</parameters></module>
<connection><from>/m/out</from><to>/m/in</to><protocol>tcp</protocol></connection>
</application>"""
    )

    def manager(*words: str) -> str:
        done = subprocess.run(
            [sys.executable, "-c", PROGRAM, "--application", str(file), *words],
            env=cli.environment,
            capture_output=True,
            text=True,
            timeout=4 * HANG,  # it starts programs, and waits for them
            check=True,
        )
        return done.stdout

    try:
        first = manager("--run", "--exit")
        assert first.count("<RUNNING>") == 2 and "2 modules run on" in first
        joined = "<CONNECTED> (0) /m/out - /m/in [tcp]"
        wait_until(lambda: joined in manager("--connect", "--exit"), 4 * HANG)
        told = json.loads(cli.run("status", "--json").stdout)
        assert [one["state"] for one in told["programs"]] == ["running"] * 2
        second = manager("--check_state", "--check_con", "--exit")
        assert second.count("<RUNNING>") == 2 and joined in second
        third = manager("--disconnect", "--stop", "--exit")
        assert "<DISCONNECTED>" in third and third.count("<STOPPED>") == 2
        assert cli.run("status").returncode == 1  # nothing is left, not even who kept it
    finally:
        cli.run("down")


def test_the_end_of_who_ran_it_is_waited_for(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    file = tmp_path / "m.xml"
    file.write_text("<application><name>managed</name></application>")
    session = Session()
    session.choose(session.add(file).name)
    looks, asked = [["managed"]] * 5, []  # who ends takes a moment

    def ask(name: str, **request: str) -> dict[str, list[object]]:
        asked.append((name, request["do"]))
        return {"programs": []}

    monkeypatch.setattr(control, "ask", ask)
    monkeypatch.setattr(control, "running", lambda: looks.pop() if looks else [])
    assert session.close() == "" and asked[-1] == ("managed", "down") and looks == []
