"""`yarpy autoqos`; tests/kits/autoqos has what it decides."""

import json
import signal
import threading
import time

import pytest
from support.system import NO_MARKS
from support.wait import HANG, wait_until

import yarpy

RULES = """
[[critical]]
connections = ["/autoqos/*"]
deadline = 0.05
"""


# What is set until it helps: a deadline, packets at both ends; where the system marks none for a
# program, threads too.
SETTINGS = 5 if NO_MARKS else 3


def helped(port):
    """Whether the first connection of a port has what helps."""
    now = port.outputs[0].qos
    return now.policy in ("SCHED_FIFO", "SCHED_RR") if NO_MARKS else now.packets == "AF42"


@pytest.fixture
def late(names):
    """A connection whose messages are late until it has what helps; what writes into it."""
    going = threading.Event()
    with (
        yarpy.Port("/autoqos/out", names=names) as out,
        yarpy.BufferedPort("/autoqos/in", names=names) as in_,
    ):
        out.connect("/autoqos/in", "tcp")
        in_.wait_for_inputs(timeout=HANG)

        def write():
            while not going.wait(0.005):
                old = not helped(out)
                # Stamps of the future are in time however busy this machine is.
                out.write([1], yarpy.Stamp(1, time.time() + (-1.0 if old else 60.0)))

        thread = threading.Thread(target=write)
        thread.start()
        yield out
        going.set()
        thread.join(HANG)


def test_each_step_is_a_line_and_an_interrupt_undoes_them(cli, late, tmp_path):
    file = tmp_path / "rules.toml"
    file.write_text(RULES)
    with cli.start("autoqos", str(file)) as agent:
        agent.wait_line(r"\d\d:\d\d:\d\d deadlines of 50 ms are counted on /autoqos/out")
        agent.wait_line(r"late on /autoqos/out -> /autoqos/in: its packets become HIGH")
        agent.wait_line("that helped: ")
        assert helped(late)
        with cli.start("autoqos", str(file)) as second:
            assert second.wait() == 1
            assert "another autoqos is running" in second.stderr
        agent.signal(signal.SIGINT)
        agent.wait()
        assert f"as it was found: {SETTINGS} settings undone" in agent.stdout
    assert not helped(late)


def test_the_next_start_undoes_what_a_killed_one_left(cli, late, tmp_path):
    file = tmp_path / "rules.toml"
    file.write_text(RULES)
    with cli.start("autoqos", "--json", str(file)) as agent:
        agent.wait_line("that helped")
        agent.kill()
    assert helped(late)
    with cli.start("autoqos", "--json", str(file)) as agent:
        line = agent.wait_line(f"that was killed left {SETTINGS} settings undone").string
        assert json.loads(line)["failed"] == []
        wait_until(lambda: "that helped" in agent.stdout)


def test_a_dry_run_says_what_it_would_do(cli, late, tmp_path):
    file = tmp_path / "rules.toml"
    file.write_text(RULES)
    with cli.start("autoqos", "--dry-run", str(file)) as agent:
        agent.wait_line("would: deadlines of 50 ms are counted on /autoqos/out")
    assert not helped(late)


def test_mistakes_in_rules(here, tmp_path):
    file = tmp_path / "rules.toml"
    said = here("autoqos", str(file))
    assert said.code == 1 and "cannot be read" in said.err
    file.write_text('[[critical]]\nconnections = ["/a"]\n')
    said = here("autoqos", str(file))
    assert said.code == 1
    assert f"{file}, line 1: expected a deadline in seconds" in said.err


def test_no_server(lone, tmp_path):
    file = tmp_path / "rules.toml"
    file.write_text(RULES)
    with lone.start("autoqos", str(file)) as agent:
        agent.wait_line("no name server answers, waiting")
