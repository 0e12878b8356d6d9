"""What all tests share: stages, patience, a browser (`support/browser.py`), and signals.

Rules: a stage is a set of folders; what is named in none of them belongs to the last, so nothing is
left out by being new. `--stage` takes the tests of one stage; without it all are taken.
"""

import signal
from pathlib import Path

import hypothesis
import pytest
from support.patience import FACTOR

from yarpy import log

hypothesis.settings.register_profile("yarpy", deadline=None)  # the machine may be busy
hypothesis.settings.load_profile("yarpy")
pytest_plugins = ["support.browser"]

TESTS = Path(__file__).parent
STAGES = {
    # bytes and values, no sockets: seconds
    "pure": {
        *("wire", "data", "idl", "carriers", "config", "test_architecture.py", "test_contact.py"),
        *("test_errors.py", "test_registry.py", "test_route.py"),
    },
    # ports, links, names and monitors of one process: a minute
    "links": {
        *("transports", "link", "monitors", "names", "nameserver", "port", "network", "testing"),
        *("aio", "test_qos.py", "test_realtime.py"),
    },
    # everything else, from devices to programs, browsers and C++ YARP: minutes
    "programs": set(),
}


def stage_of(path: Path) -> str:
    """The stage that a test file belongs to."""
    top = path.relative_to(TESTS).parts[0]
    return next((stage for stage, names in STAGES.items() if top in names), "programs")


def pytest_addoption(parser: pytest.Parser) -> None:
    parser.addoption("--stage", choices=[*STAGES], help="only the tests of one stage")


def pytest_ignore_collect(collection_path: Path, config: pytest.Config) -> bool | None:
    wanted = config.getoption("--stage")
    if wanted is None or collection_path == TESTS or not collection_path.is_relative_to(TESTS):
        return None
    return True if stage_of(collection_path) != wanted else None


def pytest_configure(config: pytest.Config) -> None:
    """Wait longer where the environment says so; and undo what a shell does to background jobs:
    programs that tests start would inherit it, and could not be interrupted."""
    limit = config.getini("timeout")
    if limit and FACTOR > 1 and config.getoption("timeout", None) is None:
        config.option.timeout = float(str(limit)) * FACTOR
    if signal.getsignal(signal.SIGINT) is signal.SIG_IGN:
        signal.signal(signal.SIGINT, signal.default_int_handler)
    hang_up = getattr(signal, "SIGHUP", None)
    if hang_up is not None and signal.getsignal(hang_up) is signal.SIG_IGN:
        signal.signal(hang_up, signal.SIG_DFL)


def pytest_runtest_setup(item: pytest.Item) -> None:
    """Each test may see as many warnings as a program in its first minute."""
    log._kinds.clear()
