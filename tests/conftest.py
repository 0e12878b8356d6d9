"""What all tests share: stages, foreign programs (`support/peer.py`), a browser, and signals.

Rules: `--stage` takes the tests of one stage (`support/stage.py`). Whether a test
needs a foreign program is no matter of lists: it says so itself, and gets the marker `peer`. `make
test` is `pytest -m "not peer"`, `make peers` is `pytest -m peer`.
"""

import gc
import logging
import os
import signal
from collections.abc import Generator
from pathlib import Path

import hypothesis
import pytest
from support import multicast, peer
from support.stage import STAGES, TESTS, stage_of
from support.system import NO_MEMFD, NO_UNIX_SOCKETS
from support.watchdog import TimeLimits

from yarpy import log

# zenoh_ros2_sdk imports a wrapper of git, which it needs only for definitions that it downloads.
os.environ.setdefault("GIT_PYTHON_REFRESH", "quiet")
hypothesis.settings.register_profile("yarpy", deadline=None)  # the machine may be busy
hypothesis.settings.load_profile("yarpy")
pytest_plugins = ["support.browser"]

LOGGER = logging.getLogger("yarpy")
UNCONFIGURED = [*LOGGER.handlers], LOGGER.level, LOGGER.propagate

if hasattr(os, "register_at_fork"):
    # What foreign libraries have here waits for their threads when it is collected, and a forked
    # child has none of them.
    os.register_at_fork(before=gc.disable, after_in_parent=gc.enable)


def pytest_addoption(parser: pytest.Parser) -> None:
    parser.addoption("--stage", choices=[*STAGES], help="only the tests of one stage")


def pytest_ignore_collect(collection_path: Path, config: pytest.Config) -> bool | None:
    wanted = config.getoption("--stage")
    if wanted is None or collection_path == TESTS or not collection_path.is_relative_to(TESTS):
        return None
    return True if stage_of(collection_path) != wanted else None


def pytest_configure(config: pytest.Config) -> None:
    """Undo what a shell does to background jobs: programs that tests start would inherit it, and
    could not be interrupted."""
    config.addinivalue_line("markers", "peer(name, ...): needs these foreign programs")
    config.pluginmanager.register(TimeLimits())
    if not hasattr(config, "workerinput"):
        peer.share()
        multicast.have_it()
    if signal.getsignal(signal.SIGINT) is signal.SIG_IGN:
        signal.signal(signal.SIGINT, signal.default_int_handler)
    hang_up = getattr(signal, "SIGHUP", None)
    if hang_up is not None and signal.getsignal(hang_up) is signal.SIG_IGN:
        signal.signal(hang_up, signal.SIG_DFL)


@pytest.hookimpl(tryfirst=True)  # before -m is applied
def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Give the marker `peer` to tests that need one by a fixture, and say of which rows a system
    has nothing."""
    for item in items:
        row = getattr(getattr(item, "callspec", None), "params", {}).values()
        if NO_UNIX_SOCKETS and "unix_stream" in item.name:
            item.add_marker(pytest.mark.skip(NO_UNIX_SOCKETS))
        if NO_MEMFD and any(isinstance(one, str) and one == "memory" for one in row):
            item.add_marker(pytest.mark.skip(NO_MEMFD))
        names = peer.needed(item)
        if names:
            item.add_marker(pytest.mark.peer(*names))


@pytest.hookimpl(wrapper=True)
def pytest_collection() -> Generator[None, object, object]:
    """Let the collector of garbage leave alone what all tests are made of, a million objects: it
    would go through them again and again while they are made, and with each test that calls it."""
    gc.disable()
    try:
        return (yield)
    finally:
        gc.freeze()
        gc.enable()


@pytest.fixture(scope="module")
def no_collector() -> Generator[None, None, None]:
    """Let it leave alone what a module reads of all source files, a million objects that no circle
    holds: it takes three times as long as reading them."""
    gc.disable()
    yield
    gc.enable()


@pytest.hookimpl(tryfirst=True)
def pytest_runtest_setup(item: pytest.Item) -> None:
    """Each test sees as many warnings as a program in its first minute, and logs as one that has
    configured nothing."""
    log._kinds.clear()
    LOGGER.handlers, LOGGER.propagate = [*UNCONFIGURED[0]], UNCONFIGURED[2]
    LOGGER.setLevel(UNCONFIGURED[1])
    peer.enter(peer.needed(item))


@pytest.hookimpl(wrapper=True)
def pytest_runtest_teardown() -> Generator[None, None, None]:
    try:
        return (yield)
    finally:
        peer.leave()
