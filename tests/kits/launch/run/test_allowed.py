"""Which programs a server starts."""

from pathlib import Path

import pytest

from yarpy.errors import AccessRefused
from yarpy.kits.launch.run.allowed import Allowed, located


def test_without_a_list_anything_goes() -> None:
    Allowed().check(["rm", "-rf"], {"LD_PRELOAD": "x"}, "/node")
    assert not Allowed() and Allowed().path("sh") is None


def test_a_list_is_for_programs_and_their_first_words(tmp_path: Path) -> None:
    allowed = Allowed(["sleep", "sh /opt/lab.sh"], ["FOO"])
    allowed.check(["sleep", "9"], {"YARP_LOG_PROCESS_LABEL": "x", "FOO": ""}, "/node")
    allowed.check([located("sleep")], {}, "/node")
    allowed.check(["sh", "/opt/lab.sh", "-x"], {}, "/node")
    assert allowed.path("sleep") == located("sleep")
    for words in (["sh"], ["sh", "-c", "x"], ["ls"], [str(tmp_path / "sleep")]):
        with pytest.raises(AccessRefused, match=r"yarpy run --server /node --allow"):
            allowed.check(words, {}, "/node")
    for name in ("LD_PRELOAD", "PATH", "PYTHONPATH", "YARPY_SCRIPTS"):
        with pytest.raises(AccessRefused, match=f"--allow-env {name}"):
            allowed.check(["sleep"], {name: "x"}, "/node")


def test_variables_that_lead_to_other_files() -> None:
    """Another access.toml, another name server, plug-ins of somebody's own."""
    allowed = Allowed(["sleep"], ["YARP_DATA_DIRS"])
    given = {"YARP_PORT_PREFIX": "/left", "YARP_RENAME_a": "/b/c", "YARP_ROBOT_NAME": "icub"}
    allowed.check(["sleep"], given | {"YARP_NAMESPACE": "/lab"}, "/node")
    allowed.check(["sleep"], {"YARP_DATA_DIRS": "/opt"}, "/node")
    for name in ("YARP_CONFIG_HOME", "YARP_DATA_HOME", "YARP_CONFIG_DIRS", "YARP_RUNTIME_DIR"):
        with pytest.raises(AccessRefused, match=f"--allow-env {name}"):
            allowed.check(["sleep"], {name: "/tmp"}, "/node")
    for value in ("../../tmp/x", "..", "/tmp"):
        with pytest.raises(AccessRefused, match="--allow-env YARP_ROBOT_NAME"):
            allowed.check(["sleep"], {"YARP_ROBOT_NAME": value}, "/node")
