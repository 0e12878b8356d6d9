"""`yarpy down`; test_up has what it ends."""

import json
import os
import signal
from pathlib import Path

import pytest
from support.wait import HANG

from yarpy.kits.launch.supervise import leftover


def test_where_nothing_runs(cli) -> None:
    done = cli.run("down")
    assert done.returncode == 1 and "no application runs here: `yarpy up FILE`" in done.stderr
    done = cli.run("down", "other")
    assert done.returncode == 1 and 'no application called "other" runs here' in done.stderr


@pytest.mark.skipif(os.name != "posix", reason="Windows has no `yarpy run --server`")
def test_what_may_go_on_at_a_server_is_tried_again(cli, monkeypatch: pytest.MonkeyPatch) -> None:
    """A server that stands still, as one whose computer is gone, and then goes on."""
    left = {"run": "", "programs": [], "away": {"lab:far": "/down/node"}}
    with cli.start("run", "--server", "/down/node", "--end-programs") as node:
        node.wait_line("/down/node starts programs")
        done = cli.run("run", "--on", "/down/node", "--as", "lab:far", "--cmd", "sleep 600")
        assert done.returncode == 0, done.stderr
        folder = Path(cli.environment["YARP_RUNTIME_DIR"]) / "up"
        folder.mkdir(mode=0o700, exist_ok=True, parents=True)
        (folder / "lab.json").write_text(json.dumps(left))
        node.signal(signal.SIGSTOP)
        monkeypatch.setattr(leftover, "_FAR", 0.5)
        done = cli.run("down", "lab")
        assert done.returncode == 1
        assert "lab:far may go on at /down/node: " in done.stderr
        assert "`yarpy down lab` tries again" in done.stderr
        node.signal(signal.SIGCONT)
        monkeypatch.setattr(leftover, "_FAR", HANG)  # what a busy machine takes
        done = cli.run("down", "lab")
        assert done.stdout == "ended what was left of lab: lab:far at /down/node\n", done.stderr
        done = cli.run("down", "lab")
        assert done.returncode == 1 and 'no application called "lab"' in done.stderr
