"""The table of a message's function calls comes about, and says that they are few."""

import subprocess
import sys
from pathlib import Path

from support.wait import HANG

BENCH = Path(__file__).resolve().parents[2] / "bench" / "calls.py"
ONCE = ("--messages", "50", "--rows", "100")


def test_tables() -> None:
    # In a program of its own, as it binds itself to one core: with two, whose turn it is is asked
    # as often as the threads happen to meet.
    command = (sys.executable, str(BENCH), *ONCE)
    printed = subprocess.run(
        command, check=True, capture_output=True, text=True, timeout=HANG
    ).stdout
    # With those of the bench, and some for a thread that is interrupted.
    for title, most in (
        ("Both sides", 32),
        ("The side that asks", 30),
        ("The side that answers", 26),
    ):
        _, found, rest = printed.partition(f"{title}: ")
        assert found
        assert int(rest.split()[0]) <= most
        rooms, functions = rest.split("| room |")[1].split("| function |")[:2]
        assert {"| port |", "| functions in C |"} <= {
            line[: line.find("|", 2) + 1] for line in rooms.splitlines()
        }
        # One of ours, and one in C; which system call is made at once depends on who is quicker.
        assert "| link/" in functions
        assert "' of '_struct.Struct' objects |" in functions
