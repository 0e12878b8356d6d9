"""Log lines: where they go, which of them, and in which colours."""

import logging

import pytest

from yarpy.cli import log


@pytest.fixture
def err(monkeypatch, capsys):
    """What standard error got."""
    logger = logging.getLogger("yarpy")
    before = list(logger.handlers), logger.level, logger.propagate
    for name in ("YARP_QUIET", "YARP_VERBOSE", "YARP_COLORED_OUTPUT"):
        monkeypatch.delenv(name, raising=False)
    yield lambda: capsys.readouterr().err
    logger.handlers, logger.level, logger.propagate = before


def say():
    log = logging.getLogger("yarpy.port")
    log.debug("deep")
    log.info("Port %s active", "/x")
    log.warning("odd")
    log.error("bad")


def test_information_and_worse(err):
    log.show()
    say()
    assert err() == "[INFO] Port /x active\n[WARNING] odd\n[ERROR] bad\n"


def test_shown_once_however_often_it_is_asked_for(err):
    log.show()
    log.show()
    logging.getLogger("yarpy.port").warning("odd")
    assert err() == "[WARNING] odd\n"


@pytest.mark.parametrize(
    ("variable", "value", "first"),
    [
        ("YARP_QUIET", "1", "[WARNING] odd"),
        ("YARP_QUIET", "True", "[WARNING] odd"),
        ("YARP_QUIET", "off", "[INFO] Port /x active"),
        ("YARP_QUIET", "what?", "[INFO] Port /x active"),
        ("YARP_VERBOSE", "on", "[DEBUG] deep"),
        ("YARP_COLORED_OUTPUT", "1", "[\x1b[34m\x1b[1mINFO\x1b[0m] Port /x active"),
    ],
)
def test_the_environment_decides(err, monkeypatch, variable, value, first):
    monkeypatch.setenv(variable, value)
    log.show()
    say()
    assert err().splitlines()[0] == first
