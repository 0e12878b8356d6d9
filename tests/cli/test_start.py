"""A signal at any moment of a start ends the program without a traceback."""

import signal
import subprocess
import sys
from pathlib import Path

import pytest
from support.wait import HANG

import yarpy

#: sends itself a signal when a module is imported for the first time, and by its end at the latest
PROGRAM = """
import signal, sys
class Sender:
    def find_spec(self, name, path=None, target=None):
        if name == {module!r}:
            signal.raise_signal({number})
sys.meta_path.insert(0, Sender())
from yarpy.cli.start import main
sys.argv = ["yarpy", "version"]
main()
"""
BEFORE = ["click", "yarpy.cli.main", "yarpy.cli.verbs.version"]


@pytest.mark.parametrize("module", BEFORE)
@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_a_signal_while_it_is_loaded(module: str, number: signal.Signals) -> None:
    program = PROGRAM.format(module=module, number=int(number))
    done = subprocess.run([sys.executable, "-c", program], capture_output=True, timeout=HANG)
    assert (done.returncode, done.stdout, done.stderr) == (128 + number, b"", b"")


BETWEEN = """
import signal, sys
from yarpy.cli import main as frame, signals
from yarpy.cli.start import main
watch = signals.watch
def watching():
    watch()
    signal.raise_signal(signal.SIGINT)
    while True:
        pass
signals.watch = watching
main()
"""


def test_a_signal_between_the_watch_and_the_command() -> None:
    done = subprocess.run([sys.executable, "-c", BETWEEN], capture_output=True, timeout=HANG)
    assert (done.returncode, done.stdout, done.stderr) == (130, b"", b"")


def test_both_ways_to_start_it_begin_here() -> None:
    project = Path(yarpy.__file__).parents[2] / "pyproject.toml"
    if project.exists():  # an installed package has none
        assert 'yarpy = "yarpy.cli.start:main"' in project.read_text(encoding="utf-8")
    module = Path(yarpy.__file__).with_name("__main__.py").read_text(encoding="utf-8")
    assert "from yarpy.cli.start import main" in module
