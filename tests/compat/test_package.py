"""compat as a package: what it imports, when, and what it says about names that it has not."""

from __future__ import annotations

import ast
import os
import subprocess
import sys
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import pytest
from support.table import for_each
from support.wait import HANG

ROOT = Path(__file__).parents[2]
SOURCE = ROOT / "compat" / "src" / "yarp"
FILES = sorted(SOURCE.glob("*.py"))

# What compat may know of yarpy: what any program may.
ALLOWED = {
    "yarpy",
    "yarpy.carriers.base",
    "yarpy.cli.start",
    "yarpy.config.command_line",
    "yarpy.config.configuration",
    "yarpy.config.ini",
    "yarpy.config.resource",
    "yarpy.contact",
    "yarpy.data.sig.pixel",
    "yarpy.data.text",
    "yarpy.idl",
    "yarpy.kits",
    "yarpy.kits.devices",
    "yarpy.kits.devices.catalogue",
    "yarpy.kits.devices.frame_grabber.firewire",
    "yarpy.kits.devices.interfaces",
    "yarpy.kits.devices.interfaces.grid_file",
    "yarpy.kits.devices.refusal",
    "yarpy.kits.devices.status",
    "yarpy.kits.devices.wrapper",
    "yarpy.kits.launch.manager",
    "yarpy.kits.launch.robot.standalone",
    "yarpy.log",
    "yarpy.names.default",
    "yarpy.names.discovery",
    "yarpy.platform.console",
    "yarpy.network.asking",
    "yarpy.network.connection",
    "yarpy.network.qos",
    "yarpy.platform.folders",
    "yarpy.qos",
    "yarpy.registry",
}


def run(code: str, environment: Mapping[str, str]) -> str:
    done = subprocess.run(
        [sys.executable, "-c", code],
        capture_output=True,
        text=True,
        timeout=HANG,
        env=environment,
    )
    assert done.returncode == 0, done.stderr
    return done.stdout


@for_each(FILES)
def test_only_the_public_side_of_yarpy_is_used(path: Path) -> None:
    tree = ast.parse(path.read_text(encoding="utf-8"))
    assert ast.get_docstring(tree)
    for node in ast.walk(tree):
        names = [alias.name for alias in node.names] if isinstance(node, ast.Import) else []
        if isinstance(node, ast.ImportFrom):
            names = [node.module or ""]
        for name in names:
            assert not name.startswith("yarpy") or name in ALLOWED, f"{node.lineno}: {name}"


def test_import_loads_nothing_heavy(environment: Mapping[str, str]) -> None:
    heavy = ("numpy", "click", "rich", "socket", "yarpy.port")
    code = f"import sys, yarp; print(sorted(set({heavy!r}) & sys.modules.keys()))"
    assert run(code, environment).strip() == "[]"


@pytest.mark.skipif(not hasattr(os, "fork"), reason="Windows has no fork")
def test_import_starts_no_thread_and_a_fork_works(environment: Mapping[str, str]) -> None:
    code = """
import os, threading, yarp
yarp.Network.init()
assert threading.active_count() == 1
yarp.Network.setLocalMode(True)
child = os.fork()
a, b = yarp.Port(), yarp.BufferedPortBottle()
assert a.open("/a") and b.open("/b") and yarp.Network.connect("/a", "/b")
a.write(yarp.Bottle("hello"))
assert b.read().toString() == "hello"
a.close(), b.close()
if child:
    print(os.waitpid(child, 0)[1])
"""
    assert run(code, environment).strip() == "0"


def test_program_that_leaves_its_ports_open_ends(environment: Mapping[str, str]) -> None:
    code = """
import yarp
yarp.Network.setLocalMode(True)
ports = [yarp.Port(), yarp.BufferedPortBottle(), yarp.RpcServer(), yarp.RpcClient()]
for index, port in enumerate(ports):
    assert port.open("/p%d" % index)
class Heard(yarp.BottleCallback):
    pass
ports[1].useCallback(Heard())
ports[3].addOutput("/p2")
print("end")
"""
    assert run(code, environment).strip() == "end"


def test_every_name_of_the_table_is_there() -> None:
    import yarp

    for name in dir(yarp):
        assert getattr(yarp, name) is not None or name.startswith("_"), name


def test_static_methods_are_functions_too() -> None:
    import yarp

    assert yarp.Network_connect is yarp.Network.connect
    assert yarp.NetworkBase_exists is yarp.NetworkBase.exists
    assert yarp.Value_makeInt32(3).asInt32() == 3
    assert yarp.Time_now() <= yarp.now()


def test_missing_member_of_a_class_says_what_there_is() -> None:
    import yarp

    with pytest.raises(AttributeError, match=r"did you mean Network_connect"):
        _ = yarp.Network_conect


def test_missing_name_says_what_there_is() -> None:
    import yarp

    with pytest.raises(AttributeError, match=r"did you mean BufferedPortBottle.*README"):
        yarp.BufferedPortBotle
    with pytest.raises(NotImplementedError, match=r"it is the << of C\+\+"):
        yarp.LogStream()
    with pytest.raises(AttributeError, match="no attribute 'Network_nothing'"):
        yarp.Network_nothing
    assert not hasattr(yarp, "__path_hook__")


def test_log_is_forwarded_where_the_environment_says_so(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    import logging

    import yarp

    made: list[logging.LogRecord] = []
    before = logging.getLogRecordFactory()

    def make(*arguments: Any, **more: Any) -> logging.LogRecord:
        made.append(before(*arguments, **more))
        return made[-1]

    monkeypatch.setattr(logging, "_logRecordFactory", make)
    yarp.Log().warning("unseen")
    monkeypatch.setenv("YARP_FORWARD_LOG_ENABLE", "1")
    yarp.Log().warning("100 % hot")
    yarp.Log.trace("deep")
    assert [(one.getMessage(), one.levelno) for one in made] == [("100 % hot", 30), ("deep", 5)]
    said = capsys.readouterr()
    assert (said.out, said.err) == ("[TRACE] deep\n", "[WARNING] unseen\n[WARNING] 100 % hot\n")
